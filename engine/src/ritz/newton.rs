//! Newton-Raphson for one equilibrium state at a prescribed approach, force, or device position.
//!
//! With the pressure eliminated and the force linear in δ, the control fixes δ at every s exactly:
//!
//! ```text
//! δ + P(s, δ)/k = Δ   ⇒   dδ/ds|_Δ = −P_s/(P_δ + k)
//! ```
//!
//! and the second line of (19), in its root form (see [`super::functional`], [`crate::disc::exact`]), is one equation in s. From a
//! contact radius three times too large it takes the 5-6 rounds that the paper reports.

use crate::continuation::{Convergence, Criteria, NewtonFailure};
use crate::disc::{Basis, Evaluation};
use crate::problem::{Control, Reduced};

/// When Newton-Raphson stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonSettings {
    /// Largest residual relative to its scale. 1e-10: |√(G/γ) − 1| at the paper's accuracy.
    pub tolerance: f64,
    /// Most rounds allowed. 40: weak adhesion and states near limit points need up to 17.
    pub rounds: usize,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self { tolerance: 1e-10, rounds: 40 }
    }
}

/// A state found by Newton-Raphson.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolvedState {
    /// The basis' answer there.
    pub evaluation: Evaluation,
    /// Rounds needed.
    pub rounds: usize,
}

/// Why Newton-Raphson found no state.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SolveFailure {
    /// An iterate left the region where the equations are defined.
    #[error("Newton-Raphson left the contact at round {round}: s = {s:.6e} (reduced units)")]
    Left {
        /// The round.
        round: usize,
        /// The radius it reached.
        s: f64,
    },
    /// The iteration did not converge.
    #[error(transparent)]
    NotConverged(#[from] NewtonFailure),
}

/// An iterate this many times as far out as the first has lost its way, and evaluating it might need a new basis.
const FARTHEST: f64 = 1e3;

/// The weight 1/k of the force in the controlled quantity δ + P/k, and the weight of δ.
fn weights(control: Control) -> (f64, f64) {
    match control {
        Control::Displacement => (1.0, 0.0),
        Control::Force => (0.0, 1.0),
        Control::Stiffness(k) => (1.0, 1.0 / k),
    }
}

/// The equilibrium at which `control` takes `value`, starting from the contact radius `s`.
///
/// # Errors
/// [`SolveFailure`] with the round and the numbers; nothing is clamped on the way.
pub fn solve(
    basis: &dyn Basis,
    problem: &Reduced,
    control: Control,
    value: f64,
    mut s: f64,
    settings: NewtonSettings,
) -> Result<SolvedState, SolveFailure> {
    let (of_approach, of_force) = weights(control);
    let mut convergence = Convergence::new(Criteria::new(settings.tolerance, settings.rounds));
    let first = s;
    loop {
        let round = convergence.round();
        let mut delta = value;
        if of_force > 0.0 {
            let unloaded = basis.evaluate(problem, s, 0.0);
            delta =
                (value - of_force * unloaded.force) / (of_approach + of_force * unloaded.force_gradient[0]);
        }
        let evaluation = basis.evaluate(problem, s, delta);
        let residual = (evaluation.residual / evaluation.residual_scale).abs();
        if !residual.is_finite() {
            return Err(SolveFailure::Left { round, s });
        }
        if convergence.is_reached(residual)? {
            return Ok(SolvedState { evaluation, rounds: round });
        }
        let [r_d, r_s] = evaluation.residual_gradient;
        let [p_d, p_s] = evaluation.force_gradient;
        let follows = -of_force * p_s / (of_approach + of_force * p_d);
        let next = s - evaluation.residual / (r_s + r_d * follows);
        if !(next > 0.0 && next <= FARTHEST * first) {
            return Err(SolveFailure::Left { round, s: next });
        }
        convergence.corrected((next - s).abs() / s)?;
        s = next;
    }
}
