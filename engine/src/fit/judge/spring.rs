//! What the fit would be with another spring.

use super::super::options::letter;
use super::super::problem::{Problem, Target};
use super::super::solve::{Solved, solve};
use crate::elementary::exp_m1;
use crate::preset::Value;
use crate::problem::Control;
use crate::progress::Progress;

/// `k 10 % larger: E* -8.0 %, γ +7.1 %; …`: what the fit would be with another spring; `None` where there is none, or it is free.
pub(in crate::fit) fn of_spring(
    problem: &Problem,
    solved: &Solved,
    robust: bool,
    progress: &dyn Progress,
) -> Option<String> {
    const KEY: &str = "path.control.stiffness";
    let Control::Stiffness(k) = problem.preset.path.control else { return None };
    if problem.parameters.iter().any(|p| p.target == Target::Key(KEY.to_owned())) {
        return None;
    }
    let mut told = Vec::new();
    for (factor, words) in [(1.1, "10 % larger"), (0.9, "10 % smaller")] {
        let mut other = problem.clone();
        other.preset.set(KEY, Value::Number(factor * k)).ok()?;
        let found = solve(&other, &solved.minimum.parameters, robust, 40, progress);
        let words = match found {
            None => format!("{words}: no fit"),
            Some(found) => {
                let changes: Vec<String> = problem
                    .parameters
                    .iter()
                    .enumerate()
                    .filter(|(_, parameter)| parameter.scale.is_none())
                    .map(|(j, parameter)| {
                        let change = found.minimum.parameters[j] - solved.minimum.parameters[j];
                        let name = letter(&problem.preset, &parameter.key());
                        format!("{name} {:+.1} %", 100.0 * exp_m1(change)).replace('-', "−")
                    })
                    .collect();
                format!("{words}: {}", changes.join(", "))
            }
        };
        told.push(words);
    }
    Some(format!("with k {}", told.join("; with k ")))
}
