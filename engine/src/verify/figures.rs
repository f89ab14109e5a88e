//! The smallest force and the smallest approach on the curves of Figs. 8 and 9, and where they occur.
//!
//! The exact values are roots of dP/ds and dδ/ds of the closed form, the lowest of all limit points from the start of
//! the figure inward: P. R. Guduru, doi:10.1016/j.jmps.2006.09.004. Forces are given relative to `P_c = (3/2)πγR` of
//! the smooth sphere.

use super::cases::{PaperFigure, smooth};
use super::row::{Group, VerifyRow};
use super::settings::Candidate;
use super::unloading::swept;
use crate::problem::Control;
use crate::quasistatic::{Curve, Extremum};
use crate::theory::unloading::{INWARD_REACH, limit_points};
use crate::theory::{Disc, Exact};
use std::sync::Arc;

/// s and the control at the limit point where `control` is smallest.
fn ours(curve: &Curve, control: Control) -> Option<(f64, f64)> {
    let states = curve.limit_points(control).into_iter().filter(|limit| limit.turn == Extremum::Minimum);
    let values = states.map(|limit| (limit.contact_radius, control.value(limit.approach, limit.force)));
    values.min_by(|a, b| a.1.total_cmp(&b.1))
}

fn exact(disc: &dyn Disc, control: Control, start: f64) -> Option<(f64, f64)> {
    let limits = limit_points(disc, control, start, INWARD_REACH * start);
    let values = limits.into_iter().filter(|limit| limit.minimum).map(|limit| {
        let state = limit.state;
        (state.contact_radius, control.value(state.approach, state.force))
    });
    values.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The extreme values of `figure` in one basis.
pub fn group(figure: &PaperFigure, candidate: &Candidate) -> Group {
    const NONE: (f64, f64) = (f64::NAN, f64::NAN);
    let disc = Exact::of(&figure.problem);
    let curve = swept(figure, &Arc::clone(&candidate.basis));
    let critical = smooth(figure.problem.work_of_adhesion).pull_off_force();
    let bound = candidate.bounds.extreme;
    let mut rows = Vec::new();
    for (control, what, place, unit) in [
        (Control::Force, "smallest force over P_c", "contact radius of smallest force", critical),
        (Control::Displacement, "smallest approach", "contact radius of smallest approach", 1.0),
    ] {
        let (s, value) = curve.as_ref().and_then(|curve| ours(curve, control)).unwrap_or(NONE);
        let (exact_s, exact_value) = exact(&*disc, control, figure.start).unwrap_or(NONE);
        rows.push(VerifyRow::relative(what, value / unit, exact_value / unit, bound));
        rows.push(VerifyRow::relative(place, s, exact_s, bound));
    }
    Group { title: format!("{}, extreme values, {}", figure.name, candidate.name), measure: "relative", rows }
}
