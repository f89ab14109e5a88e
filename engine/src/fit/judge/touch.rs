//! Whether the bodies pull before they touch, or are apart where they must have touched. At an edge without a range the first contact is
//! at δ = 0, and with a range γ/σ₀ at δ = −γ/σ₀; the force before it is that of bodies apart.
//!
//! A median of m rows is known to 1.2533 s/√m; a deviation beyond five of these is not chance.

use super::super::path::PathPlace;
use super::super::problem::{Datum, FitProblem};
use super::super::pulled::is_pulled;
use super::super::verdict::Reason;
use super::{Evidence, ROUNDING};
use crate::elementary::hypot;
use crate::measured::branches::median;
use crate::measured::{Abscissa, Segment};
use crate::text::counted;
use crate::units::Quantity;
use crate::units::number::{said, short};
use nalgebra::DVector;

/// The fewest rows that pull.
const FEWEST: usize = 2;
/// The standard error of a median, in units of that of a mean.
const OF_MEDIAN: f64 = 1.2533;
/// Errors of the force beyond which it is not chance, and errors of the place of the first touch.
const NO_CHANCE: f64 = 5.0;
const BEFORE: f64 = 3.0;

/// The noise of the rows in contact in σ, and how far the first touch and a row may be off.
fn margin(Evidence { problem, solved, scatter, inner }: Evidence) -> Option<[f64; 2]> {
    /// The step of u for a derivative.
    const STEP: f64 = 1e-4;
    let s = scatter.contact?.max(solved.scale).max(ROUNDING);
    let u = &solved.minimum.parameters;
    let slope = |j: usize| {
        let mut beside = u.clone();
        beside[j] += STEP;
        Some((problem.touches_at(&beside)? - problem.touches_at(u)?) / STEP)
    };
    let error = inner.map_or(0.0, |inner| {
        let slopes = DVector::from_fn(u.len(), |j, _| slope(j).unwrap_or(0.0));
        s * (inner * &slopes).dot(&slopes).max(0.0).sqrt()
    });
    Some([s, BEFORE * (error + problem.sigma[0])])
}

impl FitProblem {
    /// x of the first contact at `u`.
    fn touches_at(&self, u: &[f64]) -> Option<f64> {
        let range = self.preset_at(u, Segment::Approach)?.cohesion().map_or(0.0, |cohesion| cohesion.range);
        Some(self.instrument_at(u).offset - range)
    }

    /// How far beyond the first contact of the model at `u` the rows of an approach lie that are still apart, more than
    /// `margin` beyond it and far from its path; `s` is the noise in σ. The bodies cannot come nearer without touching.
    fn late(&self, u: &[f64], [s, margin]: [f64; 2]) -> Option<Vec<f64>> {
        if self.abscissa == Abscissa::Radius || is_pulled(&self.preset) {
            return None;
        }
        let (instrument, touches_at) = (self.instrument_at(u), self.touches_at(u)?);
        let beyond = |datum: &Datum| datum.point.x - touches_at;
        let is_inside =
            |datum: &&Datum| datum.free && datum.segment == Segment::Approach && beyond(datum) > margin;
        let mut inside = self.data.iter().filter(is_inside).peekable();
        inside.peek()?;
        let weights = self.weights();
        let paths = self.paths(u)?;
        let [approach, _] = paths.scaled([weights[0], weights[1], 0.0]);
        let mut hint = 0;
        let mut is_off = |datum: &&Datum| {
            let force = datum.point.force - instrument.baseline - instrument.tilt * datum.point.x;
            let place = [(datum.point.x - instrument.offset) * weights[0], force * weights[1], 0.0];
            // From the foot itself: beyond an end of the path, the distance along its normal may be nothing.
            let off = |at: PathPlace| hypot(place[0] - at[0] * weights[0], place[1] - at[1] * weights[1]);
            approach.nearest(place, &mut hint).is_some_and(|foot| off(foot.at) > NO_CHANCE * s)
        };
        Some(inside.filter(|datum| is_off(datum)).map(beyond).collect())
    }

    /// The rows of a branch that are not apart, on an approach that begins apart, before `x`.
    fn early(&self, branch: usize, x: f64) -> Vec<&Datum> {
        let of = |free: bool| {
            self.data.iter().filter(move |datum| {
                datum.branch == branch && datum.free == free && datum.segment == Segment::Approach
            })
        };
        // An approach that begins in contact has touched before.
        if of(true).next().is_none() {
            return Vec::new();
        }
        of(false).filter(|datum| datum.point.x < x).collect()
    }

    /// How far before δ = 0 the rows of an approach begin to pull at `u`, `s` being the noise in σ, which a range of adhesion
    /// explains; `None` where they hardly do, and where the place of δ = 0 is wrong.
    pub(super) fn pulls_from(&self, u: &[f64], s: f64) -> Option<f64> {
        if self.abscissa == Abscissa::Radius || self.is_late(u, s) {
            return None;
        }
        let at = self.instrument_at(u);
        let pulls = |datum: &&Datum| {
            datum.point.force - at.baseline - at.tilt * datum.point.x < -BEFORE * s * self.sigma[1]
        };
        let early = |branch| -> Vec<&Datum> {
            self.early(branch, at.offset - BEFORE * self.sigma[0]).into_iter().filter(pulls).collect()
        };
        let early = (0..self.branches()).map(early).max_by_key(Vec::len).filter(|of| of.len() >= FEWEST)?;
        early.iter().map(|datum| at.offset - datum.point.x).reduce(f64::max)
    }

    /// Whether rows of an approach are apart where the model at `u` holds the bodies in contact.
    pub(in super::super) fn is_late(&self, u: &[f64], s: f64) -> bool {
        let late = self.late(u, [s.max(ROUNDING), BEFORE * self.sigma[0]]);
        late.is_some_and(|late| late.len() > FEWEST)
    }
}

/// Rows of an approach that are apart where the model holds the bodies in contact.
pub(super) fn of_late(evidence: Evidence) -> Option<Reason> {
    let Evidence { problem, solved, .. } = evidence;
    let late = problem.late(&solved.minimum.parameters, margin(evidence)?)?;
    let most = late.iter().copied().fold(0.0, f64::max);
    (late.len() > FEWEST).then(|| {
        let sentence = format!(
            "on the approach the bodies are apart where the model has them in contact: {}, up to {} beyond its \
             first contact. --segment retraction leaves the approach out",
            counted(late.len(), "row"),
            said(&problem.preset.units, Quantity::Length, most)
        );
        Reason::new("late", most, sentence)
    })
}

/// Rows of an approach that pull where the model has the bodies apart.
pub(super) fn of_touch(evidence: Evidence) -> Option<Reason> {
    let Evidence { problem, solved, scatter, .. } = evidence;
    if problem.abscissa == Abscissa::Radius {
        return None;
    }
    let [s, margin] = margin(evidence)?;
    let u = &solved.minimum.parameters;
    let (instrument, touches_at) = (problem.instrument_at(u), problem.touches_at(u)?);
    let apart = |x: f64| touches_at - x;
    let of_branch = |branch: usize| -> Option<Reason> {
        let early = problem.early(branch, touches_at - margin);
        if early.len() < FEWEST {
            return None;
        }
        let force = |x: f64, force: f64| force - instrument.baseline - instrument.tilt * x;
        let pull = median(early.iter().map(|datum| force(datum.point.x, datum.point.force)).collect())?;
        let count = early.len() as f64 / scatter.correlation.rows();
        let t = pull / (OF_MEDIAN * s * problem.sigma[1] / count.max(1.0).sqrt());
        let most = early.iter().map(|datum| apart(datum.point.x)).fold(0.0, f64::max);
        let units = &problem.preset.units;
        (t < -NO_CHANCE).then(|| {
            let sentence = format!(
                "on the approach the bodies attract before they touch: {} rows, up to {} before the first \
                 contact of the model, have the force {} ({} standard errors). The adhesion {}, or the force lags",
                early.len(),
                said(units, Quantity::Length, most),
                said(units, Quantity::Force, pull),
                short(t.abs(), 2),
                if problem.preset.cohesion().is_some() { "reaches further" } else { "has a range" }
            );
            Reason::new("touch", t, sentence)
        })
    };
    (0..problem.branches()).find_map(of_branch)
}
