//! The state, the events, a chart and the screen as text, for the clipboard of the person's own terminal (OSC 52).
//!
//! There is no way to ask whether a terminal accepts it: xterm needs `allowWindowOps`, tmux `set-clipboard on`, GNU
//! screen passes nothing on. So the same text can be exported to a file.

use super::app::App;
use super::overlay::Excerpt;
use super::theme::Theme;
use super::view;
use crate::explorer::export::{Export, Page};
use crate::explorer::{Model, Node};
use crate::plot::picture::picture;
use pulloff_engine::case::critical_force;
use pulloff_engine::problem::Control;
use pulloff_engine::report::number::{significant, with_unit};
use pulloff_engine::report::path::events_table;
use pulloff_engine::text::sanitize;
use pulloff_engine::units::Quantity;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// The most bytes that terminals take: 100 000 in a sequence, where base64 is a third longer than the text.
pub const LONGEST: usize = 74_994;

/// A longer line is cut.
const LINE: usize = 4096;

/// Digits of a copied value.
const DIGITS: usize = 10;

/// [`drawn`] for a session without a screen, as on one of 100 columns and 30 rows.
pub fn drawn_alone(model: &Model, what: Export) -> Result<Export, String> {
    drawn(&App { screen: Rect::new(0, 0, 100, 30), ..App::on(model.clone(), Theme::default()) }, what)
}

/// Makes a page of an export of what is seen, or says why it cannot be drawn; leaves any other export as it is.
pub fn drawn(app: &App, what: Export) -> Result<Export, String> {
    let page = match what {
        Export::Screen => Page::Screen(text(app, Excerpt::Screen)),
        Export::Figure(view) => Page::Figure(picture(&app.model, view.unwrap_or(app.model.view))?),
        other => return Ok(other),
    };
    Ok(Export::Page(page))
}

/// The content as text that cannot control a terminal.
pub fn text(app: &App, content: Excerpt) -> String {
    let text = match content {
        Excerpt::State => app.theme.text(&state(&app.model)),
        // The columns come from this program, and a row always fits them.
        Excerpt::Events => {
            events_table(app.model.path_events()).and_then(|table| table.tsv()).unwrap_or_default()
        }
        Excerpt::Chart | Excerpt::Screen => cells(app, content),
    };
    let cell = |cell: &str| sanitize(cell, LINE);
    let line = |line: &str| line.split('\t').map(cell).collect::<Vec<_>>().join("\t") + "\n";
    text.lines().map(line).collect()
}

/// The state of the walker, one quantity per line.
fn state(model: &Model) -> String {
    let name = format!("{}\n", model.source.shown());
    match model.history.current() {
        Some(node) if node.is_apart() => format!("{name}the bodies are apart\n"),
        Some(node) => name + &quantities(model, node),
        None => name,
    }
}

fn quantities(model: &Model, node: &Node) -> String {
    let setting = &node.setting;
    let state = node.state.in_units(setting.units());
    let shown =
        |quantity, x| with_unit(&node.setting.preset.units, quantity, x, false, |x| significant(x, DIGITS));
    let pure = |x| significant(x, DIGITS);
    let word = |control| match (model.is_limit(node, control), node.stability.under(control)) {
        (true, _) => "limit point",
        (false, true) => "stable",
        (false, false) => "unstable",
    };
    let mut lines = vec![
        ("δ", shown(Quantity::Length, state.approach)),
        ("P", shown(Quantity::Force, state.force)),
        ("s", shown(Quantity::Length, state.contact_radius)),
        ("U", shown(Quantity::Energy, state.energy)),
    ];
    lines.extend(critical_force(&setting.preset).map(|critical| ("P/Pc", pure(state.force / critical))));
    let wave = setting.reduced.gap.wavelength();
    lines.extend(wave.map(|wave| ("s/λ", pure(node.state.contact_radius / wave))));
    lines.push(("control", setting.shown_control(node.control).to_string()));
    lines.push(("δ held", word(Control::Displacement).to_owned()));
    lines.push(("P held", word(Control::Force).to_owned()));
    lines.push(("step", node.step.to_string()));
    lines.into_iter().map(|(name, value)| [name, "\t", &value, "\n"].concat()).collect()
}

/// The screen, or its first chart; the list that asked for it is already closed.
fn cells(app: &App, content: Excerpt) -> String {
    let size = app.screen;
    let Ok(mut terminal) = Terminal::new(TestBackend::new(size.width, size.height));
    let Ok(_) = terminal.draw(|frame| {
        view::draw(frame, app);
    });
    let buffer = terminal.backend().buffer();
    let chart = view::places(app, size).and_then(|regions| regions.charts.first().map(|(_, area)| *area));
    // Its lower wall belongs to the pane below, and has the heading of that pane.
    let chart = chart.map(|area| Rect { height: area.height.saturating_sub(1), ..area });
    lines(buffer, if content == Excerpt::Chart { chart.unwrap_or(size) } else { size })
}

fn lines(buffer: &Buffer, area: Rect) -> String {
    let row = |y| (area.left()..area.right()).map(|x| buffer[(x, y)].symbol()).collect::<String>();
    (area.top()..area.bottom()).map(|y| row(y).trim_end().to_owned() + "\n").collect()
}
