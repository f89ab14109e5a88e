//! The paper's ring elements, eqs. (13)-(18).
//!
//! N rings with edges `r̃_j = j/N` on the unit disc, scaled by the contact radius: the pressure is constant
//! on each ring, the gap piecewise linear between the N + 1 nodes `r̃_j`. All coefficients are closed forms:
//!
//! ```text
//! B̃_ab = second mixed difference of I over the edges of rings a and b         (N × N)
//! W̃_aj = ∫_ring a ψ_j dS = π d (x_a + d/3), π d (x_a + 2d/3) for j = a, a + 1  (N × (N+1))
//! ```
//!
//! `B̃ = LLᵀ` is factored once per N. The forms of [`super::functional`] are then dot products of the
//! vectors L⁻¹W̃v: one triangular solve per vector, never the N³ product K.
//!
//! Accuracy: for γ > 0 the contact radius is good to about 0.16/N and the force to 1.4/N (relative, JKR);
//! for γ = 0 the radius to 0.5/N and the force to 1/N².

use super::Basis;
use super::caution::Caution;
use super::functional::{Evaluation, Forms};
use super::kernel::disc_interaction;
use super::outside;
use crate::contact::{Gap, Reduced};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::f64::consts::PI;
use std::ops::RangeInclusive;
use std::sync::{Arc, Mutex, PoisonError};

/// The allowed number of rings: fewer than 4 resolve nothing, more than 2000 cost seconds and add no digits.
pub const RING_RANGE: RangeInclusive<usize> = 4..=2000;

/// Fewer rings than this per shortest wave in the largest contact is a warning: losses are then off by percents.
pub const RINGS_PER_WAVE: f64 = 10.0;

/// γ/(E* R) below which the error of 200 rings on a sphere exceeds the adhesion.
pub const WEAK_ADHESION: f64 = 1e-6;

/// How many factorizations are kept: enough to go back and forth between two meshes, 32 MB each at most.
const KEPT: usize = 3;

/// Why a ring basis could not be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RingsError {
    /// The number of rings is out of range.
    #[error("rings = {0} is out of range, allowed are {lo} to {hi}", lo = RING_RANGE.start(), hi = RING_RANGE.end())]
    OutOfRange(usize),
    /// The matrix of the pressures lost positive definiteness.
    #[error("the pressure matrix of {0} rings is not positive definite")]
    NotPositiveDefinite(usize),
}

/// Ring elements with their factored matrix; geometry independent, so one serves every problem.
#[derive(Debug)]
pub struct Rings {
    /// `r̃_j`, N + 1 of them.
    nodes: Vec<f64>,
    factor: Cholesky<f64, Dyn>,
    /// L⁻¹W̃1, and its square 1ᵀK1.
    ones: DVector<f64>,
    cc: f64,
}

impl Rings {
    /// N uniform rings; computed once per N and then shared.
    ///
    /// # Errors
    /// When `rings` is outside [`RING_RANGE`], or the matrix cannot be factored.
    pub fn shared(rings: usize) -> Result<Arc<Self>, RingsError> {
        static CACHE: Mutex<Vec<Arc<Rings>>> = Mutex::new(Vec::new());
        {
            let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(at) = cache.iter().position(|kept| kept.size() == rings) {
                let found = cache.remove(at);
                cache.push(Arc::clone(&found));
                return Ok(found);
            }
        }
        // Not under the lock: another mesh must not wait for this one.
        let made = Arc::new(Self::uniform(rings)?);
        let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
        if cache.len() >= KEPT {
            cache.remove(0);
        }
        cache.push(Arc::clone(&made));
        Ok(made)
    }

    /// N uniform rings.
    ///
    /// # Errors
    /// As [`Rings::shared`].
    pub fn uniform(rings: usize) -> Result<Self, RingsError> {
        if !RING_RANGE.contains(&rings) {
            return Err(RingsError::OutOfRange(rings));
        }
        let factor = Cholesky::new(pressure_matrix(rings)).ok_or(RingsError::NotPositiveDefinite(rings))?;
        let nodes: Vec<f64> = (0..=rings).map(|j| j as f64 / rings as f64).collect();
        let mut this = Self { nodes, factor, ones: DVector::zeros(rings), cc: 0.0 };
        let mut ones = DMatrix::from_column_slice(rings, 1, &this.ring_integrals(|_| 1.0));
        this.forward_solve(&mut ones);
        this.ones = ones.column(0).into_owned();
        this.cc = this.ones.norm_squared();
        Ok(this)
    }

    /// W̃v for the nodal values `v_j = value(j)`.
    fn ring_integrals(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut left = value(0);
        self.nodes
            .windows(2)
            .enumerate()
            .map(|(a, edge)| {
                let right = value(a + 1);
                let width = edge[1] - edge[0];
                let integral =
                    PI * width * ((edge[0] + width / 3.0) * left + (edge[0] + width * 2.0 / 3.0) * right);
                left = right;
                integral
            })
            .collect()
    }

    /// Columns ← L⁻¹ columns.
    fn forward_solve(&self, columns: &mut DMatrix<f64>) {
        // The diagonal of a Cholesky factor is positive, so the solve cannot meet a zero pivot.
        self.factor.l_dirty().solve_lower_triangular_unchecked_mut(columns);
    }

    /// The pressure on each ring.
    fn ring_pressures(&self, gap: &dyn Gap, s: f64, delta: f64) -> DVector<f64> {
        let gap: Vec<f64> = self.nodes.iter().map(|&x| gap.jet(s * x).value - delta).collect();
        self.factor.solve(&DVector::from_vec(self.ring_integrals(|j| gap[j]))) / -s
    }

    /// The forms of `gap` at radius `s`.
    fn forms(&self, gap: &dyn Gap, s: f64) -> Forms {
        let samples: Vec<[f64; 4]> = self
            .nodes
            .iter()
            .map(|&x| {
                let jet = gap.jet(s * x);
                [jet.value, x * jet.first, x * x * jet.second, x * x * x * jet.third]
            })
            .collect();
        let rings = self.size();
        let mut q = DMatrix::zeros(rings, 4);
        for (i, mut column) in q.column_iter_mut().enumerate() {
            column.copy_from_slice(&self.ring_integrals(|j| samples[j][i]));
        }
        self.forward_solve(&mut q);
        let (h, h1, h2, h3) = (q.column(0), q.column(1), q.column(2), q.column(3));
        Forms {
            cc: self.cc,
            ch: self.ones.dot(&h),
            c1: self.ones.dot(&h1),
            c2: self.ones.dot(&h2),
            c3: self.ones.dot(&h3),
            hh: h.norm_squared(),
            h1: h.dot(&h1),
            h2: h.dot(&h2),
            h3: h.dot(&h3),
            f11: h1.norm_squared(),
            f12: h1.dot(&h2),
        }
    }
}

/// B̃ of `rings` uniform rings on the unit disc.
fn pressure_matrix(rings: usize) -> DMatrix<f64> {
    // Radii are counted in ring widths: the edges are exact integers and the differences lose least.
    let interaction = DMatrix::from_fn(rings + 1, rings + 1, |i, j| {
        if i <= j { disc_interaction(i as f64, j as f64) } else { 0.0 }
    });
    let at = |i: usize, j: usize| interaction[(i.min(j), i.max(j))];
    let unit = (rings as f64).powi(-3);
    DMatrix::from_fn(rings, rings, |a, b| {
        unit * ((at(a + 1, b + 1) - at(a, b + 1)) - (at(a + 1, b) - at(a, b)))
    })
}

impl Basis for Rings {
    fn evaluate(&self, problem: &Reduced, s: f64, delta: f64) -> Evaluation {
        self.forms(problem.gap.as_ref(), s).evaluate(s, delta, problem.work_of_adhesion)
    }

    fn energy(&self, problem: &Reduced, s: f64, delta: f64) -> f64 {
        self.forms(problem.gap.as_ref(), s).energy(s, delta, problem.work_of_adhesion)
    }

    fn equilibrium(&self, problem: &Reduced, s: f64) -> Option<Evaluation> {
        let forms = self.forms(problem.gap.as_ref(), s);
        let delta = forms.equilibrium_approach(s, problem.work_of_adhesion)?;
        Some(forms.evaluate(s, delta, problem.work_of_adhesion))
    }

    fn pressure(&self, problem: &Reduced, s: f64, delta: f64) -> Vec<(f64, f64)> {
        let pressures = self.ring_pressures(problem.gap.as_ref(), s, delta);
        let middles = self.nodes.windows(2).map(|edge| 0.5 * s * (edge[0] + edge[1]));
        middles.zip(pressures.iter().copied()).collect()
    }

    fn outside_displacement(&self, problem: &Reduced, s: f64, delta: f64, radii: &[f64]) -> Vec<f64> {
        let pressures = self.ring_pressures(problem.gap.as_ref(), s, delta);
        // A ring's pressure up to its outer edge, less what the next one has.
        let inward = |j: usize| pressures[j] - pressures.get(j + 1).copied().unwrap_or(0.0);
        let discs: Vec<(f64, f64)> =
            self.nodes[1..].iter().enumerate().map(|(j, edge)| (s * edge, inward(j))).collect();
        radii
            .iter()
            .map(|&r| discs.iter().map(|&(edge, step)| step * outside::by_disc(edge.min(r), r)).sum())
            .collect()
    }

    fn size(&self) -> usize {
        self.nodes.len() - 1
    }

    fn trusted_digits(&self, problem: &Reduced, _s: f64) -> f64 {
        // The larger of the relative errors of force and contact radius given in the module header.
        let constant = if problem.work_of_adhesion > 0.0 { 1.4 } else { 0.5 };
        (self.size() as f64 / constant).log10()
    }

    fn cautions(&self, problem: &Reduced, s: f64) -> Vec<Caution> {
        let mut cautions = Vec::new();
        if let Some(wave) = problem.gap.feature_length() {
            let per_wave = self.size() as f64 * wave / s;
            if per_wave < RINGS_PER_WAVE {
                cautions.push(Caution::FewRings { per_wave, wanted: (RINGS_PER_WAVE * s / wave).ceil() });
            }
        }
        let gamma = problem.work_of_adhesion;
        if gamma > 0.0 && gamma < WEAK_ADHESION {
            cautions.push(Caution::WeakAdhesion(gamma));
        }
        cautions
    }
}

#[cfg(test)]
mod tests {
    use super::super::examples::{check_derivatives, wavy};
    use super::*;
    use crate::contact::{Problem, Shape};

    #[test]
    fn the_pressure_matrix_is_symmetric_and_sums_to_the_full_disc() {
        for rings in [4, 37, 200] {
            let b = pressure_matrix(rings);
            assert!((&b - b.transpose()).amax() <= 1e-15);
            assert!((b.sum() / (16.0 / 3.0) - 1.0).abs() < 1e-12);
            assert!(b.iter().all(|x| *x > 0.0));
            assert!(Cholesky::new(b).is_some());
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        let rings = Rings::uniform(60).unwrap();
        for gamma in [0.004, 0.0] {
            let problem = wavy(gamma);
            for i in 0..40 {
                // Off the curve, on its tension side.
                let s = 0.05 + 0.011 * f64::from(i);
                let delta = rings.equilibrium(&problem, s).unwrap().approach - 0.003 * f64::from(i % 5 + 1);
                let (here, energy_slope) = check_derivatives(&rings, &problem, s, delta);
                // ∂U/∂s = −F, and F follows from the residual.
                let release = if gamma > 0.0 {
                    (here.residual + 1.0).powi(2) * gamma * 2.0 * PI * s
                } else {
                    -here.residual
                };
                assert!((energy_slope - (release - 2.0 * PI * gamma * s)).abs() < 1e-7, "γ={gamma} s={s}");
            }
        }
    }

    #[test]
    fn the_pressure_carries_the_force() {
        let rings = Rings::uniform(100).unwrap();
        let problem = wavy(0.004);
        let at = rings.equilibrium(&problem, 0.3).unwrap();
        let pressure = rings.pressure(&problem, 0.3, at.approach);
        let width = 0.3 / 100.0;
        let force: f64 = pressure.iter().map(|(r, p)| p * 2.0 * PI * r * width).sum();
        assert!((force / at.force - 1.0).abs() < 1e-10);
        // Tension that grows towards the edge.
        assert!(pressure[99].1 < pressure[98].1 && pressure[98].1 < 0.0);
    }

    #[test]
    fn reduced_answers_do_not_depend_on_the_units() {
        let rings = Rings::shared(50).unwrap();
        let reference = rings.equilibrium(&wavy(0.004), 0.3).unwrap();
        for (modulus, length) in [(2.5e6, 1e-9), (7e10, 3.0)] {
            let scaled = Problem {
                effective_modulus: modulus,
                work_of_adhesion: 0.004 * modulus * length,
                shape: Shape::WavySphere {
                    radius_of_curvature: length,
                    amplitude: 0.0025 * length,
                    wavelength: 0.05 * length,
                },
            };
            let reduced = scaled.reduced();
            let ours = rings.equilibrium(&reduced, 0.3).unwrap();
            assert!((ours.approach / reference.approach - 1.0).abs() < 1e-12);
            assert!((ours.force / reference.force - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_number_of_rings_is_bounded() {
        assert_eq!(Rings::shared(3).unwrap_err(), RingsError::OutOfRange(3));
        assert_eq!(Rings::shared(2001).unwrap_err(), RingsError::OutOfRange(2001));
        assert!(Arc::ptr_eq(&Rings::shared(9).unwrap(), &Rings::shared(9).unwrap()));
    }
}
