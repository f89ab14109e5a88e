//! The law of stability over the contact radius: the work of adhesion at which each state is a limit point.
//!
//! Below the curve states are stable, above it they are not; the line of the preset's adhesion crosses it at the limit
//! points. Changing the adhesion moves that line. The ordinate is logarithmic: its positions are decimal logarithms.

use super::bounds::Bounds;
use super::map;
use super::parts::{Axis, Figure, Line, Mark, Role, Sign};
use super::subject::Subject;
use crate::explorer::reach::OF_SHORT_RANGE;
use pulloff_engine::problem::Control;
use pulloff_engine::stability::Law;
use pulloff_engine::stability::law::adhesion_of;
use pulloff_engine::units::Quantity;
use std::f64::consts::TAU;

/// The number of radii at which the law is drawn.
const RADII: usize = 1500;

/// The number of decades drawn below the preset's adhesion where the law falls further: to the floor, where no adhesion
/// is stable.
const DECADES: f64 = 3.0;

/// Builds the view.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let scale = subject.scale();
    let case = &subject.curve.case;
    let units = *case.units();
    let problem = &case.problem;
    let group = problem.shape.radius_of_curvature().map(|radius| TAU / (problem.effective_modulus * radius));
    let y = if group.is_some() {
        Axis::pure("log γ'".to_owned())
    } else {
        scale.axis("log γ", "energy per area", Quantity::EnergyPerArea)
    };
    let is_one_disc = subject.is_one_disc();
    let under = match case.control {
        Control::Force => "force",
        Control::Displacement => "displacement",
        Control::Stiffness(_) => "the spring",
    };
    let of = if is_one_disc { "" } else { ", of the exact equation of one disc" };
    let title = format!("limit points under {under}: adhesion over contact radius{of}");
    let mut figure = Figure::empty(title, scale.radius_axis("s"), y);
    if case.cohesion.is_some() {
        figure.missing = Some(OF_SHORT_RANGE.to_owned());
        return figure;
    }
    let Ok(panels) = case.table.up_to(case.start) else {
        figure.missing = Some("the gap cannot be tabulated".to_owned());
        return figure;
    };
    let place = |adhesion: f64| {
        let adhesion = adhesion * units.work_of_adhesion;
        group.map_or_else(|| scale.shown(Quantity::EnergyPerArea, adhesion), |group| group * adhesion).log10()
    };
    let at = |s: f64| scale.radius(s * units.length);
    let radii: Vec<f64> =
        (0..=RADII).map(|k| case.end + (case.start - case.end) * k as f64 / RADII as f64).collect();
    let law = |control| Law { panels: panels.clone(), control };
    let curve = |law: &Law| -> Vec<(f64, f64)> {
        radii.iter().zip(law.over(&radii)).map(|(s, adhesion)| (at(*s), place(adhesion))).collect()
    };
    let own = law(case.control);
    let points = curve(&own);
    let adhesion = case.reduced.work_of_adhesion;
    let level = place(adhesion);
    let finite = || points.iter().map(|(_, y)| *y).filter(|y| y.is_finite());
    let most = finite().chain(Some(level).filter(|y| y.is_finite())).fold(f64::NEG_INFINITY, f64::max);
    let least = finite().fold(f64::INFINITY, f64::min);
    let floor = if level.is_finite() { least.max(level - DECADES).min(level - 0.5) } else { least };
    // Where no adhesion is stable, the curve runs along the floor.
    let down = |points: Vec<(f64, f64)>| -> Vec<(f64, f64)> {
        points.into_iter().map(|(x, y)| (x, if y.is_nan() { y } else { y.max(floor) })).collect()
    };
    if let Control::Displacement | Control::Stiffness(_) = case.control {
        figure.lines.push(Line::new(Role::Twin, "under force", down(curve(&law(Control::Force)))));
    } else {
        figure.lines.push(Line::new(
            Role::Twin,
            "under displacement",
            down(curve(&law(Control::Displacement))),
        ));
    }
    let (cusps, corners) = own.cusps([case.end, case.start]);
    let cusps = cusps.iter().map(|cusp| (at(cusp.contact_radius), place(adhesion_of(cusp.value))));
    figure.marks.extend(cusps.map(|at| Mark { sign: Sign::Cusp, at }));
    figure.lines.push(Line::new(Role::Law, "limit points; stable below", down(points)));
    let ends = [at(case.end), at(case.start)];
    figure.lines.push(Line::new(Role::Level, "adhesion", ends.map(|x| (x, level)).to_vec()));
    for part in subject.curve.base.inadmissible.iter().flatten() {
        let places = part.places.iter().map(|[_, _, s]| (scale.radius(*s), level)).collect();
        figure.lines.push(Line::new(Role::Inadmissible, "inadmissible", places));
    }
    figure.bounds = Bounds::of([(ends[0], floor), (ends[1], most)]);
    let limits = subject.curve.limits.iter().map(|limit| (at(limit.contact_radius), level));
    figure.marks.extend(limits.map(|at| Mark { sign: Sign::Limit, at }));
    figure.notes.extend(case.warning_of_dead_band());
    if !corners.is_empty() {
        figure.notes.push(
            "the second derivative of the gap jumps: the law has corners there, which are not cusps"
                .to_owned(),
        );
    }
    // The law is for one disc of the exact equation, not for a walker in rings of either kind.
    if let Some(node) = subject.walk.last().filter(|node| is_one_disc && subject.is_on_curve(node)) {
        let walker = (scale.radius(node.state.contact_radius), level);
        figure.marks.push(Mark { sign: Sign::Walker, at: walker });
    }
    figure
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
