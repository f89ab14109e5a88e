//! The rows: what each command is called, where it stands in the help, what it does and when.

use super::{Id, Row};
use crate::explorer::model::{Model, Panel};
use crate::explorer::view::Window;

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
    crate::explorer::branches::are_several(&model.history)
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
