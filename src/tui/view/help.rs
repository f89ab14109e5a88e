//! The help, read from the one table of commands.

use super::parts::panel;
use crate::explorer::Model;
use crate::explorer::command::ROWS;
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use crate::tui::overlay::Help;
use crate::tui::theme::Theme;
use ratatui::Frame;
use ratatui::layout::{Margin, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Paragraph};

/// Commands in it are named as [`Id::named`](crate::explorer::Id::named) does.
const FIRST_STEPS: &str = "\u{1}next-limit\u{1} runs to a limit point, \u{1}jump\u{1} takes the jump, \u{1}undo\u{1} undoes. \
                           Then select A and press \u{1}more\u{1} a few times.";

/// The same.
const READING: &[&str] = &[
    "The curve holds every equilibrium of one contact disc: approach δ, force P (tension is negative) and contact \
     radius s. On its unstable parts (dotted) the contact would not stay under the control chosen.",
    "v marks a limit point of that control: there the edge lets go and runs, at constant control, to the next stable \
     part, and the energy between is lost. d and p mark the limit points of displacement and force. Not every limit \
     point is on the quasi-static path: the events are those where the edge lets go on it.",
    "! marks states that cannot be: outside the disc the next crest would touch. They stand behind the events. \
     The real path has rings of contact there: its loop is drawn with l (loading) and u (unloading), and \u{1}events\u{1} lists it.",
    "Views follow each other with \u{1}next-view\u{1}: three of the curve, then the pressure in the disc, the gap \
     outside it and the potential over the radius at the walker's state, and the unloading with its losses hatched. \
     In the potential m and M are its stable and unstable states, B the barrier before the edge lets go; ^ marks the \
     crests.",
    "Along the curve w marks the states walked, j a jump and b what branches off; letters and dashes tell lines apart \
     without colour.",
    "Arrows move the chart, or the cross-hair, while Charts is the selected panel.",
    "The digits are an estimate of how far force and contact radius can be trusted; in the basis of rings, more rings give more.",
];

/// Where what a key does begins.
const MEANING: usize = 20;

/// A line as long as it may be: broken between words where it is shown, each row under the first.
struct HelpLine {
    /// What stands before it, as wide as its indent.
    label: String,
    text: String,
    style: Style,
    /// The command's name, shown where there is room for it.
    name: &'static str,
}

impl HelpLine {
    fn new(label: &str, text: impl Into<String>, style: Style) -> Self {
        Self { label: label.to_owned(), text: text.into(), style, name: "" }
    }

    fn rows(&self, theme: Theme, width: usize) -> Vec<Line<'static>> {
        let indent = Span::raw(&*self.label).width();
        let room = width.saturating_sub(indent).max(1);
        let mut rows: Vec<Line<'static>> = textwrap::wrap(&self.text, room)
            .into_iter()
            .enumerate()
            .map(|(i, row)| {
                let label = if i == 0 { self.label.clone() } else { " ".repeat(indent) };
                Line::from(vec![Span::styled(label, theme.key()), Span::styled(row.into_owned(), self.style)])
            })
            .collect();
        if let (Some(row), false) = (rows.last_mut(), self.name.is_empty()) {
            let left = width.saturating_sub(row.width() + self.name.len());
            if left > 1 {
                row.push_span(Span::raw(" ".repeat(left)));
                row.push_span(Span::styled(self.name, theme.dim()));
            }
        }
        rows
    }
}

/// What narrow screens cut elsewhere, whole: the status, warnings, notes.
fn now(theme: Theme, keymap: &Keymap, model: &Model) -> Vec<HelpLine> {
    let entry = |text: &str, style| HelpLine::new("  ", theme.text(text), style);
    let mut entries = vec![entry(&keymap.spelled(&model.status().1), Style::new())];
    if let Some(curve) = &model.curve {
        entries.extend(curve.base.warnings.iter().map(|text| entry(&format!("! {text}"), theme.error())));
        entries.extend(curve.base.notes.iter().map(|text| entry(text, Style::new())));
    }
    entries
}

fn entries(app: &App) -> Vec<HelpLine> {
    let (theme, keymap) = (app.theme, &app.keymap);
    let section =
        |title: &str| [HelpLine::new("", "", Style::new()), HelpLine::new("", title, theme.strong())];
    let spelled = |text: &str| HelpLine::new("  ", theme.text(&keymap.spelled(text)), Style::new());
    let mut entries = vec![HelpLine::new("", "First steps", theme.strong()), spelled(FIRST_STEPS)];
    entries.extend(section("Now"));
    entries.extend(now(theme, keymap, &app.model));
    let mut current = "";
    for row in ROWS {
        if row.section != current {
            current = row.section;
            entries.extend(section(current));
        }
        let label = format!("  {:<1$}", keymap.label(row.id), MEANING - 2);
        entries
            .push(HelpLine { name: row.name, ..HelpLine::new(&label, theme.text(row.help), Style::new()) });
    }
    let label = format!("  {:<1$}", "Ctrl-Z", MEANING - 2);
    entries.push(HelpLine::new(&label, "back to the shell; fg returns", Style::new()));
    entries.extend(section("How to read it"));
    entries.extend(READING.iter().map(|text| spelled(text)));
    entries
}

/// The lines as they are searched.
pub fn plain(app: &App) -> Vec<String> {
    entries(app).iter().map(|entry| format!("{}{} {}", entry.label, entry.text, entry.name)).collect()
}

fn title(help: &Help) -> String {
    match (&help.typing, help.found) {
        (Some(input), _) => format!("Help  /{}_", input.value()),
        (None, Some((_, at, of))) => format!("Help  /{}: {at} of {of}, n and N go on", help.pattern),
        (None, None) if help.pattern.is_empty() => {
            "Help: up and down scroll, / searches, Esc closes".to_owned()
        }
        (None, None) => format!("Help  /{}: not found", help.pattern),
    }
}

/// Draws the help over the screen, from its first line shown on.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App, help: &Help) {
    let theme = app.theme;
    let area = area.inner(Margin::new(area.width.saturating_sub(110) / 2, 0));
    let block = panel(theme, &title(help), true);
    let inner = block.inner(area);
    let mut lines: Vec<Vec<Line<'_>>> =
        entries(app).iter().map(|entry| entry.rows(theme, usize::from(inner.width))).collect();
    if let Some(found) = help.found.and_then(|(line, ..)| lines.get_mut(line)) {
        for row in found {
            *row = Line::styled(row.to_string(), theme.selection());
        }
    }
    // No further than where the last rows fill the screen.
    let mut room = usize::from(inner.height);
    let mut last = lines.len();
    while last > 0 && room >= lines[last - 1].len() {
        last -= 1;
        room -= lines[last].len();
    }
    let shown: Vec<Line<'_>> = lines.split_off(help.line.min(last)).into_iter().flatten().collect();
    frame.render_widget(Clear, area);
    frame.render_widget(block, area);
    frame.render_widget(Paragraph::new(shown), inner);
}
