//! The table of commands: name, section of the help, what each does and what it needs.

use super::{Id, Needs, Row};

const fn row(
    id: Id,
    name: &'static str,
    section: &'static str,
    short: &'static str,
    help: &'static str,
    needs: Needs,
) -> Row {
    Row { id, name, section, help, short, argument: None, needs }
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
            Needs::Walker,
        ),
    ),
    row(
        Id::NextLimit,
        "next-limit",
        WALK,
        "next limit",
        "run to the next limit point of the control",
        Needs::Walker,
    ),
    row(
        Id::PreviousLimit,
        "previous-limit",
        WALK,
        "previous",
        "turn round and run to the previous limit point",
        Needs::Walker,
    ),
    row(
        Id::Jump,
        "jump",
        WALK,
        "jump",
        "let the edge run at constant control to the next stable state",
        Needs::Jump,
    ),
    taking("number of states", row(Id::Run, "run", WALK, "run", "run and pause", Needs::Walker)),
    taking(
        "contact radius",
        row(
            Id::MoveTo,
            "move-to",
            WALK,
            "move to",
            "the walker to the state of a contact radius on the curve",
            Needs::Curve,
        ),
    ),
    row(Id::Reverse, "reverse", WALK, "reverse", "walk the other way", Needs::Walker),
    row(Id::Halve, "halve-step", WALK, "half step", "halve the step length", Needs::Nothing),
    row(Id::Double, "double-step", WALK, "double step", "double the step length", Needs::Nothing),
    taking(
        "length",
        row(
            Id::StepLength,
            "step-length",
            WALK,
            "step length",
            "the longest step, as a share of every quantity's range",
            Needs::Nothing,
        ),
    ),
    row(Id::Undo, "undo", WALK, "undo", "back to the state before; nothing is erased", Needs::Undo),
    row(
        Id::UndoCommand,
        "undo-command",
        WALK,
        "undo all",
        "back to where the last command began: a run, a count of steps",
        Needs::Undo,
    ),
    row(Id::Redo, "redo", WALK, "redo", "forward again along the last branch walked", Needs::Redo),
    taking(
        "branch",
        row(
            Id::Branches,
            "branches",
            WALK,
            "branches",
            "the branches of the walk: what each ended with, and back to it",
            Needs::Branches,
        ),
    ),
    row(Id::Restart, "restart", WALK, "restart", "back to the start state", Needs::WalkerOrNoCurve),
    taking(
        "control",
        row(
            Id::Control,
            "control",
            WALK,
            "control",
            "control the displacement, the force, or a spring's far end",
            Needs::Nothing,
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
            Needs::Walker,
        ),
    ),
    row(Id::Less, "less", VALUES, "less", "the selected value, a little less", Needs::Parameter),
    row(Id::More, "more", VALUES, "more", "the selected value, a little more", Needs::Parameter),
    row(Id::MuchLess, "much-less", VALUES, "much less", "the selected value, much less", Needs::Parameter),
    row(Id::MuchMore, "much-more", VALUES, "much more", "the selected value, much more", Needs::Parameter),
    taking(
        "value",
        row(
            Id::Edit,
            "edit",
            VALUES,
            "type value",
            "type the selected value, or choose it; in Events: go to the selected event; at the cross-hair: go there",
            Needs::Nothing,
        ),
    ),
    taking(
        "KEY=VALUE ...",
        row(Id::Assign, "set", VALUES, "set", "other values for some keys, as one change", Needs::Nothing),
    ),
    row(Id::Up, "up", VIEW, "up", "select the line above; in Charts: move up", Needs::Nothing),
    row(Id::Down, "down", VIEW, "down", "select the line below; in Charts: move down", Needs::Nothing),
    row(Id::Left, "left", VIEW, "left", "the panel before; in Charts: move left", Needs::Nothing),
    row(Id::Right, "right", VIEW, "right", "the next panel; in Charts: move right", Needs::Nothing),
    row(Id::NextPanel, "next-panel", VIEW, "panel", "next panel", Needs::Nothing),
    row(Id::PreviousPanel, "previous-panel", VIEW, "panel back", "previous panel", Needs::Nothing),
    row(Id::NextView, "next-view", VIEW, "view", "the next view of the chart", Needs::Nothing),
    row(Id::PreviousView, "previous-view", VIEW, "view back", "the view before", Needs::Nothing),
    taking(
        "place",
        row(
            Id::ZoomIn,
            "zoom-in",
            VIEW,
            "closer",
            "the chart closer, about the cross-hair or the walker",
            Needs::Curve,
        ),
    ),
    taking("place", row(Id::ZoomOut, "zoom-out", VIEW, "wider", "further away", Needs::Curve)),
    row(Id::Fit, "fit", VIEW, "fit", "the whole chart again", Needs::Zoom),
    row(
        Id::CrossHair,
        "cross-hair",
        VIEW,
        "cross-hair",
        "a cross-hair that reads the chart; arrows move it",
        Needs::Curve,
    ),
    row(Id::Axes, "axes", VIEW, "axes", "axes in P/Pc, delta, s/lambda, or raw values", Needs::Nothing),
    row(Id::Events, "events", VIEW, "events", "events on the curve, or walked", Needs::Nothing),
    row(
        Id::Device,
        "device-line",
        VIEW,
        "device",
        "show or hide the line of the loading device through the walker",
        Needs::Nothing,
    ),
    taking(
        "theory",
        row(
            Id::Overlays,
            "overlays",
            VIEW,
            "theory",
            "theory over the curve: smooth sphere, exact solution, envelope",
            Needs::Curve,
        ),
    ),
    row(Id::Pin, "pin", VIEW, "pin", "keep this curve to compare the next ones with", Needs::Curve),
    taking("number", row(Id::Pins, "pins", VIEW, "pins", "take pinned curves away", Needs::Pins)),
    taking(
        "preset",
        row(
            Id::Open,
            "open",
            FILES,
            "open",
            "open a preset; D in the list deletes one of your own",
            Needs::Nothing,
        ),
    ),
    row(Id::Save, "save", FILES, "save", "save the preset", Needs::Nothing),
    taking(
        "name",
        row(Id::SaveAs, "save-as", FILES, "save as", "save the preset under another name", Needs::Nothing),
    ),
    taking(
        "file",
        row(
            Id::Export,
            "export",
            FILES,
            "export",
            "write curve, walk or events as CSV or JSON, the session as a script, the screen as text",
            Needs::Nothing,
        ),
    ),
    row(
        Id::Copy,
        "copy",
        FILES,
        "copy",
        "the state, the events, the chart or the screen into the terminal's clipboard",
        Needs::Nothing,
    ),
    row(
        Id::CommandLine,
        "command-line",
        PROGRAM,
        "command",
        "type a command by its name; Tab completes, up and down bring lines back",
        Needs::Nothing,
    ),
    row(
        Id::Mouse,
        "mouse",
        PROGRAM,
        "mouse",
        "take the mouse (click, wheel), or leave it to the terminal to select text",
        Needs::Nothing,
    ),
    row(Id::Help, "help", PROGRAM, "help", "this help; / searches it", Needs::Nothing),
    row(
        Id::Cancel,
        "cancel",
        PROGRAM,
        "back",
        "take typed text back, close, stop a run or a curve",
        Needs::Nothing,
    ),
    row(
        Id::Quit,
        "quit",
        PROGRAM,
        "quit",
        "quit; asks only if the preset has unsaved changes",
        Needs::Nothing,
    ),
];

/// The row of a command.
pub fn row_of(id: Id) -> &'static Row {
    // Totality is tested, so the fallback is never taken.
    ROWS.iter().find(|row| row.id == id).unwrap_or(&ROWS[0])
}
