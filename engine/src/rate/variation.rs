//! How a pull changes with its values: the variational equation, solved along with each step.
//!
//! ```text
//! η = ∂y/∂θ at held ξ:     dη/dξ = φ_y η + φ_θ     (1 − h φ_y A) q = φ_y η₀ + φ_θ,     η = η₀ + h b·q
//! ```
//!
//! `φ_θ` is the derivative at held ξ, y, `L_s` and `L_t`. The equation is solved with the stages of the step that was
//! taken, so it gives the derivatives of the numbers that the pull has, whatever their error. It covers one stretch of
//! an opening edge, and the rest before it.

use super::equation::{Equation, HeldDisc, StretchMoment};
use super::radau::{STAGES, WEIGHTS};
use super::record::Moment;
pub use super::record::{MomentSlopes, VALUES};
use super::step::SolvedStep;
use crate::elementary::ln;
use crate::problem::Control;
use nalgebra::SMatrix;
use std::f64::consts::TAU;

/// The index of γ among the values.
pub const ADHESION: usize = 0;
/// The index of n.
pub const EXPONENT: usize = 1;
/// The index of V.
pub const RATE: usize = 2;
/// The index of k.
pub const STIFFNESS: usize = 3;
/// The index of s₀.
pub const START: usize = 4;

/// The variation of one stretch.
pub struct Variation<'a> {
    equation: &'a Equation<'a>,
    /// How c₀ changes with each value.
    begin: [f64; VALUES],
    /// η.
    eta: [f64; VALUES],
}

/// How the place named by ξ and y changes with each value: s, c, and K at held s and c.
struct PlaceSlopes {
    radius: [f64; VALUES],
    control: [f64; VALUES],
    opening: [f64; VALUES],
}

impl<'a> Variation<'a> {
    /// The variation of a stretch that begins in equilibrium, with the disc `start`.
    pub fn new(equation: &'a Equation<'a>, start: &HeldDisc) -> Self {
        let Equation { control, radius: s, adhesion, .. } = *equation;
        let root = (TAU * adhesion * s).sqrt();
        let mut begin = [0.0; VALUES];
        let by = |delta: f64, force: f64| control.value(delta, force);
        begin[ADHESION] = by(-0.5 * root, -s * root);
        let slope = start.slope - 0.5 * root / s;
        begin[START] = s * by(slope, 2.0 * (s * slope - root));
        if let Control::Stiffness(k) = control {
            begin[STIFFNESS] = -start.force / k;
        }
        Self { equation, begin, eta: [0.0; VALUES] }
    }

    /// What changes at held ξ and y; `passed` is the time since the stretch began.
    fn named(&self, held: &HeldDisc, passed: f64) -> PlaceSlopes {
        let mut radius = [0.0; VALUES];
        radius[START] = self.equation.radius;
        let mut control = self.begin;
        control[RATE] += self.equation.rate * passed;
        let mut opening = [0.0; VALUES];
        if let Control::Stiffness(k) = self.equation.control {
            opening[STIFFNESS] = -held.force / (k + 2.0 * held.contact_radius);
        }
        PlaceSlopes { radius, control, opening }
    }

    /// `φ_θ`.
    fn of_phi(&self, at: &StretchMoment) -> [f64; VALUES] {
        let equation = self.equation;
        let held = &at.held;
        let named = self.named(held, at.time - equation.time);
        let s = held.contact_radius;
        let root = (TAU * equation.adhesion * s).sqrt();
        let kappa = held.opening / root;
        let by_radius = (held.slope - held.by_radius) / root - 0.5 * kappa / s;
        let [speed, by_drive] = equation.branch.speed(at.drive);
        let (along, in_time) = (speed / equation.radius, 1.0 / equation.unit_of_time);
        let whole = along.abs() + in_time;
        let by_speed = in_time / (whole * whole) / equation.radius;
        std::array::from_fn(|value| {
            let mut kappa_moved = by_radius * named.radius[value]
                + (named.opening[value] - held.by_control * named.control[value]) / root;
            let mut moved = 0.0;
            match value {
                ADHESION => kappa_moved -= 0.5 * kappa,
                // v = X^{1/n}
                EXPONENT if speed != 0.0 => moved = -speed * ln(at.drive.abs()) / equation.branch.exponent,
                _ => {}
            }
            by_speed * (moved + by_drive * 2.0 * kappa * kappa_moved)
        })
    }

    /// The change of a moment if y changes by `eta`.
    fn moved(&self, held: &HeldDisc, passed: f64, eta: [f64; VALUES]) -> MomentSlopes {
        let equation = self.equation;
        let named = self.named(held, passed);
        std::array::from_fn(|value| {
            let s = named.radius[value] + equation.motion.sense() * equation.radius * eta[value];
            let c = named.control[value] - equation.rate * equation.unit_of_time * eta[value];
            let delta = held.by_radius * s + held.by_control * c - named.opening[value];
            [s, delta, 2.0 * (held.contact_radius * delta - held.opening * s)]
        })
    }

    /// The change of a moment of the rest before the stretch.
    pub fn resting(&self, moment: &Moment) -> MomentSlopes {
        let Equation { panels, control, .. } = *self.equation;
        let held = HeldDisc::new(panels, control, moment.contact_radius, moment.control);
        self.moved(&held, 0.0, [0.0; VALUES])
    }

    /// The changes of the moments of a step; NaN where there are none.
    pub fn step(&mut self, step: &SolvedStep) -> [MomentSlopes; STAGES] {
        let h = step.length;
        let mut matrix = SMatrix::<f64, STAGES, STAGES>::zeros();
        let mut right = SMatrix::<f64, STAGES, VALUES>::zeros();
        for (i, node) in step.nodes.iter().enumerate() {
            // A steep row would drown the others.
            let share = 1.0 / (1.0 + (h * WEIGHTS[i][i] * node.phi_by_y).abs());
            let steepness = share * node.phi_by_y;
            for (j, weight) in WEIGHTS[i].iter().enumerate() {
                matrix[(i, j)] = -h * weight * steepness;
            }
            matrix[(i, i)] += share;
            for (value, of_phi) in self.of_phi(node).into_iter().enumerate() {
                right[(i, value)] = share * of_phi + steepness * self.eta[value];
            }
        }
        let Some(slopes) = matrix.lu().solve(&right) else {
            self.eta = [f64::NAN; VALUES];
            return [[[f64::NAN; 3]; VALUES]; STAGES];
        };
        let eta = |i: usize| -> [f64; VALUES] {
            let along = |value: usize| (0..STAGES).map(|j| WEIGHTS[i][j] * slopes[(j, value)]).sum::<f64>();
            std::array::from_fn(|value| self.eta[value] + h * along(value))
        };
        let etas: [[f64; VALUES]; STAGES] = std::array::from_fn(eta);
        let moved = std::array::from_fn(|i| {
            let node = &step.nodes[i];
            self.moved(&node.held, node.time - self.equation.time, etas[i])
        });
        self.eta = etas[STAGES - 1];
        moved
    }
}
