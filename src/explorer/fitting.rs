//! The measured curve and the model: a fit of the keys that may change, and how far each point is from the curve.
//!
//! Both take longer than a frame and are done by a worker. A fit ends with one change of the values, which is taken back as
//! one command; what it says of them stands beside them for as long as they are what it found.

use super::command::Id;
use super::model::{Level, Model};
use super::requests::change;
use super::{Effect, View};
use crate::mend::Reason;
use pulloff_engine::fit::least_squares::Ending;
use pulloff_engine::fit::run::{Residual, residuals_own};
use pulloff_engine::fit::{Fit, FitError, Options, fit_own};
use pulloff_engine::measured::Abscissa;
use pulloff_engine::preset::{Preset, Value, data};
use pulloff_engine::report::number::short;
use pulloff_engine::text::greek;
use std::sync::Arc;

/// A fit, or residuals, that are wanted.
#[derive(Debug, Clone)]
pub struct FitWish {
    pub id: u64,
    pub preset: Preset,
}

/// A fit that is running.
#[derive(Debug, Clone)]
pub struct Fitting {
    pub id: u64,
    /// The values that it began with: a fit to others is not taken.
    pub preset: Preset,
    /// The share that is done, in per cent.
    pub percent: u8,
}

/// The distances of the points from the curve of a preset, in σ.
#[derive(Debug, Clone)]
pub struct Distances {
    pub id: u64,
    pub preset: Preset,
    pub found: Result<(Abscissa, Vec<Residual>), String>,
}

impl FitWish {
    /// Fits the free keys; `go_on` is told the share that is done.
    pub fn fit(&self, go_on: &mut dyn FnMut(f64) -> bool) -> Result<Arc<Fit>, Reason> {
        let free = self.preset.data.free().map(str::to_owned).collect();
        let options = Options { free, ..Options::default() };
        fit_own(&self.preset, &options, go_on).map(Arc::new).map_err(|error| {
            let can_be_mended = !matches!(error, FitError::NoStart | FitError::Cancelled);
            Reason { text: format!("not fitted: {error}"), can_be_mended }
        })
    }

    /// Finds the distances.
    pub fn distances(&self) -> Distances {
        let found = residuals_own(&self.preset).map_err(|error| error.to_string());
        Distances { id: self.id, preset: self.preset.clone(), found }
    }
}

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

/// The dotted key that a name in `data.free` means.
fn named(preset: &Preset, name: &str) -> Option<String> {
    use pulloff_engine::fit::problem::Target;
    Some(match pulloff_engine::fit::options::target(preset, Abscissa::Approach, name).ok()? {
        Target::Key(key) => key,
        Target::Offset => data::OFFSET.to_owned(),
        Target::Baseline => data::BASELINE.to_owned(),
        Target::Tilt => data::TILT.to_owned(),
        Target::Adhesion(_) => return None,
    })
}

/// Whether a fit may change this key.
#[must_use]
pub fn is_free(preset: &Preset, key: &str) -> bool {
    preset.data.free().any(|name| name == key || named(preset, name).as_deref() == Some(key))
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
    model.tell(Level::Info, told(&found));
    model.fit = Some(found);
    change(model, preset)
}

/// What a fit found, in a line: how well first, since narrow screens cut the end.
fn told(fit: &Fit) -> String {
    let ended = match fit.ending {
        Ending::Converged => "fitted",
        Ending::Rounds => "not converged, the best so far",
        Ending::Cancelled => "stopped, the best so far",
    };
    let warnings = fit.warnings.iter().map(|warning| format!("; {warning}"));
    greek(&format!("{ended}: χ² {}{}", short(fit.chi_squared, 3), warnings.collect::<String>()))
}

impl Model {
    /// The standard error of the value of `key`, for as long as it is the one that a fit found.
    pub fn standard_error(&self, key: &str) -> Option<f64> {
        let fit = self.fit.as_deref()?;
        let fitted = fit.parameters.iter().find(|fitted| fitted.key == key)?;
        let is_same = self.preset.get(key)?.as_number() == fit.preset.get(key)?.as_number();
        fitted.standard_error.filter(|_| is_same)
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
