//! What a jump dissipates, computed twice.
//!
//! At constant control the device and the bodies together hold the potential
//!
//! ```text
//! displacement  U            force  U − Pδ            stiffness k  U + ½k(Δ − δ)² = U + P²/2k
//! ```
//!
//! A jump dissipates its drop. Along the curve dU = P dδ, so the drop is also the area between the curve and the control
//! line, in a form in which the stiffness does not appear,
//!
//! ```text
//! snap       ∫_{s₂}^{s₁} (P − P₁)(dδ/ds) ds + ½(P₁ − P₂)(δ₁ − δ₂)
//! pull-off   ∫₀^{s₁} (P − P₁)(dδ/ds) ds + P₁δ₁ + P₁²/2k
//! ```
//!
//! After a pull-off the curve goes on to s = 0 and then along P = 0 to where the spring is slack. Under a dead load there is
//! such place: the load falls for ever and no loss is reported. Both numbers are read from one table, so their
//! agreement checks the event and the quadrature, not the table.

use super::equilibrium::State;
use crate::disc::{Local, Place, Solution, sources::GAUSS};
use crate::problem::Control;

/// How often the loss of a jump is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Losses {
    /// Once, by the drop of the potential.
    Once,
    /// Also by the area between the curve and the control line, which costs far more: two independent numbers that
    /// must agree.
    Twice,
}

/// The potential of bodies and device at `state`, up to a constant of the control.
pub fn potential(control: Control, value: f64, state: &State) -> f64 {
    match control {
        Control::Displacement => state.energy,
        Control::Force => state.energy - value * state.approach,
        Control::Stiffness(k) => state.energy + 0.5 * state.force * state.force / k,
    }
}

/// The energy lost in a jump as the drop of the potential; `after` is `None` for a pull-off.
///
/// `None` for a pull-off under a dead load.
pub fn loss(control: Control, before: &State, after: Option<&State>) -> Option<f64> {
    let Some(after) = after else {
        return (control != Control::Force).then(|| potential(control, 0.0, before));
    };
    // The device's part as a product: its energy can be a billion times the loss, and a difference would cancel. The
    // spring shortens by δ₁ − δ₂ = (P₂ − P₁)/k, which is taken from where it has more digits.
    let opened = before.approach - after.approach;
    let device = match control {
        Control::Displacement => 0.0,
        Control::Force => -before.force * opened,
        Control::Stiffness(k) => {
            let is_soft = k * before.approach.abs() < before.force.abs();
            let shortened = if is_soft { -opened } else { (before.force - after.force) / k };
            0.5 * (before.force + after.force) * shortened
        }
    };
    Some(before.energy - after.energy + device)
}

/// ∫ (dΠ/dc) dc along the curve from one place to another: `∫ P dδ` under displacement, `−∫ δ dP` under a dead load,
/// `∫ P (dδ + dP/k)` behind a spring. `None` where the basis has no equilibrium on the way.
pub fn work(solution: &dyn Solution, control: Control, from: Place, to: Place) -> Option<f64> {
    let is_inward = (to.panel, to.x) <= (from.panel, from.x);
    let (inner, outer, sign) = if is_inward { (to, from, -1.0) } else { (from, to, 1.0) };
    let by_panel = |weight: f64, at: &Local| match control {
        Control::Displacement => weight * at.force * at.slopes[0],
        Control::Force => -weight * at.approach * at.slopes[1],
        Control::Stiffness(k) => weight * at.force * (at.slopes[0] + at.slopes[1] / k),
    };
    let mut sum = 0.0;
    for panel in inner.panel..=outer.panel {
        if panel < outer.panel && !solution.is_joined(panel) {
            return None;
        }
        let from = if panel == inner.panel { inner.x } else { -1.0 };
        let to = if panel == outer.panel { outer.x } else { 1.0 };
        sum = on_panel(solution, panel, [from, to], sum, &by_panel);
    }
    Some(sign * sum)
}

/// Adds to `sum` the integral over a part of a panel by its own variable: `f` is the integrand at a state, times a weight.
fn on_panel(
    solution: &dyn Solution,
    panel: usize,
    [from, to]: [f64; 2],
    mut sum: f64,
    f: &dyn Fn(f64, &Local) -> f64,
) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let [_, width] = solution.span(panel).line();
    for four in GAUSS.as_chunks::<4>().0 {
        let found = solution.at_four(panel, four.map(|[x, _]| middle + half * x));
        for (at, [_, weight]) in found.iter().zip(four) {
            sum += f(weight * half * width, at);
        }
    }
    sum
}

/// The energy lost in a jump as the area between the curve and the control line, from `before` to `after`.
///
/// Across a narrow hole, and across a border where zones change from one root to another, the work is the step in
/// energy.
/// `None` for a pull-off under a dead load, or where the basis has no equilibrium on the way.
pub fn area(solution: &dyn Solution, control: Control, before: Place, after: Option<Place>) -> Option<f64> {
    let line = solution.at(before);
    let compliance = match control {
        Control::Displacement => 0.0,
        Control::Force if after.is_none() => return None,
        Control::Force => f64::INFINITY,
        Control::Stiffness(k) => 1.0 / k,
    };
    let end = after.unwrap_or(Place { panel: 0, x: -1.0 });
    // An outward jump passes the same stretch in the other direction.
    let is_inward = (end.panel, end.x) <= (before.panel, before.x);
    let (end, before, sign) = if is_inward { (end, before, 1.0) } else { (before, end, -1.0) };
    let in_zones = solution.edges(before).zone.is_some();
    let mut sum = 0.0;
    for panel in end.panel..=before.panel {
        let is_joined = panel == before.panel || solution.is_joined(panel);
        if !is_joined && !solution.is_passed(panel) {
            return None;
        }
        if panel < before.panel && (in_zones || !is_joined) {
            let [inner, outer] = [Place { panel, x: 1.0 }, Place { panel: panel + 1, x: -1.0 }];
            let step = solution.at(outer).approach - solution.at(inner).approach;
            sum += solution.energy(outer) - solution.energy(inner) - line.force * step;
        }
        if panel == 0 && after.is_none() {
            // To the axis: where adhesion alone rules, δ is a power of √s.
            let span = solution.span(0);
            let outer = if before.panel == 0 { solution.radius(before) } else { span.hi };
            let [from, to] = [span.lo.sqrt(), outer.sqrt()];
            for [x, weight] in GAUSS.iter() {
                let root = 0.5 * (from + to) + 0.5 * (to - from) * x;
                let at = solution.at(Place { panel, x: span.place(root * root) });
                let slope = at.slopes[0] / at.stretch * 2.0 * root;
                sum += 0.5 * (to - from) * weight * (at.force - line.force) * slope;
            }
            continue;
        }
        let from = if panel == end.panel { end.x } else { -1.0 };
        let to = if panel == before.panel { before.x } else { 1.0 };
        let above = |weight: f64, at: &Local| weight * (at.force - line.force) * at.slopes[0];
        sum = on_panel(solution, panel, [from, to], sum, &above);
    }
    if let Some(to) = after.map(|place| solution.at(place)) {
        return Some(sign * sum + 0.5 * (line.force - to.force) * (line.approach - to.approach));
    }
    // Rings begin slightly outside the axis: to rounding, what is missing there is a rectangle.
    let first = solution.at(end);
    let rest = (first.force - line.force) * first.approach;
    Some(sum + rest + line.force * line.approach + 0.5 * line.force * line.force * compliance)
}
