//! The equilibrium curve as a document.

use super::columns::columns;
use super::number::{significant, with_unit};
use super::overlap::{self, OverlapReport};
use super::path::note_of_range;
use super::problem::Head;
use super::problem::control_name;
use super::rows::{ReportTable, RowsError};
use crate::case::{Case, CaseError};
use crate::disc::{Edges, Place};
use crate::gap::wave_index;
use crate::preset::Preset;
use crate::problem::Control;
use crate::progress::{Progress, ProgressPart};
use crate::quasistatic::overlap::overlaps;
use crate::quasistatic::path::Zones;
use crate::quasistatic::{
    Curve, CurveStop, Equilibrium, Limit, Monotone, Overlap, Stability, State, StatePoint, Stiffness,
};
use crate::theory::{self, Exact};
use crate::units::Quantity;
use serde::Serialize;
use std::f64::consts::TAU;

/// The equilibrium curve with its limit points.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TraceReport {
    /// The head of the document.
    #[serde(flatten)]
    pub head: Head,
    /// What to be careful about.
    pub warnings: Vec<String>,
    /// What else is worth knowing.
    pub notes: Vec<String>,
    /// Said when the start is unstable under the control: an unloading does not begin there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_note: Option<String>,
    /// Why the trace ended, in words.
    pub stop: String,
    /// Whether it went on to where it was to end, or to where bodies with a range of adhesion lose each other.
    #[serde(skip)]
    pub has_reached_its_end: bool,
    /// The smallest force on the curve.
    pub curve_min_force: Option<f64>,
    /// The smallest approach on the curve.
    pub curve_min_approach: Option<f64>,
    /// The limit points under displacement, force and the device, each from the start inward.
    pub limit_points: Vec<LimitReport>,
    /// Where the curve is not admissible, from the start inward.
    pub inadmissible: Vec<OverlapReport>,
    /// The points.
    pub points: Vec<PointReport>,
}

/// One point of the curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PointReport {
    /// Its number, from 0.
    pub step: usize,
    /// s.
    pub contact_radius: f64,
    /// The outer edge of the zone in which adhesion with a range acts; otherwise omitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zone_radius: Option<f64>,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// U = −Φ.
    pub energy: f64,
    /// Newton rounds spent on it.
    pub newton_iterations: usize,
    /// Its stability under each control.
    pub stable: StableReport,
    /// ∂P/∂δ at a fixed contact radius, a force per length.
    pub contact_stiffness: f64,
    /// dP/dδ along the curve, a force per length; null where it is infinite, at a limit point of displacement.
    pub tangent_stiffness: Option<f64>,
    /// dA/dδ along the curve, A = πs², a length; null where it is infinite.
    pub area_slope: Option<f64>,
    /// Whether the bodies stay apart outside the disc and, without adhesion, nothing pulls inside.
    pub admissible: bool,
    /// The exact solution at the same contact radius, where it was asked for; otherwise omitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exact: Option<ExactReport>,
}

/// The exact solution at the contact radius of a point.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ExactReport {
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// U.
    pub energy: f64,
    /// P of the point minus the exact P, relative to the exact P: near P = 0 rounding shows.
    pub relative_difference: f64,
}

impl PointReport {
    /// The state at `step` of a curve of `case`, which is not admissible where it lies in one of `overlapping`.
    fn new(
        case: &Case,
        equilibrium: &Equilibrium,
        step: usize,
        (point, (state, stiffness)): (&StatePoint, (State, Stiffness)),
        overlapping: &[Overlap],
    ) -> Self {
        let units = case.units();
        let (state, stiffness) = (state.in_units(units), stiffness.in_units(units));
        let stability = equilibrium.stability(point);
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        let s = equilibrium.contact_radius(point);
        Self {
            step,
            contact_radius: state.contact_radius,
            zone_radius: None,
            approach: state.approach,
            force: state.force,
            energy: state.energy,
            newton_iterations: point.rounds,
            stable: StableReport::of(&stability, case.control),
            contact_stiffness: stiffness.contact,
            tangent_stiffness: finite(stiffness.tangent),
            area_slope: finite(stiffness.area_slope),
            admissible: !overlapping.iter().any(|overlap| overlap.contains(s)),
            exact: None,
        }
    }
}

impl PointReport {
    /// The state of a zone at a place.
    fn in_zone(case: &Case, zones: &Zones, step: usize, place: Place) -> Self {
        let units = case.units();
        let at = zones.solution.at(place);
        let Edges { contact_radius, zone } = zones.solution.edges(place);
        let stability = at.stability();
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        let area = TAU * contact_radius * zones.contact_slope(place) / stability.approach;
        Self {
            step,
            contact_radius: contact_radius * units.length,
            zone_radius: zone.map(|edge| edge * units.length),
            approach: at.approach * units.length,
            force: at.force * units.force,
            energy: zones.solution.energy(place) * units.energy,
            newton_iterations: 0,
            stable: StableReport::of(&stability, case.control),
            contact_stiffness: 2.0 * contact_radius * units.stiffness,
            tangent_stiffness: finite(stability.force / stability.approach * units.stiffness),
            area_slope: finite(area * units.length),
            admissible: true,
            exact: None,
        }
    }
}

impl ExactReport {
    /// `force` of a point beside the exact equilibrium at its radius.
    fn new(force: f64, exact: &theory::ExactEquilibrium) -> Self {
        Self {
            approach: exact.approach,
            force: exact.force,
            energy: exact.energy,
            relative_difference: (force - exact.force) / exact.force.abs(),
        }
    }
}

/// Stability under each control.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StableReport {
    /// When the approach is held.
    pub displacement: bool,
    /// When the force is held.
    pub force: bool,
    /// When the chosen control is held.
    pub chosen: bool,
}

impl StableReport {
    /// The verdicts on a state, `chosen` being the control of the document.
    pub fn of(stability: &Stability, chosen: Control) -> Self {
        Self {
            displacement: stability.under(Control::Displacement),
            force: stability.under(Control::Force),
            chosen: stability.under(chosen),
        }
    }
}

/// One limit point.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LimitReport {
    /// The control that turns there.
    pub control: Control,
    /// s.
    pub contact_radius: f64,
    /// The outer edge of the zone in which adhesion with a range acts; otherwise omitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zone_radius: Option<f64>,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// The crest of the edge; none for a gap without waves.
    pub wave: Option<u64>,
}

impl LimitReport {
    /// `limit` of `case`, with its edges.
    fn of(case: &Case, limit: &Limit, edges: Edges) -> Self {
        let units = case.units();
        Self {
            control: case.shown_control(limit.control),
            contact_radius: edges.contact_radius * units.length,
            zone_radius: edges.zone.map(|edge| edge * units.length),
            approach: limit.approach * units.length,
            force: limit.force * units.force,
            wave: wave_index(edges.contact_radius, case.reduced.gap.wavelength()),
        }
    }
}

/// The columns of the points as CSV; they never change, new ones come after them.
pub const COLUMNS: &[&str] = columns!(
    step contact_radius approach force energy newton_iterations stable_displacement stable_force stable_chosen
    contact_stiffness tangent_stiffness area_slope admissible
);

/// The columns of the exact solution, after [`COLUMNS`] where it was asked for.
pub const EXACT_COLUMNS: &[&str] =
    columns!(exact_approach exact_force exact_energy exact_relative_difference);

/// Why a trace of adhesion with a range ends where nothing cuts it short.
const OUT_OF_RANGE: &str = "the zone has shrunk to nothing: the bodies are out of range";

/// The column after them where the adhesion has a range.
pub const ZONE_COLUMNS: &[&str] = columns!(zone_radius);

/// Why an unloading does not begin where the curve does.
fn start_note(preset: &Preset, case: &Case, start: &PointReport) -> Option<String> {
    let length = |s| with_unit(&preset.units, Quantity::Length, s, true, |s| significant(s, 6));
    (!start.stable.chosen).then(|| {
        format!(
            "the start (contact radius {}) is unstable under {} control: an unloading does not begin there",
            length(start.contact_radius),
            control_name(case.control)
        )
    })
}

/// The smallest approach and the smallest force of a curve: a limit point may lie between two points.
fn smallest(points: &[PointReport], limits: &[LimitReport]) -> [Option<f64>; 2] {
    let points = points.iter().map(|p| [p.approach, p.force]);
    let all = points.chain(limits.iter().map(|p| [p.approach, p.force]));
    [0, 1].map(|at| all.clone().map(|both| both[at]).min_by(f64::total_cmp))
}

impl TraceReport {
    /// Traces `preset` by arc length and reports it.
    ///
    /// ```
    /// use pulloff_engine::{TraceReport, Unwatched, preset};
    ///
    /// let wavy = preset::read_shipped("fig-9").ok_or("no such preset")?;
    /// let curve = TraceReport::compute(&wavy, &Unwatched)?;
    /// let critical = 1.5 * std::f64::consts::PI * wavy.material.work_of_adhesion;
    /// let least = curve.curve_min_force.ok_or("no force")?;
    /// assert!((least / critical + 1.48).abs() < 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CaseError`] when it cannot be computed; [`CaseError::Stopped`] when `progress`, which is asked often, said stop.
    pub fn compute(preset: &Preset, progress: &dyn Progress) -> Result<Self, CaseError> {
        let case = Case::with_range(preset, &ProgressPart::new(progress, [0.0, 0.4]))?;
        if case.cohesion.is_some() {
            return Self::in_zone(preset, &case, &ProgressPart::new(progress, [0.4, 1.0]));
        }
        let curve = case.curve(&ProgressPart::new(progress, [0.4, 0.6]))?;
        let (branch, stop) = case.trace(&curve, &ProgressPart::new(progress, [0.6, 0.8]))?;
        Self::new(preset, &case, &curve, &branch.points, stop, &ProgressPart::new(progress, [0.8, 1.0]))
    }

    /// The document of the equilibria of adhesion with a range, from the start to where the zone has shrunk to nothing, or to the
    /// first state that is not one disc in one zone.
    fn in_zone(preset: &Preset, case: &Case, progress: &dyn Progress) -> Result<Self, CaseError> {
        let units = case.units();
        let zones = case.zones(progress)?;
        let solution = &*zones.solution;
        let start = solution.radius(zones.start);
        let radius = |place| solution.radius(place);
        let drawn = zones.drawn(progress).map_err(|error| case.no_path(error, case.control));
        let (places, fault) = drawn?;
        let point = |(step, place): (usize, &Place)| PointReport::in_zone(case, &zones, step, *place);
        let points: Vec<PointReport> = places.iter().enumerate().map(point).collect();
        let least = points.last().and_then(|point| point.zone_radius).map_or(0.0, |edge| edge / units.length);
        let limit_points: Vec<LimitReport> = case
            .controls()
            .into_iter()
            .flat_map(|control| {
                let limits = Monotone::of(solution, control).limits;
                limits.into_iter().rev().filter(|limit| (least..=start).contains(&radius(limit.place)))
            })
            .map(|limit| LimitReport::of(case, &limit, solution.edges(limit.place)))
            .collect();
        let [curve_min_approach, curve_min_force] = smallest(&points, &limit_points);
        let has_reached_its_end = fault.is_none();
        let stop = fault.map_or_else(|| OUT_OF_RANGE.to_owned(), |error| error.words(&case.printer()));
        Ok(Self {
            head: Head::new("trace", preset, case),
            warnings: case.warnings_of_problem(case.start),
            notes: note_of_range(preset, case).into_iter().collect(),
            start_note: points.first().and_then(|start| start_note(preset, case, start)),
            stop,
            has_reached_its_end,
            curve_min_force,
            curve_min_approach,
            limit_points,
            inadmissible: Vec::new(),
            points,
        })
    }

    /// The same document with `exact`, the solution of the same problem in the user's units, beside each point.
    #[must_use]
    pub fn beside(mut self, exact: &Exact) -> Self {
        if self.points.iter().any(|point| point.zone_radius.is_some()) {
            self.warnings.push(
                "the exact solutions are those of short-range adhesion: none is given for adhesion with a range"
                    .to_owned(),
            );
            return self;
        }
        let radii: Vec<f64> = self.points.iter().map(|point| point.contact_radius).collect();
        let mut unresolved = 0;
        for (point, exact) in self.points.iter_mut().zip(exact.curve(&radii)) {
            unresolved += usize::from(!exact.resolved);
            point.exact = Some(ExactReport::new(point.force, &exact));
        }
        if unresolved > 0 {
            self.warnings.push(format!(
                "the integrals of the exact solution are not resolved at {unresolved} of {} points: it has too many \
                 waves, and its digits there are uncertain",
                self.points.len()
            ));
        }
        self
    }

    /// The document of a curve of `case`, its points `traced` along it by arc length.
    ///
    /// # Errors
    /// [`CaseError::Stopped`] when `progress` said stop.
    pub fn new(
        preset: &Preset,
        case: &Case,
        curve: &Curve,
        traced: &[StatePoint],
        stop: CurveStop,
        progress: &dyn Progress,
    ) -> Result<Self, CaseError> {
        let units = case.units();
        let equilibrium = &curve.equilibrium;
        let overlapping = overlaps(curve, progress)?;
        let inadmissible = OverlapReport::all(&overlapping, units);
        let known = equilibrium.states_and_stiffnesses(traced, progress)?;
        let points: Vec<PointReport> = traced
            .iter()
            .zip(known)
            .enumerate()
            .map(|(step, (point, known))| {
                PointReport::new(case, equilibrium, step, (point, known), &overlapping)
            })
            .collect();
        let limit_points: Vec<LimitReport> = case
            .controls()
            .into_iter()
            .flat_map(|control| curve.limit_points(control))
            .map(|limit| {
                let edges = Edges { contact_radius: limit.contact_radius, zone: None };
                LimitReport::of(case, &limit, edges)
            })
            .collect();
        let [curve_min_approach, curve_min_force] = smallest(&points, &limit_points);
        Ok(Self {
            head: Head::new("trace", preset, case),
            warnings: case
                .warnings(curve.outermost())
                .into_iter()
                .chain(case.warning_of_dead_band())
                .chain(overlap::warning("the curve", &inadmissible, &preset.units))
                .collect(),
            notes: case.notes(curve.outermost()),
            start_note: points.first().and_then(|start| start_note(preset, case, start)),
            has_reached_its_end: stop == CurveStop::End,
            stop: stop.words(&case.printer()),
            curve_min_force,
            curve_min_approach,
            limit_points,
            inadmissible,
            points,
        })
    }

    /// The points under the names of their columns.
    ///
    /// # Errors
    /// As [`ReportTable::of`].
    pub fn table(&self) -> Result<ReportTable, RowsError> {
        let exact: &[&str] =
            if self.points.iter().all(|point| point.exact.is_none()) { &[] } else { EXACT_COLUMNS };
        let zone: &[&str] =
            if self.points.iter().all(|point| point.zone_radius.is_none()) { &[] } else { ZONE_COLUMNS };
        ReportTable::of(&[COLUMNS, exact, zone].concat(), &self.points)
    }

    /// The points as CSV.
    ///
    /// # Errors
    /// As [`ReportTable::csv`].
    pub fn csv(&self) -> Result<String, RowsError> {
        self.table()?.csv()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::{Stopped, until};
    use crate::report::PathReport;
    use crate::report::path::Extent;
    use crate::{Adhesion, Material, Shape, Start, Unwatched};
    use std::cell::Cell;

    /// A document that asks whether it is still wanted.
    type Way<'a> = &'a dyn Fn(&dyn Progress) -> Option<CaseError>;

    #[test]
    fn a_document_that_is_no_longer_wanted_is_cancelled_at_every_question() {
        let gap = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 };
        let material = Material {
            effective_modulus: 1.0,
            work_of_adhesion: 0.004,
            range_of_action: None,
            adhesion: Adhesion::ShortRange,
        };
        let preset = Preset::new(material, gap, Start::ContactRadius(0.3));
        let trace = |progress: &dyn Progress| TraceReport::compute(&preset, progress).err();
        let of = Extent::default();
        let unload = |progress: &dyn Progress| PathReport::unload(&preset, of, progress).err();
        let cycle = |progress: &dyn Progress| PathReport::cycle(&preset, None, of, progress).err();
        let ways: [Way<'_>; 3] = [&trace, &unload, &cycle];
        for compute in ways {
            let asked = Cell::new(0_usize);
            let count = || {
                asked.set(asked.get() + 1);
                false
            };
            // The tables that are kept are asked for once.
            assert_eq!(compute(&Unwatched), None);
            assert_eq!(compute(&count), None);
            let all = asked.get();
            assert!(all >= 5, "{all}");
            for number in 1..=all {
                assert_eq!(
                    compute(&until(number - 1)),
                    Some(CaseError::Stopped(Stopped)),
                    "{number} of {all}"
                );
            }
        }
    }
}
