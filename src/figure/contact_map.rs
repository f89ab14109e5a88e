//! The contacts over the travel of the control: bands between their edges, first for loading, then for unloading.
//!
//! The abscissa is how far the control has moved since the first touch, up to the turn and back, so that
//! loading and unloading stand side by side and nothing covers anything.

use super::bounds::Bounds;
use super::loops::{NO_LOOP, number_as_path};
use super::parts::{Area, Axis, Figure, Line, Mark, Meaning, Role, Sign};
use super::scale::Scale;
use super::subject::Subject;
use pulloff_engine::problem::Control;
use pulloff_engine::report::path::{EventReport, PathReport, PathStateReport, StateReport};

/// Builds the view.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let scale = subject.scale();
    match subject.cycle {
        Some(report) => {
            let mut figure = contact_map(report, scale);
            number_as_path(subject, &mut figure);
            figure
        }
        None => Figure { missing: Some(NO_LOOP.to_owned()), ..blank(subject.curve.setting.control, scale) },
    }
}

fn blank(control: Control, scale: Scale<'_>) -> Figure {
    let mut x = match control {
        Control::Displacement => scale.length_axis("δ"),
        Control::Force => scale.force_axis(),
        Control::Stiffness(_) => scale.length_axis("Δ"),
    };
    x = Axis { symbol: format!("travel of {}", x.symbol), ..x };
    Figure::empty(format!("contacts over the {}", x.symbol), x, scale.radius_axis("r"))
}

/// The contacts in the loop of `report`, with the divisors of `scale`.
pub fn contact_map(report: &PathReport, scale: Scale<'_>) -> Figure {
    let mut figure = blank(report.control, scale);
    let way = ControlWay::of(report, scale);
    let same = |a: &PathStateReport, b: &PathStateReport| {
        (a.piece, a.direction, a.state.contacts.len()) == (b.piece, b.direction, b.state.contacts.len())
    };
    for stretch in report.states.chunk_by(same) {
        for contact in 0..stretch[0].state.contacts.len() {
            let edge = |side: usize| {
                let at = move |at: &PathStateReport| {
                    (way.at(at.direction, at.control), scale.radius(at.state.contacts[contact][side]))
                };
                stretch.iter().map(at).collect::<Vec<_>>()
            };
            let (inner, outer) = (edge(0), edge(1));
            let outline = outer.iter().chain(inner.iter().rev()).copied().collect();
            figure.areas.push(Area { meaning: Meaning::Contact, outline, lost: None });
            // The axis is not an edge of a disc.
            let inner = Some(inner).filter(|inner| inner.iter().any(|(_, r)| *r > 0.0));
            let edges = inner.into_iter().chain([outer]);
            figure.lines.extend(edges.map(|edge| Line::new(Role::Edges, "edge", edge)));
        }
    }
    let bounds = Bounds::of(figure.areas.iter().flat_map(|area| area.outline.iter().copied()));
    // Leaves no room below the axis of the bodies.
    figure.bounds = Bounds { y: [0.0, bounds.y[1]], ..bounds };
    let jumps = report.events.iter().filter(|event| event.before != event.after);
    figure.lines.extend(jumps.map(|event| jump(event, way, scale)));
    figure.marks.extend(report.events.iter().filter_map(|event| mark(event, way, scale)));
    if let Some(turn) = report.events.iter().find(|event| event.kind == "turn") {
        let at = way.at("loading", turn.control);
        figure.lines.insert(0, Line::new(Role::Level, "", vec![(at, 0.0), (at, figure.bounds.y[1])]));
    }
    figure
}

/// Converts a value of the control into how far it has moved.
#[derive(Clone, Copy)]
struct ControlWay<'a> {
    scale: Scale<'a>,
    is_force: bool,
    first: f64,
    turn: f64,
}

impl<'a> ControlWay<'a> {
    fn of(report: &PathReport, scale: Scale<'a>) -> Self {
        let value = |kind: &str| report.events.iter().find(|event| event.kind == kind);
        let first = value("first-touch").or(report.events.first()).map_or(0.0, |event| event.control);
        let turn = value("turn").map_or(first, |event| event.control);
        Self { scale, is_force: report.control == Control::Force, first, turn }
    }

    fn at(self, direction: &str, control_value: f64) -> f64 {
        let gone = if direction == "unloading" {
            (self.turn - self.first) + (self.turn - control_value)
        } else {
            control_value - self.first
        };
        if self.is_force { self.scale.force(gone) } else { self.scale.length(gone) }
    }
}

/// The outermost edge during a jump: a vertical line, because the control is held.
fn jump(event: &EventReport, way: ControlWay<'_>, scale: Scale<'_>) -> Line {
    let x = way.at(event.direction, event.control);
    let edge = |state: &Option<StateReport>| {
        (x, scale.radius(state.as_ref().map_or(0.0, |state| state.contact_radius)))
    };
    Line::new(Role::Jump, "jump", vec![edge(&event.before), edge(&event.after)])
}

/// The mark where a crest touches, contacts merge or split, or the bodies come apart.
fn mark(event: &EventReport, way: ControlWay<'_>, scale: Scale<'_>) -> Option<Mark> {
    let (sign, radius) = match event.kind {
        "last-contact" => {
            (Sign::LastContact(event.number), event.before.as_ref().map(|state| state.contact_radius))
        }
        "turn" | "snap-in" | "snap" => return None,
        _ => (Sign::Touch, event.radius),
    };
    Some(Mark { sign, at: (way.at(event.direction, event.control), scale.radius(radius?)) })
}
