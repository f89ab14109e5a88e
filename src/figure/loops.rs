//! The whole loop of loading and unloading: the stable stretches, the jumps between them, and the losses, as areas.
//!
//! A jump from one disc to one disc, or from or to bodies that are apart, loses the area between its line and the curve
//! of one disc, along which its edge runs. Where every bounded loss has such an area, each is drawn. Jumps between
//! rings follow no curve; the area that loading and unloading enclose is then drawn instead, which is the sum of all
//! losses where the approach or a spring is controlled. Under a dead load the loop encloses no area, and only each jump
//! of a disc has one.

use super::bounds::Bounds;
use super::curves::place;
use super::parts::{Area, Figure, Line, Mark, Meaning, Role, Sign};
use super::scale::Scale;
use super::subject::Subject;
use crate::explorer::View;
use crate::explorer::curve::CurvePoint;
use pulloff_engine::problem::{Begin, Control};
use pulloff_engine::report::number::{loss, with_unit};
use pulloff_engine::report::path::{EventReport, PathReport, PathStateReport, StateReport};
use pulloff_engine::units::Quantity;

const VIEW: View = View::Cycle;

/// The message where no loop has been computed.
pub const NO_LOOP: &str = "no loop yet";

/// The largest relative error of an outline's area against its loss; the points of a curve are dense enough to look at.
const FAITHFUL: f64 = 0.02;

/// Builds the view.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let scale = subject.scale();
    match subject.cycle {
        Some(report) => {
            let mut figure = cycle_figure(report, &subject.curve.points, scale);
            number_as_path(subject, &mut figure);
            figure
        }
        None => Figure { missing: Some(NO_LOOP.to_owned()), ..blank(scale) },
    }
}

/// The numbers on the screen are those of the path: a loop beside an unloading has none.
pub fn number_as_path(subject: &Subject<'_>, figure: &mut Figure) {
    if subject.preset.path.begin == Begin::Apart {
        return;
    }
    for mark in &mut figure.marks {
        if let Sign::LastContact(number) = &mut mark.sign {
            *number = 0;
        }
    }
}

fn blank(scale: Scale<'_>) -> Figure {
    let [x, y] = scale.axes(VIEW);
    Figure::empty(format!("cycle: {} over {}", y.title(), x.symbol), x, y)
}

/// The loop of `report` with these divisors; `curve` is the equilibrium curve of one disc, whose points bound the
/// losses of discs.
pub fn cycle_figure(report: &PathReport, curve: &[CurvePoint], scale: Scale<'_>) -> Figure {
    let mut figure = blank(scale);
    figure.lines = lines(report, scale, VIEW);
    let kept = figure.lines.iter().filter(|line| line.role != Role::Jump);
    let zero = scale.place(VIEW, [0.0; 3]);
    figure.bounds = Bounds::of(kept.flat_map(|line| line.points.iter().copied()).chain([zero]));
    figure.marks = report.events.iter().flat_map(|event| marks(event, scale, VIEW)).collect();
    figure.areas = areas(report, curve, scale);
    let shown = |lost| with_unit(scale.units, Quantity::Energy, lost, false, loss);
    figure.notes.push(match report.totals.dissipated {
        Some(lost) => format!("lost {}", shown(lost)),
        None => format!("lost {} and the fall", shown(report.totals.dissipated_before_last_contact)),
    });
    let band = report.totals.dead_band;
    figure.notes.extend(band.map(|band| format!("dead band {}", shown(band.dissipated))));
    figure
}

/// δ, P and the outermost edge.
fn quantities(state: &StateReport) -> [f64; 3] {
    [state.approach, state.force, state.contact_radius]
}

/// The stable stretches and the jumps of a loop in a view of the curve.
pub fn lines(report: &PathReport, scale: Scale<'_>, view: View) -> Vec<Line> {
    let mut lines: Vec<Line> = report
        .states
        .chunk_by(|a, b| a.piece == b.piece && a.direction == b.direction)
        .map(|stretch| {
            let points = stretch.iter().map(|at| scale.place(view, quantities(&at.state))).collect();
            Line::new(role(&stretch[0]), stretch[0].direction, points)
        })
        .collect();
    // Unloading runs back over the states of loading, so the broken line is drawn on top.
    lines.sort_by_key(|line| line.role);
    lines.extend(report.events.iter().filter(|event| event.before != event.after).filter_map(|event| {
        let [before, after] = ends(report.control, event)?;
        let points = vec![scale.place(view, before), scale.place(view, after)];
        Some(Line::new(Role::Jump, "jump", points))
    }));
    lines
}

fn role(at: &PathStateReport) -> Role {
    if at.direction == "unloading" { Role::Unloading } else { Role::Loading }
}

/// δ, P and s before and after; bodies that are apart are placed where the device holds them.
fn ends(control: Control, event: &EventReport) -> Option<[[f64; 3]; 2]> {
    /// Under a dead load the bodies separate without limit: a line to the left, out of the figure.
    const FAR: f64 = -1e3;
    let held = event.before.as_ref().or(event.after.as_ref())?;
    let apart = match control {
        // A load brings the bodies together from the first touch.
        Control::Force if event.before.is_none() => [0.0, held.force, 0.0],
        Control::Force => [FAR * held.approach.abs(), held.force, 0.0],
        Control::Displacement | Control::Stiffness(_) => [event.control, 0.0, 0.0],
    };
    Some([&event.before, &event.after].map(|state| state.as_ref().map_or(apart, quantities)))
}

/// The marks of an event in a view of the curve: where it begins, and where it lands.
fn marks(event: &EventReport, scale: Scale<'_>, view: View) -> Vec<Mark> {
    let sign = match event.kind {
        "first-touch" | "touch" | "merge" | "split" | "vanish" => Sign::Touch,
        "turn" => Sign::Turn,
        "last-contact" => Sign::LastContact(event.number),
        _ => Sign::Limit,
    };
    let at = |state: &StateReport| scale.place(view, quantities(state));
    let begins = event.before.as_ref().map(|state| Mark { sign, at: at(state) });
    let lands = event.after.as_ref().filter(|_| event.before != event.after);
    begins.into_iter().chain(lands.map(|state| Mark { sign: Sign::Landing, at: at(state) })).collect()
}

/// The losses as areas.
fn areas(report: &PathReport, curve: &[CurvePoint], scale: Scale<'_>) -> Vec<Area> {
    let jumps: Vec<&EventReport> =
        report.events.iter().filter(|event| event.dissipated.is_some_and(|lost| lost > 0.0)).collect();
    let outlines: Vec<_> = jumps.iter().map(|event| of_disc(report.control, event, curve)).collect();
    let shown = |outline: Vec<[f64; 2]>, lost| {
        let outline = outline.into_iter().map(|[approach, force]| scale.place(VIEW, [approach, force, 0.0]));
        Area { meaning: Meaning::Lost, outline: outline.collect(), lost }
    };
    if report.control == Control::Force || outlines.iter().all(Option::is_some) {
        let each = outlines.into_iter().zip(jumps);
        return each.filter_map(|(outline, event)| Some(shown(outline?, event.dissipated))).collect();
    }
    let held = report.events.iter().filter_map(|event| ends(report.control, event));
    let around = report.states.iter().map(|at| [at.state.approach, at.state.force]);
    // From the first touch round the loop, and back along P = 0.
    let [first, last] = [held.clone().next(), held.clone().next_back()];
    let first = first.map(|[before, _]| [before[0], before[1]]);
    let last = last.map(|[_, after]| [after[0], after[1]]);
    vec![shown(first.into_iter().chain(around).chain(last).collect(), report.totals.dissipated)]
}

/// The outline δ, P of the loss in the jump of one disc; `None` where the curve of one disc does not follow it.
fn of_disc(control: Control, event: &EventReport, curve: &[CurvePoint]) -> Option<Vec<[f64; 2]>> {
    let is_disc = |state: &Option<StateReport>| {
        state.as_ref().is_none_or(|state| matches!(state.contacts[..], [[0.0, _]]))
    };
    if !(is_disc(&event.before) && is_disc(&event.after)) {
        return None;
    }
    let [before, after] = ends(control, event)?;
    let (inner, outer) = (before[2].min(after[2]), before[2].max(after[2]));
    let passed = curve.iter().filter(|point| point.contact_radius > inner && point.contact_radius < outer);
    // From the start inward.
    let mut outline: Vec<[f64; 2]> = passed.map(place).map(|at| [at[0], at[1]]).collect();
    let (large, small) = if before[2] > after[2] { (before, after) } else { (after, before) };
    outline.insert(0, [large[0], large[1]]);
    if inner == 0.0 {
        // The curve continues to a disc of zero size.
        outline.push([0.0; 2]);
    }
    outline.push([small[0], small[1]]);
    let next = outline.iter().cycle().skip(1);
    let enclosed: f64 = outline.iter().zip(next).map(|(a, b)| 0.5 * (a[0] * b[1] - b[0] * a[1])).sum();
    event.dissipated.filter(|lost| (enclosed.abs() - lost).abs() <= FAITHFUL * lost).map(|_| outline)
}
