//! The law of stability over the contact radius: the work of adhesion at which each state is a limit point.
//!
//! Below the curve states are stable, above it they are not; the line of the preset's adhesion crosses it at the limit
//! points. Changing the adhesion moves that line.

use super::map;
use super::parts::{Axis, AxisScale, Figure, Line, Mark, Role, Sign};
use super::scale::Scale;
use super::subject::Subject;
use crate::explorer::reach::OF_SHORT_RANGE;
use pulloff_engine::Case;
use pulloff_engine::disc::Panels;
use pulloff_engine::problem::{Control, Units};
use pulloff_engine::stability::Law;
use pulloff_engine::stability::law::{Cusp, adhesion_of};
use pulloff_engine::units::Quantity;
use std::f64::consts::TAU;
use std::sync::Arc;

/// The number of radii at which the law is drawn.
const RADII: usize = 1500;

/// The law is drawn down to the preset's adhesion over this; where it falls further, to where no adhesion is stable, it runs
/// along the floor.
const RANGE: f64 = 1e3;

/// Where contact radii and works of adhesion, both reduced, stand on the axes: the latter by γ', or by γ where the gap
/// has no radius of curvature.
struct LawPlaces<'a> {
    scale: Scale<'a>,
    units: Units,
    /// γ' over γ.
    group: Option<f64>,
}

impl LawPlaces<'_> {
    fn radius(&self, s: f64) -> f64 {
        self.scale.radius(s * self.units.length)
    }

    fn adhesion(&self, adhesion: f64) -> f64 {
        let adhesion = adhesion * self.units.work_of_adhesion;
        let shown = || self.scale.shown(Quantity::EnergyPerArea, adhesion);
        self.group.map_or_else(shown, |group| group * adhesion)
    }

    /// The law at these radii.
    fn curve(&self, law: &Law, radii: &[f64]) -> Vec<(f64, f64)> {
        let all = radii.iter().zip(law.over(radii));
        all.map(|(s, adhesion)| (self.radius(*s), self.adhesion(adhesion))).collect()
    }
}

/// Builds the view.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let scale = subject.scale();
    let case = &subject.curve.case;
    let problem = &case.problem;
    let group = problem.shape.radius_of_curvature().map(|radius| TAU / (problem.effective_modulus * radius));
    let y = match group {
        Some(_) => Axis::pure("γ'".to_owned()),
        None => scale.axis("γ", "energy per area", Quantity::EnergyPerArea),
    };
    let y = y.running(AxisScale::Logarithmic);
    let is_one_disc = subject.is_one_disc();
    let under = match case.control {
        Control::Force => "force",
        Control::Displacement => "displacement",
        Control::Stiffness(_) => "the spring",
    };
    let of = if is_one_disc { "" } else { ", of the exact equation of one disc" };
    let title = format!("limit points under {under}{of}");
    let mut figure = Figure::empty(title, scale.radius_axis("s"), y);
    if case.cohesion.is_some() {
        figure.missing = Some(OF_SHORT_RANGE.to_owned());
        return figure;
    }
    let Ok(panels) = case.table.up_to(case.start) else {
        figure.missing = Some("the gap cannot be tabulated".to_owned());
        return figure;
    };
    let places = LawPlaces { scale, units: *case.units(), group };
    let level = places.adhesion(case.reduced.work_of_adhesion);
    laws(&mut figure, case, &panels, &places, level);
    for part in subject.curve.base.inadmissible.iter().flatten() {
        let places = part.places.iter().map(|[_, _, s]| (scale.radius(*s), level)).collect();
        figure.lines.push(Line::new(Role::Inadmissible, "inadmissible", places));
    }
    let limits = subject.curve.limits.iter().map(|limit| (places.radius(limit.contact_radius), level));
    figure.marks.extend(limits.map(|at| Mark { sign: Sign::Limit, at }));
    // The law is for one disc of the exact equation, not for a walker in rings of either kind.
    if let Some(node) = subject.walk.last().filter(|node| is_one_disc && subject.is_on_curve(node)) {
        let walker = (scale.radius(node.state.contact_radius), level);
        figure.marks.push(Mark { sign: Sign::Walker, at: walker });
    }
    figure
}

/// Draws the law of the device and the one beside it, their cusps, and the preset's adhesion at this level.
fn laws(figure: &mut Figure, case: &Case, panels: &Arc<Panels>, places: &LawPlaces<'_>, level: f64) {
    let law = |control| Law { panels: Arc::clone(panels), control };
    let radii: Vec<f64> =
        (0..=RADII).map(|k| case.end + (case.start - case.end) * k as f64 / RADII as f64).collect();
    let own = law(case.control);
    let points = places.curve(&own, &radii);
    let positive = || points.iter().map(|(_, y)| *y).filter(|y| y.is_finite() && *y > 0.0);
    let most = positive().fold(level, f64::max);
    let least = positive().fold(f64::INFINITY, f64::min);
    let floor = if level > 0.0 { least.max(level / RANGE).min(0.3 * level) } else { least };
    // Where no adhesion is stable, the curve runs along the floor.
    let down = |points: Vec<(f64, f64)>| -> Vec<(f64, f64)> {
        points.into_iter().map(|(x, y)| (x, if y.is_nan() { y } else { y.max(floor) })).collect()
    };
    let (twin, name) = match case.control {
        Control::Displacement | Control::Stiffness(_) => (Control::Force, "under force"),
        Control::Force => (Control::Displacement, "under displacement"),
    };
    figure.lines.push(Line::new(Role::Twin, name, down(places.curve(&law(twin), &radii))));
    let (cusps, corners) = own.cusps([case.end, case.start]);
    let at = |cusp: &Cusp| (places.radius(cusp.contact_radius), places.adhesion(adhesion_of(cusp.value)));
    figure.marks.extend(cusps.iter().map(|cusp| Mark { sign: Sign::Cusp, at: at(cusp) }));
    figure.lines.push(Line::new(Role::Law, "limit points; stable below", down(points)));
    let ends = [case.end, case.start].map(|s| places.radius(s));
    figure.lines.push(Line::new(Role::Level, "adhesion", ends.map(|x| (x, level)).to_vec()));
    figure.bounds = figure.around([(ends[0], floor), (ends[1], most)]);
    figure.notes.extend(case.warning_of_dead_band());
    if !corners.is_empty() {
        let why = "the second derivative of the gap jumps: the law has corners there, which are not cusps";
        figure.notes.push(why.to_owned());
    }
}

/// The map of two parameters, where it is known.
pub fn map(subject: &Subject<'_>) -> Figure {
    match subject.map {
        Some(Ok(report)) => map::figure(report, subject),
        Some(Err(reason)) => empty_map(&format!("no map: {reason}")),
        None => empty_map("the map is being computed"),
    }
}

fn empty_map(why: &str) -> Figure {
    let none = || Axis::pure(String::new());
    Figure { missing: Some(why.to_owned()), ..Figure::empty("where snaps begin".to_owned(), none(), none()) }
}
