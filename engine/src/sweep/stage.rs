//! What quantities are computed from, each stage from the one before: the values of the preset, its start, its curve,
//! the unloading under one control, the loop under one control.

use super::fault::Fault;
use crate::case::{Case, CaseError};
use crate::fit::least_squares::Ending;
use crate::fit::{Fit, Fitted, Options, Verdict, fit_own};
use crate::preset::Preset;
use crate::problem::{Control, Groups, Problem};
use crate::progress::Progress;
use crate::quasistatic::beyond::{is_smaller_beyond, is_smaller_within};
use crate::quasistatic::monotone::weighted;
use crate::quasistatic::{Curve, Detail, Equilibrium, Event, EventKind, Path, PathState, State};
use crate::report::number::exact;
use crate::theory::jkr::Jkr;
use crate::theory::worst_phase::WorstPhase;
use std::cell::OnceCell;
use std::fmt;

/// A value of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell {
    /// A number; in the user's units once it is in a row.
    Number(f64),
    /// A count.
    Count(usize),
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(x) => f.write_str(&exact(*x)),
            Self::Count(n) => write!(f, "{n}"),
        }
    }
}

/// Values of the preset, in the user's units.
pub(super) struct PresetValues {
    problem: Problem,
    pub(super) groups: Groups,
}

/// The start, reduced.
pub(super) struct StartState {
    pub(super) case: Case,
}

/// The curve, reduced.
pub(super) struct CurveMinima {
    pub(super) curve: Curve,
    /// The state of smallest force and the state of smallest approach.
    least: [LeastState; 2],
    critical_force: Option<f64>,
}

/// The state of the curve at which the controlled quantity is smallest.
struct LeastState {
    state: State,
    /// Whether it is the innermost state, or contacts further in have a smaller value.
    is_early: OnceCell<bool>,
    is_cut_off: OnceCell<bool>,
    control: Control,
}

/// An unloading or a loop under one control, reduced.
pub(super) struct OnPath {
    pub(super) path: Path,
}

/// The fit of `data.free` to the measured curve of the preset, in the user's units.
pub(super) struct Fitting {
    fit: Fit,
}

impl Fitting {
    /// The fit as `pulloff fit` makes it without further options; a fit that did not finish, or whose values the points
    /// do not determine, is a fault.
    pub(super) fn new(preset: &Preset, progress: &dyn Progress) -> Result<Self, Fault> {
        let free = preset.data.free().map(str::to_owned).collect();
        let options = Options { free, ..Options::default() };
        let fit = fit_own(preset, &options, progress).map_err(|error| Fault::of_fit(&error))?;
        match &fit.direction {
            _ if fit.ending != Ending::Converged => Err(Fault::bad_fit("it did not converge")),
            Some(direction) => Err(Fault::bad_fit(direction)),
            None => Ok(Self { fit }),
        }
    }

    fn of(&self, key: &str) -> Option<&Fitted> {
        self.fit.parameters.iter().find(|fitted| fitted.key == key)
    }

    pub(super) fn value(&self, key: &str) -> Option<Cell> {
        self.of(key).map(|fitted| Cell::Number(fitted.value))
    }

    pub(super) fn error(&self, key: &str) -> Option<Cell> {
        let is_believed = self.fit.verdict == Verdict::Describes;
        self.of(key)?.standard_error.filter(|_| is_believed).map(Cell::Number)
    }

    pub(super) fn chi_squared(&self) -> Cell {
        Cell::Number(self.fit.chi_squared)
    }

    pub(super) fn warnings(&self) -> Cell {
        Cell::Count(self.fit.reasons.len() + self.fit.warnings.len())
    }

    pub(super) fn verdict(&self) -> Cell {
        Cell::Count(if self.fit.verdict == Verdict::Describes { 0 } else { 4 })
    }

    pub(super) fn outliers(&self) -> Cell {
        Cell::Count(self.fit.outliers)
    }
}

impl OnPath {
    fn event(&self, kind: EventKind) -> Option<&Event> {
        self.path.events.iter().find(|event| event.kind == kind)
    }

    pub(super) fn loss(&self) -> Option<Cell> {
        let totals = &self.path.totals;
        let band = totals.dead_band.map_or(0.0, |band| band.lost);
        totals.dissipated.map(|lost| Cell::Number(lost + band))
    }

    pub(super) fn largest_pull(&self) -> Option<Cell> {
        self.path.largest_pull().map(|state| Cell::Number(state.force))
    }

    pub(super) fn farthest(&self) -> Option<Cell> {
        self.path.farthest().map(|state| Cell::Number(state.approach))
    }

    pub(super) fn last_contact(&self, of: fn(&PathState) -> f64) -> Option<Cell> {
        let last = self.path.last_contact()?.before.as_ref()?;
        Some(Cell::Number(of(last)))
    }

    pub(super) fn last_contact_loss(&self) -> Option<Cell> {
        self.path.last_contact()?.dissipated.map(Cell::Number)
    }

    fn snapping(&self) -> impl Iterator<Item = &Event> {
        self.path.events.iter().filter(|event| event.kind == EventKind::Snap)
    }

    pub(super) fn snaps(&self) -> Cell {
        Cell::Count(self.snapping().count())
    }

    pub(super) fn snap_loss(&self) -> Cell {
        Cell::Number(self.snapping().filter_map(|event| event.dissipated).fold(0.0, |sum, loss| sum + loss))
    }

    pub(super) fn first_touch(&self, of: fn(&PathState) -> f64) -> Option<Cell> {
        // Bodies that jump in may make contact in the same jump.
        let touches = |event: &&Event| {
            let lands = event.after.as_ref().is_some_and(|state| !state.contacts.is_empty());
            event.kind == EventKind::FirstTouch || event.kind == EventKind::JumpIn && lands
        };
        let after = self.path.events.iter().find(touches)?.after.as_ref()?;
        Some(Cell::Number(of(after)))
    }

    pub(super) fn jump_in(&self, of: fn(&PathState) -> f64) -> Option<Cell> {
        let after = self.event(EventKind::JumpIn)?.after.as_ref()?;
        Some(Cell::Number(of(after)))
    }

    pub(super) fn snap_off(&self, of: fn(&PathState) -> f64) -> Option<Cell> {
        let before = self.event(EventKind::SnapOff)?.before.as_ref()?;
        Some(Cell::Number(of(before)))
    }

    pub(super) fn touches(&self) -> Cell {
        Cell::Count(self.path.events.iter().filter(|event| event.kind == EventKind::Touch).count())
    }

    pub(super) fn rings_at_most(&self) -> Cell {
        Cell::Count(self.path.states.iter().map(PathState::rings).max().unwrap_or(0))
    }

    pub(super) fn contact_share(&self) -> Option<Cell> {
        let at = self.event(EventKind::Turn)?.before.as_ref()?;
        let circle = std::f64::consts::PI * at.contact_radius * at.contact_radius;
        (circle > 0.0).then_some(Cell::Number(at.contact_area / circle))
    }
}

impl PresetValues {
    pub(super) fn new(preset: &Preset) -> Self {
        let problem = preset.problem();
        let groups = Groups::of(&problem, preset.range_of_action(), preset.cohesion());
        Self { problem, groups }
    }

    pub(super) fn critical_force(&self) -> Option<Cell> {
        let radius = self.problem.shape.radius_of_curvature()?;
        Some(Cell::Number(1.5 * std::f64::consts::PI * self.problem.work_of_adhesion * radius))
    }

    /// The gap without its waves, and the waves; `None` if there are no waves or no adhesion.
    fn worst_phase(&self) -> Option<WorstPhase> {
        let smooth = Jkr {
            effective_modulus: self.problem.effective_modulus,
            work_of_adhesion: self.problem.work_of_adhesion,
            radius_of_curvature: self.problem.shape.radius_of_curvature()?,
        };
        let waves = self.problem.shape.waves();
        (!waves.is_empty()).then_some(WorstPhase { smooth, waves })
    }

    pub(super) fn kesari_lew(&self) -> Option<Cell> {
        let ratio = self.worst_phase()?.kesari_lew();
        ratio.is_finite().then_some(Cell::Number(ratio))
    }

    pub(super) fn guduru(&self) -> Option<Cell> {
        self.worst_phase()?.guduru().map(Cell::Number)
    }
}

impl StartState {
    pub(super) fn contact_radius(&self) -> Cell {
        Cell::Number(self.case.start)
    }
}

impl CurveMinima {
    pub(super) fn new(case: &Case, progress: &dyn Progress) -> Result<Self, CaseError> {
        let mut curve = case.curve_in(Detail::Borders, progress)?;
        let least = [Control::Force, Control::Displacement].map(|control| {
            curve.hold(control);
            let state = least(&curve, control);
            LeastState { state, is_early: OnceCell::new(), is_cut_off: OnceCell::new(), control }
        });
        let critical_force = case.critical_force().map(|force| force / case.units().force);
        Ok(Self { curve, least, critical_force })
    }

    pub(super) fn least(&self, of: fn(&State) -> f64) -> Result<Option<Cell>, Fault> {
        Ok(Some(Cell::Number(of(self.smallest(0)?))))
    }

    pub(super) fn least_approach(&self) -> Result<Option<Cell>, Fault> {
        Ok(Some(Cell::Number(self.smallest(1)?.approach)))
    }

    pub(super) fn enhancement(&self) -> Result<Option<Cell>, Fault> {
        let Some(critical_force) = self.critical_force else { return Ok(None) };
        Ok(Some(Cell::Number(-self.smallest(0)?.force / critical_force)))
    }

    pub(super) fn waves(&self) -> Result<Option<Cell>, Fault> {
        let Some(wave) = self.curve.equilibrium.problem.gap.feature_length() else { return Ok(None) };
        Ok(Some(Cell::Number(self.smallest(0)?.contact_radius / wave)))
    }

    /// The state of smallest force, or of smallest approach, among all contacts and not only those up to the start.
    fn smallest(&self, which: usize) -> Result<&State, Fault> {
        let LeastState { state, is_early, is_cut_off, control } = &self.least[which];
        let is_cut_off = is_cut_off.get_or_init(|| {
            let (start, Equilibrium { problem, table, .. }) =
                (self.curve.outermost(), &self.curve.equilibrium);
            let here = state.contact_radius;
            here >= start || is_smaller_beyond(table, problem, [start, here], *control, None)
        });
        let is_early = is_early.get_or_init(|| {
            let Equilibrium { problem, table, .. } = &self.curve.equilibrium;
            let end = self.curve.samples.last().map_or(0.0, |end| end.contact_radius);
            let here = weighted(*control, state.approach, state.force);
            // Without adhesion everything is smallest where the contact vanishes.
            problem.work_of_adhesion > 0.0
                && (state.contact_radius <= end
                    || is_smaller_within(table, problem, (end, here), *control, None))
        });
        match (*is_cut_off, *is_early) {
            (true, _) => Err(Fault::small_start()),
            (false, true) => Err(Fault::early_end()),
            (false, false) => Ok(state),
        }
    }
}

/// The state of the curve at which the quantity held by `control` is smallest.
fn least(curve: &Curve, control: Control) -> State {
    let limits = curve
        .limit_points(control)
        .into_iter()
        .map(|limit| [limit.contact_radius, limit.approach, limit.force]);
    let ends = [curve.samples.first(), curve.samples.last()].into_iter().flatten();
    let ends = ends.map(|at| [at.contact_radius, at.approach, at.force]);
    let value = |[_, approach, force]: &[f64; 3]| weighted(control, *approach, *force);
    let found = limits.chain(ends).min_by(|a, b| value(a).total_cmp(&value(b)));
    let [contact_radius, approach, force] = found.unwrap_or([f64::NAN; 3]);
    // The energy is not needed here.
    State { contact_radius, approach, force, energy: f64::NAN }
}
