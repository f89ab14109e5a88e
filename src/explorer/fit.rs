//! The commands about a fit: which keys it may change, its beginning and what comes of it.

use super::command::Id;
use super::fitting::{FitWish, Fitting, named};
use super::model::{Level, Model};
use super::requests::change;
use super::{Effect, View};
use crate::mend::Reason;
use pulloff_engine::fit::least_squares::Ending;
use pulloff_engine::fit::{Fit, FitError, Verdict};
use pulloff_engine::measured::Abscissa;
use pulloff_engine::preset::{Value, data};
use pulloff_engine::report::number::short;
use pulloff_engine::text::greek;
use std::sync::Arc;

/// Marks the selected key as free to be fitted, or no longer.
pub(super) fn mark(model: &mut Model) -> Vec<Effect> {
    let Some((row, _)) = model.selected_knob() else { return Vec::new() };
    let mut preset = model.preset.clone();
    let is_it = |name: &&str| named(&preset, name).as_deref() == Some(&*row.key);
    let mut keys: Vec<String> = preset.data.free().filter(|name| !is_it(name)).map(str::to_owned).collect();
    if keys.len() == preset.data.free().count() {
        let known = pulloff_engine::fit::options::target(&preset, Abscissa::Approach, &row.key);
        if let Err(FitError::Key { why, .. }) = known {
            model.tell(Level::Error, format!("{} {why}", row.key));
            return Vec::new();
        }
        keys.push(row.key.to_string());
    }
    match preset.set(data::FREE, Value::Text(keys.join(","))) {
        Ok(()) => change(model, preset),
        Err(invalid) => {
            model.tell(Level::Error, invalid.to_string());
            Vec::new()
        }
    }
}

/// Asks for a fit of the values as they are.
pub(super) fn fit(model: &mut Model) -> Vec<Effect> {
    if let Some(fitting) = &model.fitting {
        return vec![Effect::StopFit(fitting.id)];
    }
    if model.preset.data.source.is_some() && model.preset.data.free().next().is_none() {
        let text =
            format!("nothing is free to be fitted: {} lets the selected value change", Id::Free.named());
        model.tell(Level::Error, text);
        return Vec::new();
    }
    let wish = FitWish { id: model.number(), preset: model.preset.clone() };
    model.fitting = Some(Fitting { id: wish.id, preset: wish.preset.clone(), percent: 0 });
    vec![Effect::Fit(Box::new(wish))]
}

/// Takes what came of a fit.
pub(super) fn fit_came(model: &mut Model, id: u64, result: Result<Arc<Fit>, Reason>) -> Vec<Effect> {
    let Some(fitting) = model.fitting.take_if(|fitting| fitting.id == id) else { return Vec::new() };
    if fitting.preset != model.preset {
        model.tell(Level::Error, "the values were changed while the fit ran: what it found is not taken");
        return Vec::new();
    }
    let found = match result {
        Ok(found) => found,
        Err(reason) => {
            model.tell(Level::of(&reason), reason.text);
            return Vec::new();
        }
    };
    if let Some(direction) = &found.direction {
        model.tell(Level::Error, format!("not determined, and not taken: {direction}"));
        return Vec::new();
    }
    let preset = found.preset.clone();
    model.tell(if found.verdict == Verdict::Describes { Level::Info } else { Level::Error }, told(&found));
    model.fit = Some(found);
    change(model, preset)
}

/// What a fit found, in a line: the verdict first, since narrow screens cut the end.
fn told(fit: &Fit) -> String {
    let ended = match (fit.ending, fit.verdict) {
        (Ending::Rounds, _) => "not converged, the best so far",
        (Ending::Cancelled, _) => "stopped, the best so far",
        (Ending::Converged, Verdict::Describes) => "fitted",
        (Ending::Converged, _) => "fitted, but the model does NOT describe the points",
    };
    let reasons = fit.reasons.iter().map(|reason| &reason.sentence).chain(&fit.warnings);
    let begins = format!("{ended}: χ² {}", short(fit.chi_squared, 3));
    let parts: Vec<&str> = std::iter::once(&*begins).chain(reasons.map(String::as_str)).collect();
    greek(&parts.join("; "))
}

impl Model {
    /// The standard error of the value of `key`, for as long as all is as the fit found it: of another file, another R or another
    /// column nothing is known. There is none where the model does not describe the points.
    pub fn standard_error(&self, key: &str) -> Option<f64> {
        let fit = self.fit.as_deref().filter(|fit| fit.verdict == Verdict::Describes)?;
        if !fit.holds_for(&self.preset) {
            return None;
        }
        fit.parameters.iter().find(|fitted| fitted.key == key)?.standard_error
    }
}

/// Asks for the distances of the points while they are looked at.
pub(super) fn want_distances(model: &mut Model) -> Option<Effect> {
    let is_shown = model.shown_views().contains(&View::Residuals) && model.preset.data.source.is_some();
    let is_there = model.distances.as_ref().is_some_and(|found| found.preset == model.preset);
    let is_asked = model.distances_wanted.as_ref().is_some_and(|wanted| wanted.preset == model.preset);
    if !is_shown || is_there || is_asked {
        return None;
    }
    let wish = FitWish { id: model.number(), preset: model.preset.clone() };
    model.distances_wanted = Some(Box::new(wish.clone()));
    Some(Effect::Distances(Box::new(wish)))
}
