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
//!
//! The area is taken in stretches between the knots of the gap, in x with s = base + x²: at the knot the curve is a power of
//! √(s − base), and where adhesion alone rules, towards s = 0, so is δ.

use super::equilibrium::{Equilibrium, State};
use crate::contact::breaks::Stretch;
use crate::contact::{Control, Gap};
use crate::ritz::Order;
use gauss_quad::GaussLegendre;

/// Nodes of Gauss's rule in each piece of the area. 12: on a third of a wave the two losses agree to rounding.
const NODES: usize = 12;

/// Pieces of the area per wave of the gap.
const PIECES_PER_WAVE: f64 = 3.0;

/// Fewest pieces: a gap that is steep but has no waves is a polynomial of high degree in one.
const FEWEST_PIECES: f64 = 3.0;

/// Most pieces: a thousand waves.
const MOST_PIECES: f64 = 2000.0;

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
    let to = after.unwrap_or(0.0);
    let (radii, weights) = area_rule(&equilibrium.problem.gap, before, to)?;
    let solved = equilibrium.basis.equilibria(&equilibrium.problem, &radii, Order::Slopes, &mut || true);
    if solved.len() < radii.len() {
        return None;
    }
    let line = |delta: f64| match control {
        Control::Displacement => 0.0,
        Control::Force => value,
        Control::Stiffness(k) => k * (value - delta),
    };
    let mut area: f64 = solved
        .iter()
        .zip(&weights)
        .map(|(e, weight)| -(e.force - line(e.approach)) * e.slopes()[0] * weight)
        .sum();
    if let (None, Control::Stiffness(k)) = (after, control) {
        // From δ = 0 along P = 0 to the slack spring at δ = Δ*.
        area += 0.5 * k * value * value;
    }
    Some(area)
}

/// Radii from `before` inward to `to`, with the weights of ∫ ds.
fn area_rule(gap: &dyn Gap, before: f64, to: f64) -> Option<(Vec<f64>, Vec<f64>)> {
    let rule = GaussLegendre::new(NODES.try_into().ok()?);
    let breaks = gap.breaks();
    let broken = !breaks.between(to, before).is_empty();
    let (mut radii, mut weights) = (Vec::new(), Vec::new());
    for Stretch { from, to, base } in breaks.stretches(to, before).rev() {
        let waves = gap.feature_length().map_or(0.0, |wave| (to - from) / wave);
        let fewest = if broken { 1.0 } else { FEWEST_PIECES };
        let pieces = (PIECES_PER_WAVE * waves).ceil().clamp(fewest, MOST_PIECES);
        let edge = |piece: f64| (to + (from - to) * (piece / pieces).min(1.0) - base).max(0.0).sqrt();
        let mut piece = 0.0;
        while piece < pieces {
            let (a, b) = (edge(piece), edge(piece + 1.0));
            let node = |x: f64| 0.5 * ((a + b) + (b - a) * x);
            radii.extend(rule.iter().map(|(x, _)| base + node(*x).powi(2)));
            weights.extend(rule.iter().map(|(x, weight)| (b - a) * weight * node(*x)));
            piece += 1.0;
        }
    }
    Some((radii, weights))
}
