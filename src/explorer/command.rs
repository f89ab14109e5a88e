//! The one table of commands.
//!
//! Dispatcher, footer, help screen and the manual's key table are read from it; the keymap of the terminal gives
//! each id its keys.

use super::model::{Model, Panel};
use super::view::{Overlay, View, Window};
use crate::preset::Key;
use std::path::PathBuf;

/// A command's identity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Id {
    /// One step along the curve.
    Step,
    /// Run until something happens, or pause.
    Run,
    /// Run to the next limit point of the control.
    NextLimit,
    /// Run to the previous limit point of the control.
    PreviousLimit,
    /// Let the edge run at constant control.
    Jump,
    /// The state of a contact radius.
    MoveTo,
    /// Walk the other way.
    Reverse,
    /// Halve the step length.
    Halve,
    /// Double the step length.
    Double,
    /// The step length as a number.
    StepLength,
    /// Back to the node before.
    Undo,
    /// Back to where the last command began.
    UndoCommand,
    /// Forward again.
    Redo,
    /// The branches of the walk, to go to.
    Branches,
    /// Back to the start state.
    Restart,
    /// Another control.
    Control,
    /// The value of the selected parameter, a little less.
    Less,
    /// A little more.
    More,
    /// Much less.
    MuchLess,
    /// Much more.
    MuchMore,
    /// Other values for some keys, as one change.
    Assign,
    /// Type the value of the selected parameter, or go to the selected event.
    Edit,
    /// The walker to an event by its number.
    SelectEvent,
    /// The parameter, event or line above.
    Up,
    /// The one below.
    Down,
    /// The panel to the left, or the chart moved.
    Left,
    /// The panel to the right, or the chart moved.
    Right,
    /// The panel before.
    PreviousPanel,
    /// The next panel.
    NextPanel,
    /// The next view.
    NextView,
    /// The view before.
    PreviousView,
    /// Closer.
    ZoomIn,
    /// Further away.
    ZoomOut,
    /// The whole of the chart.
    Fit,
    /// The cross-hair.
    CrossHair,
    /// Dimensionless or raw axes.
    Axes,
    /// Events on the curve, or walked.
    Events,
    /// The line of the loading device through the walker.
    Device,
    /// Theory over the curve.
    Overlays,
    /// Keep the curve to compare the next ones with.
    Pin,
    /// The pinned curves, to take away.
    Pins,
    /// Open a preset.
    Open,
    /// Save the preset.
    Save,
    /// Save it under another name.
    SaveAs,
    /// Write the curve, the walk, the events or a script to a file.
    Export,
    /// Put something into the clipboard.
    Copy,
    /// Take the mouse, or leave it to the terminal.
    Mouse,
    /// Type a command.
    CommandLine,
    /// The help screen.
    Help,
    /// Take back, close, pause.
    Cancel,
    /// Leave.
    Quit,
}

/// One row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// The command.
    pub id: Id,
    /// Its name in scripts and key bindings.
    pub name: &'static str,
    /// The section of the help it stands in.
    pub section: &'static str,
    /// One line that says what it does.
    pub help: &'static str,
    /// A word or two for the footer.
    pub short: &'static str,
    /// What it takes, if anything.
    pub argument: Option<&'static str>,
    /// Whether it can be done now.
    pub enabled: fn(&Model) -> bool,
}

/// A key and the text of its value.
pub type Assignment = (Key, String);

/// Most steps that one command takes.
pub const MOST_STEPS: usize = 9999;

/// A command with its argument.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// A command without an argument.
    Plain(Id),
    /// So many steps.
    Steps(usize),
    /// A run that ends after so many states, if it meets nothing before.
    RunOf(usize),
    /// The longest step by hand, in the scaled unknowns.
    StepLength(f64),
    /// The walker to the event of this number, from 1, among those shown.
    SelectEvent(usize),
    /// Other values for some keys, as one change; as on a command line a bare number is SI in an SI preset.
    Assign(Vec<Assignment>),
    /// Another value for a key, as typed.
    Set {
        /// The dotted key.
        key: Key,
        /// What was typed.
        text: String,
    },
    /// Another value for a key while it is typed: what was there before can be taken back.
    Try {
        /// The dotted key.
        key: Key,
        /// What has been typed.
        text: String,
    },
    /// Back to the values before those tried.
    TakeBack,
    /// List the profiles in this folder; without one, in that of the preset's own profile.
    Browse(Option<PathBuf>),
    /// Select a panel, and a line of it.
    Pick {
        /// The panel.
        panel: Panel,
        /// The line.
        line: Option<usize>,
    },
    /// Go to the state of this contact radius, in the user's units.
    MoveTo(f64),
    /// Closer to a place of a view, or further away.
    Zoom {
        /// The view.
        view: View,
        /// Whether closer.
        closer: bool,
        /// The place that stays where it is, in shares of the window.
        about: (f64, f64),
    },
    /// Draw this theory over the curve, or no longer.
    Overlay(Overlay),
    /// Stand on the last state walked with these δ, P and s, reduced, bit for bit.
    GoToState([f64; 3]),
    /// Stand on this node of the walk, by its number in this numbering.
    GoTo {
        /// The number of the node.
        node: usize,
        /// [`History::numbering`](super::History::numbering) when it was asked for.
        numbering: u64,
    },
    /// Take away the pinned curve of this number, or all.
    Unpin(Option<usize>),
    /// Open this preset, by name or path.
    Open(String),
    /// Open this preset with other values for some keys.
    OpenWith {
        /// Its name or path.
        name: String,
        /// The values, as on a command line.
        assignments: Vec<Assignment>,
    },
    /// Delete the person's own preset of this name, for good.
    Delete(String),
    /// Save under this name.
    SaveAs {
        /// The name.
        name: String,
        /// Whether a preset of that name is to be replaced.
        replace: bool,
        /// Whether the data of a profile are copied beside it.
        with_data: bool,
    },
    /// Save although the file was changed by somebody else meanwhile.
    SaveAnyway,
    /// Write a text, such as the screen, to a file ending in `.txt`.
    ExportText {
        /// The text.
        text: String,
        /// The path.
        path: String,
        /// Whether a file of that name is to be replaced.
        replace: bool,
    },
    /// Export to a file, its ending chooses CSV or JSON.
    Export {
        /// The document.
        what: super::files::Document,
        /// The path.
        path: String,
        /// Whether a file of that name is to be replaced.
        replace: bool,
    },
}

impl From<Id> for Command {
    fn from(id: Id) -> Self {
        Self::Plain(id)
    }
}

impl Command {
    /// Its row in the table.
    pub fn id(&self) -> Id {
        match self {
            Self::Plain(id) => *id,
            Self::Steps(_) => Id::Step,
            Self::RunOf(_) => Id::Run,
            Self::StepLength(_) => Id::StepLength,
            Self::SelectEvent(_) => Id::SelectEvent,
            Self::MoveTo(_) => Id::MoveTo,
            Self::Assign(_) => Id::Assign,
            Self::Set { .. } | Self::Try { .. } | Self::Browse(_) => Id::Edit,
            Self::Pick { .. } => Id::NextPanel,
            Self::TakeBack => Id::Cancel,
            Self::Zoom { closer: true, .. } => Id::ZoomIn,
            Self::Zoom { closer: false, .. } => Id::ZoomOut,
            Self::Overlay(_) => Id::Overlays,
            Self::GoTo { .. } | Self::GoToState(_) => Id::Branches,
            Self::Unpin(_) => Id::Pins,
            Self::Open(_) | Self::OpenWith { .. } | Self::Delete(_) => Id::Open,
            Self::SaveAs { .. } => Id::SaveAs,
            Self::SaveAnyway => Id::Save,
            Self::Export { .. } | Self::ExportText { .. } => Id::Export,
        }
    }
}

fn always(_: &Model) -> bool {
    true
}

fn walking(model: &Model) -> bool {
    model.history.current().is_some()
}

/// Without a curve, which was given up or failed, it is computed again.
fn can_restart(model: &Model) -> bool {
    walking(model) || !model.is_computing()
}

fn knob(model: &Model) -> bool {
    model.panel == Panel::Problem
}

fn can_undo(model: &Model) -> bool {
    model.history.parent().is_some() || model.is_ahead()
}

fn can_redo(model: &Model) -> bool {
    model.history.redo_target().is_some()
}

fn has_branches(model: &Model) -> bool {
    super::branches::are_several(&model.history)
}

fn has_curve(model: &Model) -> bool {
    model.curve.is_some()
}

fn has_pins(model: &Model) -> bool {
    !model.pins.is_empty()
}

fn is_moved(model: &Model) -> bool {
    model.window(model.view) != Window::WHOLE
}

fn can_jump(model: &Model) -> bool {
    model.can_jump()
}

const fn row(
    id: Id,
    name: &'static str,
    section: &'static str,
    short: &'static str,
    help: &'static str,
    enabled: fn(&Model) -> bool,
) -> Row {
    Row { id, name, section, help, short, argument: None, enabled }
}

const fn taking(argument: &'static str, mut row: Row) -> Row {
    row.argument = Some(argument);
    row
}

const WALK: &str = "Walk along the curve";
const VALUES: &str = "Change the problem";
const VIEW: &str = "Look";
const FILES: &str = "Presets and files";
const PROGRAM: &str = "Program";

/// The table, in the order of the help.
pub static ROWS: &[Row] = &[
    taking(
        "number of steps",
        row(
            Id::Step,
            "step",
            WALK,
            "step",
            "one step along the curve; type a number first for that many",
            walking,
        ),
    ),
    row(
        Id::NextLimit,
        "next-limit",
        WALK,
        "next limit",
        "run to the next limit point of the control",
        walking,
    ),
    row(
        Id::PreviousLimit,
        "previous-limit",
        WALK,
        "previous",
        "turn round and run to the previous limit point",
        walking,
    ),
    row(
        Id::Jump,
        "jump",
        WALK,
        "jump",
        "let the edge run at constant control to the next stable state",
        can_jump,
    ),
    taking("number of states", row(Id::Run, "run", WALK, "run", "run and pause", walking)),
    taking(
        "contact radius",
        row(
            Id::MoveTo,
            "move-to",
            WALK,
            "move to",
            "the walker to the state of a contact radius on the curve",
            has_curve,
        ),
    ),
    row(Id::Reverse, "reverse", WALK, "reverse", "walk the other way", walking),
    row(Id::Halve, "halve-step", WALK, "half step", "halve the step length", always),
    row(Id::Double, "double-step", WALK, "double step", "double the step length", always),
    taking(
        "length",
        row(
            Id::StepLength,
            "step-length",
            WALK,
            "step length",
            "the longest step, as a share of every quantity's range",
            always,
        ),
    ),
    row(Id::Undo, "undo", WALK, "undo", "back to the state before; nothing is erased", can_undo),
    row(
        Id::UndoCommand,
        "undo-command",
        WALK,
        "undo all",
        "back to where the last command began: a run, a count of steps",
        can_undo,
    ),
    row(Id::Redo, "redo", WALK, "redo", "forward again along the last branch walked", can_redo),
    taking(
        "branch",
        row(
            Id::Branches,
            "branches",
            WALK,
            "branches",
            "the branches of the walk: what each ended with, and back to it",
            has_branches,
        ),
    ),
    row(Id::Restart, "restart", WALK, "restart", "back to the start state", can_restart),
    taking(
        "control",
        row(
            Id::Control,
            "control",
            WALK,
            "control",
            "control the displacement, the force, or a spring's far end",
            always,
        ),
    ),
    taking(
        "number",
        row(
            Id::SelectEvent,
            "select-event",
            WALK,
            "event",
            "the walker to the event of this number in the list",
            walking,
        ),
    ),
    row(Id::Less, "less", VALUES, "less", "the selected value, a little less", knob),
    row(Id::More, "more", VALUES, "more", "the selected value, a little more", knob),
    row(Id::MuchLess, "much-less", VALUES, "much less", "the selected value, much less", knob),
    row(Id::MuchMore, "much-more", VALUES, "much more", "the selected value, much more", knob),
    taking(
        "value",
        row(
            Id::Edit,
            "edit",
            VALUES,
            "type value",
            "type the selected value, or choose it; in Events: go to the selected event; at the cross-hair: go there",
            always,
        ),
    ),
    taking(
        "KEY=VALUE ...",
        row(Id::Assign, "set", VALUES, "set", "other values for some keys, as one change", always),
    ),
    row(Id::Up, "up", VIEW, "up", "select the line above; in Charts: move up", always),
    row(Id::Down, "down", VIEW, "down", "select the line below; in Charts: move down", always),
    row(Id::Left, "left", VIEW, "left", "the panel before; in Charts: move left", always),
    row(Id::Right, "right", VIEW, "right", "the next panel; in Charts: move right", always),
    row(Id::NextPanel, "next-panel", VIEW, "panel", "next panel", always),
    row(Id::PreviousPanel, "previous-panel", VIEW, "panel back", "previous panel", always),
    row(Id::NextView, "next-view", VIEW, "view", "the next view of the chart", always),
    row(Id::PreviousView, "previous-view", VIEW, "view back", "the view before", always),
    taking(
        "place",
        row(
            Id::ZoomIn,
            "zoom-in",
            VIEW,
            "closer",
            "the chart closer, about the cross-hair or the walker",
            has_curve,
        ),
    ),
    taking("place", row(Id::ZoomOut, "zoom-out", VIEW, "wider", "further away", has_curve)),
    row(Id::Fit, "fit", VIEW, "fit", "the whole chart again", is_moved),
    row(
        Id::CrossHair,
        "cross-hair",
        VIEW,
        "cross-hair",
        "a cross-hair that reads the chart; arrows move it",
        has_curve,
    ),
    row(Id::Axes, "axes", VIEW, "axes", "axes in P/Pc, delta, s/lambda, or raw values", always),
    row(Id::Events, "events", VIEW, "events", "events on the curve, or walked", always),
    row(
        Id::Device,
        "device-line",
        VIEW,
        "device",
        "show or hide the line of the loading device through the walker",
        always,
    ),
    taking(
        "theory",
        row(
            Id::Overlays,
            "overlays",
            VIEW,
            "theory",
            "theory over the curve: smooth sphere, exact solution, envelope",
            has_curve,
        ),
    ),
    row(Id::Pin, "pin", VIEW, "pin", "keep this curve to compare the next ones with", has_curve),
    taking("number", row(Id::Pins, "pins", VIEW, "pins", "take pinned curves away", has_pins)),
    taking(
        "preset",
        row(Id::Open, "open", FILES, "open", "open a preset; D in the list deletes one of your own", always),
    ),
    row(Id::Save, "save", FILES, "save", "save the preset", always),
    taking(
        "name",
        row(Id::SaveAs, "save-as", FILES, "save as", "save the preset under another name", always),
    ),
    taking(
        "file",
        row(
            Id::Export,
            "export",
            FILES,
            "export",
            "write curve, walk or events as CSV or JSON, the session as a script, the screen as text",
            always,
        ),
    ),
    row(
        Id::Copy,
        "copy",
        FILES,
        "copy",
        "the state, the events, the chart or the screen into the terminal's clipboard",
        always,
    ),
    row(
        Id::CommandLine,
        "command-line",
        PROGRAM,
        "command",
        "type a command by its name; Tab completes, up and down bring lines back",
        always,
    ),
    row(
        Id::Mouse,
        "mouse",
        PROGRAM,
        "mouse",
        "take the mouse (click, wheel), or leave it to the terminal to select text",
        always,
    ),
    row(Id::Help, "help", PROGRAM, "help", "this help; / searches it", always),
    row(Id::Cancel, "cancel", PROGRAM, "back", "take typed text back, close, stop a run or a curve", always),
    row(Id::Quit, "quit", PROGRAM, "quit", "quit; asks only if the preset has unsaved changes", always),
];

/// The row of a command.
pub fn row_of(id: Id) -> &'static Row {
    // Totality is tested, so the fallback is never taken.
    ROWS.iter().find(|row| row.id == id).unwrap_or(&ROWS[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_id_has_one_row_with_a_name_of_its_own() {
        let ids: HashSet<Id> = ROWS.iter().map(|row| row.id).collect();
        let names: HashSet<&str> = ROWS.iter().map(|row| row.name).collect();
        assert_eq!(ids.len(), ROWS.len());
        assert_eq!(names.len(), ROWS.len());
        // The last variant's number counts the variants: a new one without a row fails here.
        assert_eq!(Id::Quit as usize + 1, ROWS.len());
        for row in ROWS {
            assert_eq!(row_of(row.id).name, row.name);
        }
    }
}
