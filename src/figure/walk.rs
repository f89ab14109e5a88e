//! The states walked, the jumps as straight lines, and the walker.

use super::parts::{Axis, Figure, Line, Mark, Role, Sign};
use super::scale::Scale;
use super::subject::Subject;
use crate::explorer::View;
use crate::explorer::node::{Node, NodeKind};
use pulloff_engine::problem::Control;
use pulloff_engine::quasistatic::path::EventKind;
use pulloff_engine::quasistatic::{PathState, State};
use pulloff_engine::report::path::EventReport;

/// The position of bodies that are apart: the device holds its approach, its load, or its slack spring.
pub fn apart(control: Control, before: &State, control_value: f64) -> State {
    /// Under a dead load the bodies separate without limit: a line to the left, out of the figure.
    const FAR: f64 = -1e3;
    let (approach, force) = match control {
        Control::Displacement => (before.approach, 0.0),
        Control::Force => (FAR * before.approach.abs(), before.force),
        Control::Stiffness(_) => (control_value, 0.0),
    };
    State { contact_radius: 0.0, approach, force, energy: 0.0 }
}

/// δ, P and s of a state in the user's units.
pub fn quantities(state: &State) -> [f64; 3] {
    [state.approach, state.force, state.contact_radius]
}

/// The sign of an event. Those that are no snaps begin where crests meet, contact ends within a zone, or the control turns.
pub fn sign_of(event: &EventReport) -> Sign {
    let begins_at_limit = [EventKind::Snap, EventKind::SnapIn].iter().any(|kind| kind.name() == event.kind);
    match &event.after {
        None => Sign::LastContact(event.number),
        Some(_) if begins_at_limit => Sign::Event(event.number),
        Some(_) => Sign::Passing(event.number),
    }
}

/// Where the events of the path begin, as marks.
pub fn events_before<'a>(
    subject: &Subject<'a>,
    scale: Scale<'a>,
    view: View,
) -> impl Iterator<Item = Mark> + 'a {
    let events = subject.path.into_iter().flat_map(|path| &path.events);
    events.filter_map(move |event| {
        let sign = sign_of(event);
        let state = event.before.as_ref().or(event.after.as_ref())?;
        Some(Mark { sign, at: scale.place(view, [state.approach, state.force, state.contact_radius]) })
    })
}

/// Adds the other branches of the walk to a view of the curve, as far as they are states of its problem: to compare
/// problems there are pins, which have names.
pub fn branches(subject: &Subject<'_>, scale: Scale<'_>, view: View, figure: &mut Figure) {
    let place =
        |node: &Node, state: &State| scale.place(view, quantities(&state.in_units(node.setting.units())));
    let mut lines: Vec<Vec<(f64, f64)>> = Vec::new();
    for branch in &subject.branches {
        let mut steps: Vec<(f64, f64)> = Vec::new();
        for node in &branch.nodes {
            match &node.kind {
                _ if !subject.is_on_curve(node) => lines.push(std::mem::take(&mut steps)),
                NodeKind::Stale(_) => {}
                // Without a landing the line would end nowhere.
                NodeKind::Jump(event) if event.after.is_none() => {}
                NodeKind::Jump(_) | NodeKind::Step | NodeKind::Limit | NodeKind::Touch(_) => {
                    steps.push(place(node, &node.state));
                }
                _ => {
                    lines.push(std::mem::take(&mut steps));
                    steps.push(place(node, &node.state));
                }
            }
        }
        lines.push(steps);
    }
    let lines = lines.into_iter().filter(|steps| steps.len() > 1);
    figure.lines.extend(lines.map(|steps| Line::new(Role::Branch, "other branch", steps)));
}

/// Adds the walk to a view of the curve; the walker is the last mark.
pub fn walk(subject: &Subject<'_>, scale: Scale<'_>, view: View, figure: &mut Figure) {
    let place =
        |node: &Node, state: &State| scale.place(view, quantities(&state.in_units(node.setting.units())));
    let mut steps: Vec<(f64, f64)> = Vec::new();
    let mut finish = |steps: &mut Vec<(f64, f64)>| {
        if steps.len() > 1 {
            figure.lines.push(Line::new(Role::Walk, "walked", std::mem::take(steps)));
        }
        steps.clear();
    };
    let inner = inner_edges(subject, scale, view);
    let (mut jumps, mut landings) = (Vec::new(), Vec::new());
    for node in &subject.walk {
        if !subject.is_on_curve(node) {
            finish(&mut steps);
            continue;
        }
        match &node.kind {
            NodeKind::Jump(event) => {
                finish(&mut steps);
                let Some(before) = event.before.as_ref().map(PathState::state) else { continue };
                let after = event.after.as_ref().map(PathState::state);
                let after = after.unwrap_or_else(|| apart(node.control, &before, event.control_value));
                let after = place(node, &after);
                jumps.push(Line::new(Role::Jump, "jump", vec![place(node, &before), after]));
                if event.after.is_some() {
                    landings.push(Mark { sign: Sign::Landing, at: after });
                    steps.push(after);
                }
            }
            NodeKind::Step | NodeKind::Limit | NodeKind::Touch(_) if !steps.is_empty() => {
                steps.push(place(node, &node.state));
            }
            _ => {
                finish(&mut steps);
                steps.push(place(node, &node.state));
            }
        }
    }
    finish(&mut steps);
    figure.lines.extend(inner);
    figure.lines.extend(jumps);
    figure.marks.extend(landings);
    if let Some(node) = subject.walk.last() {
        let sign = if subject.is_on_curve(node) { Sign::Walker } else { Sign::Stray };
        figure.marks.push(Mark { sign, at: place(node, &node.state) });
    }
}

/// The inner edges of the contacts along the walk, where radii are shown.
fn inner_edges(subject: &Subject<'_>, scale: Scale<'_>, view: View) -> Vec<Line> {
    if view == View::ForceApproach {
        return Vec::new();
    }
    let has_rings = |node: &Node| subject.is_on_curve(node) && node.has_rings() && !node.is_apart();
    let mut lines = Vec::new();
    for part in subject.walk.chunk_by(|a, b| {
        has_rings(a)
            && has_rings(b)
            && a.point.y().len() == b.point.y().len()
            && !matches!(b.kind, NodeKind::Jump(_))
    }) {
        let Some(first) = part.first().filter(|node| has_rings(node)) else { continue };
        let edges = first.contacts().edge_count();
        let place = |node: &&Node, edge: usize| {
            let state = node.state.in_units(node.setting.units());
            let radius = node.contacts().edges().get(edge).map_or(f64::NAN, |edge| edge.radius);
            scale.place(view, [state.approach, state.force, radius * node.setting.units().length])
        };
        lines.extend((0..edges.saturating_sub(1)).map(|edge| {
            // A single state is drawn as a line of zero length.
            let mut points: Vec<(f64, f64)> = part.iter().map(|node| place(node, edge)).collect();
            if let [only] = points[..] {
                points.push(only);
            }
            Line::new(Role::Walk, "walked", points)
        }));
    }
    lines
}

/// The states walked have lines but no axes; this figure tells whoever draws it where to find them.
pub fn table() -> Figure {
    let none = || Axis::pure(String::new());
    let why = "the states walked are a table: export walk writes it";
    Figure { missing: Some(why.to_owned()), ..Figure::empty("walk".to_owned(), none(), none()) }
}
