//! The preset that a fit leaves: its own, with what was found.

use super::problem::{ADHESION, FitProblem, FreeParameter, Target};
use super::uncertain::{uncertain, written};
use crate::measured::{Instrument, Segment};
use crate::preset::data::{BASELINE, OFFSET, TILT};
use crate::preset::{Preset, Value, edge};
use crate::units::Quantity;
use crate::units::number::said;

/// `preset` with the values of `found`; its path stays its own.
pub(super) fn laid(
    preset: &Preset,
    problem: &FitProblem,
    (found, closing, instrument): (&Preset, Option<f64>, &Instrument),
    notes: &mut Vec<String>,
) -> Preset {
    let mut laid = preset.clone();
    // What was known before stays so: the next fit has the same points, which must count once.
    let known = uncertain(preset, problem.abscissa, &preset.data.uncertain).unwrap_or_default();
    let known: Vec<String> = problem
        .priors
        .iter()
        .map(|prior| (&problem.parameters[prior.parameter], prior))
        .filter(|(parameter, _)| known.iter().any(|known| known.target.key() == parameter.key()))
        .map(|(parameter, prior)| written(parameter, prior))
        .collect();
    laid.data.uncertain = known.join(",");
    let opening = found.material.work_of_adhesion;
    // A closing edge gains at most what an opening one costs, so the opening value must be set first.
    let is_closing = |of: &&FreeParameter| of.target == Target::Adhesion(Segment::Approach);
    let all = || problem.parameters.iter();
    if let Some(before) = laid.edge.closing_work_of_adhesion.filter(|before| *before > opening) {
        laid.edge.closing_work_of_adhesion = None;
        if !all().any(|parameter| is_closing(&parameter)) {
            notes.push(format!(
                "{} = {} is above the work of adhesion that was found, and not in the fitted preset",
                edge::CLOSING_ADHESION,
                said(&preset.units, Quantity::EnergyPerArea, before)
            ));
        }
    }
    for parameter in all().filter(|of| !is_closing(of)).chain(all().filter(is_closing)) {
        let (key, value) = match &parameter.target {
            Target::Key(key) => (key.as_str(), found.get(key)),
            Target::Adhesion(Segment::Retraction | Segment::Other) => (ADHESION, found.get(ADHESION)),
            Target::Adhesion(_) => {
                (edge::CLOSING_ADHESION, closing.filter(|closing| *closing <= opening).map(Value::from))
            }
            Target::Offset => (OFFSET, Some(instrument.offset.into())),
            // A baseline that no rows show is known no better by the next fit: it stays as it was given.
            Target::Baseline if !problem.data.iter().any(|datum| datum.free) => continue,
            Target::Baseline => (BASELINE, Some(instrument.baseline.into())),
            Target::Tilt => (TILT, Some(instrument.tilt.into())),
        };
        if let Some(Err(invalid)) = value.map(|value| laid.set(key, value)) {
            notes.push(format!("{key} could not be set in the preset: {invalid}"));
        }
    }
    laid
}
