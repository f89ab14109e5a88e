//! What a jump dissipates, computed twice.
//!
//! At constant control the device and the bodies together hold the potential
//!
//! ```text
//! displacement  U            force  U − Pδ            stiffness k  U + ½k(Δ − δ)²
//! ```
//!
//! A jump dissipates its drop. Along the curve dU = P dδ, so the drop is also the area between the curve and
//! the control line, `−∫(P − P_line) dδ` from before to after, with `P_line` = 0, P*, k(Δ* − δ). After a pull-off the
//! curve goes on to s = 0 and then along P = 0 to where the spring is slack. Under a dead load there is no such
//! place: the load falls for ever and no loss is reported.

use super::curve::radii;
use super::equilibrium::{Equilibrium, State};
use crate::contact::{Control, Gap};
use crate::ritz::Evaluation;
use gauss_quad::GaussLegendre;

/// Steps per wave of the area's Gauss rule, four nodes each: the two losses then agree to about 1e-10.
const STEPS_PER_WAVE: f64 = 20.0;

/// Steps of the area at least in one jump: a short jump encloses a lens so thin that steps by the wave alone leave
/// 1e-6 of it.
const STEPS_PER_JUMP: f64 = 8.0;

/// Below this share of the radius, and one step of a wave, a pull-off's area is one last piece to s = 0.
const LAST_PIECE: f64 = 0.02;

/// The potential of bodies and device at `state`, the control held at `value`.
pub fn potential(control: Control, value: f64, state: &State) -> f64 {
    match control {
        Control::Displacement => state.energy,
        Control::Force => state.energy - value * state.approach,
        Control::Stiffness(k) => state.energy + 0.5 * k * (value - state.approach).powi(2),
    }
}

/// The energy lost in a jump as the drop of the potential; `after` is `None` for a pull-off.
///
/// `None` for a pull-off under a dead load.
pub fn loss(control: Control, value: f64, before: &State, after: Option<&State>) -> Option<f64> {
    let Some(after) = after else {
        return (control != Control::Force).then(|| potential(control, value, before));
    };
    // The device's part as a product: its energy can be a billion times the loss, and would cancel.
    let given = before.approach - after.approach;
    let device = match control {
        Control::Displacement => 0.0,
        Control::Force => -value * given,
        Control::Stiffness(k) => -0.5 * k * given * (2.0 * value - before.approach - after.approach),
    };
    Some(before.energy - after.energy + device)
}

/// The energy lost in a jump as the area between the curve and the control line.
///
/// `None` for a pull-off under a dead load, or where the basis has no equilibrium on the way.
pub fn area(
    equilibrium: &Equilibrium,
    control: Control,
    value: f64,
    before: f64,
    after: Option<f64>,
) -> Option<f64> {
    if after.is_none() && control == Control::Force {
        return None;
    }
    let feature = equilibrium.problem.gap.feature_length();
    let last_piece = feature.map_or(f64::INFINITY, |wave| wave / STEPS_PER_WAVE).min(LAST_PIECE * before);
    let to = after.unwrap_or(last_piece);
    let by_jump = (before - to) / STEPS_PER_JUMP * STEPS_PER_WAVE;
    let mut radii =
        radii(before, to, Some(feature.map_or(by_jump, |wave| wave.min(by_jump))), STEPS_PER_WAVE);
    if after.is_none() {
        radii.push(0.0);
    }
    let line = |delta: f64| match control {
        Control::Displacement => 0.0,
        Control::Force => value,
        Control::Stiffness(k) => k * (value - delta),
    };
    let rule = GaussLegendre::new(4.try_into().ok()?);
    let (mut nodes, mut weights) = (Vec::new(), Vec::new());
    for pair in radii.windows(2) {
        // s = x²: δ behaves like √s towards s = 0 and is smooth in x.
        let (a, b) = (pair[0].sqrt(), pair[1].sqrt());
        for (t, weight) in &rule {
            let x = 0.5 * (a + b) + 0.5 * (b - a) * t;
            nodes.push(x * x);
            weights.push(0.5 * (b - a) * weight * 2.0 * x);
        }
    }
    let found = equilibrium.basis.equilibria(&equilibrium.problem, &nodes, &mut || true);
    let term = |e: &Evaluation, weight: f64| weight * (e.force - line(e.approach)) * e.slopes()[0];
    let mut area = -found.iter().zip(&weights).map(|(e, weight)| term(e, *weight)).sum::<f64>();
    if let (None, Control::Stiffness(k)) = (after, control) {
        // From δ = 0 along P = 0 to the slack spring at δ = Δ*.
        area += 0.5 * k * value * value;
    }
    (found.len() == nodes.len()).then_some(area)
}
