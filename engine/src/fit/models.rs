//! Several models fitted to the same points, and which of them the points tell apart.
//!
//! ```text
//! A = Σ min(r²/s², 16)/k + 2p
//! ```
//!
//! with s the noise of neighbouring points in σ, k the rows of the noise that count as one and p the free values: H. Akaike, IEEE Trans.
//! Autom. Control 19, 716 (1974). A model whose AIC is larger by more than 10 has no support beside the other: K. P. Burnham and
//! D. R. Anderson, *Model Selection and Multimodel Inference* (2002), section 2.6.

use super::directed::fit_own;
use super::options::{FitError, Options};
use super::outcome::Fit;
use super::verdict::Verdict;
use crate::elementary::cbrt;
use crate::measured::Origin;
use crate::preset::schema::RANGE_KEYS;
use crate::preset::{Preset, Value, data, edge};
use crate::problem::{Adhesion, StatedCohesion};
use crate::progress::{Progress, ProgressPart};
use crate::units::UnitSystem;
use crate::units::number::short;
use serde::Serialize;
use std::f64::consts::PI;

/// The free keys of a law of the edge's speed.
const LAW_KEYS: [&str; 2] = [edge::REFERENCE_SPEED, edge::EXPONENT];
/// A difference of AIC that tells two models apart.
const APART: f64 = 10.0;
/// Residuals count as at most this many s.
const MOST: f64 = 4.0;

/// How the adhesion acts, or the edge moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Model"))]
#[serde(rename_all = "kebab-case")]
pub enum AdhesionModel {
    /// Adhesion at the edge of contact alone.
    ShortRange,
    /// A constant tension within a range.
    Dugdale,
    /// Adhesion at the edge alone that grows with the speed of the edge.
    Rate,
}

impl AdhesionModel {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::ShortRange, Self::Dugdale, Self::Rate];

    /// Its word.
    pub fn name(self) -> &'static str {
        match self {
            Self::ShortRange => Adhesion::NAMES[0],
            Self::Dugdale => Adhesion::NAMES[1],
            Self::Rate => "rate",
        }
    }

    /// The model of a word.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|model| model.name() == word)
    }

    /// `preset` with this model, and what is free in it in addition to `free`: the tension of adhesion with a range,
    /// unless its range is free, or the law of an edge's speed.
    pub fn laid(self, preset: &Preset, free: &[String]) -> (Preset, Vec<String>) {
        let mut laid = preset.clone();
        let row = |key: &str| preset.row(key).map_or_else(String::new, |row| row.label.to_string());
        let is_of = |keys: &[&str], name: &String| keys.iter().any(|key| name == key || *name == row(key));
        let others: &[&[&str]] = match self {
            Self::ShortRange => &[&RANGE_KEYS, &LAW_KEYS],
            Self::Dugdale => &[&LAW_KEYS],
            Self::Rate => &[&RANGE_KEYS],
        };
        let is_other = |name: &&String| others.iter().any(|keys| is_of(keys, name));
        let mut free: Vec<String> = free.iter().filter(|name| !is_other(name)).cloned().collect();
        match (self, preset.material.adhesion) {
            (Self::ShortRange | Self::Rate, _) => laid.material.adhesion = Adhesion::ShortRange,
            (Self::Dugdale, Adhesion::Dugdale(StatedCohesion::Strength(_) | StatedCohesion::Range(_))) => {}
            (Self::Dugdale, _) => {
                laid.material.adhesion = Adhesion::Dugdale(StatedCohesion::Strength(guess(preset)));
            }
        }
        if self != Self::Rate {
            laid.edge.rate = None;
        }
        match self {
            Self::ShortRange => {}
            Self::Dugdale if free.iter().any(|name| is_of(&RANGE_KEYS, name)) => {}
            Self::Dugdale => {
                let key = usize::from(matches!(
                    laid.material.adhesion,
                    Adhesion::Dugdale(StatedCohesion::Range(_))
                ));
                free.push(RANGE_KEYS[key].to_owned());
            }
            Self::Rate => {
                // A scan around the rate of the device finds the law: these values only say that there is one.
                let speed = if matches!(preset.units, UnitSystem::Si(_)) { 1e-6 } else { 1.0 };
                laid.edge.reference_speed = laid.edge.reference_speed.or(Some(speed));
                laid.edge.exponent = laid.edge.exponent.or(Some(0.5));
                if !free.iter().any(|name| is_of(&LAW_KEYS, name)) {
                    free.extend(LAW_KEYS.map(str::to_owned));
                }
            }
        }
        (laid, free)
    }
}

/// A tension to begin with: `λ_M` = 1.
fn guess(preset: &Preset) -> f64 {
    let (e, gamma) = (preset.material.effective_modulus, preset.material.work_of_adhesion);
    let length = preset.gap.radius_of_curvature().or(preset.gap.length()).unwrap_or(1.0);
    cbrt(2.0 * PI * gamma * e * e / (9.0 * length))
}

/// One model fitted.
#[derive(Debug, Clone)]
pub struct FittedModel {
    /// The model; `None` for one that only the preset has.
    pub model: Option<AdhesionModel>,
    /// What is free in it.
    pub free: Vec<String>,
    /// Its fit, or why there is none.
    pub fit: Result<Fit, FitError>,
}

/// Two models compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Pair {
    /// The better one and the other.
    pub models: [AdhesionModel; 2],
    /// By how much the AIC of the other is larger.
    pub difference: f64,
    /// Whether the difference tells them apart.
    pub told_apart: bool,
    /// The same in words.
    pub sentence: String,
}

/// Several models fitted to the same points.
#[derive(Debug, Clone)]
pub struct Models {
    /// The fits, in the order in which they were asked for.
    pub fits: Vec<FittedModel>,
    /// The number of the best; `None` where no fit came to an end.
    pub best: Option<usize>,
    /// Each of the others compared with the best.
    pub pairs: Vec<Pair>,
}

impl Models {
    /// The fit of the best, and what was free in it.
    pub fn best(&self) -> Option<(&Fit, &[String])> {
        let FittedModel { fit, free, .. } = self.fits.get(self.best?)?;
        Some((fit.as_ref().ok()?, free))
    }
}

/// Fits `models`, each named once, to the preset's own measured curve; where none is named, the model of `preset`.
///
/// # Errors
/// [`FitError`] of the only model; where there are several, each has its own.
pub fn fit_models(
    preset: &Preset,
    models: &[AdhesionModel],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Models, FitError> {
    if options.free.is_empty() {
        return Err(FitError::NothingFree);
    }
    let laid: Vec<_> = match models {
        [] => {
            vec![(AdhesionModel::of(preset.material.adhesion.name()), preset.clone(), options.free.clone())]
        }
        models => {
            let of = |model: &AdhesionModel| {
                let (laid, free) = model.laid(preset, &options.free);
                (Some(*model), laid, free)
            };
            models.iter().map(of).collect()
        }
    };
    // A pull is fitted to the retraction: for a comparison all models have the same rows.
    let of_retraction = models.len() > 1 && models.contains(&AdhesionModel::Rate);
    let count = laid.len() as f64;
    let mut fits: Vec<FittedModel> = Vec::new();
    for (i, (model, mut laid, free)) in laid.into_iter().enumerate() {
        if of_retraction && laid.data.source.is_some() && laid.data.segment.is_none() {
            let retraction = Value::Text(data::SEGMENTS[1].to_owned());
            laid.set(data::SEGMENT, retraction).map_err(|invalid| FitError::Data(invalid.to_string()))?;
        }
        // All models have the same rows in contact.
        let mut done = fits.iter().filter_map(|fitted| fitted.fit.as_ref().ok());
        if done.any(|fit| fit.preset.data.free_part == "none") {
            laid.set(data::FREE_PART, "none".into())
                .map_err(|invalid| FitError::Data(invalid.to_string()))?;
        }
        let mut options = Options { free: free.clone(), ..options.clone() };
        // The others are judged by the noise of the first.
        if let Some(first) = fits.iter().find_map(|fitted| fitted.fit.as_ref().ok())
            && first.noise.from[1] == Origin::Neighbours
        {
            let of = |axis: usize| Some(first.noise.sigma[axis]).filter(|sigma| *sigma > 0.0);
            options.asked.sigma = [of(0), of(1), of(2)];
            options.asked.share = Some(first.noise.share);
        }
        let part = ProgressPart::new(progress, [i as f64 / count, (i + 1) as f64 / count]);
        fits.push(FittedModel { model, free, fit: fit_own(&laid, &options, &part) });
    }
    if let [FittedModel { fit: Err(error), .. }] = &fits[..] {
        return Err(error.clone());
    }
    let scores = scores(&fits);
    let best = (0..fits.len())
        .filter(|i| scores[*i].is_finite())
        .min_by(|a, b| rank(&fits[*a], scores[*a]).total_cmp(&rank(&fits[*b], scores[*b])));
    let pairs = best.map_or_else(Vec::new, |best| {
        let others = (0..fits.len()).filter(|i| *i != best && scores[*i].is_finite());
        others.filter_map(|i| pair(&fits, &scores, [best, i])).collect()
    });
    Ok(Models { fits, best, pairs })
}

/// The AIC of each; infinite where there is none.
fn scores(fits: &[FittedModel]) -> Vec<f64> {
    let known = fits.iter().filter_map(|fitted| fitted.fit.as_ref().ok());
    let noise = known.clone().filter_map(|fit| fit.scatter.contact).fold(f64::INFINITY, f64::min);
    let together = known.map(|fit| fit.scatter.correlation.rows()).fold(f64::INFINITY, f64::min).max(1.0);
    let s = if noise.is_finite() { noise.max(1.0) } else { 1.0 };
    let of = |fit: &Fit| {
        let cost: f64 = fit.residuals.iter().map(|row| (row.residual / s).clamp(-MOST, MOST).powi(2)).sum();
        cost / together + 2.0 * fit.parameters.len() as f64
    };
    fits.iter().map(|fitted| fitted.fit.as_ref().map_or(f64::INFINITY, of)).collect()
}

/// A, raised by the difference that tells two models apart where the model is not determined or does not describe the
/// points: it must not win over one that is as good.
fn rank(fitted: &FittedModel, score: f64) -> f64 {
    let is_told = fitted.fit.as_ref().is_ok_and(|fit| fit.direction.is_none());
    let is_refuted = verdict(fitted) == Some(Verdict::DoesNotDescribe);
    if is_told && !is_refuted { score } else { score + APART }
}

fn verdict(fitted: &FittedModel) -> Option<Verdict> {
    fitted.fit.as_ref().ok().map(|fit| fit.verdict)
}

fn pair(fits: &[FittedModel], scores: &[f64], [best, other]: [usize; 2]) -> Option<Pair> {
    let difference = scores[other] - scores[best];
    let [Some(one), Some(two)] = [best, other].map(|i| fits[i].model) else { return None };
    let verdicts = [best, other].map(|i| verdict(&fits[i]));
    let sentence = sentence([one, two].map(AdhesionModel::name), verdicts, difference);
    Some(Pair { models: [one, two], difference, told_apart: difference > APART, sentence })
}

/// What the AIC of the second, larger by `difference`, and both verdicts say of two models.
fn sentence([one, two]: [&str; 2], verdicts: [Option<Verdict>; 2], difference: f64) -> String {
    let by = if difference < 0.0 { "smaller" } else { "larger" };
    let size = short(difference.abs(), 3);
    let is_described = verdicts[0] == Some(Verdict::Describes);
    let is_refuted = verdicts[1] == Some(Verdict::DoesNotDescribe);
    match (difference > APART, is_described) {
        (true, true) => format!("the points favour {one} over {two}, whose AIC is {by} by {size}"),
        (true, false) => format!(
            "{one} is nearer to the points than {two}, whose AIC is {by} by {size}, but it does not describe them"
        ),
        (false, true) if is_refuted => format!(
            "{one} describes the points and {two} does not; the AIC of {two} is {by} by {size}, and {APART} would be \
             needed to tell them apart by it"
        ),
        (false, _) => format!(
            "the points do not distinguish {one} from {two}, whose AIC is {by} by {size}; {APART} would be needed"
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::sentence;
    use crate::fit::verdict::Verdict::{Describes, DoesNotDescribe, NotDetermined};

    #[test]
    fn a_comparison_says_which_model_is_refuted() {
        let of = |verdict, difference| sentence(["a", "b"], [Some(Describes), Some(verdict)], difference);
        assert!(
            of(DoesNotDescribe, -3.0)
                .starts_with("a describes the points and b does not; the AIC of b is smaller by 3")
        );
        assert!(of(NotDetermined, 3.0).starts_with("the points do not distinguish a from b"));
        assert!(of(DoesNotDescribe, 11.0).starts_with("the points favour a over b"));
    }
}
