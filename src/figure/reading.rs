//! What a point of a figure means: its coordinates, and on a view of the curve the nearest state and what it is.

use super::bounds::Bounds;
use super::curves::{pinned_scale, place};
use super::parts::{Axis, AxisScale, Figure, Line, Role};
use super::scale::Scale;
use super::subject::Subject;
use crate::explorer::pins::letter;
use crate::explorer::{CurveData, View};
use pulloff_engine::problem::Control;
use pulloff_engine::report::number::significant;
use pulloff_engine::report::path::EventReport;
use pulloff_engine::report::problem::control_word;

/// Within this share of the window, a mark is preferred to a nearer state of the curve.
const NEAR: f64 = 0.025;

/// Two radii closer than this are the same.
const SAME: f64 = 1e-6;

/// What a state is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum What {
    /// A point of the curve, stable under the control or not.
    Curve { stable: bool },
    Limit {
        control: Control,
        /// Its number from the start inward, from 1.
        number: usize,
        of: usize,
        event: Option<usize>,
    },
    /// Where the jump of the event of this number lands.
    Landing(usize),
    /// A point of the pinned curve of this number.
    Pin(usize),
}

/// The state nearest to a point of a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestState {
    pub at: (f64, f64),
    pub what: What,
    /// δ, in the user's units.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// s.
    pub contact_radius: f64,
}

impl NearestState {
    /// The state in words, on the axes of the charts.
    pub fn text(&self, scale: Scale<'_>) -> String {
        let shown = |axis: &Axis, x: f64| {
            let space = if axis.shown.is_empty() { "" } else { " " };
            format!("{} {}{space}{}", axis.symbol, significant(x, 5), axis.shown)
        };
        let [length, force, radius] = scale.state_axes();
        format!(
            "{} {} {} {}",
            shown(&length, scale.length(self.approach)),
            shown(&force, scale.force(self.force)),
            shown(&radius, scale.radius(self.contact_radius)),
            self.what.text()
        )
    }
}

impl What {
    /// In words.
    pub fn text(self) -> String {
        match self {
            Self::Curve { stable: true } => "stable".to_owned(),
            Self::Curve { stable: false } => "unstable".to_owned(),
            Self::Limit { control, number, of, event } => {
                let event = event.map_or_else(String::new, |event| format!(", event {event}"));
                format!("limit point of {} control {number} of {of}{event}", control_word(control))
            }
            Self::Landing(event) => format!("landing of event {event}"),
            Self::Pin(number) => format!("on pin {}", letter(number)),
        }
    }
}

/// The point of the lines of this role that is nearest to `x` on its axis.
pub fn on_line(figure: &Figure, role: Role, x: f64) -> Option<(f64, f64)> {
    let drawn = figure.lines.iter().filter(|line| line.role == role).flat_map(|line| &line.points);
    drawn.copied().min_by(|a, b| (a.0 - x).abs().total_cmp(&(b.0 - x).abs()))
}

/// The point at the x of `at` on the line that is nearest to it there, and the line; `None` where none has that x.
pub fn on_nearest_line(figure: &Figure, at: (f64, f64)) -> Option<((f64, f64), &Line)> {
    let crossings = figure.lines.iter().flat_map(|line| {
        line.points.windows(2).filter_map(move |pair| {
            let [from, to] = [pair[0], pair[1]];
            let share = (at.0 - from.0) / (to.0 - from.0);
            let y = from.1 + share * (to.1 - from.1);
            ((0.0..=1.0).contains(&share) && y.is_finite()).then_some(((at.0, y), line))
        })
    });
    crossings.min_by(|(a, _), (b, _)| (a.1 - at.1).abs().total_cmp(&(b.1 - at.1).abs()))
}

/// The state beside `at` on the curve that passes nearest, in a window with these bounds, limit points and landings first; `None`
/// if the view shows no states.
pub fn nearest(subject: &Subject<'_>, view: View, bounds: &Bounds, at: (f64, f64)) -> Option<NearestState> {
    if !view.is_curve() {
        return None;
    }
    let scale = subject.scale();
    let share = |[lo, hi]: [f64; 2], by: f64| by / (hi - lo);
    let away = |(x, y): (f64, f64)| share(bounds.x, x - at.0).hypot(share(bounds.y, y - at.1));
    let by_distance = |a: &NearestState, b: &NearestState| away(a.at).total_cmp(&away(b.at));
    let state = |scale: Scale<'_>, [approach, force, contact_radius]: [f64; 3], what| NearestState {
        at: scale.place(view, [approach, force, contact_radius]),
        what,
        approach,
        force,
        contact_radius,
    };
    let marks = marks(subject.curve).into_iter().map(|(quantities, what)| state(scale, quantities, what));
    let mark = marks.filter(|mark| away(mark.at) <= NEAR).min_by(by_distance);
    if mark.is_some() {
        return mark;
    }
    let own = subject.curve.points.iter();
    let own = own.map(|point| state(scale, place(point), What::Curve { stable: point.stable }));
    let pinned = subject.pins.iter().map(|pin| {
        let scale = pinned_scale(subject, pin);
        let points = pin.curve.points.iter();
        points.map(|point| state(scale, place(point), What::Pin(pin.number))).collect()
    });
    // The curve that passes nearest need not be that of the nearest state.
    let passing = |states: Vec<NearestState>| {
        let pairs = states.windows(2).map(|pair| (pair[0], pair[1]));
        let alone = states.first().map(|one| (*one, *one));
        let beside = |(one, other): (NearestState, NearestState)| {
            let nearer = if away(one.at) <= away(other.at) { one } else { other };
            let [a, b] =
                [one.at, other.at].map(|(x, y)| [share(bounds.x, x - at.0), share(bounds.y, y - at.1)]);
            (from_origin(a, b), nearer)
        };
        pairs.chain(alone).map(beside).min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let nearest = std::iter::once(own.collect()).chain(pinned).filter_map(passing);
    nearest.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, state)| state)
}

/// How far the straight line from `a` to `b` is from the origin.
fn from_origin(a: [f64; 2], b: [f64; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let share = -(a[0] * along[0] + a[1] * along[1]) / length;
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    (a[0] + share * along[0]).hypot(a[1] + share * along[1])
}

/// The limit points of a curve under every control shown, and the landings of its events, as δ, P and s.
fn marks(curve: &CurveData) -> Vec<([f64; 3], What)> {
    let events = curve.report.as_ref().map_or(&[][..], |report| &report.events);
    let event_at = |s: f64| {
        let begins = |event: &EventReport| {
            event.before.as_ref().is_some_and(|before| (before.contact_radius - s).abs() <= SAME * s)
        };
        events.iter().position(begins).map(|at| at + 1)
    };
    let own = curve.shown_limits();
    let of = own.len();
    let control = curve.setting.control;
    let mut marks: Vec<_> = own
        .into_iter()
        .enumerate()
        .map(|(i, at)| (at, What::Limit { control, number: i + 1, of, event: event_at(at[2]) }))
        .collect();
    for other in [Control::Displacement, Control::Force] {
        let limits: Vec<_> = curve.other_limits.iter().filter(|(control, _)| *control == other).collect();
        let of = limits.len();
        marks.extend(limits.into_iter().enumerate().map(|(i, (control, point))| {
            (place(point), What::Limit { control: *control, number: i + 1, of, event: None })
        }));
    }
    let landings = events.iter().enumerate().filter_map(|(i, event)| {
        let after = event.after.as_ref()?;
        Some(([after.approach, after.force, after.contact_radius], What::Landing(i + 1)))
    });
    marks.extend(landings);
    marks
}

/// Both coordinates of a point as text, with as many digits as a window with these bounds can distinguish.
pub fn coordinates(bounds: &Bounds, [x, y]: [&Axis; 2], at: (f64, f64)) -> String {
    /// The number of positions distinguished across a window.
    const PLACES: f64 = 1e3;
    let shown = |axis: &Axis, [lo, hi]: [f64; 2], at: f64| {
        let size = match axis.run {
            AxisScale::Linear | AxisScale::Counted => lo.abs().max(hi.abs()),
            // A step along the axis is a share of the value itself.
            AxisScale::Logarithmic => std::f64::consts::LOG10_E,
        };
        let digits = (size / (hi - lo) * PLACES).log10().ceil().clamp(3.0, 16.0);
        // Between 3 and 16.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        significant(axis.run.value(at), digits as usize)
    };
    format!("{} {}, {} {}", x.title(), shown(x, bounds.x, at.0), y.title(), shown(y, bounds.y, at.1))
}
