//! The quasi-static path: the stable pieces, the jumps between them, and what each dissipates, as the area between the
//! curve and the control line (Fig. 10).
//!
//! The area of a jump is closed by the curve that the edge runs past and by the line of the device; that of a pull-off
//! continues along the curve to s = 0 and returns along P = 0. Under a dead load the latter has no bound and is not
//! drawn.

use super::bounds::Bounds;
use super::curves::{inadmissible, place};
use super::parts::{Area, Figure, Line, Mark, Meaning, Role, Sign};
use super::scale::Scale;
use super::subject::Subject;
use super::walk::{apart, events_before, quantities};
use crate::explorer::curve::CurvePoint;
use crate::explorer::{CurveData, View};
use pulloff_engine::problem::{Control, Units};
use pulloff_engine::quasistatic::{Event, EventKind, PathState, State};
use pulloff_engine::report::number::{loss, with_unit};
use pulloff_engine::units::Quantity;

const VIEW: View = View::Unloading;

/// Builds the view.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let scale = subject.scale();
    let [x, y] = scale.axes(VIEW);
    let mut figure = Figure::empty(format!("unloading: {} over {}", y.title(), x.symbol), x, y);
    let points: Vec<(f64, f64)> =
        subject.curve.points.iter().map(|point| scale.place(VIEW, place(point))).collect();
    figure.bounds = Bounds::of(points.iter().copied());
    let unloading = match &subject.curve.unloading {
        Ok(unloading) => unloading,
        Err(reason) => {
            figure.missing = Some(format!("no path: {reason}"));
            return figure;
        }
    };
    figure.lines.push(Line::new(Role::Unstable, "passed by", points));
    let path = OnCurve { curve: subject.curve, scale, units: *subject.curve.case.units() };
    let jumps: Vec<&Event> = unloading.events.iter().filter(|event| event.kind != EventKind::Depin).collect();
    for stretch in unloading.states.chunk_by(|a, b| a.piece == b.piece) {
        let [Some(first), Some(last)] = [stretch.first(), stretch.last()] else { continue };
        let is_disc = stretch.iter().all(|state| state.rings() == 0);
        let points = if is_disc {
            // A pinned edge moves along a straight line.
            let held = |state: &&PathState| state.contact_radius.to_bits() == first.contact_radius.to_bits();
            let free = stretch.iter().take_while(held).last().unwrap_or(first);
            let before = (free != first).then(|| path.shown(&first.state()));
            before.into_iter().chain(path.between(&free.state(), Some(&last.state()))).collect()
        } else {
            stretch.iter().map(|state| path.shown(&state.state())).collect()
        };
        figure.lines.push(Line::new(Role::Stable, "path", points));
        let leaves =
            |event: &&&Event| event.before.as_ref().is_some_and(|before| before.piece == first.piece);
        for event in jumps.iter().filter(leaves) {
            path.jump(unloading.control, event, &mut figure);
        }
    }
    // The path may begin or land beyond the curve, and bodies that are apart may be far away.
    let kept = figure.lines.iter().filter(|line| line.role != Role::Jump);
    figure.bounds = Bounds::of(kept.flat_map(|line| line.points.iter().copied()));
    inadmissible(subject, scale, VIEW, &mut figure);
    figure.marks.extend(events_before(subject, scale, VIEW));
    let lost: f64 = figure.areas.iter().filter_map(|area| area.lost).sum();
    let bounded = figure.areas.len() == jumps.len();
    if !unloading.events.is_empty() {
        let all = if bounded { "" } else { " and the fall" };
        figure
            .notes
            .push(format!("lost {}{all}", with_unit(scale.units, Quantity::Energy, lost, false, loss)));
    }
    figure
}

/// What is needed to follow the curve between two of its states.
struct OnCurve<'a> {
    curve: &'a CurveData,
    scale: Scale<'a>,
    units: Units,
}

impl OnCurve<'_> {
    fn shown(&self, state: &State) -> (f64, f64) {
        self.scale.place(VIEW, quantities(&state.in_units(&self.units)))
    }

    /// The curve from one state inward to another, or to its end.
    fn between(&self, from: &State, to: Option<&State>) -> Vec<(f64, f64)> {
        let radius = |state: &State| state.contact_radius * self.units.length;
        let (outer, inner) = (radius(from), to.map_or(0.0, radius));
        let between = |point: &&CurvePoint| point.contact_radius < outer && point.contact_radius > inner;
        let mut points = vec![self.shown(from)];
        let passed = self.curve.points.iter().filter(between);
        points.extend(passed.map(|point| self.scale.place(VIEW, place(point))));
        points.extend(to.map(|to| self.shown(to)));
        points
    }

    /// Adds the line of a jump, its loss and its landing.
    fn jump(&self, control: Control, event: &Event, figure: &mut Figure) {
        let Some(before) = event.before.as_ref().map(PathState::state) else { return };
        let after = event.after.as_ref().map(PathState::state);
        let to = after.unwrap_or_else(|| apart(control, &before, event.control_value));
        figure.lines.push(Line::new(Role::Jump, "jump", vec![self.shown(&before), self.shown(&to)]));
        if event.before.iter().chain(&event.after).all(|state| state.rings() == 0) {
            figure.areas.extend(self.area(control, event, &before, after.as_ref()));
        }
        if event.after.is_some() {
            figure.marks.push(Mark { sign: Sign::Landing, at: self.shown(&to) });
        }
    }

    /// The area of a jump; `None` where it has no bound.
    fn area(&self, control: Control, event: &Event, before: &State, after: Option<&State>) -> Option<Area> {
        let mut outline = self.between(before, after);
        if after.is_none() {
            if control == Control::Force {
                return None;
            }
            outline.push(self.scale.place(VIEW, [0.0; 3]));
            outline.push(self.shown(&apart(control, before, event.control_value)));
        }
        Some(Area {
            meaning: Meaning::Lost,
            outline,
            lost: event.dissipated.map(|lost| lost * self.units.energy),
        })
    }
}
