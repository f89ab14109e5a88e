//! What a fit comes to: its values, errors, doubts, and the preset that it leaves.

use super::fitted::Fitted;
use super::least_squares::Ending;
use super::options::letter;
use super::problem::{ADHESION, MODULUS};
use super::residuals::Residual;
use super::rows::Rows;
use super::scatter::Scatter;
use super::start::Tried;
use super::uncertain::Given;
use super::verdict::{Reason, Verdict};
use crate::gap::Gap;
use crate::measured::points::Turned;
use crate::measured::{Abscissa, Instrument, Noise};
use crate::preset::{Preset, edge};
use crate::problem::Control;
use crate::units::Quantity;
use crate::units::number::{said, significant};

/// A fit.
#[derive(Debug, Clone)]
pub struct Fit {
    /// What it comes to.
    pub verdict: Verdict,
    /// What speaks against it; empty where the model describes the points.
    pub reasons: Vec<Reason>,
    /// What x of the points is.
    pub abscissa: Abscissa,
    /// The values.
    pub parameters: Vec<Fitted>,
    /// What was known of them before, with an error.
    pub priors: Vec<Given>,
    /// The correlations of the values; `None` where they are not determined.
    pub correlations: Option<Vec<Vec<f64>>>,
    /// Σr²/(n − p), r in σ.
    pub chi_squared: f64,
    /// The same without the rows that are outliers; `None` where there are none.
    pub chi_squared_without_outliers: Option<f64>,
    /// Σr²/n of the points in contact, and of those apart.
    pub chi_squared_of: [Option<f64>; 2],
    /// The degrees of freedom of the error that is known least well.
    pub degrees: f64,
    /// The noise of the rows as neighbours show it.
    pub scatter: Scatter,
    /// The rows of the file by branch and part.
    pub rows: Rows,
    /// How many rows are outliers.
    pub outliers: usize,
    /// The condition of the whitened Jacobian.
    pub condition: f64,
    /// What the points cannot tell, in words; `None` where everything is determined.
    pub direction: Option<String>,
    /// How it ended.
    pub ending: Ending,
    /// The starts that were run, by their ends, the best first.
    pub starts: Vec<Tried>,
    /// The snaps of the fitted path.
    pub snaps: usize,
    /// σ of x, P and s, and where each comes from.
    pub noise: Noise,
    /// How many fits of the bootstrap there were, and the rows of its blocks.
    pub bootstrapped: Option<[usize; 2]>,
    /// Whether the signs of x and P are reversed against the file.
    pub turned: Turned,
    /// What was found, assumed and held, in words.
    pub notes: Vec<String>,
    /// What is doubtful, in words.
    pub warnings: Vec<String>,
    /// The preset with the fitted values.
    pub preset: Preset,
    /// The values between model and instrument, in the numbers of the file.
    pub instrument: Instrument,
    /// The points compared with the fit.
    pub residuals: Vec<Residual>,
}

impl Fit {
    /// The values of which a combination is known far better than each alone, in words: pairs, and what depends on a
    /// radius of curvature that the points do not show.
    pub fn known_together(&self) -> Vec<String> {
        /// Beyond this correlation the errors of two values say little about both together.
        const TOGETHER: f64 = 0.98;
        let rows = self.correlations.iter().flatten().enumerate();
        let pairs = rows.flat_map(|(i, row)| row.iter().take(i).enumerate().map(move |(j, r)| ([j, i], *r)));
        let together = pairs.filter(|(_, r)| r.abs() > TOGETHER);
        let sentence = |([j, i], r): ([usize; 2], f64)| {
            let [a, b] = [j, i].map(|k| letter(&self.preset, &self.parameters[k].key));
            format!(
                "a combination of {a} and {b} is known far better than either of them (correlation {r:+.4})"
            )
        };
        self.of_radius().into_iter().chain(together.map(sentence)).collect()
    }

    /// A sentence on a radius of curvature that is held: (R, E*, γ) → (a²R, E*/a, γ/a²) leaves P(δ) of a sphere as it is, and
    /// (aR, aE*, γ/a) its P(s). A speed of the edge goes with s in the first, and with 1/δ in the second.
    fn of_radius(&self) -> Option<String> {
        let gap = &self.preset.gap;
        let radius = gap.radius_of_curvature().filter(|_| gap.feature_length().is_none())?;
        let is_free = |key: &str| self.parameters.iter().any(|fitted| fitted.key.starts_with(key));
        let of_radius = self.abscissa == Abscissa::Radius;
        let has_radii = !of_radius && self.noise.sigma[2] > 0.0;
        let depends = is_free(ADHESION) || is_free(MODULUS);
        if has_radii || !depends || is_free("gap.") {
            return None;
        }
        let radius = said(&self.preset.units, Quantity::Length, radius);
        // A force, or a spring, does not go with δ.
        let goes = !of_radius || self.preset.path.control == Control::Displacement;
        let [values, shown] = match (goes && is_free(edge::REFERENCE_SPEED), of_radius) {
            (false, false) => ["E* and γ", "E*√R and γR"],
            (false, true) => ["E* and γ", "E*/R and γE*"],
            (true, false) => ["E*, γ and v0", "E*√R, γR and v0/√R"],
            (true, true) => ["E*, γ and v0", "E*/R, γE* and v0/R"],
        };
        let missing = if of_radius { "an approach" } else { "contact radii" };
        Some(format!(
            "{values} hold for R = {radius}, which is not fitted: without {missing} the points show {shown}"
        ))
    }

    /// Takes the values as not determined if `other` describes the points as well with others, far beyond the errors; `why` begins
    /// the sentence.
    pub(super) fn is_told_from(&mut self, other: &Self, why: &str) {
        /// How far, in standard errors.
        const FAR: f64 = 3.0;
        let pairs =
            || self.parameters.iter().zip(&other.parameters).filter(|(own, other)| own.key == other.key);
        let is_far = |(own, other): (&Fitted, &Fitted)| {
            own.standard_error.is_some_and(|error| (own.value - other.value).abs() > FAR * error)
        };
        if !pairs().any(is_far) {
            return;
        }
        let shown = pairs().map(|(_, other)| {
            format!("{} = {}", letter(&self.preset, &other.key), significant(other.value, 4))
        });
        let shown: Vec<String> = shown.collect();
        self.direction =
            Some(format!("{why}, and {} describe the points as well, in base units", shown.join(", ")));
        self.verdict = Verdict::NotDetermined;
        self.correlations = None;
        for fitted in &mut self.parameters {
            (fitted.standard_error, fitted.degrees, fitted.interval) = (None, None, None);
            (fitted.profile, fitted.bootstrap) = (None, None);
        }
    }

    /// Whether what was found holds for `preset`: it has the same points, taken in the same way, and all the fitted and
    /// all the held values of the fit. Its path, which a fit does not see, may differ.
    pub fn holds_for(&self, preset: &Preset) -> bool {
        let found = &self.preset;
        let mut same = preset.clone();
        same.title.clone_from(&found.title);
        same.data.free.clone_from(&found.data.free);
        same.data.uncertain.clone_from(&found.data.uncertain);
        same.basis.clone_from(&found.basis);
        let has_same_device = preset.path.control == found.path.control;
        same.path = found.path;
        has_same_device && same == *found
    }
}
