//! The two charts: P over δ, and s over P.

use super::is_selected;
use crate::contact::Control;
use crate::explorer::curve::{CurveData, CurvePoint};
use crate::explorer::history::{Node, NodeKind};
use crate::explorer::{Axes, Chart as Which, Model, Panel};
use crate::quasistatic::{Event, EventKind, State};
use crate::tui::app::App;
use crate::tui::chart::{Bounds, Chart, Mark, Series, Stroke};
use crate::tui::theme::{Theme, ink};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

/// What the axes are divided by.
#[derive(Debug, Clone, Copy)]
struct Scale {
    force: Option<f64>,
    radius: Option<f64>,
}

impl Scale {
    fn new(model: &Model, curve: &CurveData) -> Self {
        if model.axes == Axes::Raw {
            return Self { force: None, radius: None };
        }
        let problem = curve.setting.case.problem;
        // Without adhesion there is no P_c, without waves no λ: those axes stay raw.
        Self {
            force: Some(curve.sweep.critical_force).filter(|force| *force > 0.0),
            radius: crate::contact::Gap::feature_length(&problem.shape),
        }
    }

    fn place(self, which: Which, approach: f64, force: f64, radius: f64) -> (f64, f64) {
        let force = force / self.force.unwrap_or(1.0);
        match which {
            Which::ForceApproach => (approach, force),
            Which::RadiusForce => (force, radius / self.radius.unwrap_or(1.0)),
        }
    }

    fn force_name(self) -> &'static str {
        if self.force.is_some() { "P/Pc" } else { "P" }
    }

    fn radius_name(self) -> &'static str {
        if self.radius.is_some() { "s/λ" } else { "s" }
    }
}

/// Draws one of the charts; `alone` when the other is behind a key.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App, which: Which, alone: bool) {
    let chart = match &app.model.curve {
        Some(curve) => chart(&app.model, curve, which, alone, app.theme),
        None => Chart {
            title: "Curve".to_owned(),
            x_title: String::new(),
            series: Vec::new(),
            marks: Vec::new(),
            bounds: Bounds::of([]),
            legend: vec!["computing".to_owned()],
        },
    };
    chart.draw(frame, area, app.theme, is_selected(app, Panel::Charts));
}

fn chart(model: &Model, curve: &CurveData, which: Which, alone: bool, theme: Theme) -> Chart {
    let scale = Scale::new(model, curve);
    let of_point = |p: &CurvePoint| scale.place(which, p.approach, p.force, p.contact_radius);
    let all: Vec<(f64, f64)> = curve.points.iter().map(of_point).collect();
    let mut series = Vec::new();
    if model.smooth {
        let points = curve.sweep.smooth.iter().map(of_point).collect();
        series.push(Series { points, color: ink::SMOOTH, stroke: Stroke::Sparse });
    }
    series.extend(pieces(curve, &all));
    let mut marks = limit_marks(curve, scale, which);
    if let (Which::ForceApproach, Some(ends)) = (which, crate::explorer::device::line(model)) {
        let points = ends.map(|(approach, force)| scale.place(which, approach, force, 0.0)).to_vec();
        series.push(Series { points, color: ink::MARK, stroke: Stroke::Dotted });
    }
    walk(model, scale, which, &mut series, &mut marks);
    // The walker may have left the range of the curve: the chart follows it there.
    let walker = model.walker().filter(|node| !node.is_apart()).map(|node| {
        let state = node.state.in_units(node.setting.case.units());
        scale.place(which, state.approach, state.force, state.contact_radius)
    });
    let bounds = Bounds::of(all.iter().copied().chain(walker));
    let (y, x) = match which {
        Which::ForceApproach => (scale.force_name(), "δ"),
        Which::RadiusForce => (scale.radius_name(), scale.force_name()),
    };
    let hint = match (alone, which) {
        (false, _) => String::new(),
        (true, Which::ForceApproach) => format!("  (t: {} over {})", scale.radius_name(), scale.force_name()),
        (true, Which::RadiusForce) => format!("  (t: {} over δ)", scale.force_name()),
    };
    let smooth = if model.smooth { " thin JKR" } else { "" };
    let line = theme.glyph("━ stable ┈ unstable", "o stable . unstable");
    Chart {
        title: format!("{y} over {x}{hint}"),
        x_title: x.to_owned(),
        bounds,
        series,
        marks,
        legend: vec![
            format!("{line}{smooth} v limit X pull-off L landing @ here"),
            "v limit X pull-off L landing @ here".to_owned(),
            "v limit @ here".to_owned(),
        ],
    }
}

/// The curve cut where its stability changes.
fn pieces(curve: &CurveData, all: &[(f64, f64)]) -> Vec<Series> {
    let mut pieces: Vec<Series> = Vec::new();
    let mut last = None;
    for (point, at) in curve.points.iter().zip(all) {
        if last != Some(point.stable) {
            // The piece before reaches to here, so that no gap is left.
            if let Some(piece) = pieces.last_mut() {
                piece.points.push(*at);
            }
            let color = if point.stable { ink::STABLE } else { ink::UNSTABLE };
            pieces.push(Series {
                points: Vec::new(),
                color,
                stroke: if point.stable { Stroke::Solid } else { Stroke::Dotted },
            });
            last = Some(point.stable);
        }
        if let Some(piece) = pieces.last_mut() {
            piece.points.push(*at);
        }
    }
    // Stable parts last: they are drawn over the dots.
    pieces.sort_by_key(|piece| piece.stroke == Stroke::Solid);
    pieces
}

/// Limit points of the control as `v`, of the others as a small mark, the pull-off as `X`.
fn limit_marks(curve: &CurveData, scale: Scale, which: Which) -> Vec<Mark> {
    let style = Style::new().fg(ink::MARK).add_modifier(Modifier::BOLD);
    let equilibrium = &curve.sweep.curve.equilibrium;
    let units = curve.setting.case.units();
    let mut marks: Vec<Mark> = curve
        .other_limits
        .iter()
        .map(|(control, p)| {
            let letter = if *control == Control::Force { "p" } else { "d" };
            Mark {
                at: scale.place(which, p.approach, p.force, p.contact_radius),
                letter,
                style: Style::new().fg(ink::MARK),
            }
        })
        .collect();
    marks.extend(curve.limits.iter().map(|limit| {
        let [delta, force, s] = equilibrium.quantities(&limit.point.y);
        let at = scale.place(which, delta * units.length, force * units.force, s * units.length);
        Mark { at, letter: "v", style }
    }));
    if let Ok(unloading) = &curve.unloading {
        marks.extend(unloading.events.iter().filter(|event| event.kind == EventKind::PullOff).map(|event| {
            let state = event.before.in_units(units);
            Mark {
                at: scale.place(which, state.approach, state.force, state.contact_radius),
                letter: "X",
                style,
            }
        }));
    }
    marks
}

/// Where the bodies are once they are apart: the device holds its approach, its load, or its slack spring.
fn apart(node: &Node, event: &Event) -> State {
    /// Under a dead load the bodies fall apart for ever: a line to the left, out of the chart.
    const FAR: f64 = -1e3;
    let (approach, force) = match node.control {
        Control::Displacement => (event.before.approach, 0.0),
        Control::Force => (FAR * event.before.approach.abs(), event.before.force),
        Control::Stiffness(_) => (event.control_value, 0.0),
    };
    State { contact_radius: 0.0, approach, force, energy: 0.0 }
}

/// The walk: its steps, its jumps as straight lines, and the walker.
fn walk(model: &Model, scale: Scale, which: Which, series: &mut Vec<Series>, marks: &mut Vec<Mark>) {
    let place = |node: &Node, state: &State| {
        let state = state.in_units(node.setting.case.units());
        scale.place(which, state.approach, state.force, state.contact_radius)
    };
    let path: Vec<&Node> = model.history.path().into_iter().map(|(_, node)| node).collect();
    let mut steps: Vec<(f64, f64)> = Vec::new();
    let mut finish = |steps: &mut Vec<(f64, f64)>| {
        if steps.len() > 1 {
            series.push(Series { points: std::mem::take(steps), color: ink::WALK, stroke: Stroke::Solid });
        }
        steps.clear();
    };
    let mut jumps = Vec::new();
    for node in &path {
        if !model.is_on_curve(node) {
            finish(&mut steps);
            continue;
        }
        match &node.kind {
            NodeKind::Jump(event) => {
                finish(&mut steps);
                let before = place(node, &event.before);
                let after =
                    event.after.map_or_else(|| place(node, &apart(node, event)), |after| place(node, &after));
                jumps.push(vec![before, after]);
                if event.after.is_some() {
                    let style = Style::new().fg(ink::JUMP).add_modifier(Modifier::BOLD);
                    marks.push(Mark { at: after, letter: "L", style });
                    steps.push(after);
                }
            }
            NodeKind::Step | NodeKind::Limit if !steps.is_empty() => steps.push(place(node, &node.state)),
            _ => {
                finish(&mut steps);
                steps.push(place(node, &node.state));
            }
        }
    }
    finish(&mut steps);
    series.extend(jumps.into_iter().map(|points| Series { points, color: ink::JUMP, stroke: Stroke::Solid }));
    if let Some(node) = path.last() {
        let at = place(node, &node.state);
        let on = model.is_on_curve(node);
        let style = if on {
            Style::new().fg(ink::WALKER).add_modifier(Modifier::BOLD | Modifier::REVERSED)
        } else {
            Style::new().fg(ink::SMOOTH).add_modifier(Modifier::REVERSED)
        };
        marks.push(Mark { at, letter: "@", style });
    }
}
