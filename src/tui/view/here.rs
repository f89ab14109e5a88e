//! The state on which the walker stands, and how it steps.

use super::parts::{is_selected, pair, panel, symbol};
use crate::explorer::node::{Node, NodeKind};
use crate::explorer::{Id, Model, ScreenPanel};
use crate::figure::{Axis, Scale};
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use crate::tui::theme::Theme;
use pulloff_engine::case::critical_force;
use pulloff_engine::gap::wave_index;
use pulloff_engine::problem::Control;
use pulloff_engine::quasistatic::State;
use pulloff_engine::report::number::{difference, fixed, short, significant, with_unit};
use pulloff_engine::units::Quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// An approach below this share of the contact radius is rounding alone.
const NO_APPROACH: f64 = 1e-12;

/// The largest difference from the exact state that is rounding alone.
const ROUNDING: f64 = 1e-10;

/// The state of a node in the user's units.
fn shown_state(node: &Node) -> State {
    let mut state = node.seen();
    if state.approach.abs() <= NO_APPROACH * state.contact_radius {
        state.approach = 0.0;
    }
    state
}

/// Draws the state of the walker.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let node = model.history.current();
    let title = node.map_or_else(|| "Here".to_owned(), |node| format!("Here, step {}", node.step));
    let block = panel(theme, &title, is_selected(app, ScreenPanel::Here));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let Some(node) = node else { return };
    let stale = matches!(node.kind, NodeKind::Stale(_)) || !model.is_on_curve(node);
    let mut lines = if node.is_apart() {
        apart(theme, &app.keymap, node)
    } else {
        state(theme, model, node, usize::from(inner.width))
    };
    if stale {
        let style = theme.dim();
        lines = lines.into_iter().map(|line| Line::styled(line.to_string(), style)).collect();
        lines.insert(0, Line::styled(" for other values", theme.error()));
    }
    let room = usize::from(inner.width);
    let lines: Vec<Line> = lines.into_iter().filter_map(|line| fitting(theme, line, room)).collect();
    frame.render_widget(Paragraph::new(lines), inner);
}

/// The state in one line: as many of its parts as fit, in the units of the charts.
pub fn line(app: &App, room: usize) -> Line<'static> {
    let (model, theme) = (&app.model, app.theme);
    let (Some(node), Some(curve)) = (model.history.current(), model.curve.as_deref()) else {
        return Line::default();
    };
    let scale = Scale::of(curve, model.axes);
    let [length, force, radius] = scale.state_axes();
    let state = shown_state(node);
    // Each part with its rank: those of the highest ranks go where there is no room.
    let mut parts: Vec<(u8, Vec<Span<'static>>)> = Vec::new();
    let shown = |axis: &Axis, x: f64, digits| {
        pair(theme, &format!("{} ", axis.symbol), &significant(x, digits)).to_vec()
    };
    parts.push((0, vec![Span::styled(format!("@ {}", node.step), theme.strong())]));
    if matches!(node.kind, NodeKind::Stale(_)) || !model.is_on_curve(node) {
        parts.push((1, vec![Span::styled("for other values", theme.error())]));
    }
    if let Some(event) = node.parted_by() {
        parts.push((1, vec![Span::styled(format!("apart, {event}"), theme.strong())]));
    }
    parts.push((4, shown(&length, scale.length(state.approach), 4)));
    parts.push((3, shown(&force, scale.force(state.force), 4)));
    parts.push((5, shown(&radius, scale.radius(state.contact_radius), 3)));
    if !node.is_apart() {
        let fault = inadmissible(theme, node).map(|line| line.to_string().trim().to_owned());
        parts.extend(fault.map(|fault| (1, vec![Span::styled(fault, theme.error())])));
        let mut flags = Vec::new();
        for [name, word] in stable(model, node) {
            let (word, is_bad) = match word {
                "yes" => ("stable", false),
                "no" => ("unstable", true),
                word => (word, true),
            };
            let between = if flags.is_empty() { "" } else { " " };
            flags.push(Span::styled(theme.text(&format!("{between}{name} ")), theme.dim()));
            flags.push(if is_bad { Span::styled(word, theme.error()) } else { Span::raw(word) });
        }
        parts.push((2, flags));
        let way = if model.inward { "inward" } else { "outward" };
        parts.push((6, vec![Span::raw(way)]));
        parts.push((7, pair(theme, "step ", &short(model.length, 3)).to_vec()));
    }
    let width = |part: &(u8, Vec<Span<'_>>)| 2 + part.1.iter().map(Span::width).sum::<usize>();
    // The first has one space before it, the others two.
    while parts.iter().map(width).sum::<usize>() > room + 1 {
        let Some(last) = parts.iter().map(|(rank, _)| *rank).max().filter(|rank| *rank > 0) else { break };
        parts.retain(|(rank, _)| *rank != last);
    }
    let mut spans = Vec::new();
    for (_, part) in parts {
        spans.push(Span::raw(if spans.is_empty() { " " } else { "  " }));
        spans.extend(part);
    }
    Line::from(spans)
}

/// Each control, and whether the state is stable with it held.
fn stable(model: &Model, node: &Node) -> Vec<[&'static str; 2]> {
    let spring = model.control().filter(|control| matches!(control, Control::Stiffness(_)));
    let word = |control| {
        let word = match node.stability.under(control) {
            _ if model.is_limit(node, control) => "LIMIT",
            true => "yes",
            false => "no",
        };
        [symbol(control), word]
    };
    // The device first: narrow panels cut the end.
    spring.into_iter().chain([Control::Displacement, Control::Force]).map(word).collect()
}

/// A line that fits, or as many of its pairs as fit.
fn fitting(theme: Theme, mut line: Line<'static>, room: usize) -> Option<Line<'static>> {
    while line.width() > room && line.spans.len() > 3 {
        line.spans.truncate(line.spans.len() - 2);
    }
    if line.width() <= room {
        return Some(line);
    }
    let style = line.style;
    let text = theme.whole_words(&line.to_string(), room);
    // A key without its value says nothing.
    (text.split_whitespace().count() > 1).then(|| Line::styled(text, style))
}

/// A value of the node's problem in the unit in which it is shown.
fn shown(theme: Theme, node: &Node, quantity: Quantity, x: f64, digits: usize) -> String {
    with_unit(&node.setting.preset.units, quantity, x, theme.ascii, |x| significant(x, digits))
}

fn apart(theme: Theme, keymap: &Keymap, node: &Node) -> Vec<Line<'static>> {
    let state = shown_state(node);
    let shown = |quantity, x| shown(theme, node, quantity, x, 5);
    let event = node.parted_by().unwrap_or_default();
    let line = |name: &str, quantity, x| Line::from(pair(theme, name, &shown(quantity, x)).to_vec());
    vec![
        Line::styled(" the bodies are apart", theme.strong()),
        line(&format!(" {event:<12} δ "), Quantity::Length, state.approach),
        line("              P ", Quantity::Force, state.force),
        line("              s ", Quantity::Length, state.contact_radius),
        Line::raw(format!(
            " {} goes back, {} starts again",
            keymap.first(Id::Undo),
            keymap.first(Id::Restart)
        )),
    ]
}

fn state(theme: Theme, model: &Model, node: &Node, width: usize) -> Vec<Line<'static>> {
    let setting = &node.setting;
    let state = shown_state(node);
    let critical = critical_force(&setting.preset);
    let wave = setting.reduced.gap.wavelength();
    let s = node.state.contact_radius;
    let mut force = pair(theme, " P ", &shown(theme, node, Quantity::Force, state.force, 4)).to_vec();
    if let Some(critical) = critical {
        force.extend(pair(theme, "  /Pc ", &significant(state.force / critical, 4)));
    }
    let mut radius =
        pair(theme, " s ", &shown(theme, node, Quantity::Length, state.contact_radius, 4)).to_vec();
    if let Some(wave) = wave {
        radius.extend(pair(theme, "  s/λ ", &significant(s / wave, 4)));
    }
    let zone = node.on_path.filter(|_| model.is_on_curve(node));
    let zone = zone.and_then(|at| model.curve.as_ref()?.zone(at));
    let of_each = stable(model, node);
    // With a spring there are three.
    let between = if of_each.len() > 2 { " " } else { "  " };
    let mut flags = vec![Span::styled(" stable", theme.dim())];
    for [name, word] in of_each {
        let word = if word == "yes" { Span::raw(word) } else { Span::styled(word, theme.error()) };
        flags.extend([Span::styled(theme.text(&format!("{between}{name} ")), theme.dim()), word]);
    }
    let way = if model.inward {
        theme.glyph("← inward", "< inward")
    } else {
        theme.glyph("→ outward", "> outward")
    };
    let mut lines = vec![
        Line::from(pair(theme, " δ ", &shown(theme, node, Quantity::Length, state.approach, 4)).to_vec()),
        Line::from(force),
        Line::from(radius),
        Line::from(flags),
    ];
    lines.extend(zone.map(|edge| {
        let edge = shown(theme, node, Quantity::Length, edge * setting.units().length, 4);
        Line::from(pair(theme, " zone to ", &edge).to_vec())
    }));
    lines.extend(inadmissible(theme, node));
    lines.extend(contacts(theme, node));
    // A share of the range of every quantity, spelled out if there is room.
    let step = short(model.length, 3);
    let said = format!("{step} of range");
    let room = width.saturating_sub(" step   ".len() + way.chars().count());
    let step = if said.len() <= room { said } else { step };
    lines.push(Line::from([pair(theme, " step ", &step), pair(theme, "  ", way)].concat()));
    let mut last = Vec::new();
    if let Some(crest) = wave_index(s, wave) {
        last.extend(pair(theme, " crest ", &crest.to_string()));
    }
    last.extend(pair(theme, " digits ", &fixed(node.digits.floor(), 0)));
    lines.push(Line::from(last));
    // What the basis' own estimate is worth; where there is nothing but rounding, the digits have said it.
    if node.from_exact.is_finite() && node.from_exact.abs() > ROUNDING {
        lines.push(Line::from(pair(theme, " off exact ", &difference(node.from_exact)).to_vec()));
    }
    lines.extend(stiffness(theme, node));
    lines.extend(known_to(theme, node));
    lines
}

/// The contacts of a state with rings, from the axis outward, in λ if there is a single wave.
fn contacts(theme: Theme, node: &Node) -> Vec<Line<'static>> {
    if !node.has_rings() {
        return Vec::new();
    }
    let wave = node.setting.reduced.gap.wavelength();
    let length = node.setting.units().length;
    let radius = |r: f64| match wave {
        Some(wave) => significant(r / wave, 4),
        None => shown(theme, node, Quantity::Length, r * length, 4),
    };
    let all = node.contacts().intervals().into_iter().map(|[inner, outer]| {
        let (name, text) = if inner > 0.0 {
            (" ring ", format!("{} to {}", radius(inner), radius(outer)))
        } else {
            (" disc ", radius(outer))
        };
        let unit = if wave.is_some() { theme.text(" λ") } else { String::new() };
        Line::from(pair(theme, name, &format!("{text}{unit}")).to_vec())
    });
    all.collect()
}

/// The message for an inadmissible state: r of the crest that would touch, or where the disc would have to pull.
fn inadmissible(theme: Theme, node: &Node) -> Option<Line<'static>> {
    let (radius, _) = node.fault_radius()?;
    let radius = shown(theme, node, Quantity::Length, radius * node.setting.units().length, 4);
    Some(Line::styled(format!(" inadmissible: r {radius}"), theme.error()))
}

/// The message for an admissible state whose gap is not known, or not checked, beyond a radius.
fn known_to(theme: Theme, node: &Node) -> Option<Line<'static>> {
    let radius = node.admissibility.known_to.filter(|_| node.admissibility.holds)?;
    let radius = shown(theme, node, Quantity::Length, radius * node.setting.units().length, 4);
    Some(Line::from(pair(theme, " admissible up to r ", &radius).to_vec()))
}

/// dP/dδ, `P_δ` and dA/dδ; and the iterations, which are dispensable if there is no room.
fn stiffness(theme: Theme, node: &Node) -> [Line<'static>; 3] {
    let stiffness = node.stiffness.in_units(node.setting.units());
    // At a limit point of the approach, the slopes are infinite.
    let slope = |quantity, x: f64| {
        if x.is_nan() {
            // At a corner, the slopes on the two sides differ.
            "none".to_owned()
        } else if x.is_infinite() {
            "infinite".to_owned()
        } else {
            shown(theme, node, quantity, x, 4)
        }
    };
    let tangent = pair(theme, " dP/dδ ", &slope(Quantity::ForcePerLength, stiffness.tangent));
    let contact = pair(theme, "   with s held ", &slope(Quantity::ForcePerLength, stiffness.contact));
    let mut area = pair(theme, " dA/dδ ", &slope(Quantity::Length, stiffness.area_slope)).to_vec();
    area.extend(pair(theme, "  iterations ", &node.point.rounds.to_string()));
    [Line::from(tangent.to_vec()), Line::from(contact.to_vec()), Line::from(area)]
}
