//! What a fit of adhesion with a range cannot tell, and where one disc in one zone is not the whole state.

use super::super::determined::Determined;
use super::super::options::letter;
use super::super::path::Foot;
use super::super::problem::{FitProblem, FreeParameter, Target};
use super::super::scatter::Scatter;
use super::super::solve::{SolvedFit, solve};
use super::super::start::start;
use super::super::track::{END_MAUGIS, maugis};
use super::super::verdict::Reason;
use crate::measured::Segment;
use crate::preset::edge;
use crate::preset::schema::RANGE_KEYS;
use crate::problem::Adhesion;
use crate::progress::Progress;
use crate::units::Quantity;
use crate::units::number::{said, short, with_unit};
use nalgebra::DVector;

/// The largest error of the logarithm of a tension or a range that still counts as found: its 95 % interval goes from a
/// quarter of the value to four times it.
const MOST: f64 = 0.7;
/// χ² must be larger by this much for a range to be told from none: the bound for comparing two models, with one more
/// value.
const WORSE: f64 = 12.0;
/// Residuals count as at most this many s.
const CLIPPED: f64 = 4.0;
/// Rounds of the fit without a range.
const ROUNDS: usize = 100;
/// Places on a path at which it is checked that one disc in one zone is the whole state.
const LOOKED: u32 = 12;

/// A work of adhesion of the approach that has run off to zero: its logarithm has no minimum, and the errors of the others would
/// take it as known.
fn runs_off(problem: &FitProblem, u: &[f64]) -> Option<String> {
    /// As a share of that of the retraction.
    const LEAST: f64 = 1e-4;
    let is_closing = |of: &FreeParameter| of.target == Target::Adhesion(Segment::Approach);
    problem.parameters.iter().find(|parameter| is_closing(parameter))?;
    let [closing, opening] = [Segment::Approach, Segment::Retraction]
        .map(|of| Some(problem.preset_at(u, of)?.material.work_of_adhesion));
    (closing? < LEAST * opening?).then(|| {
        format!(
            "the approach shows no work of adhesion above 0: hold {}, or fit the retraction alone",
            edge::CLOSING_ADHESION
        )
    })
}

/// Why the points do not tell how far the adhesion reaches, where that is free; none where they do.
///
/// The errors hold next to the minimum. Farther off, where the range vanishes, there may be another minimum as deep,
/// which is sought separately.
pub(in super::super) fn unseen(
    problem: &FitProblem,
    solved: &SolvedFit,
    (what, scatter): (&Determined, &Scatter),
    robust: bool,
    progress: &dyn Progress,
) -> Option<String> {
    let u = &solved.minimum.parameters;
    if let Some(why) = runs_off(problem, u) {
        return Some(why);
    }
    let j = problem.free_range()?;
    let error = what.errors.as_ref()?[j];
    let preset = problem.preset_at(u, Segment::Retraction)?;
    let maugis = maugis(&preset);
    let at = maugis.map_or_else(String::new, |maugis| format!(" at lambda_M = {}", short(maugis, 2)));
    let is_known = error <= MOST && maugis.is_none_or(|maugis| maugis < END_MAUGIS);
    let why = if is_known {
        let mut sharp = problem.holding(j, u[j])?;
        sharp.preset.material.adhesion = Adhesion::ShortRange;
        let found = start(&sharp, true, robust, progress)
            .and_then(|ends| solve(&sharp, &ends.best, robust, ROUNDS, progress));
        let s = scatter.contact.unwrap_or(solved.scale).max(1.0);
        match found {
            // There is nothing to compare with, so this makes no claim.
            None => "no fit of adhesion at the edge alone was found to compare it with".to_owned(),
            Some(found) => {
                let worse = cost(&found.minimum.at.residuals, s) - cost(&solved.minimum.at.residuals, s);
                let worse = worse / scatter.correlation.rows();
                if worse > WORSE {
                    return None;
                }
                let than = if worse < 0.0 { "smaller" } else { "larger" };
                format!(
                    "adhesion at the edge alone fits as well, with a chi squared {than} by {}",
                    short(worse.abs(), 2)
                )
            }
        }
    } else {
        format!("its error{at} is {} times its value", short(error, 2))
    };
    // The error of a range that is not determined hides how far it reaches beyond the rows that are apart.
    let late =
        "at this value rows of the approach that are apart would be in contact: adhesion reaches less far";
    let late = problem.is_late(u, solved.scale).then(|| late.to_owned());
    let first = of_first_pull(problem, solved).or(late).map_or_else(String::new, |said| format!(" ({said})"));
    Some(format!(
        "{}: {why}, so the points of the curve do not show how far the adhesion reaches: hold it{first}, or set \
         material.adhesion = \"short-range\", and compare both with --model short-range,dugdale",
        letter(&problem.preset, &problem.parameters[j].key()),
    ))
}

/// The range of the adhesion that the beginning of an approach shows, where that is free: what the curve does not show, its
/// beginning may. `None` where it shows none.
pub(in super::super) fn of_first_pull(problem: &FitProblem, solved: &SolvedFit) -> Option<String> {
    let key = problem.parameters[problem.free_range()?].key();
    let u = &solved.minimum.parameters;
    let preset = problem.preset_at(u, Segment::Retraction)?;
    let range = problem.pulls_from(u, solved.scale)?;
    let rounded = |x: f64| format!("{x:.1e}").parse().map_or_else(|_| short(x, 2), |x| short(x, 2));
    let about = |quantity, value| with_unit(&problem.preset.units, quantity, value, true, rounded);
    let length = about(Quantity::Length, range);
    let value = if key == RANGE_KEYS[0] {
        about(Quantity::Stress, preset.material.work_of_adhesion / range)
    } else {
        length.clone()
    };
    let name = letter(&problem.preset, &key);
    Some(format!(
        "on the approach the bodies attract from about {length} before delta = 0 on, as with {name} = {value}"
    ))
}

/// χ² of residuals in s, none of which counts as more than a few.
fn cost(residuals: &DVector<f64>, s: f64) -> f64 {
    residuals.iter().map(|r| (r / s).clamp(-CLIPPED, CLIPPED).powi(2)).sum()
}

/// A state among those of the points that is not one disc in one zone: the values are then those of another problem.
pub(super) fn of_zone(problem: &FitProblem, solved: &SolvedFit) -> Option<Reason> {
    let u = &solved.minimum.parameters;
    let paths = problem.paths(u)?;
    let feet = problem.feet(&paths, &problem.instrument_at(u))?;
    [Segment::Approach, Segment::Retraction].into_iter().find_map(|segment| {
        let of = problem.data.iter().zip(&feet).filter(|(datum, _)| datum.segment == segment);
        let along = of.filter_map(|(_, foot)| match foot.as_ref()?.foot {
            Foot::Radius(along) => Some(along),
            _ => None,
        });
        let [lo, hi] = along.fold([f64::INFINITY, 0.0], |[lo, hi]: [f64; 2], at| [lo.min(at), hi.max(at)]);
        let places = (0..=LOOKED).map(|k| lo + (hi - lo) * f64::from(k) / f64::from(LOOKED));
        let (radius, why) = places.filter(|_| lo <= hi).find_map(|at| paths.of(segment).fault(at))?;
        let shown = said(&problem.preset.units, Quantity::Length, radius);
        let sentence = format!(
            "the fitted path has a state that is not one disc in one zone ({}): its values are not valid",
            why.map_or_else(|| format!("no state at r = {shown}"), |kind| kind.words(&shown))
        );
        Some(Reason::new("zone", radius, sentence))
    })
}
