//! Which commands can be done now, and why the others cannot.

use super::branches;
use super::command::{Id, Needs, row_of};
use super::model::Model;
use super::node::Node;
use super::status_line::back_or_anew;
use super::view::{Panel, Window};

/// Whether a command can be done now.
pub fn is_available(model: &Model, id: Id) -> bool {
    let is_walking = model.history.current().is_some();
    match row_of(id).needs {
        Needs::Nothing => true,
        Needs::Walker => is_walking,
        // Without a curve, which was given up or failed, it is computed again.
        Needs::WalkerOrNoCurve => is_walking || !model.is_computing(),
        Needs::Jump => model.can_jump(),
        Needs::Undo => model.can_travel(model.undo.past()),
        Needs::Redo => model.can_travel(model.undo.future()),
        Needs::Branches => branches::are_several(&model.history),
        Needs::Curve => model.curve.is_some(),
        Needs::Pins => !model.pins.is_empty(),
        Needs::Parameter => model.panel == Panel::Problem,
        Needs::Zoom => model.window(model.view) != Window::WHOLE,
    }
}

pub(super) fn why_unavailable(model: &Model, id: Id) -> String {
    let apart = model.history.current().is_some_and(Node::is_apart);
    match id {
        Id::Undo => "this is the start: there is nothing to undo".to_owned(),
        Id::Redo => "there is nothing to redo".to_owned(),
        Id::Branches => {
            format!(
                "the walk has one branch: {} goes back, and another step begins a second",
                Id::Undo.named()
            )
        }
        Id::Jump if apart => format!("the bodies are apart: {}", back_or_anew()),
        Id::Jump => {
            format!("the state is stable: the edge stays; {} runs to the next event", Id::NextEvent.named())
        }
        Id::FineLess | Id::FineMore | Id::Less | Id::More | Id::MuchLess | Id::MuchMore | Id::Free => {
            format!("select a value first: {} goes to Problem", Id::NextPanel.named())
        }
        Id::Whole => "the whole chart is shown".to_owned(),
        Id::Pins => format!("no curve is pinned: {} pins the one on the screen", Id::Pin.named()),
        _ if model.is_computing() => "the curve is being computed".to_owned(),
        _ => format!("there is no curve: change a value, or {} computes it again", Id::Restart.named()),
    }
}
