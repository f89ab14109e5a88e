//! What the fit would be with another spring.

use super::super::least_squares::Ending;
use super::super::options::letter;
use super::super::problem::{FitProblem, Target};
use super::super::solve::{SolvedFit, solve};
use crate::elementary::exp_m1;
use crate::measured::Abscissa;
use crate::preset::Value;
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
    robust: bool,
    progress: &dyn Progress,
) -> Option<String> {
    const KEY: &str = "path.control.stiffness";
    let Control::Stiffness(k) = problem.preset.path.control else { return None };
    if problem.parameters.iter().any(|p| p.target == Target::Key(KEY.to_owned())) {
        return None;
    }
    // A part of the rows gives the effect of a spring to a tenth of a per cent, if it is compared with a fit to the
    // same part.
    let problem = &problem.thinned(ROWS);
    let own = solve(problem, &solved.minimum.parameters, robust, ROUNDS, progress)?.minimum.parameters;
    let (mut told, mut plays) = (Vec::new(), false);
    for (factor, words) in [(1.1, "10 % larger"), (0.9, "10 % smaller")] {
        let mut other = problem.clone();
        other.preset.set(KEY, Value::Number(factor * k)).ok()?;
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Of points that another spring moves off the model, the scale of the residuals may go to and fro without end.
        let mut ends = std::iter::successors(Some((own.clone(), None)), |(from, _)| {
            let found = solve(&other, from, robust, ROUNDS, progress)?.minimum;
            let rests = found.ending == Ending::Converged || apart(&found.parameters, from) < UNSEEN;
            Some((found.parameters, Some(rests)))
        });
        let found = ends.by_ref().take(TIMES).find(|(_, rests)| *rests == Some(true)).map(|(u, _)| u);
        // Another spring moves the points: values that stay where they were have not been fitted to it.
        let found = found.filter(|u| problem.abscissa != Abscissa::Position || apart(u, &own) > STILL);
        // And values that a tenth of k multiplies have run away.
        let found = found.filter(|u| apart(u, &own) < RUN_AWAY);
        let words = match found {
            None => {
                plays |= problem.abscissa == Abscissa::Position;
                format!("{words}: no fit comes to an end, so what k does to the values is not known")
            }
            Some(found) => {
                let changes: Vec<String> = problem
                    .parameters
                    .iter()
                    .enumerate()
                    .filter(|(_, parameter)| parameter.scale.is_none())
                    .map(|(j, parameter)| {
                        let change = found[j] - own[j];
                        plays |= change.abs() >= UNSEEN;
                        let name = letter(&problem.preset, &parameter.key());
                        format!("{name} {:+.1} %", 100.0 * exp_m1(change)).replace('-', "−")
                    })
                    .collect();
                format!("{words}: {}", changes.join(", "))
            }
        };
        told.push(words);
    }
    plays.then(|| format!("with k {}", told.join("; with k ")))
}
