//! The commands for a fit: which keys it may change, its start and its outcome.

use super::background::{Background, Tell, Want, Watcher, ask, asked, stop};
use super::command::Id;
use super::effect::Effect;
use super::fitting::named;
use super::model::{FitStart, Level, Model};
use super::requests::change;
use crate::mend::WordedFault;
use pulloff_engine::fit::least_squares::Ending;
use pulloff_engine::fit::{Fit, FitError, Options, Verdict, fit_own};
use pulloff_engine::measured::Abscissa;
use pulloff_engine::preset::{Preset, Value, data};
use pulloff_engine::progress::Stopped;
use pulloff_engine::report::number::short;
use pulloff_engine::text::{counted, greek};
use std::sync::Arc;

/// Marks the selected key as free to be fitted, or unmarks it.
pub(super) fn mark(model: &mut Model) -> Vec<Effect> {
    let Some((row, _)) = model.selected_knob() else { return Vec::new() };
    let mut preset = model.preset.clone();
    let is_it = |name: &&str| named(&preset, name).as_deref() == Some(&*row.key);
    let mut keys: Vec<String> = preset.data.free().filter(|name| !is_it(name)).map(str::to_owned).collect();
    let is_freed = keys.len() == preset.data.free().count();
    if is_freed {
        if let Some(why) = not_fitted(&preset, &row.key) {
            return model.refuse(why);
        }
        keys.push(row.key.to_string());
    }
    match preset.set(data::FREE, Value::Text(keys.join(","))) {
        Ok(()) => {
            let effects = change(model, preset);
            let does = if is_freed { "is free: a fit may change it" } else { "is no longer in data.free" };
            model.tell(Level::Info, format!("{} {does}", row.label));
            effects
        }
        Err(invalid) => model.refuse(invalid.to_string()),
    }
}

/// Why a fit cannot change the value of this name.
pub(super) fn not_fitted(preset: &Preset, name: &str) -> Option<String> {
    match pulloff_engine::fit::options::target(preset, Abscissa::Approach, name) {
        Err(FitError::Key { why, .. }) => Some(format!("{name} {why}")),
        _ => None,
    }
}

/// The outcome of a fit, or why there is none.
#[derive(Debug, Clone)]
pub struct FitOutcome(Result<Arc<Fit>, WordedFault>);

impl Background for FitOutcome {
    type Key = Preset;
    const NAME: &'static str = "fit";
    const CHANGES_VALUES: bool = true;
    const ONLY_NEWEST: bool = true;

    /// Requested by a command; once it is done, it is no longer wanted.
    fn wanted(model: &Model) -> Want<Preset> {
        if model.results.under_way::<Self>().is_some() { Want::Later } else { Want::Not }
    }

    fn is_same(asked: &Preset, wanted: &Preset) -> bool {
        asked == wanted
    }

    fn compute(preset: &Preset, progress: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        let free = preset.data.free().map(str::to_owned).collect();
        let options = Options { free, ..Options::default() };
        let found = fit_own(preset, &options, progress).map(Arc::new).map_err(|error| {
            let can_be_mended = !matches!(error, FitError::NoStart | FitError::Stopped(Stopped));
            let units = if matches!(error, FitError::NoStart) { preset.note_of_units() } else { None };
            let units = units.map_or_else(String::new, |units| format!("; {units}"));
            WordedFault { text: format!("not fitted: {error}{units}"), can_be_mended }
        });
        Some(Self(found))
    }

    fn came(model: &mut Model, found: Arc<Self>) -> Vec<Effect> {
        if repeats(model).is_some_and(std::mem::take) {
            // Undo and redo lead to and from its values meanwhile.
            model.fit = found.0.as_ref().ok().cloned();
            if model.fitted().is_some() {
                model.tell(Level::Info, "the errors and the report of the fit are back");
            }
            return Vec::new();
        }
        if asked::<Self>(model) != Some(&model.preset) {
            return model.refuse("the values changed while the fit ran: its result is discarded");
        }
        match &found.0 {
            Ok(found) => taken(model, found),
            Err(reason) => {
                model.tell(Level::of(reason), reason.text.clone());
                Vec::new()
            }
        }
    }

    fn says(model: &Model) -> Option<String> {
        let percent = model.results.percent::<Self>()?;
        if model.fits_again() {
            return Some(format!("repeating the fit, {percent} %"));
        }
        Some(format!("fitting, {percent} %; {}: best so far", Id::Cancel.named()))
    }
}

/// Whether the last fit is under way again, to be changed.
fn repeats(model: &mut Model) -> Option<&mut bool> {
    model.fitted_from.as_mut().map(|from| &mut from.repeats)
}

/// Requests a fit of the present values; one of them that is under way ends with the best result so far.
pub(super) fn fit(model: &mut Model) -> Vec<Effect> {
    let is_of_these = asked::<FitOutcome>(model) == Some(&model.preset) && !model.fits_again();
    if let Some(stops) = stop::<FitOutcome>(model).filter(|_| is_of_these) {
        return vec![stops];
    }
    if model.preset.data.source.is_some() && model.preset.data.free().next().is_none() {
        let text = format!("no value is free to fit: {} lets the selected value change", Id::Free.named());
        return model.refuse(text);
    }
    let preset = model.preset.clone();
    if let Some(repeats) = repeats(model) {
        *repeats = false;
    }
    vec![ask::<FitOutcome>(model, preset)]
}

/// Requests the fit from `from` again, which led to the values of a session that is resumed: its errors and its report.
pub(super) fn fit_again(model: &mut Model, from: Preset) -> Effect {
    model.fitted_from = Some(FitStart { preset: from.clone(), repeats: true });
    ask::<FitOutcome>(model, from)
}

/// Adopts what a fit found.
fn taken(model: &mut Model, found: &Arc<Fit>) -> Vec<Effect> {
    if let Some(direction) = &found.direction {
        let stays = model.fitted().is_some();
        let stays =
            if stays { "; the values are still those of the last fit, and so is its report" } else { "" };
        return model.refuse(format!("not determined, so not taken: {direction}{stays}"));
    }
    model.tell(if found.verdict == Verdict::Describes { Level::Info } else { Level::Error }, told(found));
    model.fit = Some(Arc::clone(found));
    model.fitted_from = Some(FitStart { preset: model.preset.clone(), repeats: false });
    change(model, found.preset.clone())
}

/// What a fit found, in one line: the verdict comes first, since narrow screens cut off the end.
fn told(fit: &Fit) -> String {
    let ended = match (fit.ending, fit.verdict) {
        (Ending::Rounds, _) => "not converged, the best so far".to_owned(),
        (Ending::Cancelled, _) => "stopped, the best so far".to_owned(),
        (Ending::Converged, Verdict::Describes) => "fitted".to_owned(),
        (Ending::Converged, verdict) => format!("fitted, but {}", verdict.sentence_for(&fit.reasons)),
    };
    let holds = (fit.verdict == Verdict::Describes).then(|| fit.verdict.sentence());
    let reasons = fit.reasons.iter().map(|reason| &*reason.sentence);
    let reasons = holds.into_iter().chain(reasons).chain(fit.warnings.iter().map(String::as_str));
    let outliers = fit.chi_squared_without_outliers.map_or_else(String::new, |chi| {
        format!(", {} without {}", short(chi, 3), counted(fit.outliers, "outlier"))
    });
    let begins =
        format!("{ended}: χ² {}{outliers} ({}: the report)", short(fit.chi_squared, 3), Id::About.named());
    let together = fit.known_together();
    let parts: Vec<&str> =
        std::iter::once(&*begins).chain(reasons).chain(together.iter().map(String::as_str)).collect();
    greek(&parts.join("; "))
}

/// How well a fitted value is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FittedError {
    /// Its standard error.
    Holds(f64),
    /// No error holds: the model does not describe the points, or they do not determine the value.
    Unknown,
}

impl Model {
    /// The last fit that was adopted, if the present values are still its values.
    pub fn fitted(&self) -> Option<&Fit> {
        self.fit.as_deref().filter(|fit| fit.holds_for(&self.preset))
    }

    /// Where the fit began whose values these are.
    pub fn fit_began(&self) -> Option<&Preset> {
        let is_known = self.fitted().is_some() || self.fits_again();
        self.fitted_from.as_ref().filter(|_| is_known).map(|from| &from.preset)
    }

    /// Whether the last fit is under way again.
    pub fn fits_again(&self) -> bool {
        self.fitted_from.as_ref().is_some_and(|from| from.repeats)
    }

    /// What it found, in one line.
    pub(super) fn fit_said(&self) -> Option<String> {
        self.fitted().map(told)
    }

    /// How well the value of `key` is known, as long as everything is as the fit found it: for another file, another R
    /// or another column nothing is known.
    pub fn fitted_error(&self, key: &str) -> Option<FittedError> {
        let fit = self.fitted()?;
        let fitted = fit.parameters.iter().find(|fitted| fitted.key == key)?;
        let holds = fit.verdict == Verdict::Describes && fitted.has_error();
        Some(fitted.standard_error.filter(|_| holds).map_or(FittedError::Unknown, FittedError::Holds))
    }
}
