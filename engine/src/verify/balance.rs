//! The first law over a whole unloading: the work of the device is the increase of the energy stored in the bodies and
//! its spring, plus the losses in the instabilities.
//!
//! ```text
//! W = ∫ P dx = [U + P²/(2k)] at the end − at the start + Σ losses
//! ```
//!
//! x is the far end of the device: δ for fixed grips, Δ = δ + P/k for a spring, both at rest in a jump. A dead load
//! hangs on the bodies and so also moves in a jump, with P held. The integral runs along the stable pieces of the
//! curve, which are solved again at the nodes of a Gauss rule, and does not use energies. A pull-off leaves nothing
//! stored; under a dead load, where its loss has no bound, the balance ends at the last limit point.
//!
//! It holds in any basis, as in theory, because the functional is stationary in s: dU = P dδ.

use super::row::VerifyRow;
use crate::problem::Control;
use crate::quasistatic::places::radii;
use crate::quasistatic::{Curve, Equilibrium, Path, PathState};
use gauss_quad::GaussLegendre;

/// Steps of the Gauss rule per wave, with eight nodes each, and the largest step relative to the radius: far finer than
/// the bound needs.
const STEPS_PER_WAVE: f64 = 10.0;
const RATIO: f64 = 0.025;

/// Nodes of each step.
const NODES: usize = 8;

/// The largest share of the energy turned over that may be unaccounted for.
const BOUND: f64 = 1e-9;

/// What the difference of two numbers of ours is divided by: the loss, or the energy turned over.
pub const OWN_MEASURE: &str = "relative";

/// Work against stored and lost energy along `ours`, the unloading of `curve`.
pub fn row(curve: &Curve, ours: &Path) -> VerifyRow {
    const WHAT: &str = "device's work against stored and lost";
    let Some(work) = work(&curve.equilibrium, ours) else {
        return VerifyRow::own(WHAT, f64::NAN, f64::NAN, 1.0, BOUND);
    };
    let lost = ours.losses();
    let Some(start) = ours.start() else { return VerifyRow::own(WHAT, f64::NAN, f64::NAN, 1.0, BOUND) };
    let at_start = stored(ours.control, start);
    let at_end = match ours.events.last() {
        Some(last) if last.dissipated.is_none() => {
            last.before.as_ref().map_or(f64::NAN, |before| stored(ours.control, before))
        }
        Some(last) => last.after.as_ref().map_or(0.0, |after| stored(ours.control, after)),
        None => at_start,
    };
    let turned = work.abs().max(lost).max(at_start.abs()).max(at_end.abs());
    VerifyRow::own(WHAT, work, at_end - at_start + lost, turned, BOUND)
}

/// The energy of the bodies and of the spring.
fn stored(control: Control, state: &PathState) -> f64 {
    match control {
        Control::Displacement | Control::Force => state.energy,
        Control::Stiffness(k) => state.energy + 0.5 * state.force * state.force / k,
    }
}

/// The work of the device from the start to the last event.
fn work(equilibrium: &Equilibrium, ours: &Path) -> Option<f64> {
    let mut work = 0.0;
    let mut from = ours.start()?;
    for event in &ours.events {
        let before = event.before.as_ref()?;
        work += along(equilibrium, ours.control, from.contact_radius, before.contact_radius)?;
        let Some(after) = &event.after else { break };
        if ours.control == Control::Force {
            work += event.control_value * (after.approach - before.approach);
        }
        from = after;
    }
    Some(work)
}

/// ∫ P dx along the curve from one radius inward to another; `None` if the basis has no equilibrium somewhere between.
fn along(equilibrium: &Equilibrium, control: Control, from: f64, to: f64) -> Option<f64> {
    let rule = GaussLegendre::new(NODES.try_into().ok()?);
    let wave = equilibrium.problem.gap.feature_length();
    let steps = radii(from, to, RATIO, wave.map_or(f64::INFINITY, |wave| wave / STEPS_PER_WAVE));
    let mut solvable = true;
    let mut work = 0.0;
    for pair in steps.windows(2) {
        work += rule.integrate(pair[0], pair[1], |s| {
            let Some(e) = equilibrium.basis.equilibrium(&equilibrium.problem, s) else {
                solvable = false;
                return 0.0;
            };
            let [approach, force] = e.slopes();
            let way = match control {
                Control::Displacement | Control::Force => approach,
                Control::Stiffness(k) => approach + force / k,
            };
            e.force * way
        });
    }
    solvable.then_some(work)
}
