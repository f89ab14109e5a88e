//! The background curve: everything the screen shows of a preset.
//!
//! It comes in two parts. A [`ProblemCurve`] belongs to the problem: the curve itself does not know what is controlled. A
//! [`CurveData`] adds what belongs to the control: limit points, stability, events. Another control, or another
//! stiffness of the device, needs the second part only.
//!
//! Which states are admissible takes longer than both, and is added to a curve that is on the screen already.

use super::progress::{CurveStage, Staged};
use super::setting::{Setting, basis, same_curve};
use super::theory::Theory;
use pulloff_engine::case::{Case, CaseError};
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::{Begin, Control, Groups};
use pulloff_engine::progress::{Progress, Stopped};
use pulloff_engine::quasistatic::overlap::overlaps;
use pulloff_engine::quasistatic::{
    Admissibility, Curve, Detail, Limit, Overlap, Path, Sample, Stability, Stiffness,
};
use pulloff_engine::report::path::LOOP_IS_EXACT;
use pulloff_engine::report::{OverlapReport, PathReport};
use std::sync::Arc;

/// Decimal digits of states of adhesion with a range: their series are evaluated to as many.
const ZONE_DIGITS: f64 = 11.0;
/// The controls whose limit points are shown under every control.
const SHOWN: [Control; 2] = [Control::Displacement, Control::Force];

/// One point of the curve in the user's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// s.
    pub contact_radius: f64,
    pub stable: bool,
}

/// Neighbouring states of the curve that are inadmissible.
#[derive(Debug, Clone, PartialEq)]
pub struct Inadmissible {
    pub report: OverlapReport,
    /// δ, P and s of its states in the user's units, both ends included.
    pub places: Vec<[f64; 3]>,
}

/// What belongs to the problem, whatever is controlled: the curve, swept once, and all that follows from it alone.
#[derive(Debug, Clone)]
pub struct ProblemCurve {
    /// The preset it was swept for; its control does not matter here.
    pub preset: Preset,
    pub case: Case,
    /// The curve between start and end, reduced. It holds the limit points of `SHOWN`.
    pub curve: Curve,
    pub theory: Theory,
    pub groups: Groups,
    /// Decimal digits to which the basis can be trusted at the start.
    pub digits: f64,
    /// dP/dδ and dA/dδ at the start, reduced; `None` for an empty curve.
    pub stiffness: Option<Stiffness>,
    /// `P_c`; 0 without adhesion.
    pub critical_force: f64,
    /// The admissibility of the start; `None` for an empty curve.
    pub start: Option<Admissibility>,
    /// Where the curve is not admissible, from the start inward; `None` until checked.
    pub inadmissible: Option<Vec<Inadmissible>>,
    pub warnings: Vec<String>,
    pub notes: Vec<String>,
}

/// What the screen shows of a preset: the curve of its problem, and what belongs to its control.
#[derive(Debug, Clone)]
pub struct CurveData {
    /// What belongs to the problem, shared with the curves of the same problem under other controls.
    pub base: Arc<ProblemCurve>,
    pub case: Case,
    /// The problem and its control, shared with the nodes walked on it.
    pub setting: Arc<Setting>,
    /// The curve in the user's units, including the part before it on which the path of an unstable start begins.
    pub points: Vec<CurvePoint>,
    /// The limit points under the chosen control, reduced, from the start inward.
    pub limits: Vec<Limit>,
    /// The limit points of the other controls in the user's units, with their control.
    pub other_limits: Vec<(Control, CurvePoint)>,
    /// The quasi-static unloading path, reduced, or why there is none.
    pub unloading: Result<Path, String>,
    /// The path of the device, along which the walker goes if the states lie on no single curve, or why there is none.
    pub along: Option<Result<Arc<Path>, String>>,
    pub report: Option<PathReport>,
    /// Whether the checks that take longer have been made for the path too.
    checked: bool,
}

impl ProblemCurve {
    /// Computes the curve of `preset`.
    pub fn compute(preset: &Preset, progress: &Staged<'_>) -> Result<Self, CaseError> {
        let walked = Preset { basis: basis(preset), ..preset.clone() };
        let case = Case::with_range(&walked, progress)?;
        progress.enter(CurveStage::Curve(1));
        let mut curve = case.curve(progress)?;
        progress.enter(CurveStage::Limits);
        for control in SHOWN {
            progress.go_on()?;
            curve.hold(control);
        }
        // With a range of adhesion, each state has been checked already, and the equations of the curve do not hold for
        // it.
        let in_zone = case.cohesion.is_some();
        let start = (!in_zone).then(|| curve.equilibrium.explicit(curve.outermost())).flatten();
        let digits = if in_zone { ZONE_DIGITS } else { case.basis.trusted_digits(&case.reduced, case.start) };
        let warnings =
            if in_zone { case.warnings_of_problem(case.start) } else { case.warnings(curve.outermost()) };
        let mut notes = if in_zone { Vec::new() } else { case.notes(curve.outermost()) };
        if walked.basis != preset.basis {
            notes.push(LOOP_IS_EXACT.to_owned());
        }
        Ok(Self {
            preset: preset.clone(),
            start: start.as_ref().map(|point| curve.equilibrium.admissibility(point, progress)),
            inadmissible: in_zone.then(Vec::new),
            theory: Theory::of(&case, &curve, progress).ok_or(Stopped)?,
            groups: Groups::of(&case.problem, preset.range_of_action(), preset.cohesion()),
            digits,
            stiffness: start.as_ref().map(|point| curve.equilibrium.state_and_stiffness(point).1),
            critical_force: case.critical_force().unwrap_or(0.0),
            warnings,
            notes,
            curve,
            case,
        })
    }

    /// Whether it is the curve of `preset`, whose control may differ.
    pub fn is_of(&self, preset: &Preset) -> bool {
        same_curve(&self.preset, preset)
    }

    /// An inadmissible part of the curve with its states.
    fn part(&self, overlap: &Overlap, report: OverlapReport) -> Inadmissible {
        let units = self.case.units();
        let between = |at: &&Sample| overlap.to < at.contact_radius && at.contact_radius < overlap.from;
        let place =
            |[delta, force, s]: [f64; 3]| [delta * units.length, force * units.force, s * units.length];
        let inner = self.curve.samples.iter().filter(between);
        let inner = inner.map(|at| [at.approach, at.force, at.contact_radius]);
        let [from, to] = [overlap.from, overlap.to].map(|s| {
            let at = self.curve.solution.at(self.curve.solution.place(s)?);
            Some([at.approach, at.force, s])
        });
        Inadmissible { report, places: from.into_iter().chain(inner).chain(to).map(place).collect() }
    }
}

/// `points`, from outside inward, with the limit points at which their stability changes between them: each belongs to the part that
/// it begins.
fn parted(points: Vec<CurvePoint>, limits: &[CurvePoint]) -> Vec<CurvePoint> {
    let mut all: Vec<CurvePoint> = Vec::with_capacity(points.len() + limits.len());
    for point in points {
        if let Some(before) = all.last().filter(|before| before.stable != point.stable) {
            let (outer, inner) = (before.contact_radius, point.contact_radius);
            let mut between =
                limits.iter().filter(|at| inner < at.contact_radius && at.contact_radius < outer);
            if let (Some(limit), None) = (between.next(), between.next()) {
                all.push(CurvePoint { stable: point.stable, ..*limit });
            }
        }
        all.push(point);
    }
    all
}

impl CurveData {
    /// Computes the curve of `preset` and what belongs to its control.
    pub fn compute(preset: &Preset, progress: &Staged<'_>) -> Result<Self, CaseError> {
        Self::under(Arc::new(ProblemCurve::compute(preset, progress)?), preset, progress)
    }

    /// The curve `base` under the control of `preset`, whose problem must be the same: no equilibrium is computed again.
    pub fn under(base: Arc<ProblemCurve>, preset: &Preset, progress: &Staged<'_>) -> Result<Self, CaseError> {
        let mut curve = base.curve.clone();
        let units = *base.case.units();
        let control = preset.path.control.in_units(units.stiffness);
        let case = Case { control, contact: preset.path.contact, ..base.case.clone() };
        let shown = |at: &Sample| CurvePoint {
            approach: at.approach * units.length,
            force: at.force * units.force,
            contact_radius: at.contact_radius * units.length,
            stable: at.slopes.under(control),
        };
        curve.hold(control);
        let limits = curve.limit_points(control);
        let at_limit = |limit: &Limit| {
            let Limit { contact_radius, approach, force, .. } = *limit;
            shown(&Sample {
                contact_radius,
                approach,
                force,
                slopes: Stability { approach: 0.0, force: 0.0 },
            })
        };
        let other_limits = SHOWN
            .into_iter()
            .filter(|other| *other != control)
            .flat_map(|other| curve.limit_points(other))
            .map(|limit| (limit.control, at_limit(&limit)))
            .collect();
        progress.enter(CurveStage::Events);
        let told = |path: Result<Path, CaseError>| match path {
            Err(CaseError::Stopped(stopped)) => Err(stopped),
            path => Ok(path.map_err(|error| error.to_string())),
        };
        let unloading = told(case.unload(&curve, &case.setting_of_unloading(), progress))?;
        let along = if case.cohesion.is_none() && case.closing.is_none() {
            None
        } else if preset.path.begin == Begin::Disc {
            Some(unloading.clone())
        } else {
            let turn = preset.path.turn;
            let turn = turn.map(|turn| turn.in_units(1.0 / units.length, 1.0 / units.force, control));
            Some(told(case.cycle(turn, &case.setting(), progress))?)
        };
        // If the path of an unstable start begins further out, the curve is drawn up to there.
        let start = unloading.as_ref().ok().and_then(|path| path.start()).filter(|start| start.rings() == 0);
        let start = start.map_or(0.0, |start| start.contact_radius);
        let outward = if case.cohesion.is_none() && start > curve.outermost() * (1.0 + 1e-12) {
            let (problem, ends) = (case.reduced.clone(), [start, curve.outermost()]);
            let (basis, table) = (Arc::clone(&case.basis), Arc::clone(&case.table));
            Curve::new(problem, basis, table, ends, Detail::Drawn, progress)?
        } else {
            None
        };
        let outward = outward.map_or_else(Vec::new, |outward| outward.samples);
        let own = outward.len().saturating_sub(1);
        let points: Vec<CurvePoint> = outward[..own].iter().chain(&curve.samples).map(shown).collect();
        let points = parted(points, &limits.iter().map(at_limit).collect::<Vec<_>>());
        let report = unloading.as_ref().ok().map(|path| PathReport::new(preset, &case, path));
        let setting = Arc::new(Setting::new(preset.clone(), curve.equilibrium.scales));
        let along = along.map(|path| path.map(Arc::new));
        let checked = case.cohesion.is_some();
        Ok(Self { base, case, setting, points, limits, other_limits, unloading, along, report, checked })
    }

    /// The warnings about the path where it starts with a disc, and otherwise about the problem.
    pub fn warnings(&self) -> Vec<String> {
        let path = self.report.as_ref().filter(|_| self.setting.preset.path.begin == Begin::Disc);
        path.map_or(&self.base.warnings, |path| &path.warnings).clone()
    }

    /// The outer edge of the zone (reduced) in this state of the path, where adhesion has a range.
    pub fn zone(&self, at: usize) -> Option<f64> {
        self.along.as_ref()?.as_ref().ok()?.states.get(at)?.zone
    }

    /// δ, P and s of the limit points under the chosen control in the user's units, from the start inward.
    pub fn shown_limits(&self) -> Vec<[f64; 3]> {
        let units = self.case.units();
        let shown = |limit: &Limit| {
            [limit.approach * units.length, limit.force * units.force, limit.contact_radius * units.length]
        };
        self.limits.iter().map(shown).collect()
    }

    /// Whether the admissibility of its states and of its path has been checked.
    pub fn is_checked(&self) -> bool {
        self.base.inadmissible.is_some() && self.checked
    }

    /// The same curve with its inadmissible states and those of its path; `None` if `progress` asked to stop.
    pub fn checked(&self, progress: &dyn Progress) -> Option<Self> {
        if self.is_checked() {
            return Some(self.clone());
        }
        let mut base = Arc::clone(&self.base);
        if base.inadmissible.is_none() {
            let overlaps = overlaps(&base.curve, progress).ok()?;
            let reports = OverlapReport::all(&overlaps, base.case.units());
            let parts = overlaps.iter().zip(reports).map(|(overlap, report)| base.part(overlap, report));
            base = Arc::new(ProblemCurve { inadmissible: Some(parts.collect()), ..(*base).clone() });
        }
        let mut report = self.report.clone();
        if let (Ok(unloading), Some(unchecked)) = (&self.unloading, &self.report) {
            let mut checked = unchecked.clone().checked(&self.case, &base.curve, unloading, progress).ok()?;
            checked.warnings.extend(self.case.unsettled(unloading, progress));
            report = Some(checked);
        }
        // A check that was given up may lack its warning.
        (!progress.stop()).then(|| Self { base, report, checked: true, ..self.clone() })
    }
}
