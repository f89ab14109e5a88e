//! The unloading of a figure under three controls: every limit point, landing and loss against the exact path.
//!
//! The exact path is [`theory::unloading`](crate::theory::unloading): roots of the slopes of Guduru's closed form,
//! landings from the monotone pieces between them, losses from its energies (P. R. Guduru,
//! doi:10.1016/j.jmps.2006.09.004; the paper's Fig. 10). Losses are compared twice: the drop of the potential with the
//! exact one, and, instability by instability, the area between the curve and the control line with that drop.

use super::balance;
use super::cases::PaperFigure;
use super::row::{Group, VerifyRow};
use super::settings::Candidate;
use crate::disc::Basis;
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::quasistatic::path::{PathSetting, unload};
use crate::quasistatic::{Curve, Event, Path, PathState};
use crate::theory::unloading::{self, ExactJump, INWARD_REACH, limit_points};
use crate::theory::{Disc, Exact, ExactEquilibrium};
use std::sync::Arc;

/// Where a swept curve ends, as a share of its start: the default of presets.
const END: f64 = 0.004;

/// The drop of the potential and the area agree to this share of the loss.
const TWO_LOSSES: f64 = 1e-6;

/// The curve of `figure` in `basis`.
pub fn swept(figure: &PaperFigure, basis: &Arc<dyn Basis>) -> Option<Curve> {
    Curve::of(figure.problem.reduced(), Arc::clone(basis), figure.start, END * figure.start)
}

/// The names of s, δ and P in the comparison.
const QUANTITIES: [&str; 3] = ["contact radius", "approach", "force"];

fn of_ours(state: &PathState) -> [f64; 3] {
    [state.contact_radius, state.approach, state.force]
}

fn of_exact(state: &ExactEquilibrium) -> [f64; 3] {
    [state.contact_radius, state.approach, state.force]
}

/// The unloadings of `figure` in one basis, one group for each control.
pub fn groups(figure: &PaperFigure, candidate: &Candidate) -> Vec<Group> {
    let exact = Exact::of(&figure.problem);
    let curve = swept(figure, &candidate.basis);
    let group = |control| {
        let title = format!("{} under {control} control, {}", figure.name, candidate.name);
        let measure = "states over their range, losses relative";
        let rows = rows(&*exact, figure, candidate, curve.as_ref(), control);
        Group { title, measure, rows }
    };
    figure.controls().into_iter().map(group).collect()
}

fn rows(
    exact: &dyn Disc,
    figure: &PaperFigure,
    candidate: &Candidate,
    curve: Option<&Curve>,
    control: Control,
) -> Vec<VerifyRow> {
    let Some((curve, path)) = curve.zip(unloading::unload(exact, control, figure.start)) else {
        return vec![VerifyRow::worst("equilibrium curve", [], 1.0, 0.0)];
    };
    let ranges = ranges(exact, figure);
    let mut rows = limits(exact, figure, candidate, curve, control, ranges);
    match unload(curve, &PathSetting::one_disc(control), &Unwatched) {
        Ok(ours) => {
            rows.extend(states(&ours, &path.jumps, candidate, ranges));
            rows.extend(losses(&ours, &path.jumps, candidate));
            rows.push(balance::row(curve, &ours));
        }
        Err(_) => rows.push(VerifyRow::worst("unloading", [], 1.0, 0.0)),
    }
    rows
}

/// The ranges of s, δ and P on the exact curve from the start inward.
fn ranges(exact: &dyn Disc, figure: &PaperFigure) -> [f64; 3] {
    /// As fine as a chart: only their size matters.
    const POINTS: u32 = 1000;
    let radii = (1..=POINTS).map(|i| figure.start * f64::from(i) / f64::from(POINTS));
    let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for s in radii {
        for (range, x) in ranges.iter_mut().zip([s, exact.approach(s), exact.force(s)]) {
            *range = [range[0].min(x), range[1].max(x)];
        }
    }
    ranges.map(|[lo, hi]| hi - lo)
}

/// All limit points of the curve, on the path or inside a jump.
fn limits(
    exact: &dyn Disc,
    figure: &PaperFigure,
    candidate: &Candidate,
    curve: &Curve,
    control: Control,
    ranges: [f64; 3],
) -> Vec<VerifyRow> {
    let ours: Vec<f64> = curve.limit_points(control).iter().map(|limit| limit.contact_radius).collect();
    let exact: Vec<f64> = limit_points(exact, control, figure.start, INWARD_REACH * figure.start)
        .iter()
        .map(|limit| limit.state.contact_radius)
        .collect();
    let what = format!("contact radius, worst of {}", exact.len());
    vec![
        VerifyRow::new("limit points on the curve", ours.len() as f64, exact.len() as f64, 1.0, 0.0),
        VerifyRow::worst(what, ours.into_iter().zip(exact), ranges[0], candidate.bounds.state),
    ]
}

/// The states that the instabilities leave, and those they reach.
fn states(ours: &Path, exact: &[ExactJump], candidate: &Candidate, ranges: [f64; 3]) -> Vec<VerifyRow> {
    let count = |snap: bool| exact.iter().filter(|jump| jump.after.is_some() == snap).count() as f64;
    let ours_count = |snap: bool| ours.events.iter().filter(|e| e.after.is_some() == snap).count() as f64;
    let mut rows = vec![
        VerifyRow::new("snaps", ours_count(true), count(true), 1.0, 0.0),
        VerifyRow::new("last contacts", ours_count(false), count(false), 1.0, 0.0),
    ];
    let pairs: Vec<(&Event, &ExactJump)> = ours.events.iter().zip(exact).collect();
    for (k, quantity) in QUANTITIES.into_iter().enumerate() {
        let left = pairs.iter().filter_map(|(event, jump)| {
            Some((of_ours(event.before.as_ref()?)[k], of_exact(&jump.before)[k]))
        });
        let what = format!("{quantity} before, worst of {}", exact.len());
        rows.push(VerifyRow::worst(what, left, ranges[k], candidate.bounds.state));
    }
    for (k, quantity) in QUANTITIES.into_iter().enumerate() {
        let reached = pairs.iter().filter_map(|(event, jump)| {
            Some((of_ours(event.after.as_ref()?)[k], of_exact(jump.after.as_ref()?)[k]))
        });
        let what = format!("{quantity} after, worst of {}", count(true));
        rows.push(VerifyRow::worst(what, reached, ranges[k], candidate.bounds.state));
    }
    rows
}

/// The loss in each instability, in both ways; a last contact under a dead load has no loss.
fn losses(ours: &Path, exact: &[ExactJump], candidate: &Candidate) -> Vec<VerifyRow> {
    let mut rows = Vec::new();
    for (number, (event, jump)) in ours.events.iter().zip(exact).enumerate() {
        let Some(exact) = jump.dissipated else { continue };
        let drop = event.dissipated.unwrap_or(f64::NAN);
        let area = event.dissipated_by_area.unwrap_or(f64::NAN);
        let kind = if jump.after.is_some() { "snap" } else { "last contact" };
        let number = number + 1;
        rows.push(VerifyRow::relative(format!("{number} {kind}: loss"), drop, exact, candidate.bounds.loss));
        rows.push(VerifyRow::own(
            format!("{number} {kind}: area against drop"),
            area,
            drop,
            drop.abs(),
            TWO_LOSSES,
        ));
    }
    rows
}
