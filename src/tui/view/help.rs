//! The glossary in pages: how to read the screen, first steps, and what the preset says. Every key is in the list of
//! commands.

use super::parts::panel;
use crate::explorer::pins::changes;
use crate::explorer::{Home, Id};
use crate::tui::app::App;
use crate::tui::overlay::Help;
use crate::tui::theme::Theme;
use pulloff_engine::report::FitReport;
use pulloff_engine::text::greek;
use ratatui::Frame;
use ratatui::layout::{Margin, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Paragraph};

/// Commands in it are named in the form of [`Id::named`](crate::explorer::Id::named).
const FIRST_STEPS: &[&str] = &[
    "The walker @ stands at the start of the path. \u{1}next-event\u{1} runs to the first event: there the edge lets go.",
    "\u{1}next-event\u{1} again lets it happen and shows the energy lost; and so on, down to the last contact. \u{1}step\u{1} follows the equilibrium instead, past limit points too. \u{1}undo\u{1} takes back the last change of the walk or the values; consecutive turns of one value count as one change.",
    "Select A with the arrow keys and press \u{1}more\u{1} a few times: the curve follows. \u{1}edit\u{1} types a value, with its unit where the preset has units.",
    "\u{1}pin\u{1} keeps the curve to compare the next ones with; \u{1}control\u{1} holds the force, or a spring, instead of the displacement.",
    "\u{1}go\u{1} and i shows the inside of the state: gap, pressure, energy; \u{1}go\u{1} and m how it depends on the values; \u{1}next-view\u{1} is the next chart; \u{1}cross-hair\u{1} reads numbers off it.",
    "\u{1}save-as\u{1} keeps the preset under a name of your own, \u{1}export\u{1} writes curve, walk, events or a figure, and \u{1}open\u{1} lists the presets. Sessions are kept without asking: pulloff --resume goes on with one.",
];

/// The same.
const READING: &[&str] = &[
    "The curve holds every equilibrium of one contact disc: approach δ, force P (tension is negative) and contact \
     radius s. On its unstable parts (broken lines) the contact would not stay under the control chosen.",
    "A number marks an event of the log: there the edge lets go and runs, at constant control, to the next stable part, \
     and the energy between is lost. A is the largest pull, B the farthest state. A dot is a limit point off the path.",
    "Inadmissible states have the colour of a warning, or ! without colours: outside the disc the next crest would \
     touch. The log lists them after the events; +13 !7 in its corner counts the events and such parts out of sight. \
     The real path has rings of contact there: its loop is drawn too, loading and unloading in colours of their own; with path.begin = apart the walk follows it.",
    "\u{1}go\u{1} and a letter lead to one of four places, \u{1}next-view\u{1} through the charts there. \
     In the potential m and M are its stable and unstable states, B the barrier before the edge lets go; ^ marks the \
     crests.",
    "What was walked is bright; a jump and what branches off are broken lines. Without colours, letters along the lines \
     tell them apart.",
    "Arrows move the chart, or the cross-hair, while Charts is the selected panel.",
    "The digits are an estimate of how far force and contact radius can be trusted; in the basis of rings, more rings give more.",
];

/// The abbreviations on the screen, one per line.
const SHORT: &[(&str, &str)] = &[
    ("δ  P  s", "approach, force (a pull is negative), contact radius: the outermost edge"),
    ("E*  γ  R", "effective modulus, work of adhesion, radius of the sphere"),
    ("P/Pc", "the force over the pull-off force of the smooth sphere, 3πγR/2"),
    (
        "A/λ  λ/R",
        "amplitude of the waves over their length (crest to trough is 2A), their length over the radius of the sphere",
    ),
    ("γ'", "2πγ/(E*R): adhesion against stiffness"),
    ("λ²/AR", "above 8.58 the gap rises all the way out; below, it has valleys around the axis"),
    ("α", "Johnson's √(2γλ/(π²E*A²)): large where adhesion flattens the waves"),
    ("μ", "Tabor's number: from 5 up the adhesion acts at the edge only, as computed here"),
    ("snap in", "an edge jumps and the contact grows; in a snap it jumps inward"),
    ("+13 !7", "below the last line of the log: events, and inadmissible parts, that are out of sight"),
    ("crest 8", "the crest nearest to the edge, counted from the axis; 8>7: from one to the next"),
    ("digits 13", "of force and contact radius, how many can be trusted, by the state's own check"),
    ("off exact", "the force minus that of the exact solution at this radius, as a share of it"),
    (
        "stable δ yes",
        "whether the state is stable with the displacement (δ), the force (P), the spring (k) held",
    ),
    ("step 0.02", "the longest step by hand, as a share of the range of δ, P and s of the curve"),
    ("dP/dδ", "the slope of the curve; with s held: that of a punch of this radius"),
    ("dA/dδ", "how fast the area of contact grows with the approach along the curve"),
    ("c7", "on maps: the line of limit points at the seventh crest from the axis"),
    (
        "first snap",
        "the least amplitude with a snap before the last contact under this control; it depends on where between two crests the last contact is",
    ),
    ("snap", "a jump of the edge, at constant control, before the bodies come apart"),
    (
        "-2",
        "an event left behind without happening: a jump off the path went round it, or a value was changed",
    ),
    ("last contact", "the event from which nothing stable is left: the bodies come apart"),
    ("A  B", "largest pull, and farthest: the least P and the least δ until the last contact"),
    ("○ landing", "where a jump comes to rest"),
    ("touch", "a crest outside the disc meets the other body: a ring of contact begins"),
    (
        "spring",
        "soft ones snap earlier; displacement control is the stiffest limit: what snaps there snaps with every spring, alone or within a larger jump",
    ),
    ("1.1 × smooth", "of a pull at a rate: over the largest pull of the smooth sphere at the same rate"),
    (
        "5/6 jumps seen",
        "of a pull at a rate: five of the six jumps of the slow path leave a peak in its force",
    ),
    ("W", "beside a pin: the energy lost"),
    (
        "lost 3e-4",
        "energy lost in jumps, the first touch and the last contact included; with a + after it, plus that of a jump without bound",
    ),
    (
        "dead band",
        "the extra energy that opening costs over closing: the part of a loop's loss that is not in jumps",
    ),
    ("no bound", "a dead load keeps falling: the loss at the last contact has no limit"),
    ("by area agrees", "the same loss as the area between the curve and the way of the device"),
    ("admissible", "whether the bodies stay apart outside the contact"),
    ("Ctrl-Z", "back to the shell; fg returns"),
    ("*  unsaved", "beside the name: the values shown are in no file"),
];

/// The names of the pages, in order.
pub const PAGES: [&str; 3] = ["how to read it", "first steps", "this preset"];

/// The page on what the preset says.
pub const ABOUT: usize = 2;

/// The column where the meaning of a key begins.
const MEANING: usize = 20;

/// A line of any length, broken between words when shown; its further rows are indented like the first.
struct HelpLine {
    /// What precedes it; as wide as its indent.
    label: String,
    text: String,
    style: Style,
}

impl HelpLine {
    fn new(label: &str, text: impl Into<String>, style: Style) -> Self {
        Self { label: label.to_owned(), text: text.into(), style }
    }

    fn rows(&self, theme: Theme, width: usize) -> Vec<Line<'static>> {
        let indent = Span::raw(&*self.label).width();
        let room = width.saturating_sub(indent).max(1);
        textwrap::wrap(&self.text, room)
            .into_iter()
            .enumerate()
            .map(|(i, row)| {
                let label = if i == 0 { self.label.clone() } else { " ".repeat(indent) };
                Line::from(vec![Span::styled(label, theme.key()), Span::styled(row.into_owned(), self.style)])
            })
            .collect()
    }
}

/// The full text of what narrow screens cut elsewhere: the status, warnings, notes.
pub fn now(app: &App) -> Vec<String> {
    let curve = app.model.curve.as_ref();
    let warnings = app.model.warnings().into_iter().map(|text| format!("! {text}"));
    let notes = curve.iter().flat_map(|curve| curve.base.notes.iter().cloned());
    [app.keymap.spelled(&app.model.status().1)].into_iter().chain(warnings).chain(notes).collect()
}

/// The lines of a page.
fn entries(app: &App, page: usize) -> Vec<HelpLine> {
    match page {
        0 => reading(app),
        1 => steps(app),
        _ => about(app),
    }
}

/// A title with nothing above it, or an empty line.
fn section(entries: &mut Vec<HelpLine>, theme: Theme, title: &str) {
    if !entries.is_empty() {
        entries.push(HelpLine::new("", "", Style::new()));
    }
    entries.push(HelpLine::new("", title, theme.strong()));
}

/// What is reported now, what is abbreviated, and what the chart shows.
fn reading(app: &App) -> Vec<HelpLine> {
    let (theme, keymap) = (app.theme, &app.keymap);
    let mut entries = Vec::new();
    section(&mut entries, theme, "Now");
    entries.extend(now(app).into_iter().map(|text| {
        let style = if text.starts_with("! ") { theme.error() } else { Style::new() };
        HelpLine::new("  ", theme.text(&text), style)
    }));
    section(&mut entries, theme, "Abbreviations");
    entries.extend(SHORT.iter().map(|(short, text)| {
        let label = format!("  {:<1$}", theme.text(short), MEANING - 2);
        HelpLine::new(&label, theme.text(text), Style::new())
    }));
    for home in Home::ALL {
        section(
            &mut entries,
            theme,
            &format!("{} {}: {}", keymap.first(Id::Go), home.name(), home.question()),
        );
        entries.extend(home.views().iter().map(|view| {
            let label = format!("  {:<1$}", view.name(), MEANING - 2);
            HelpLine::new(&label, theme.text(view.meaning()), Style::new())
        }));
    }
    section(&mut entries, theme, "The chart");
    entries.extend(READING.iter().map(|text| spelled(app, text)));
    entries
}

fn spelled(app: &App, text: &str) -> HelpLine {
    HelpLine::new("  ", app.theme.text(&app.keymap.spelled(text)), Style::new())
}

fn steps(app: &App) -> Vec<HelpLine> {
    let mut entries = Vec::new();
    section(&mut entries, app.theme, "First steps");
    entries.extend(FIRST_STEPS.iter().map(|text| spelled(app, text)));
    entries
}

/// The report of a fit whose values these are, what the preset says about itself, and what was changed since it was
/// read.
fn about(app: &App) -> Vec<HelpLine> {
    let (theme, model) = (app.theme, &app.model);
    let mut entries = Vec::new();
    let line = |text: &str| HelpLine::new("  ", theme.text(text), Style::new());
    if let Some(fit) = model.fitted() {
        let file = fit.preset.data.source.as_ref().map_or("", |source| &source.name);
        section(&mut entries, theme, "What the fit found");
        entries.extend(FitReport::new(file, fit, None).text().lines().map(line));
    }
    section(&mut entries, theme, &theme.text(&model.preset.title));
    entries.extend(paragraphs(&model.comment).iter().map(|text| line(text)));
    if model.comment.is_empty() {
        entries.push(line("(the file has no description)"));
    }
    let changes = changes(&model.saved, &model.preset);
    if !changes.is_empty() {
        section(&mut entries, theme, "Changed since");
        entries.extend(changes.iter().map(|change| line(&greek(change))));
    }
    entries
}

/// The paragraphs of a comment, each in one line: the screen breaks them anew. A line that was full goes on in the next one, if
/// that begins with a word; lists, formulas and short lines stay.
fn paragraphs(comment: &str) -> Vec<String> {
    const FULL: usize = 60;
    let mut all: Vec<String> = Vec::new();
    let mut was_full = false;
    for text in comment.lines() {
        let goes_on = was_full && text.starts_with(char::is_alphabetic) && !text.contains(" = ");
        match all.last_mut().filter(|_| goes_on) {
            Some(last) => last.extend([" ", text]),
            None => all.push(text.to_owned()),
        }
        was_full = text.chars().count() >= FULL && !text.contains(" = ");
    }
    all
}

/// The lines of a page in the form in which they are searched.
pub fn plain(app: &App, page: usize) -> Vec<String> {
    entries(app, page).iter().map(|entry| format!("{}{}", entry.label, entry.text)).collect()
}

fn title(help: &Help) -> String {
    let page = format!("Help {} of {}: {}", help.page + 1, PAGES.len(), PAGES[help.page]);
    match (&help.typing, help.found) {
        (Some(input), _) => format!("{page}  /{}_", input.value()),
        (None, Some(found)) => {
            format!("{page}  /{}: {} of {}, n and N go on", help.pattern, found.number, found.of)
        }
        (None, None) if help.pattern.is_empty() => {
            format!("{page} (Tab: the next page, / searches, Esc goes back)")
        }
        (None, None) => format!("{page}  /{}: not found", help.pattern),
    }
}

/// The number of rows of these lines.
fn count(lines: &[Vec<Line<'_>>]) -> usize {
    lines.iter().map(Vec::len).sum()
}

/// Draws the help over the screen, starting from the first line shown.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App, help: &Help) {
    let theme = app.theme;
    // Beside a narrower help, the footer would be seen in part.
    let beside = area.width.saturating_sub(110) / 2;
    let area = Rect { height: area.height.saturating_sub(u16::from(beside > 0)), ..area }
        .inner(Margin::new(beside, 0));
    let mut block = panel(theme, &title(help), true);
    let inner = block.inner(area);
    let mut lines: Vec<Vec<Line<'_>>> =
        entries(app, help.page).iter().map(|entry| entry.rows(theme, usize::from(inner.width))).collect();
    let found = help.found.filter(|found| found.page == help.page);
    if let Some(found) = found.and_then(|found| lines.get_mut(found.line)) {
        for row in found {
            *row = Line::styled(row.to_string(), theme.selection());
        }
    }
    // No further than to where the last rows fill the screen.
    let mut room = usize::from(inner.height);
    let mut last = lines.len();
    while last > 0 && room >= lines[last - 1].len() {
        last -= 1;
        room -= lines[last].len();
    }
    let first = help.line.min(last);
    let (above, all) = (count(&lines[..first]), count(&lines));
    let shown: Vec<Line<'_>> = lines.split_off(first).into_iter().flatten().collect();
    let end = (above + usize::from(inner.height)).min(all);
    block = block.title_bottom(Line::from(format!("lines {} to {end} of {all}", above + 1)).right_aligned());
    frame.render_widget(Clear, area);
    frame.render_widget(block, area);
    frame.render_widget(Paragraph::new(shown), inner);
}
