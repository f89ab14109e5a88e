//! Panels, and the line selected in each.

use super::curve::give_up;
use super::values::tell_bare_range;
use crate::explorer::backgrounds::give_up_first;
use crate::explorer::effect::Effect;
use crate::explorer::fit::{FitOutcome, fit};
use crate::explorer::model::{Level, Model};
use crate::explorer::requests::stop;
use crate::explorer::script::key_called;
use crate::explorer::studies::{is_over, range, typed_range};
use crate::explorer::view::{ScreenPanel, View};
use crate::explorer::{look, reach};
use pulloff_engine::preset::{Row, Value, groups};
use pulloff_engine::stability::MapAxis;
use pulloff_engine::sweep::QuantityColumn;
use pulloff_engine::text::{greek, show_name};

/// An arrow key: in Charts it moves what is shown, elsewhere it moves the selection.
pub(in crate::explorer) fn arrow(model: &mut Model, (right, up): (f64, f64), down: bool) {
    if model.panel == ScreenPanel::Charts { look::go(model, right, up) } else { move_selection(model, down) }
}

/// Ends what is under way, the newest first.
pub(in crate::explorer) fn cancel(model: &mut Model) -> Vec<Effect> {
    if model.walking.is_some() {
        stop(model)
    } else if model.is_computing() {
        give_up(model)
    } else if model.results.under_way::<FitOutcome>().is_some() {
        fit(model)
    } else if model.cross.take().is_some() {
        Vec::new()
    } else {
        give_up_first(model)
    }
}

/// Shows a quantity over the range of the selected value, which becomes the one called `over` if that is given, alone
/// or with a range.
pub(super) fn study(model: &mut Model, column: QuantityColumn, over: Option<String>) -> Vec<Effect> {
    if let Some(name) = over {
        match study_over(model, &name) {
            Ok((at, range)) => {
                (model.parameter, model.studied_over) = (at, range);
                tell_bare_range(model, &name);
            }
            Err(why) => return model.refuse(why),
        }
    }
    model.studied = column;
    reach::show(model, View::Study);
    Vec::new()
}

/// The place in Problem of the value called `over`, and the range given with it.
/// Errors: Why there is no study over it, in words.
fn study_over(model: &Model, over: &str) -> Result<(usize, Option<MapAxis>), String> {
    let knobs = model.knobs();
    let named = |key: &str| format!("{key} has no value here: nothing to vary");
    if over.contains('=') {
        let axis = typed_range(&model.preset, over)?;
        let at = knobs.iter().position(|(row, _)| is_over(&axis, row)).ok_or_else(|| named(&axis.key))?;
        return Ok((at, Some(axis)));
    }
    let key = key_called(&model.preset, over)?;
    let at = knobs.iter().position(|(row, _)| row.key == key).ok_or_else(|| named(&key))?;
    range(&model.preset, &knobs[at].0).map(|_| (at, None))
}

pub(in crate::explorer) fn next_panel(model: &mut Model, by: usize) {
    let at = ScreenPanel::ALL.iter().position(|panel| *panel == model.panel).unwrap_or(0);
    model.panel = ScreenPanel::ALL[(at + by) % ScreenPanel::ALL.len()];
}

fn move_selection(model: &mut Model, down: bool) {
    let moved = |at: usize, count: usize| {
        let last = count.saturating_sub(1);
        if down { (at + 1).min(last) } else { at.saturating_sub(1).min(last) }
    };
    match model.panel {
        ScreenPanel::Problem => {
            let knobs = model.knobs();
            let to = moved(model.parameter, knobs.len());
            // At the end of the list an arrow says nothing anew.
            let selected = knobs.into_iter().nth(to).filter(|_| to != model.parameter);
            model.parameter = to;
            if let Some(text) = selected
                .and_then(|(row, value)| group_effect(&row).or_else(|| long_text(&row, value.as_ref())))
            {
                model.tell(Level::Info, text);
            }
        }
        ScreenPanel::Log => {
            model.event = moved(model.event, model.log_lines());
        }
        ScreenPanel::Here | ScreenPanel::Result | ScreenPanel::Charts => {}
    }
}

/// What a group changes, if this is one; kept short, since the list may scroll at the same time.
fn group_effect(row: &Row) -> Option<String> {
    let [changed, held] = groups::effect(&row.key)?;
    Some(greek(&format!("turning it changes {changed}, {held} held")))
}

/// The whole text of a value that is too long for its place beside the label.
fn long_text(row: &Row, value: Option<&Value>) -> Option<String> {
    /// The number of characters that fit on every screen.
    const FITTING: usize = 11;
    match value? {
        Value::Text(text) if text.chars().count() > FITTING => Some(format!("{}: {text}", row.label)),
        Value::Profile(rows) => Some(format!("{}: {}", row.label, show_name(&rows.name))),
        _ => None,
    }
}

/// Selects a panel and a line of it, at most its last.
pub(super) fn pick(model: &mut Model, panel: ScreenPanel, line: Option<usize>) {
    model.panel = panel;
    let lines = match panel {
        ScreenPanel::Problem => model.knobs().len(),
        ScreenPanel::Log => model.log_lines(),
        ScreenPanel::Charts if model.view.is_table() => model.history.path().len(),
        ScreenPanel::Here | ScreenPanel::Result | ScreenPanel::Charts => 0,
    };
    let Some(line) = line.map(|line| line.min(lines.saturating_sub(1))) else { return };
    match panel {
        ScreenPanel::Problem => model.parameter = line,
        ScreenPanel::Log => model.event = line,
        ScreenPanel::Charts if model.view.is_table() => reach::pick_walk_line(model, line),
        ScreenPanel::Here | ScreenPanel::Result | ScreenPanel::Charts => {}
    }
}
