//! The preset that a fit leaves: its own, with what was found.

use super::problem::{ADHESION, FitProblem, FreeParameter, START, Target};
use super::pulled::is_pulled;
use super::uncertain::{uncertain, written};
use crate::elementary::{log10, pow};
use crate::measured::{Instrument, Segment};
use crate::preset::data::{BASELINE, OFFSET, TARE, TILT};
use crate::preset::{BasisSpec, Preset, Value, edge};
use crate::problem::Start;
use crate::units::Quantity;
use crate::units::number::said;

/// A path that begins this share of its start within the points reaches them.
const REACHED: f64 = 0.01;

/// `preset` with the values of `found`; its path stays its own, unless it begins within the points.
pub(super) fn laid(
    preset: &Preset,
    problem: &FitProblem,
    (found, closing, instrument): (&Preset, Option<f64>, &Instrument),
    widest: f64,
    notes: &mut Vec<String>,
) -> Preset {
    let mut laid = preset.clone();
    // Its curve is the one that was fitted.
    laid.basis = BasisSpec::Exact;
    laid.data.uncertain = known_before(preset, problem);
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
    let mut set = |key: &str, value: Value| {
        if let Err(invalid) = laid.set(key, value) {
            notes.push(format!("{key} could not be set in the preset: {invalid}"));
        }
    };
    if is_pulled(found) {
        // The fitted preset makes the pull that was fitted, also where its rate is that of the times, or its start is held.
        let is_held = all().all(|parameter| parameter.key() != START);
        for key in [edge::RATE].into_iter().chain(is_held.then_some(START)) {
            if let Some(value) = found.get(key) {
                set(key, value);
            }
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
            // A baseline that no rows show is known no better by the next fit, which is free to change it.
            Target::Baseline if !problem.data.iter().any(|datum| datum.free) => {
                (TARE, Some(instrument.baseline.into()))
            }
            Target::Baseline => (BASELINE, Some(instrument.baseline.into())),
            Target::Tilt => (TILT, Some(instrument.tilt.into())),
        };
        if let Some(value) = value {
            set(key, value);
        }
    }
    let is_within =
        matches!(laid.path.start, Start::ContactRadius(start) if widest > start * (1.0 + REACHED));
    let is_fitted = all().any(|parameter| parameter.key() == START);
    if is_within && !is_fitted && laid.set(START, Value::Number(rounded_up(widest))).is_ok() {
        let start = said(&preset.units, Quantity::Length, rounded_up(widest));
        notes.push(format!("{START} is {start} in the fitted preset: its curve reaches the first points"));
    }
    laid
}

/// What is known with an error, as it is written in a preset.
fn known_before(preset: &Preset, problem: &FitProblem) -> String {
    // What was known before stays so: the next fit has the same points, which must count once.
    let known = uncertain(preset, problem.abscissa, &preset.data.uncertain).unwrap_or_default();
    let known: Vec<String> = problem
        .priors
        .iter()
        .map(|prior| (&problem.parameters[prior.parameter], prior))
        .filter(|(parameter, _)| known.iter().any(|known| known.target.key() == parameter.key()))
        .map(|(parameter, prior)| written(parameter, prior))
        .collect();
    known.join(",")
}

/// A positive number with three digits, not below `x`.
fn rounded_up(x: f64) -> f64 {
    let digit = pow(10.0, log10(x).floor() - 2.0);
    (x / digit).ceil() * digit
}
