//! A curve arrived, failed or was given up.

use super::walk::{begin_walk, restart, walk};
use crate::explorer::command::Id;
use crate::explorer::curve::CurveData;
use crate::explorer::effect::Effect;
use crate::explorer::model::{CurveError, Level, Model};
use crate::explorer::node::{Node, NodeKind};
use crate::explorer::status_line::of_before;
use crate::explorer::walk::Action;
use crate::mend::WordedFault;
use pulloff_engine::problem::Begin;
use std::sync::Arc;

/// The curve on the screen stays; the one being computed is no longer wanted.
pub(super) fn give_up(model: &mut Model) -> Vec<Effect> {
    model.queue.clear();
    model.curve_shown = model.curve_wanted;
    let control = model.curve.as_ref().filter(|curve| curve.base.is_of(&model.preset)).map(|curve| {
        // Only the control was changed, which undo does not take back.
        curve.setting.preset.path.control
    });
    let text = match (&model.curve, control) {
        (Some(_), Some(control)) => {
            model.preset.path.control = control;
            "cancelled: the control is as before".to_owned()
        }
        (Some(_), None) => format!("cancelled: {}", of_before()),
        (None, _) => {
            format!(
                "cancelled: there is no curve; {} computes it again, or change a value",
                Id::Restart.named()
            )
        }
    };
    if control.is_none() {
        model.curve_error = Some(CurveError::GivenUp(text.clone()));
    }
    model.tell(Level::Info, text);
    vec![Effect::StopCurve(model.curve_wanted)]
}

/// What follows from a curve, or from the reason why there is none. `None`: the waiting commands may go on.
pub(super) fn curve_came(
    model: &mut Model,
    id: u64,
    result: Result<Arc<CurveData>, WordedFault>,
) -> Option<Vec<Effect>> {
    if id <= model.curve_shown {
        return Some(Vec::new());
    }
    model.curve_shown = id;
    match result {
        Err(reason) => {
            let text = format!("no curve for these values: {reason}");
            model.tell(Level::of(&reason), text.clone());
            model.curve_error = Some(CurveError::Failed(text));
            None
        }
        Ok(curve) => {
            model.curve_error = None;
            let first = model.history.current().is_none();
            let begin = curve.setting.preset.path.begin;
            let walker = model.history.current();
            // A path that begins apart touches first elsewhere under another control.
            let begins_elsewhere = walker.is_some_and(|node| {
                let touches = node.begins && begin == Begin::Apart && node.control != curve.case.control;
                node.setting.preset.path.begin != begin || touches
            });
            model.curve = Some(Arc::clone(&curve));
            model.event = model.event.min(model.log_lines().saturating_sub(1));
            if first {
                return begin_walk(model, &curve);
            }
            if model.is_computing() {
                // It will be solved again on the newer curve.
                return Some(Vec::new());
            }
            let is_tried = std::mem::take(&mut model.is_tried);
            if model.walking.is_some() {
                // It will be solved again once that is over.
                return Some(Vec::new());
            }
            let is_stale =
                model.history.current().is_some_and(|node| matches!(node.kind, NodeKind::Stale(_)));
            if begins_elsewhere && !is_tried {
                // What was walked is not part of this path: its events would count as done, and their losses as lost.
                return Some(restart(model));
            }
            if is_tried && is_stale { None } else { solve_again(model) }
        }
    }
}

/// Whether a state that was reached under another control is a limit point of the present one.
fn becomes_limit(model: &Model, node: &Node) -> bool {
    let control = model.control().filter(|control| *control != node.control);
    control.is_some_and(|control| model.is_limit(node, control))
}

/// Solves the walker's state for the values of the curve, if it does not lie on it, or if another control makes it a limit point.
pub(super) fn solve_again(model: &mut Model) -> Option<Vec<Effect>> {
    let is_open = |node: &&Node| !model.is_on_curve(node) || becomes_limit(model, node);
    model.history.current().filter(is_open).filter(|node| !node.is_apart())?;
    let again = Action::solve(&model.history, model.preset.path.begin)?;
    Some(walk(model, again))
}
