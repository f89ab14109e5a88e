//! What a command requires before it can be run: `Err` says why it cannot be run now.

use super::branches as walk_branches;
use super::command::Id;
use super::model::Model;
use super::node::Node;
use super::status_line::back_or_anew;
use super::view::{ScreenPanel, Window};
use pulloff_engine::problem::Begin;

/// Why a command cannot be run, in words.
pub type Available = Result<(), String>;

fn when(is_there: bool, why: impl FnOnce() -> String) -> Available {
    if is_there { Ok(()) } else { Err(why()) }
}

fn no_curve(model: &Model) -> String {
    if model.is_computing() {
        return "the curve is being computed".to_owned();
    }
    format!("there is no curve: change a value, or {} computes it again", Id::Restart.named())
}

/// Requires nothing.
#[expect(clippy::unnecessary_wraps, reason = "every requirement has the same signature")]
pub(super) fn always(_: &Model) -> Available {
    Ok(())
}

/// Requires a state of the walk.
pub(super) fn walker(model: &Model) -> Available {
    when(model.history.current().is_some(), || no_curve(model))
}

/// Requires a state of the walk in which the bodies are not apart.
pub(super) fn goes_on(model: &Model) -> Available {
    walker(model)?;
    let is_apart = model.history.current().is_some_and(Node::is_apart);
    when(!is_apart, || format!("the bodies are apart: {}", back_or_anew()))
}

/// Requires a state of a walk that may turn round; along a path, the walk follows the device.
pub(super) fn turns(model: &Model) -> Available {
    goes_on(model)?;
    when(model.curve.as_ref().is_none_or(|curve| curve.along.is_none()), || {
        let undo = Id::Undo.named();
        match model.preset.path.begin {
            Begin::Apart => {
                format!("the walk follows the path, which turns by itself; {undo} takes steps back")
            }
            Begin::Disc => {
                format!(
                    "the walk follows the unloading: begin = apart walks the whole loop; {undo} takes steps back"
                )
            }
        }
    })
}

/// Requires a state of the walk, or that no curve is being computed: one given up or failed is computed again.
pub(super) fn walker_or_no_curve(model: &Model) -> Available {
    if model.is_computing() { walker(model) } else { Ok(()) }
}

/// Requires a state in which an edge can run.
pub(super) fn jump(model: &Model) -> Available {
    when(model.can_jump(), || {
        goes_on(model).err().unwrap_or_else(|| {
            format!("the state is stable: the edge stays; {} runs to the next event", Id::NextEvent.named())
        })
    })
}

/// Requires a command to undo.
pub(super) fn undo(model: &Model) -> Available {
    when(model.can_travel(model.undo.past()), || "this is the start: there is nothing to undo".to_owned())
}

/// Requires a command to redo.
pub(super) fn redo(model: &Model) -> Available {
    when(model.can_travel(model.undo.future()), || "there is nothing to redo".to_owned())
}

/// Requires a second branch of the walk.
pub(super) fn branches(model: &Model) -> Available {
    when(walk_branches::are_several(&model.history), || {
        format!("the walk has one branch: {} goes back, and a new step starts a second", Id::Undo.named())
    })
}

/// Requires a curve.
pub(super) fn curve(model: &Model) -> Available {
    when(model.curve.is_some(), || no_curve(model))
}

/// Requires a pinned curve.
pub(super) fn pins(model: &Model) -> Available {
    let why = || format!("no curve is pinned: {} pins the one on the screen", Id::Pin.named());
    when(!model.pins.is_empty(), why)
}

/// Requires a selected value.
pub(super) fn parameter(model: &Model) -> Available {
    let why = || format!("select a value first: {} goes to Problem", Id::NextPanel.named());
    when(model.panel == ScreenPanel::Problem, why)
}

/// Requires a view that shows only a part of its chart.
pub(super) fn zoomed(model: &Model) -> Available {
    when(model.window(model.view) != Window::WHOLE, || "the whole chart is shown".to_owned())
}
