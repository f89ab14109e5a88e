//! The quasi-static path of an exact disc: its limit points, landings and losses, from the closed form alone.
//!
//! The device prescribes c = δ, P or δ + P/k. Along the curve of a [`Disc`] both c(s) and its slope are known,
//!
//! ```text
//! c' = δ',  P'  or  δ' + P'/k          δ' = g' − T/(2s),   P' = 2E*(sδ' − T)
//! stable         c' > 0
//! limit point    c' = 0                on unloading a minimum of c over s: the edge runs inward, c held at c*
//! landing        c(s) = c*, c' > 0     the next such s inward; none left is the pull-off
//! loss           the drop of U,  U − P*δ  or  U + ½k(Δ* − δ)²
//! ```
//!
//! Sign changes of c' are looked for on a grid much finer than the waves, and each is halved down to rounding. Between
//! two limit points c is monotone, so a landing lies between two nodes and is halved likewise. Nothing here depends on
//! a basis, on Newton or on continuation, so it can judge them. The path is that of P. R. Guduru, J. Mech. Phys. Solids
//! 55, 445 (2007), doi:10.1016/j.jmps.2006.09.004, and of Fig. 10 of the paper.

use super::disc::{Disc, ExactEquilibrium};
use crate::problem::Control;
use crate::root;

/// Steps of the grid per wave: two limit points closer than this share of a wave would be overlooked.
const STEPS_PER_WAVE: f64 = 200.0;

/// Largest step relative to the radius: towards s = 0 the curve behaves like √s.
const STEP_RATIO: f64 = 0.01;

/// Smallest step as a fraction of the largest radius, so that the grid stays finite for any number of waves.
const LEAST_STEP: f64 = 1e-5;

/// How far inward a path is followed, as a fraction of its first radius: adhesion alone dominates long before.
pub const INWARD_REACH: f64 = 1e-4;

/// How far outward a stable state is looked for, as a multiple of the radius asked for.
pub const OUTWARD_REACH: f64 = 1000.0;

/// A limit point of a control on an exact curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactLimit {
    /// Whether the control has a minimum there along s: the edge leaves it on unloading. Otherwise it has a maximum.
    pub minimum: bool,
    /// The state.
    pub state: ExactEquilibrium,
}

/// One instability of an exact path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactJump {
    /// c*, the value of the controlled quantity at which it happens.
    pub control_value: f64,
    /// The limit point.
    pub before: ExactEquilibrium,
    /// The landing; `None` for the pull-off.
    pub after: Option<ExactEquilibrium>,
    /// The energy lost; `None` for a pull-off under a dead load, where it has no bound.
    pub dissipated: Option<f64>,
}

/// The exact unloading.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactPath {
    /// What was controlled.
    pub control: Control,
    /// The first state, which is stable: if the one asked for is not, the edge first runs outward from it.
    pub start: ExactEquilibrium,
    /// The instabilities in order. Only the last can be a pull-off; without a pull-off the disc shrinks to nothing, as
    /// it does without adhesion.
    pub jumps: Vec<ExactJump>,
}

/// A radius of the grid, or a limit point among them.
#[derive(Debug, Clone, Copy)]
struct GridNode {
    radius: f64,
    /// c there.
    value: f64,
    /// Whether it is a limit point, and if so, whether a minimum.
    minimum: Option<bool>,
}

fn value(disc: &dyn Disc, control: Control, s: f64) -> f64 {
    control.value(disc.approach(s), disc.force(s))
}

fn slope(disc: &dyn Disc, control: Control, s: f64) -> f64 {
    let (approach, force) = disc.slopes(s);
    control.value(approach, force)
}

/// Radii from `from` inward to `to`, both included.
fn grid(disc: &dyn Disc, from: f64, to: f64) -> Vec<f64> {
    let wave = disc.wave().map_or(f64::INFINITY, |wave| wave / STEPS_PER_WAVE).max(LEAST_STEP * from);
    let inner = std::iter::successors(Some(from), |s| Some(s - wave.min(STEP_RATIO * s)));
    inner.take_while(|s| *s > to).chain([to]).collect()
}

/// The grid with the limit points of `control` among its radii, running inward.
fn nodes(disc: &dyn Disc, control: Control, from: f64, to: f64) -> Vec<GridNode> {
    let node = |radius, minimum| GridNode { radius, value: value(disc, control, radius), minimum };
    let mut nodes = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    for s in grid(disc, from, to) {
        let here = slope(disc, control, s);
        if let Some((outer, rise)) = before.filter(|(_, rise)| (*rise > 0.0) != (here > 0.0)) {
            // Just outside a minimum the control grows with s.
            nodes.push(node(root::sign_change(outer, s, |s| slope(disc, control, s)), Some(rise > 0.0)));
        }
        nodes.push(node(s, None));
        before = Some((s, here));
    }
    nodes
}

/// The limit points of `control` between the radii `from` and `to < from`, running inward.
pub fn limit_points(disc: &dyn Disc, control: Control, from: f64, to: f64) -> Vec<ExactLimit> {
    let found: Vec<(f64, bool)> = nodes(disc, control, from, to)
        .into_iter()
        .filter_map(|node| node.minimum.map(|minimum| (node.radius, minimum)))
        .collect();
    let radii: Vec<f64> = found.iter().map(|(radius, _)| *radius).collect();
    disc.curve(&radii)
        .into_iter()
        .zip(found)
        .map(|(state, (_, minimum))| ExactLimit { minimum, state })
        .collect()
}

/// The smallest value of the quantity held by `control` between the radii `from` and `to < from`.
pub fn least(disc: &dyn Disc, control: Control, from: f64, to: f64) -> f64 {
    nodes(disc, control, from, to).into_iter().map(|node| node.value).fold(f64::INFINITY, f64::min)
}

/// The radius asked for, or, if it is not stable under `control`, the next stable one outward.
fn stable_start(disc: &dyn Disc, control: Control, from: f64) -> Option<f64> {
    if slope(disc, control, from) > 0.0 {
        return Some(from);
    }
    let held = value(disc, control, from);
    let mut reach = from;
    while reach < OUTWARD_REACH * from {
        let inner = reach;
        reach = (1.5 * reach).min(OUTWARD_REACH * from);
        let nodes = nodes(disc, control, reach, inner);
        let risen = nodes.windows(2).rfind(|pair| pair[0].value >= held && pair[1].value < held);
        if let Some([outer, inner]) = risen {
            return Some(root::sign_change(outer.radius, inner.radius, |s| value(disc, control, s) - held));
        }
    }
    None
}

/// Unloads an exact disc under `control` from the contact radius `from > 0`.
///
/// `None` if that state is unstable and there is no stable one outward up to [`OUTWARD_REACH`].
pub fn unload(disc: &dyn Disc, control: Control, from: f64) -> Option<ExactPath> {
    let start = stable_start(disc, control, from)?;
    let nodes = nodes(disc, control, start, INWARD_REACH * start);
    // The limit point and the landing of each jump, and c* between them.
    let mut jumps: Vec<(f64, f64, Option<f64>)> = Vec::new();
    let mut at = 0;
    while let Some(limit) = (at..nodes.len()).find(|&k| nodes[k].minimum == Some(true)) {
        let held = nodes[limit].value;
        let fallen = (limit + 1..nodes.len()).find(|&k| nodes[k].value <= held && nodes[k - 1].value > held);
        let landing = fallen.map(|k| {
            root::sign_change(nodes[k - 1].radius, nodes[k].radius, |s| value(disc, control, s) - held)
        });
        jumps.push((nodes[limit].radius, held, landing));
        let Some(k) = fallen else { break };
        at = k;
    }
    // One pass for the energies of all states.
    let radii: Vec<f64> = [start]
        .into_iter()
        .chain(jumps.iter().flat_map(|(before, _, after)| [Some(*before), *after]).flatten())
        .collect();
    let mut states = disc.curve(&radii).into_iter();
    let start = states.next()?;
    let jumps = jumps
        .into_iter()
        .map_while(|(_, control_value, landing)| {
            let before = states.next()?;
            let after = landing.and_then(|_| states.next());
            let dissipated = loss(control, control_value, &before, after.as_ref());
            Some(ExactJump { control_value, before, after, dissipated })
        })
        .collect();
    Some(ExactPath { control, start, jumps })
}

/// The drop in the potential of bodies and device in a jump, with the control held at `value`.
fn loss(
    control: Control,
    value: f64,
    before: &ExactEquilibrium,
    after: Option<&ExactEquilibrium>,
) -> Option<f64> {
    let (approach, energy) = match (after, control) {
        (Some(after), _) => (after.approach, after.energy),
        (None, Control::Force) => return None,
        // Apart: no energy in the bodies, and a slack spring, with δ = Δ*.
        (None, _) => (value, 0.0),
    };
    let given = before.approach - approach;
    let device = match control {
        Control::Displacement => 0.0,
        Control::Force => -value * given,
        // ½k[(Δ* − δ)² − (Δ* − δ_after)²], as a product.
        Control::Stiffness(k) => -0.5 * k * given * (2.0 * value - before.approach - approach),
    };
    Some(before.energy - energy + device)
}
