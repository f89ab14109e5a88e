//! What the fit would be with another spring, or with a force that drifts.

use super::super::least_squares::Ending;
use super::super::options::letter;
use super::super::problem::{FitProblem, FreeParameter, Target};
use super::super::solve::{SolvedFit, solve};
use crate::elementary::exp_m1;
use crate::measured::Abscissa;
use crate::measured::noise::range;
use crate::preset::Value;
use crate::preset::schema::STIFFNESS;
use crate::problem::Control;
use crate::progress::Progress;

/// Rows of the part, rounds of each fit, and how often one goes on that has not come to rest.
const ROWS: usize = 240;
const ROUNDS: usize = 40;
const TIMES: usize = 5;
/// A change of a value, or of its logarithm where it is positive, that counts as none.
const STILL: f64 = 1e-9;
/// No value changes by more than this, or its logarithm, with a spring that changes by a tenth.
const RUN_AWAY: f64 = 2.0;
/// The same of a logarithm in words, which have a tenth of a per cent.
const UNSEEN: f64 = 5e-4;

/// `k 10 % larger: E* -8.0 %, γ +7.1 %; …`: what the fit would be with another spring; `None` where there is none,
/// it is free, or it moves no value: beside an approach it decides only where the edge snaps.
pub(in crate::fit) fn of_spring(
    problem: &FitProblem,
    solved: &SolvedFit,
    is_of_deflection: bool,
    (robust, progress): (bool, &dyn Progress),
) -> Option<String> {
    let Control::Stiffness(k) = problem.preset.path.control else { return None };
    if problem.parameters.iter().any(|p| p.target == Target::Key(STIFFNESS.to_owned())) {
        return None;
    }
    let part = FitPart::of(problem, solved, robust, progress)?;
    let (mut told, mut plays) = (Vec::new(), false);
    for (factor, words) in [(1.1, "10 % larger"), (0.9, "10 % smaller")] {
        let mut other = part.problem.clone();
        other.preset.set(STIFFNESS, Value::Number(factor * k)).ok()?;
        // The force is k times what was measured.
        if is_of_deflection {
            other.data.iter_mut().for_each(|datum| datum.point.force *= factor);
            other.sigma[1] *= factor;
        }
        // Another spring moves the points: values that stay where they were have not been fitted to it.
        let is_position = problem.abscissa == Abscissa::Position;
        let found = part.moved(&other).filter(|u| !is_position || farthest(u, &part.own) > STILL);
        let words = match found {
            None => {
                plays |= is_position;
                format!("{words}: no fit comes to an end, so what k does to the values is not known")
            }
            Some(found) => {
                plays |= part.change(&found) >= UNSEEN;
                format!("{words}: {}", part.changes(&found))
            }
        };
        told.push(words);
    }
    plays.then(|| format!("with k {}", told.join("; with k ")))
}

/// What a force that drifts evenly from row to row would do to the values; `None` over a contact radius, with a tilt, and where both
/// branches are fitted, which shows a drift, or no value changes by much.
pub(in crate::fit) fn of_drift(
    problem: &FitProblem,
    solved: &SolvedFit,
    robust: bool,
    progress: &dyn Progress,
) -> Option<String> {
    /// The drift over all rows, as a share of the range of the force.
    const DRIFT: f64 = 0.01;
    /// A smaller change of a logarithm is not worth a note.
    const MATTERS: f64 = 3e-3;
    let is_free = problem.parameters.iter().any(|p| p.target == Target::Tilt);
    // A tilt that is given is that of a drift.
    let is_given = problem.instrument_at(&solved.minimum.parameters).tilt != 0.0;
    if is_free || is_given || problem.abscissa == Abscissa::Radius || problem.data.is_empty() {
        return None;
    }
    let first = problem.data[0].segment;
    if problem.data.iter().any(|datum| datum.segment != first) {
        return None;
    }
    let part = FitPart::of(problem, solved, robust, progress)?;
    let mut other = part.problem.clone();
    let forces = range(other.data.iter().map(|datum| datum.point.force));
    let rows = range(other.data.iter().map(|datum| datum.point.at as f64));
    for datum in &mut other.data {
        datum.point.force += DRIFT * forces * datum.point.at as f64 / rows;
    }
    let found = part.moved(&other).filter(|found| part.change(found) >= MATTERS)?;
    // It may drift either way.
    let signs: Vec<f64> = part.logarithms(&found).map(|(_, change)| change.signum()).collect();
    let each = part.logarithms(&found).zip(&signs).map(|((parameter, change), sign)| {
        let name = letter(&problem.preset, &parameter.key());
        let sign = if sign.total_cmp(&signs[0]).is_eq() { '±' } else { '∓' };
        format!("{name} {sign}{:.1} %", 100.0 * change.abs())
    });
    Some(format!(
        "a force that drifts by 1 % of its range over the rows would change the values by {}. The errors hold no drift: measure both \
         branches, or free data.tilt",
        each.collect::<Vec<_>>().join(", ")
    ))
}

/// A fit to a part of the rows. Compared with it, another fit to that part shows the effect of a change to a tenth of a per cent.
struct FitPart<'a> {
    problem: FitProblem,
    own: Vec<f64>,
    robust: bool,
    progress: &'a dyn Progress,
}

/// The largest difference of a value.
fn farthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

impl<'a> FitPart<'a> {
    fn of(
        problem: &FitProblem,
        solved: &SolvedFit,
        robust: bool,
        progress: &'a dyn Progress,
    ) -> Option<Self> {
        let problem = problem.thinned(ROWS);
        let own = solve(&problem, &solved.minimum.parameters, robust, ROUNDS, progress)?.minimum.parameters;
        Some(Self { problem, own, robust, progress })
    }

    /// Where the fit to `other` ends; `None` where it comes to no end, or its values run away.
    fn moved(&self, other: &FitProblem) -> Option<Vec<f64>> {
        // Of points that a change moves off the model, the scale of the residuals may go to and fro without end.
        let mut ends = std::iter::successors(Some((self.own.clone(), None)), |(from, _)| {
            let found = solve(other, from, self.robust, ROUNDS, self.progress)?.minimum;
            let rests = found.ending == Ending::Converged || farthest(&found.parameters, from) < UNSEEN;
            Some((found.parameters, Some(rests)))
        });
        let found = ends.by_ref().take(TIMES).find(|(_, rests)| *rests == Some(true)).map(|(u, _)| u);
        // Values that a small change multiplies have run away.
        found.filter(|u| farthest(u, &self.own) < RUN_AWAY)
    }

    /// The values that are positive, each with the change of its logarithm.
    fn logarithms(&self, found: &[f64]) -> impl Iterator<Item = (&FreeParameter, f64)> {
        let changes: Vec<f64> = found.iter().zip(&self.own).map(|(now, own)| now - own).collect();
        self.problem.parameters.iter().zip(changes).filter(|(parameter, _)| parameter.scale.is_none())
    }

    /// The largest of these changes.
    fn change(&self, found: &[f64]) -> f64 {
        self.logarithms(found).map(|(_, change)| change.abs()).fold(0.0, f64::max)
    }

    /// These changes in words.
    fn changes(&self, found: &[f64]) -> String {
        let each = self.logarithms(found).map(|(parameter, change)| {
            let name = letter(&self.problem.preset, &parameter.key());
            format!("{name} {:+.1} %", 100.0 * exp_m1(change)).replace('-', "−")
        });
        each.collect::<Vec<_>>().join(", ")
    }
}
