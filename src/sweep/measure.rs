//! The wanted quantities of one preset, and nothing else: no curve where the groups are all, no losses where none are
//! asked for.

use super::fault::Fault;
use super::quantity::{Column, Of};
use pulloff_engine::case::{Case, CaseError};
use pulloff_engine::disc::{ExactSolution, Solution};
use pulloff_engine::gap::Gap;
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::{Control, Groups, Problem};
use pulloff_engine::quasistatic::monotone::weighted;
use pulloff_engine::quasistatic::overlap::passed_while;
use pulloff_engine::quasistatic::{
    Curve, Detail, Equilibrium, EventKind, Losses, Monotone, PathStop, State, Unloading,
};
use pulloff_engine::report::number::exact;
use pulloff_engine::theory::guduru::Guduru;
use pulloff_engine::theory::kesari_lew::KesariLew;
use pulloff_engine::units::Quantity as Unit;
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

/// The quantities of a preset.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// One for each wanted column; `None` where it is not defined or could not be had.
    pub cells: Vec<Option<Cell>>,
    /// The first reason for which one could not be had.
    pub fault: Option<Fault>,
}

/// Values of the preset, in the user's units.
pub(super) struct Ground {
    problem: Problem,
    pub(super) groups: Groups,
}

/// The start, reduced.
pub(super) struct Start {
    case: Case,
}

/// The curve, reduced.
pub(super) struct Line {
    curve: Curve,
    /// The state of smallest force and that of smallest approach.
    least: [Least; 2],
    critical_force: Option<f64>,
}

/// A state of the curve at which what a control holds is smallest; none where it is smaller in a contact larger than
/// that of the start.
struct Least {
    state: State,
    is_cut_off: OnceCell<bool>,
    control: Control,
}

/// What is smallest in contacts up to so many times the start's, and in so many more waves, is sought: from wave to wave
/// the minima fall on the way out until they rise.
const REACH: f64 = 1.5;
const WAVES: f64 = 2.0;
/// Smaller by this share is smaller.
const SMALLER: f64 = 1e-3;

/// The unloading under one control, reduced.
pub(super) struct Path {
    unloading: Unloading,
}

impl Ground {
    fn new(preset: &Preset) -> Self {
        let problem = preset.problem();
        let groups = Groups::of(&problem, preset.range_of_action());
        Self { problem, groups }
    }

    pub(super) fn critical_force(&self) -> Option<Cell> {
        let radius = self.problem.shape.radius_of_curvature()?;
        Some(Cell::Number(1.5 * std::f64::consts::PI * self.problem.work_of_adhesion * radius))
    }

    pub(super) fn kesari_lew(&self) -> Option<Cell> {
        let (amplitude, wavelength) = self.problem.shape.wave()?;
        let sphere = Guduru {
            effective_modulus: self.problem.effective_modulus,
            work_of_adhesion: self.problem.work_of_adhesion,
            radius_of_curvature: self.problem.shape.radius_of_curvature()?,
            amplitude,
            wavelength,
        };
        let ratio = KesariLew { sphere }.pull_off_ratio();
        ratio.is_finite().then_some(Cell::Number(ratio))
    }
}

impl Start {
    pub(super) fn contact_radius(&self) -> Cell {
        Cell::Number(self.case.start)
    }
}

impl Line {
    fn new(case: &Case, go_on: impl FnMut() -> bool) -> Result<Self, CaseError> {
        let mut curve = case.curve_in(Detail::Borders, go_on)?;
        let least = [Control::Force, Control::Displacement].map(|control| {
            curve.hold(control);
            Least { state: least(&curve, control), is_cut_off: OnceCell::new(), control }
        });
        let critical_force = case.critical_force().map(|force| force / case.units().force);
        Ok(Self { curve, least, critical_force })
    }

    /// Of the state of smallest force.
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

    /// The state of smallest force, or of smallest approach, of all contacts and not only of those up to the start's.
    fn smallest(&self, which: usize) -> Result<&State, Fault> {
        let Least { state, is_cut_off, control } = &self.least[which];
        let is_cut_off = is_cut_off.get_or_init(|| {
            state.contact_radius >= self.curve.outermost() || self.is_smaller_beyond(state, *control)
        });
        if *is_cut_off { Err(Fault::small_start()) } else { Ok(state) }
    }

    /// Whether what `control` holds is smaller in a larger contact than the curve has, by the table of the gap: rings need not
    /// resolve the waves out there.
    fn is_smaller_beyond(&self, state: &State, control: Control) -> bool {
        let Equilibrium { problem, table, .. } = &self.curve.equilibrium;
        let start = self.curve.outermost();
        let waves = problem.gap.feature_length().map_or(0.0, |wave| WAVES * wave);
        let far = (REACH * start + waves).min(problem.largest_contact());
        let Ok(panels) = table.up_to(far) else { return false };
        let exact = ExactSolution::new(panels, problem.work_of_adhesion);
        let Some(here) = exact.place(state.contact_radius).map(|place| exact.at(place)) else { return false };
        let here = weighted(control, here.approach, here.force);
        let [Some(first), Some(last)] = [start, far].map(|s| exact.place(s)) else { return false };
        let monotone = Monotone::on(&exact, control, first.panel..last.panel + 1);
        let ends = monotone.stretches.iter().flat_map(|stretch| {
            let [inner, outer] = stretch.radii;
            [(inner, stretch.values[0]), (outer, stretch.values[1])]
        });
        let least = ends
            .filter(|(s, _)| *s > start && *s <= far)
            .map(|(_, value)| value)
            .fold(f64::INFINITY, f64::min);
        start < far && least < here - SMALLER * here.abs()
    }
}

/// The state of the curve at which the quantity that `control` holds is smallest.
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
    // No energy is asked for here.
    State { contact_radius, approach, force, energy: f64::NAN }
}

impl Path {
    pub(super) fn pull_off(&self, of: fn(&State) -> f64) -> Option<Cell> {
        let last = self.unloading.events.last().filter(|event| event.kind == EventKind::PullOff)?;
        Some(Cell::Number(of(&last.before)))
    }

    fn snapping(&self) -> impl Iterator<Item = &pulloff_engine::quasistatic::Event> {
        self.unloading.events.iter().filter(|event| event.kind == EventKind::Snap)
    }

    pub(super) fn snaps(&self) -> Cell {
        Cell::Count(self.snapping().count())
    }

    pub(super) fn snap_loss(&self) -> Cell {
        Cell::Number(self.snapping().filter_map(|event| event.dissipated).fold(0.0, |sum, loss| sum + loss))
    }

    pub(super) fn pull_off_loss(&self) -> Option<Cell> {
        let last = self.unloading.events.last().filter(|event| event.kind == EventKind::PullOff)?;
        last.dissipated.map(Cell::Number)
    }
}

/// What has been computed of a preset so far: each part once, when the first quantity needs it.
struct Work<'a> {
    preset: &'a Preset,
    ground: Ground,
    start: Option<Result<Start, Fault>>,
    line: Option<Result<Line, Fault>>,
    paths: Vec<(Control, Result<Path, Fault>)>,
    go_on: &'a dyn Fn() -> bool,
}

/// The `wanted` quantities of `preset`; `go_on` is asked now and then, `None` when it said no.
pub fn measure(preset: &Preset, wanted: &[Column], go_on: &dyn Fn() -> bool) -> Option<Measured> {
    let ground = Ground::new(preset);
    let mut work = Work { preset, ground, start: None, line: None, paths: Vec::new(), go_on };
    let mut measured = Measured { cells: Vec::with_capacity(wanted.len()), fault: None };
    for column in wanted {
        let cell = work.cell(column).unwrap_or_else(|fault| {
            measured.fault.get_or_insert(fault);
            None
        });
        if !go_on() {
            return None;
        }
        measured.cells.push(cell.map(|cell| work.shown(cell, column.quantity)));
    }
    Some(measured)
}

impl Work<'_> {
    fn cell(&mut self, column: &Column) -> Result<Option<Cell>, Fault> {
        let own = self.preset.path.control;
        match column.quantity.of {
            Of::Ground(of) => Ok(of(&self.ground)),
            Of::Start(of) => self.start().map(of),
            Of::Line(of) => of(self.line()?),
            Of::Limits => {
                let control = self.reduced(column.under.control(own))?;
                Ok(Some(Cell::Count(self.line()?.curve.limit_points(control).len())))
            }
            Of::Path(of) => {
                let control = self.reduced(column.under.control(own))?;
                let path = self.path(control)?;
                match (of(path), path.unloading.stop) {
                    // What is counted up to there is not what is asked for.
                    (_, PathStop::Curve(stop)) => {
                        let case = &self.start()?.case;
                        let stop = PathStop::Curve(stop.in_units(case.units()));
                        Err(Fault::incomplete(&stop.words(&case.shown)))
                    }
                    (found, _) => Ok(found),
                }
            }
            Of::Passed => {
                let control = self.reduced(column.under.control(own))?;
                self.inadmissible_share(control)
            }
        }
    }

    fn reduced(&mut self, control: Control) -> Result<Control, Fault> {
        let stiffness = self.start()?.case.units().stiffness;
        Ok(control.in_units(stiffness))
    }

    fn start(&mut self) -> Result<&Start, Fault> {
        let made = self.start.get_or_insert_with(|| {
            let case = Case::prepare(self.preset, &mut |_| (self.go_on)()).map_err(|e| Fault::of_case(&e))?;
            Ok(Start { case })
        });
        made.as_ref().map_err(Clone::clone)
    }

    fn line(&mut self) -> Result<&Line, Fault> {
        if self.line.is_none() {
            let go_on = self.go_on;
            let made =
                self.start().and_then(|start| Line::new(&start.case, go_on).map_err(|e| Fault::of_case(&e)));
            self.line = Some(made);
        }
        match &self.line {
            Some(Ok(line)) => Ok(line),
            Some(Err(fault)) => Err(fault.clone()),
            None => Err(Fault::incomplete("no curve")),
        }
    }

    fn path(&mut self, control: Control) -> Result<&Path, Fault> {
        let known = self.paths.iter().position(|(known, _)| *known == control);
        let at = known.unwrap_or_else(|| {
            let made = self.line().map(|_| ()).and_then(|()| {
                let (Some(Ok(start)), Some(Ok(line))) = (&self.start, &self.line) else {
                    return Err(Fault::incomplete("no curve"));
                };
                let unloading = start.case.unload_while(&line.curve, control, Losses::Once, self.go_on);
                Ok(Path { unloading: unloading.map_err(|e| Fault::of_case(&e))? })
            });
            self.paths.push((control, made));
            self.paths.len() - 1
        });
        self.paths[at].1.as_ref().map_err(Clone::clone)
    }

    fn inadmissible_share(&mut self, control: Control) -> Result<Option<Cell>, Fault> {
        let pieces = self.path(control)?.unloading.pieces.clone();
        let go_on = self.go_on;
        let passed = passed_while(&self.line()?.curve, &pieces, &mut || go_on());
        let length = |sum: f64, [from, to]: [f64; 2]| sum + (from - to);
        let whole = pieces.iter().copied().fold(0.0, length);
        let lost =
            passed.unwrap_or_default().iter().map(|overlap| [overlap.from, overlap.to]).fold(0.0, length);
        Ok((whole > 0.0).then(|| Cell::Number(lost / whole)))
    }

    /// A cell in the user's units: what comes of the preset alone is in them already.
    fn shown(&self, cell: Cell, quantity: &super::quantity::Quantity) -> Cell {
        let (Cell::Number(x), Some(Ok(start)), false) =
            (cell, &self.start, matches!(quantity.of, Of::Ground(_)))
        else {
            return cell;
        };
        let units = start.case.units();
        Cell::Number(match quantity.unit {
            Unit::Length => x * units.length,
            Unit::Force => x * units.force,
            Unit::Energy => x * units.energy,
            _ => x,
        })
    }
}
