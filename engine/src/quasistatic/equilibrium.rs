//! The contact as a system of equations for the continuation.
//!
//! Unknowns y = (δ/δ₀, P/P₀, s/s₀), scaled by the ranges of the curve, and two equations
//!
//! ```text
//! ρ(s, δ) = 0            the equilibrium residual of the basis
//! P − P(s, δ) = 0        the force it goes with
//! ```
//!
//! Stability follows from the curve: with tension at the edge `P_s < 0`, and the condition
//! `−F_s (P_δ + k) − P_s² > 0` is the same as d(δ + P/k)/ds > 0 along the curve. Under displacement control
//! that is dδ/ds > 0, under force control dP/ds > 0.
//!
//! In stiffnesses: along the curve dP/dδ = `P_δ + P_s/(dδ/ds)`, which is below the contact's own stiffness `P_δ` where
//! displacement control is stable and above it where not. So a state with tension at the edge is stable under a device
//! of stiffness k exactly when
//!
//! ```text
//! −k < dP/dδ < P_δ
//! ```

use super::admissible::{Admissibility, Judge};
use crate::continuation::{self, ColumnView, Linearization, MatrixMut, System, Vector};
use crate::disc::{Basis, Evaluation, Table};
use crate::elementary::{exp2, log2};
use crate::problem::{Control, Reduced, Units};
use crate::progress::{Progress, Stopped};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::sync::Arc;

/// The unit of each unknown: the ranges of δ, P and s over the curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scales {
    /// δ₀.
    #[serde(with = "crate::exact")]
    pub approach: f64,
    /// P₀.
    #[serde(with = "crate::exact")]
    pub force: f64,
    /// s₀.
    #[serde(with = "crate::exact")]
    pub contact_radius: f64,
}

impl Scales {
    /// The ranges over states (δ, P, s), as powers of two; a quantity that does not vary is scaled by its size.
    ///
    /// Powers of two cost no digits: a state comes back from the unknowns exactly as it went in.
    pub fn of(states: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let empty = [f64::INFINITY, f64::NEG_INFINITY, 0.0];
        let mut ranges = [empty; 3];
        for state in states {
            for (range, x) in ranges.iter_mut().zip(state) {
                *range = [range[0].min(x), range[1].max(x), range[2].max(x.abs())];
            }
        }
        let scale = |[lo, hi, size]: [f64; 3]| {
            let range = hi - lo;
            let found = [range, size].into_iter().find(|x| x.is_finite() && *x > 0.0).unwrap_or(1.0);
            exp2(log2(found).round())
        };
        let [approach, force, contact_radius] = ranges.map(scale);
        Self { approach, force, contact_radius }
    }

    /// δ, P and s of the unknowns.
    pub fn quantities(&self, y: ColumnView<'_>) -> [f64; 3] {
        [y[0] * self.approach, y[1] * self.force, y[2] * self.contact_radius]
    }

    /// The slopes of the curve at a point.
    pub fn stability(&self, point: &StatePoint) -> Stability {
        let [delta, force, s] = self.quantities(point.tangent());
        Stability { approach: delta / s, force: force / s }
    }
}

/// One equilibrium state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// s.
    #[serde(with = "crate::exact")]
    pub contact_radius: f64,
    /// δ.
    #[serde(with = "crate::exact")]
    pub approach: f64,
    /// P.
    #[serde(with = "crate::exact")]
    pub force: f64,
    /// U, the total energy of the bodies.
    #[serde(with = "crate::exact")]
    pub energy: f64,
}

impl State {
    /// The same state in the user's units.
    #[must_use]
    pub fn in_units(&self, units: &Units) -> Self {
        Self {
            contact_radius: self.contact_radius * units.length,
            approach: self.approach * units.length,
            force: self.force * units.force,
            energy: self.energy * units.energy,
        }
    }
}

/// The slopes of the curve at a state, from which the stability under every control follows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// dδ/ds.
    #[serde(with = "crate::exact")]
    pub approach: f64,
    /// dP/ds.
    #[serde(with = "crate::exact")]
    pub force: f64,
}

impl Stability {
    /// Whether the state is stable when `control` is held.
    pub fn under(&self, control: Control) -> bool {
        control.value(self.approach, self.force) > 0.0
    }
}

/// How the force and the contact area respond to the approach at a state.
///
/// Units: a force per length, and a length.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stiffness {
    /// `P_δ` = ∂P/∂δ at a fixed contact radius: the stiffness of the contact itself.
    #[serde(with = "crate::exact")]
    pub contact: f64,
    /// dP/dδ along the curve; infinite at a limit point of the approach, with the sign that rounding leaves it; not a
    /// number at a corner of the curve, where there are two slopes.
    #[serde(with = "crate::exact")]
    pub tangent: f64,
    /// dA/dδ along the curve, A = πs² the contact area; infinite, or not a number, where `tangent` is.
    #[serde(with = "crate::exact")]
    pub area_slope: f64,
}

impl Stiffness {
    /// The same in the user's units.
    #[must_use]
    pub fn in_units(self, units: &Units) -> Self {
        Self {
            contact: self.contact * units.stiffness,
            tangent: self.tangent * units.stiffness,
            area_slope: self.area_slope * units.length,
        }
    }
}

/// A reduced problem, its basis and the scales of its curve.
#[derive(Debug, Clone)]
pub struct Equilibrium {
    /// The problem.
    pub problem: Reduced,
    /// The discretization.
    pub basis: Arc<dyn Basis>,
    /// The table of the gap, by which states are judged.
    pub table: Arc<Table>,
    /// The unit of each unknown.
    pub scales: Scales,
}

/// A state with the frame of the curve there.
pub type StatePoint = continuation::Point;

/// Three numbers that go with the unknowns: their values, or the row of a control.
pub type Unknowns = Vector;

/// The number of unknowns and their indices.
pub mod unknown {
    /// Three.
    pub const COUNT: usize = 3;
    /// δ/δ₀.
    pub const APPROACH: usize = 0;
    /// P/P₀.
    pub const FORCE: usize = 1;
    /// s/s₀.
    pub const CONTACT_RADIUS: usize = 2;
}

impl Equilibrium {
    /// The unknowns of a state.
    pub fn unknowns_of(&self, e: &Evaluation) -> Unknowns {
        let Scales { approach, force, contact_radius } = self.scales;
        vec![e.approach / approach, e.force / force, e.contact_radius / contact_radius].into()
    }

    /// δ, P and s of the unknowns.
    pub fn quantities(&self, y: ColumnView<'_>) -> [f64; 3] {
        self.scales.quantities(y)
    }

    /// s of a point.
    pub fn contact_radius(&self, point: &StatePoint) -> f64 {
        point.y()[unknown::CONTACT_RADIUS] * self.scales.contact_radius
    }

    /// The row of a control: row · y is the controlled quantity.
    pub fn control_row(&self, control: Control) -> Unknowns {
        let Scales { approach, force, .. } = self.scales;
        let row = match control {
            Control::Displacement => [approach, 0.0, 0.0],
            Control::Force => [0.0, force, 0.0],
            Control::Stiffness(k) => [approach, force / k, 0.0],
        };
        row.to_vec().into()
    }

    /// The state at a point, its energy evaluated there.
    pub fn state(&self, point: &StatePoint) -> State {
        let [delta, force, s] = self.quantities(point.y());
        let energy = self.basis.evaluate(&self.problem, s, delta).energy;
        State { contact_radius: s, approach: delta, force, energy }
    }

    /// The judge of whether a state is admissible.
    pub fn judge(&self) -> Judge {
        Judge::new(&self.problem, &self.table)
    }

    /// Whether the state of a point is admissible; where `progress` says stop, nothing is known of the gap outside.
    pub fn admissibility(&self, point: &StatePoint, progress: &dyn Progress) -> Admissibility {
        let [delta, _, s] = self.quantities(point.y());
        self.judge().judge(s, delta, progress)
    }

    /// The slopes of the curve at a point.
    pub fn stability(&self, point: &StatePoint) -> Stability {
        self.scales.stability(point)
    }

    /// The state and the stiffnesses at a point, energy and `P_δ` evaluated there.
    pub fn state_and_stiffness(&self, point: &StatePoint) -> (State, Stiffness) {
        let [delta, _, s] = self.quantities(point.y());
        self.known(point, &self.basis.evaluate(&self.problem, s, delta))
    }

    /// The same at each of `points`.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn states_and_stiffnesses(
        &self,
        points: &[StatePoint],
        progress: &dyn Progress,
    ) -> Result<Vec<(State, Stiffness)>, Stopped> {
        let place = |point: &StatePoint| {
            let [delta, _, s] = self.quantities(point.y());
            [s, delta]
        };
        let places: Vec<[f64; 2]> = points.iter().map(place).collect();
        let found = self.basis.evaluations(&self.problem, &places, progress);
        let all = points.iter().zip(&found).map(|(point, here)| self.known(point, here));
        if found.len() == points.len() { Ok(all.collect()) } else { Err(Stopped) }
    }

    /// The state and the stiffnesses at a point, already evaluated as `here`.
    fn known(&self, point: &StatePoint, here: &Evaluation) -> (State, Stiffness) {
        /// The largest slope of the scaled approach along the curve, `t_δ`, that remains at a located limit point.
        const ROUNDING: f64 = 1e-10;
        let [delta, force, s] = self.quantities(point.y());
        let [along_delta, along_force, along_s] = self.quantities(point.tangent());
        let turns = point.tangent()[unknown::APPROACH].abs() <= ROUNDING;
        let corner = self.table.has_corner(s);
        let per_approach = |slope: f64| {
            if corner {
                return f64::NAN;
            }
            let ratio = slope / along_delta;
            if turns { f64::INFINITY.copysign(ratio) } else { ratio }
        };
        let stiffness = Stiffness {
            contact: here.force_gradient[0],
            tangent: per_approach(along_force),
            area_slope: per_approach(2.0 * PI * s * along_s),
        };
        (State { contact_radius: s, approach: delta, force, energy: here.energy }, stiffness)
    }

    /// The state of radius `s` from the explicit root, as a point whose tangent runs inward.
    pub fn explicit(&self, s: f64) -> Option<StatePoint> {
        self.point(&self.basis.equilibrium(&self.problem, s)?)
    }

    /// The point of an evaluated equilibrium, its tangent running inward; `None` where the curve is singular.
    pub fn point(&self, evaluation: &Evaluation) -> Option<StatePoint> {
        let mut at = Linearization::new(unknown::COUNT);
        self.linearization(evaluation, evaluation.force, &mut at);
        StatePoint::new(self, &self.unknowns_of(evaluation), &at, &inward())
    }

    /// The two equations and their derivatives at an evaluated (s, δ) and the force `p`.
    fn linearization(&self, e: &Evaluation, p: f64, at: &mut Linearization) {
        let Scales { approach: d0, force: p0, contact_radius: s0 } = self.scales;
        let [r_d, r_s] = e.residual_gradient;
        let [p_d, p_s] = e.force_gradient;
        at.residual.copy_from_slice(&[e.residual, (p - e.force) / p0]);
        at.scale.copy_from_slice(&[e.residual_scale, e.force_scale.max(f64::MIN_POSITIVE) / p0]);
        // By columns.
        at.jacobian.copy_from_slice(&[r_d * d0, -p_d * d0 / p0, 0.0, 1.0, r_s * s0, -p_s * s0 / p0]);
        at.kept.clear();
        at.kept.extend(e.residual_second.iter().chain(&e.force_second));
    }
}

/// The direction in which a detachment runs: the contact radius shrinks.
pub fn inward() -> Unknowns {
    vec![0.0, 0.0, -1.0].into()
}

impl System for Equilibrium {
    fn unknowns(&self) -> usize {
        unknown::COUNT
    }

    fn linearize(&self, y: &Unknowns, at: &mut Linearization) -> Option<()> {
        let [delta, force, s] = self.quantities(y.column(0));
        if s.is_nan() || s <= 0.0 {
            return None;
        }
        self.linearization(&self.basis.evaluate(&self.problem, s, delta), force, at);
        Some(())
    }

    fn second(&self, at: &Linearization, v: &Unknowns, mut second: MatrixMut<'_>) -> Option<()> {
        let Scales { approach: d0, force: p0, contact_radius: s0 } = self.scales;
        let &[r_dd, r_ds, r_ss, p_dd, p_ds, p_ss] = at.kept.as_slice() else { return None };
        // Both depend only on δ and s.
        let rows = [[r_dd, r_ds, r_ss], [-p_dd / p0, -p_ds / p0, -p_ss / p0]].map(|[dd, ds, ss]| {
            let (dd, ds, ss) = (dd * d0 * d0, ds * d0 * s0, ss * s0 * s0);
            [dd * v[0] + ds * v[2], ds * v[0] + ss * v[2]]
        });
        let [[r_d, r_s], [p_d, p_s]] = rows;
        // By columns.
        second.copy_from_slice(&[r_d, p_d, 0.0, 0.0, r_s, p_s]);
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::fixtures;
    use crate::progress::Unwatched;
    use crate::quasistatic::Curve;

    /// Fig. 9 in the exact basis, whose energy has the digits that second differences need.
    fn swept() -> Curve {
        let mut preset = fixtures::preset("fig-9");
        preset.set("basis.kind", "exact".into()).unwrap();
        Case::new(&preset).unwrap().curve(&Unwatched).unwrap()
    }

    /// `U_ss`, `U_sδ` and `U_δδ` by central differences.
    fn hessian(equilibrium: &Equilibrium, s: f64, delta: f64) -> [f64; 3] {
        let (h, d) = (1e-4 * s, 1e-4 * s);
        let u = |i: f64, j: f64| {
            equilibrium.basis.evaluate(&equilibrium.problem, s + i * h, delta + j * d).energy
        };
        let ss = (u(1.0, 0.0) - 2.0 * u(0.0, 0.0) + u(-1.0, 0.0)) / (h * h);
        let sd = (u(1.0, 1.0) - u(1.0, -1.0) - u(-1.0, 1.0) + u(-1.0, -1.0)) / (4.0 * h * d);
        let dd = (u(0.0, 1.0) - 2.0 * u(0.0, 0.0) + u(0.0, -1.0)) / (d * d);
        [ss, sd, dd]
    }

    #[test]
    fn stability_is_the_curvature_of_the_potential_and_the_stiffness_between_its_bounds() {
        let curve = swept();
        let equilibrium = &curve.equilibrium;
        let mut judged = [0, 0];
        for at in curve.samples.iter().step_by(7) {
            let (delta, s) = (at.approach, at.contact_radius);
            let point = &equilibrium.explicit(s).unwrap();
            let [ss, sd, dd] = hessian(equilibrium, s, delta);
            let stiffness = equilibrium.state_and_stiffness(point).1;
            assert!((stiffness.contact / dd - 1.0).abs() < 1e-5, "{} {dd}", stiffness.contact);
            for k in [0.01, 0.15, 1.0, 20.0] {
                // The potential of bodies and device: its second derivatives are those of U, with k added to U_δδ.
                let determinant = ss * (dd + k) - sd * sd;
                if determinant.abs() < 1e-4 * (ss.abs() * (dd + k) + sd * sd) {
                    continue;
                }
                let stable = equilibrium.stability(point).under(Control::Stiffness(k));
                assert_eq!(stable, determinant > 0.0 && ss > 0.0, "s {s} k {k}");
                let between = -k < stiffness.tangent && stiffness.tangent < stiffness.contact;
                assert_eq!(stable, between, "s {s} k {k}: {stiffness:?}");
                judged[usize::from(stable)] += 1;
            }
        }
        assert!(judged[0] > 50 && judged[1] > 50, "{judged:?}");
    }

    #[test]
    fn the_slopes_are_those_of_neighbouring_states_and_infinite_at_a_limit_point() {
        let curve = swept();
        let equilibrium = &curve.equilibrium;
        for s in [0.48, 0.3, 0.2, 0.05] {
            let [before, after] = [s * (1.0 - 1e-5), s * (1.0 + 1e-5)].map(|s| {
                let point = equilibrium.explicit(s).unwrap();
                equilibrium.quantities(point.y())
            });
            let delta = after[0] - before[0];
            let stiffness = equilibrium.state_and_stiffness(&equilibrium.explicit(s).unwrap()).1;
            let area = PI * (after[2] * after[2] - before[2] * before[2]);
            assert!((stiffness.tangent * delta / (after[1] - before[1]) - 1.0).abs() < 1e-5, "{s}");
            assert!((stiffness.area_slope * delta / area - 1.0).abs() < 1e-5, "{s}");
        }
        let limits = curve.limit_points(Control::Displacement);
        assert!(limits.len() > 10);
        for limit in limits {
            let stiffness =
                equilibrium.state_and_stiffness(&equilibrium.explicit(limit.contact_radius).unwrap()).1;
            assert!(stiffness.tangent.is_infinite() && stiffness.area_slope.is_infinite(), "{stiffness:?}");
            assert!(stiffness.contact.is_finite());
        }
    }
}
