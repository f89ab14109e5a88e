//! The outcome of the path: A, B, the last contact, the snaps and their losses; with a pin, its numbers beside them.

use super::parts::{is_selected, pair, panel};
use crate::explorer::pinned::Compared;
use crate::explorer::pins::{Pin, letter};
use crate::explorer::{CurveData, Model, ScreenPanel};
use crate::figure::{Axis, Scale};
use crate::tui::app::App;
use crate::tui::theme::Theme;
use pulloff_engine::report::PathReport;
use pulloff_engine::report::number::{loss, significant, with_unit};
use pulloff_engine::report::path::StateReport;
use pulloff_engine::units::Quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Draws the outcome of the path.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let pinned = model.pins.beside(&model.preset).0.pop();
    let pinned = pinned.and_then(|pin| Some((pin, Compared::of(model, pin)?)));
    let title = title(model, pinned.as_ref(), usize::from(area.width.saturating_sub(2)));
    let block = panel(theme, &title, is_selected(app, ScreenPanel::Result));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let lines = match (model.path(), pinned) {
        (Some(_), Some((pin, compared))) => beside(theme, model, pin, &compared),
        (Some(path), None) => lines(theme, model, path, usize::from(inner.width)),
        (None, _) => vec![Line::styled(" no path yet", theme.dim())],
    };
    frame.render_widget(Paragraph::new(lines), inner);
}

/// Its name; that its numbers are not those of the pull at a rate; and beside a pin, what the rows are given in, as much
/// as fits.
fn title(model: &Model, pinned: Option<&(&Pin, Compared<'_>)>, room: usize) -> String {
    let is_pulled = model.is_pulled();
    let (Some((pin, compared)), Some(curve)) = (pinned, model.curve.as_deref()) else {
        return if is_pulled { "Result, quasi-static" } else { "Result" }.to_owned();
    };
    let scale = common(model, curve, &pin.curve);
    let energy = Axis {
        shown: model.preset.units.unit(Quantity::Energy).map_or_else(String::new, ToString::to_string),
        ..Axis::pure("W".to_owned())
    };
    let [length, force, radius] = scale.state_axes();
    // Otherwise it would be taken for P/Pc, which it is without a pin.
    let is_raw = scale.force.is_none() && Scale::of(curve, model.axes).force.is_some();
    let name = if is_pulled { "Result q-static" } else { compared.name.unwrap_or("Result") };
    let mut title = name.to_owned();
    for axis in [force, length, radius, energy] {
        let unit = if axis.shown.is_empty() { String::new() } else { format!(" {}", axis.shown) };
        let is_raw = is_raw && axis.symbol == "P" && unit.is_empty();
        let unit = if is_raw { " raw".to_owned() } else { unit };
        let item = format!(" {}{unit}", axis.symbol);
        if title.chars().count() + item.chars().count() > room {
            break;
        }
        title += &item;
    }
    title
}

/// The divisors of both curves; what they do not share divides neither.
fn common<'a>(model: &'a Model, now: &'a CurveData, pinned: &'a CurveData) -> Scale<'a> {
    let [now, other] = [now, pinned].map(|curve| Scale::of(curve, model.axes));
    let is_same = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
    let both = |a: Option<f64>, b: Option<f64>| a.filter(|a| b.is_some_and(|b| is_same(*a, b)));
    Scale {
        force: both(now.force, other.force),
        wave: both(now.wave, other.wave),
        curvature: both(now.curvature, other.curvature),
        ..now
    }
}

fn lines(theme: Theme, model: &Model, path: &PathReport, room: usize) -> Vec<Line<'static>> {
    let Some(curve) = model.curve.as_deref() else { return Vec::new() };
    let scale = Scale::of(curve, model.axes);
    let [length, force, radius] = scale.state_axes();
    let shown = |symbol: &str, x: f64| pair(theme, &format!("{symbol} "), &significant(x, 4));
    let unit = |axis: &Axis| {
        theme.text(&if axis.shown.is_empty() { String::new() } else { format!(" {}", axis.shown) })
    };
    let state = |at: &StateReport| {
        let [of_approach, of_radius] = [&length, &radius].map(unit);
        let approach = shown(&length.symbol, scale.length(at.approach));
        let radius = shown(&radius.symbol, scale.radius(at.contact_radius));
        let is_one = of_approach == of_radius;
        let line = |[of_approach, of_radius]: [String; 2]| {
            let between = Span::raw(format!("{of_approach}  "));
            let parts = [vec![Span::raw("  ")], approach.to_vec(), vec![between], radius.to_vec()].concat();
            Line::from([parts, vec![Span::raw(of_radius)]].concat())
        };
        let with_units = line([of_approach, of_radius.clone()]);
        // One unit for both, where there is no room for two.
        let with_one = line([String::new(), if is_one { of_radius } else { String::new() }]);
        [with_units, with_one]
            .into_iter()
            .find(|line| line.width() <= room)
            .unwrap_or_else(|| line([String::new(), String::new()]))
    };
    let head = |name: &str, value: [Span<'static>; 2]| {
        Line::from([vec![Span::raw(theme.text(name))], value.to_vec()].concat())
    };
    let totals = &path.totals;
    let mut lines = Vec::new();
    for (name, at) in [(" A largest pull", totals.pull()), (" B farthest", totals.farthest.as_ref())] {
        let Some(at) = at else { continue };
        lines.push(Line::raw(name.to_owned()));
        let units = &model.preset.units;
        let own = with_unit(units, Quantity::Force, at.force, theme.ascii, |x| significant(x, 4));
        let mut line = match scale.force {
            Some(_) => head("  ", shown(&force.symbol, scale.force(at.force))),
            None => head("  ", pair(theme, &format!("{} ", force.symbol), &own)),
        };
        // A share of Pc also in the unit of the force, if there is one.
        if scale.force.is_some() && units.unit(Quantity::Force).is_some() {
            let own = Span::raw(format!("  {own}"));
            line.spans.extend(Some(own).filter(|own| line.width() + own.width() <= room));
        }
        lines.push(line);
        lines.push(state(at));
    }
    if let Some(event) = path.events.iter().find(|event| event.kind == "last-contact") {
        lines.push(head(" last contact", pair(theme, "  event ", &event.number.to_string())));
    }
    let lost = totals.dissipated.unwrap_or(totals.dissipated_before_last_contact);
    let energy = |lost| with_unit(&model.preset.units, Quantity::Energy, lost, theme.ascii, loss);
    let fall = if totals.dissipated.is_none() { "+" } else { "" };
    let lost = format!("{}{fall}", energy(lost));
    let count = head(" ", pair(theme, "snaps ", &snaps(path, " in")));
    match totals.dead_band {
        // The count of snaps goes where there is no room for it.
        Some(band) => lines.extend([
            head(" ", pair(theme, "in jumps ", &lost)),
            head(" ", pair(theme, "dead band ", &energy(band.dissipated))),
            count,
        ]),
        None => lines.extend([count, head(" ", pair(theme, "lost in all ", &lost))]),
    }
    lines
}

/// How many snaps a path has: those of an edge that opens and, if there are any, those of one that closes, with a word behind them.
fn snaps(path: &PathReport, word: &str) -> String {
    let [opening, closing] =
        ["snap", "snap-in"].map(|kind| path.events.iter().filter(|event| event.kind == kind).count());
    if closing == 0 { opening.to_string() } else { format!("{opening}+{closing}{word}") }
}

/// The width of a name.
const NAME: usize = 4;
/// The widths of the columns beside it: now, the pin, and the change from the pin in per cent.
const COLUMNS: [usize; 3] = [8, 8, 7];

/// The same numbers in columns, beside those of the newest pin.
fn beside(theme: Theme, model: &Model, pin: &Pin, compared: &Compared<'_>) -> Vec<Line<'static>> {
    let Compared { now: path, pin: other, .. } = *compared;
    let Some(curve) = model.curve.as_deref() else { return Vec::new() };
    let scale = common(model, curve, &pin.curve);
    let [now_width, pin_width, change_width] = COLUMNS;
    let head = |name: String, now: &str, pin: &str, change: &str| {
        // A long name takes its room from a short value.
        let now_width = (NAME + now_width).saturating_sub(name.chars().count().max(NAME));
        Line::from(vec![
            Span::styled(theme.text(&format!("{name:<NAME$}")), theme.dim()),
            Span::raw(format!("{now:>now_width$}")),
            Span::styled(format!("{pin:>pin_width$}"), theme.dim()),
            Span::styled(format!("{change:>change_width$}"), theme.strong()),
        ])
    };
    let row = |name: &str, values: [Option<f64>; 2]| {
        let [mut now, pin] = values.map(|x| x.map_or_else(|| "none".to_owned(), cell));
        // A blank stays between a long name and its value.
        if let Some(x) =
            values[0].filter(|_| name.chars().count() + 1 + now.chars().count() >= NAME + now_width)
        {
            now = format!("{x:.1e}");
        }
        let change = match values {
            [Some(now), Some(was)] if was != 0.0 => change(now, was),
            _ => String::new(),
        };
        head(format!(" {name}"), &now, &pin, &change)
    };
    let mut lines = vec![head(String::new(), "now", &format!("pin {}", letter(pin.number)), "change")];
    let totals = [&path.totals, &other.totals];
    let states =
        [("A", totals.map(|totals| totals.pull())), ("B", totals.map(|totals| totals.farthest.as_ref()))];
    for (name, [now, was]) in states {
        let both = |value: &dyn Fn(&StateReport) -> f64| [now, was].map(|at| at.map(value));
        lines.push(row(&format!("{name} P"), both(&|at| scale.force(at.force))));
        lines.push(row("  \u{3b4}", both(&|at| scale.length(at.approach))));
        lines.push(row("  s", both(&|at| scale.radius(at.contact_radius))));
    }
    let units = &model.preset.units;
    let energy = |lost| units.shown(Quantity::Energy, lost).number;
    let bands = totals.map(|totals| totals.dead_band.map(|band| energy(band.dissipated)));
    // The panel has no line more than without one.
    if bands == [None, None] {
        // The word has no room in a column.
        let [now, pin] = [path, other].map(|path| snaps(path, ""));
        lines.push(head(" snaps".to_owned(), &now, &pin, ""));
    } else {
        lines.push(row("band", bands));
    }
    let lost = totals.map(|totals| totals.dissipated.map(energy));
    if let [Some(_), Some(_)] = lost {
        lines.push(row("W", lost));
    } else {
        // What is lost after it has no bound, or is not known where a path ends early.
        let at_least = totals.map(|totals| format!("{:.1e}+", energy(totals.dissipated_before_last_contact)));
        let text = |at: usize| lost[at].map_or_else(|| at_least[at].clone(), cell);
        lines.push(head(" W".to_owned(), &text(0), &text(1), ""));
    }
    lines
}

/// Three digits of a number, with an exponent if they do not fit into a column.
fn cell(x: f64) -> String {
    let plain = if x.fract() == 0.0 && x.abs() < 1e6 { format!("{x}") } else { significant(x, 3) };
    let [width, ..] = COLUMNS;
    if plain.chars().count() < width { plain } else { format!("{x:.2e}") }
}

/// The change relative to the former value, in per cent: a larger pull is an increase, though its force is more
/// negative.
fn change(now: f64, was: f64) -> String {
    let percent = 100.0 * (now - was) / was;
    match percent.abs() {
        0.0..0.005 => "0%".to_owned(),
        0.005..1.0 => format!("{percent:+.2}%"),
        1.0..10.0 => format!("{percent:+.1}%"),
        10.0..1000.0 => format!("{percent:+.0}%"),
        _ => format!("x{}", significant(now / was, 2)),
    }
}
