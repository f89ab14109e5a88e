//! The help, read from the one table of commands.

use super::panel;
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
use ratatui::widgets::{Clear, Paragraph, Wrap};

/// Commands in it are named as [`Id::named`](crate::explorer::Id::named) does.
const READING: &[&str] = &[
    "The curve holds every equilibrium of one contact disc: approach δ, force P (tension is negative) and",
    "contact radius s. On its unstable parts (dotted) the contact would not stay under the control chosen.",
    "v marks a limit point of that control: there the edge lets go and runs, at constant control, to the",
    "next stable part, and the energy between is lost. d and p mark the limit points of displacement and force.",
    "Not every limit point is on the quasi-static path: the events are those where the edge lets go on it.",
    "! marks states that cannot be: outside the disc the next crest would touch. They stand behind the events.",
    "Views follow each other with \u{1}next-view\u{1}: three of the curve, then the pressure in the disc, the gap outside it and the",
    "potential over the radius at the walker's state, and the unloading with its losses hatched. In the potential",
    "m and M are its stable and unstable states, B the barrier before the edge lets go; ^ marks the crests.",
    "Along the curve w marks the states walked and j a jump; letters and dashes tell lines apart without colour.",
    "Arrows move the chart, or the cross-hair, while Charts is the selected panel.",
    "The digits are an estimate of how far force and contact radius can be trusted; more rings give more.",
    "First steps: \u{1}next-limit\u{1} runs to a limit point, \u{1}jump\u{1} takes the jump, \u{1}undo\u{1} undoes. \
     Then select A and press \u{1}more\u{1} a few times.",
];

/// What narrow screens cut elsewhere, whole: the status, warnings, notes.
fn now(theme: Theme, keymap: &Keymap, model: &Model) -> Vec<Line<'static>> {
    let mut lines = vec![Line::default(), Line::styled("Now", theme.strong())];
    lines.push(Line::raw(format!("  {}", theme.text(&keymap.spelled(&model.status().1)))));
    if let Some(curve) = &model.curve {
        let line = |text: &String, style| Line::styled(format!("  {}", theme.text(text)), style);
        lines.extend(curve.sweep.warnings.iter().map(|text| line(&format!("! {text}"), theme.error())));
        lines.extend(curve.sweep.notes.iter().map(|text| line(text, Style::new())));
    }
    lines
}

fn text(app: &App) -> Vec<Line<'static>> {
    let (theme, keymap) = (app.theme, &app.keymap);
    let mut lines = now(theme, keymap, &app.model);
    let mut section = "";
    for row in ROWS {
        if row.section != section {
            section = row.section;
            lines.push(Line::default());
            lines.push(Line::styled(section, theme.strong()));
        }
        lines.push(Line::from(vec![
            Span::styled(format!("  {:<18}", keymap.label(row.id)), theme.key()),
            Span::raw(row.help),
        ]));
    }
    lines.push(Line::from(vec![
        Span::styled(format!("  {:<18}", "Ctrl-Z"), theme.key()),
        Span::raw("back to the shell; fg returns"),
    ]));
    lines.push(Line::default());
    lines.push(Line::styled("How to read it", theme.strong()));
    lines.extend(READING.iter().map(|line| Line::raw(format!("  {}", theme.text(&keymap.spelled(line))))));
    lines.remove(0);
    lines
}

/// The lines as they are searched.
pub fn plain(app: &App) -> Vec<String> {
    text(app).iter().map(Line::to_string).collect()
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
    let mut lines = text(app);
    let area = area.inner(Margin::new(area.width.saturating_sub(110) / 2, 0));
    let block = panel(theme, &title(help), true);
    let inner = block.inner(area);
    if let Some(found) = help.found.and_then(|(line, ..)| lines.get_mut(line)) {
        *found = Line::styled(found.to_string(), theme.selection());
    }
    // A wrapped line takes several rows: no further than where the last rows fill the screen.
    let rows = |line: &Line<'_>| line.width().div_ceil(usize::from(inner.width.max(1))).max(1);
    let mut room = usize::from(inner.height);
    let mut last = lines.len();
    while last > 0 && room >= rows(&lines[last - 1]) {
        last -= 1;
        room -= rows(&lines[last]);
    }
    let shown = lines.split_off(help.line.min(last));
    frame.render_widget(Clear, area);
    frame.render_widget(block, area);
    frame.render_widget(Paragraph::new(shown).wrap(Wrap { trim: false }), inner);
}
