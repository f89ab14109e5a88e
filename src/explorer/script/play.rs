//! A script run on a model, without a terminal: each line is over before the next begins.

use super::line;
use super::permissions::{Permission, allowed};
use super::read::ScriptLine;
use crate::explorer::command::{Command, Id, by_name};
use crate::explorer::driver::Inline;
use crate::explorer::effect::Effect;
use crate::explorer::export::Export;
use crate::explorer::model::{CurveError, Level, Model};
use crate::explorer::studies::StudyData;
use crate::explorer::update::update;
use crate::explorer::view::View;
use crate::mend::WordedFault;
use thiserror::Error;

/// The line that failed, and why.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{number}: {command}: {reason}")]
pub struct Failed {
    /// The line's number, from 1.
    pub number: usize,
    pub command: String,
    pub reason: WordedFault,
}

/// Makes a page of an export of what a session shows, or says why it cannot; leaves any other export as it is.
pub type Painter<'a> = &'a dyn Fn(&Model, Export) -> Result<Export, String>;

/// Runs `effects` and then the lines one after another; `told` receives each line that was done, `draws` what is to be
/// drawn.
///
/// What ends a run (a limit point, the end of the path) is not a failure.
/// Errors: The first line that fails; the lines after it are not run.
pub fn play(
    model: &mut Model,
    driver: &Inline,
    effects: Vec<Effect>,
    lines: &[ScriptLine],
    permission: Permission,
    draws: Painter<'_>,
    told: &mut dyn FnMut(&ScriptLine, &Model),
) -> Result<(), Failed> {
    // A script that opens its own preset does not need the curve of the previous one.
    if !lines.first().is_some_and(|line| opens(&line.command) && !line.may_fail) {
        driver.settle(model, effects);
        if let Some(reason) = refusal(model) {
            return Err(Failed { number: 0, command: "the preset".to_owned(), reason });
        }
    }
    let mut before_study = None;
    for each in lines {
        if !matches!(each.command, Command::Export { .. }) {
            // A study is computed while it is looked at: what this line changes would compute it again.
            model.view = before_study.take().unwrap_or(model.view);
        }
        let before = model.view;
        let result = obey(model, driver, each, permission, draws);
        if each.command.id() == Id::Study {
            before_study = Some(before);
        }
        if let (Err(reason), false) = (result, each.may_fail) {
            let command = line(&each.command).unwrap_or_default();
            return Err(Failed { number: each.number, command, reason });
        }
        told(each, model);
        if model.quit {
            break;
        }
    }
    Ok(())
}

/// Whether a command leaves nothing of the preset before it.
pub fn opens(command: &Command) -> bool {
    matches!(command, Command::Open(_) | Command::OpenWith { .. })
}

fn obey(
    model: &mut Model,
    driver: &Inline,
    line: &ScriptLine,
    permission: Permission,
    draws: Painter<'_>,
) -> Result<(), WordedFault> {
    let mut command = allowed(model, line.command.clone(), permission).map_err(WordedFault::mendable)?;
    if let Command::Export { what, .. } = &mut command {
        *what =
            drawn(model, driver, what.clone(), draws).map_err(|why| WordedFault::mendable(by_name(&why)))?;
    }
    let effects = update(model, command);
    driver.settle(model, effects);
    // There is nobody to answer what a screen would ask now.
    model.question = None;
    refusal(model).map_or(Ok(()), Err)
}

/// Draws what is seen; a view that is not on the screen, as is a study made before, is shown for that moment.
fn drawn(model: &mut Model, driver: &Inline, what: Export, draws: Painter<'_>) -> Result<Export, String> {
    let before = model.view;
    let view = match what {
        Export::Figure(view) => view,
        Export::Study => model.results.found::<StudyData>().map(|_| View::Study),
        _ => None,
    };
    if let Some(view) = view {
        let effects = update(model, Command::Show(view));
        driver.settle(model, effects);
    }
    let page = draws(model, what);
    model.view = before;
    page
}

fn refusal(model: &Model) -> Option<WordedFault> {
    let (level, text) = model.message.as_ref().filter(|(level, _)| level.is_bad())?;
    // Nothing is being computed any more: if there is no curve, it could not be computed.
    let cause = model.curve_error.as_ref().filter(|_| model.curve.is_none());
    let text = by_name(cause.map_or(text, CurveError::text));
    Some(WordedFault { text, can_be_mended: *level == Level::Error })
}
