//! Pressures that are eigenfunctions of the half-space operator: exact to rounding once they resolve the waves.
//!
//! On the unit disc, with t = √(1 − r̃²), the pressures `P_2k(t)/t` displace the surface by multiples of themselves
//! times t (E* = 1; Legendre polynomials of even degree):
//!
//! ```text
//! p = P_2k(t)/t   ⇒   u = λ_k P_2k(t),    λ_k = π a_k²,    a_k = (2k)!/(4ᵏ (k!)²) = |P_2k(0)|
//! δ − h(s√(1−t²)) = Σ d_k P_2k(t),        d_k = (4k+1) ∫₀¹ (δ − h) P_2k dt
//! ```
//!
//! so the matrix of the pressures is diagonal, `2πλ_k/(4k+1)`, and the functional (16) is minimized term by term:
//! the pressure on a disc of radius s is `p = Σ d_k/(s λ_k) P_2k(t)/t` and
//!
//! ```text
//! U = πs Σ d_k²/((4k+1) λ_k) − πγs²
//! P = 2s d_0 = 2s (δ − H(s)),     H = ∫₀^{π/2} h(s sin θ) sin θ dθ
//! q = −Σ (−1)ᵏ d_k/a_k = g(s) − δ,  g = s ∫₀^{π/2} h'(s sin θ) dθ
//! ```
//!
//! q is the signed coefficient of the edge singularity, positive in tension: the stress-intensity factor is
//! q/√(πs), and G = q²/(2πs). G = γ with tension at the edge is one equation, linear in δ, for every γ ≥ 0:
//!
//! ```text
//! ρ = q/√(2πs) − √γ = 0     ⇔     δ = g(s) − √(2πγs)
//! ```
//!
//! P and q need one and the same sampling of the gap's slope (see [`super::moments`]), and so do their derivatives:
//! `sH' = g − H` makes `∂P/∂s = −2q` exactly. Only energy and pressure need the coefficients `d_k`: Gauss nodes in t,
//! the positive half of a rule on (−1, 1), because all is even in t; n of them for n functions. Where the gap is not
//! smooth they are nodes in θ, broken there (see [`breaks`](crate::contact::breaks)).
//!
//! Sources: Popov, J. Appl. Math. Mech. 27 (1963), for the eigenfunctions; Sneddon, Int. J. Eng. Sci. 3 (1965) 47,
//! doi:10.1016/0020-7225(65)90019-4, for g.

use super::Basis;
use super::caution::Caution;
use super::functional::Evaluation;
use super::moments::{EdgeRules, Moments};
use super::outside;
use crate::contact::breaks::{Angles, CUBIC_FREQUENCY};
use crate::contact::{Axis, Gap, Reduced};
use gauss_quad::GaussLegendre;
use nalgebra::DVectorView;
use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::num::NonZeroUsize;
use std::ops::RangeInclusive;

/// The allowed number of functions: 4 are exact for a smooth sphere, 4096 resolve about a thousand waves.
pub const FUNCTION_RANGE: RangeInclusive<usize> = 4..=4096;

/// Most nodes in θ beyond one per function: enough for the waves that the functions resolve, and for a gap that has
/// none.
const MORE_EDGE_NODES: usize = 16;

/// Rounding of the edge functional relative to the sizes in it, over Newton's tolerance of 1e-10: 1e-13 leaves room
/// for the rounding of the phase of some hundred waves.
const EDGE_ROUNDING: f64 = 1e-3;

/// The amplitude of the last terms of the energy, relative to the largest, at which an automatic number of functions is enough: a decade
/// above the rounding of the coefficients, and far below what a screen or a file's reader can use.
pub const TAIL_TOLERANCE: f64 = 1e-12;

/// Points of a picture of the pressure per wave, and the fewest and most of them.
const PICTURE_POINTS_PER_WAVE: f64 = 20.0;
const PICTURE_POINTS: [f64; 2] = [80.0, 2000.0];

/// The coefficients that count as the tail: two, in case one of them passes through zero.
const TAIL: usize = 2;

/// The same where more functions buy little: a tip like that of a cone, or a measured curve, has terms that fall as a power
/// of their number.
const SLOW_TAIL: f64 = 1e-6;

/// So many functions tell the slow gaps from the others, which are done long before.
const SLOW_FUNCTIONS: usize = 256;

/// Factor from one automatic number of functions to the next.
const GROWTH: f64 = 1.25;

/// Fewer trusted digits than this are a warning: rings would do as well.
pub const DIGITS_WANTED: f64 = 6.0;

/// Functions per wave in the contact: a wave of phase φ = 2πs/λ has terms up to the degree 2k ≈ φ.
const FUNCTIONS_PER_WAVE: f64 = PI;

/// Why a spectral basis could not be made.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SpectralError {
    /// The number of functions is out of range.
    #[error(
        "functions = {0} is out of range, allowed are {lo} to {hi}",
        lo = FUNCTION_RANGE.start(),
        hi = FUNCTION_RANGE.end()
    )]
    OutOfRange(usize),
    /// Not even the most functions resolve the gap.
    #[error(
        "basis.functions = \"auto\" needs more than {functions} functions for {waves:.0} waves in the largest contact \
         (their tail is {tail:.1e}, wanted is {TAIL_TOLERANCE:.0e}): start from a smaller contact or give a number"
    )]
    Unresolved {
        /// The most functions.
        functions: usize,
        /// Waves from the axis to the edge of the largest contact.
        waves: f64,
        /// The tail they leave.
        tail: f64,
    },
}

/// n eigenfunctions with their quadrature; geometry independent, and cheap enough to be made anew.
#[derive(Debug, Clone)]
pub struct Spectral {
    functions: usize,
    edge: EdgeRules,
    disc: DiscRule,
}

/// Gauss nodes in t on (0, 1).
#[derive(Debug, Clone)]
struct DiscRule {
    /// t, ascending.
    depths: Vec<f64>,
    /// r̃ = √(1 − t²).
    radii: Vec<f64>,
    /// The weights of ∫ dt.
    weights: Vec<f64>,
}

impl DiscRule {
    fn new(nodes: usize) -> Self {
        let rule = GaussLegendre::new(NonZeroUsize::new(2 * nodes).unwrap_or(NonZeroUsize::MIN));
        let half = || rule.iter().skip(nodes);
        Self {
            depths: half().map(|(t, _)| *t).collect(),
            radii: half().map(|(t, _)| ((1.0 - t) * (1.0 + t)).sqrt()).collect(),
            weights: half().map(|(_, weight)| *weight).collect(),
        }
    }
}

impl Spectral {
    /// n functions.
    ///
    /// # Errors
    /// [`SpectralError::OutOfRange`] when `functions` is outside [`FUNCTION_RANGE`].
    pub fn new(functions: usize) -> Result<Self, SpectralError> {
        if !FUNCTION_RANGE.contains(&functions) {
            return Err(SpectralError::OutOfRange(functions));
        }
        let edge = EdgeRules::new((functions + MORE_EDGE_NODES).next_multiple_of(4));
        Ok(Self { functions, edge, disc: DiscRule::new(functions) })
    }

    /// Enough functions for the gap of `problem` in a contact of radius `s` (reduced) and one wave more.
    ///
    /// The first guess counts the waves; it grows until the tail of the coefficients is below [`TAIL_TOLERANCE`].
    /// A gap whose terms fall as a power of their number gets twice as many functions as take it to six digits, and at
    /// least 256. Where it is known not to be smooth, as many as take it there and at most all: δ and P do not depend on
    /// their number, and energies feel its square.
    ///
    /// # Errors
    /// [`SpectralError::Unresolved`] with the numbers when the most functions are not enough.
    pub fn resolving(problem: &Reduced, s: f64) -> Result<Self, SpectralError> {
        let most = *FUNCTION_RANGE.end();
        let wave = problem.gap.feature_length();
        // An unstable start runs outward to the next wave.
        let largest = (s + wave.unwrap_or(0.0)).min(problem.largest_contact().max(s));
        let waves = wave.map_or(0.0, |wave| largest / wave);
        let mut wanted = FUNCTIONS_PER_WAVE * waves;
        let breaks = problem.gap.breaks();
        let rough = (breaks.axis != Axis::Even || breaks.matter(largest)) && wanted <= most as f64;
        let mut slow = None;
        loop {
            // Positive and at most 4096.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let functions = (wanted.min(most as f64).ceil() as usize).max(*FUNCTION_RANGE.start());
            let basis = Self::new(functions)?;
            let tail = basis.tail(problem, largest);
            if tail <= SLOW_TAIL && slow.is_none() {
                // Where the gap is not smooth, twice as many would buy half a digit.
                let enough = if rough { functions } else { 2 * functions };
                slow = Some(enough.max(SLOW_FUNCTIONS));
            }
            if tail <= TAIL_TOLERANCE
                || slow.is_some_and(|enough| functions >= if rough { enough.min(most) } else { enough })
            {
                return Ok(basis);
            }
            if functions >= most {
                return Err(SpectralError::Unresolved { functions, waves, tail });
            }
            wanted = (GROWTH * functions as f64).max(functions as f64 + 1.0);
        }
    }

    /// Calls `each(k, P_2k at every depth)` for the n functions in turn.
    fn for_each_function(&self, depths: &[f64], mut each: impl FnMut(usize, &[f64])) {
        let mut even = vec![1.0; depths.len()];
        let mut odd = depths.to_vec();
        for k in 0..self.functions {
            each(k, &even);
            // (m+1) P_{m+1} = (2m+1) t P_m − m P_{m−1}, for m = 2k+1 and 2k+2.
            let m = (2 * k + 1) as f64;
            let [a, b] = [(2.0 * m + 1.0) / (m + 1.0), m / (m + 1.0)];
            let [c, d] = [(2.0 * m + 3.0) / (m + 2.0), (m + 1.0) / (m + 2.0)];
            for ((&t, even), odd) in depths.iter().zip(&mut even).zip(&mut odd) {
                *even = a * t * *odd - b * *even;
                *odd = c * t * *even - d * *odd;
            }
        }
    }

    /// The rule for projections of `gap` on a disc of radius `s`.
    ///
    /// A gap that is not even and smooth in r is neither in t: it takes nodes in θ, t = cos θ, broken where it breaks.
    fn rule(&self, gap: &dyn Gap, s: f64) -> Cow<'_, DiscRule> {
        let breaks = gap.breaks();
        if breaks.axis == Axis::Even && !breaks.matter(s) {
            return Cow::Borrowed(&self.disc);
        }
        let degree = 2.0 * self.functions as f64;
        let frequency = degree + if breaks.cubic { CUBIC_FREQUENCY } else { degree };
        let Angles { sines, cosines, mut weights } = Angles::new(breaks, s, frequency);
        for (weight, sin) in weights.iter_mut().zip(&sines) {
            *weight *= sin;
        }
        Cow::Owned(DiscRule { depths: cosines, radii: sines, weights })
    }

    /// `d_k` of δ − h on the disc of radius `s`, n of them, lengths.
    fn coefficients(&self, gap: &dyn Gap, s: f64, delta: f64) -> Vec<f64> {
        let rule = self.rule(gap, s);
        let DiscRule { depths, radii, weights } = rule.as_ref();
        let mut samples = vec![0.0; radii.len()];
        gap.values(s, radii, &mut samples);
        for (sample, weight) in samples.iter_mut().zip(weights) {
            *sample *= -weight;
        }
        let samples = DVectorView::from_slice(&samples, samples.len());
        let mut coefficients = Vec::with_capacity(self.functions);
        self.for_each_function(depths, |k, values| {
            let projection = samples.dot(&DVectorView::from_slice(values, values.len()));
            coefficients.push((4 * k + 1) as f64 * projection);
        });
        // ∫₀¹ P_0 dt = 1, the other functions have no mean.
        if let Some(first) = coefficients.first_mut() {
            *first += delta;
        }
        coefficients
    }

    /// The amplitudes `d_k/(a_k√(4k+1))` of the last terms of the gap's energy, relative to the largest.
    ///
    /// Energy is what truncation touches first, with their squares; pressure feels the amplitudes themselves.
    fn tail(&self, problem: &Reduced, s: f64) -> f64 {
        let terms: Vec<f64> = self
            .coefficients(problem.gap.as_ref(), s, 0.0)
            .iter()
            .zip(edge_values())
            .enumerate()
            .map(|(k, (d, a))| (d / a).abs() / ((4 * k + 1) as f64).sqrt())
            .collect();
        let largest = |terms: &[f64]| terms.iter().copied().fold(0.0, f64::max);
        let size = largest(&terms);
        if size > 0.0 { largest(&terms[self.functions - TAIL..]) / size } else { 0.0 }
    }

    /// The contact pressure (reduced, compression positive) at the given r̃ = r/s in 0 ≤ r̃ < 1.
    pub fn pressure_at(&self, problem: &Reduced, s: f64, delta: f64, radii: &[f64]) -> Vec<f64> {
        let depths: Vec<f64> = radii.iter().map(|r| ((1.0 - r) * (1.0 + r)).sqrt()).collect();
        let coefficients = self.coefficients(problem.gap.as_ref(), s, delta);
        let loads: Vec<f64> =
            coefficients.iter().zip(edge_values()).map(|(d, a)| d / (s * PI * a * a)).collect();
        let mut pressure = vec![0.0; depths.len()];
        self.for_each_function(&depths, |k, values| {
            for (p, value) in pressure.iter_mut().zip(values) {
                *p += loads[k] * value;
            }
        });
        pressure.iter().zip(&depths).map(|(p, t)| p / t).collect()
    }

    /// Residual and force at (s, δ) from the sums there.
    fn evaluated(m: &Moments, s: f64, delta: f64, gamma: f64) -> Evaluation {
        let [edge, edge_s, edge_ss] = m.edge;
        let q = edge - delta;
        let unit = (TAU * s).sqrt().recip();
        Evaluation {
            contact_radius: s,
            approach: delta,
            residual: q * unit - gamma.sqrt(),
            residual_scale: gamma
                .sqrt()
                .max(EDGE_ROUNDING * (m.size + delta.abs()) * unit)
                .max(f64::MIN_POSITIVE),
            residual_gradient: [-unit, (edge_s - q / (2.0 * s)) * unit],
            residual_second: [0.0, unit / (2.0 * s), (edge_ss - edge_s / s + 0.75 * q / (s * s)) * unit],
            force: 2.0 * s * (delta - m.mean),
            force_scale: 2.0 * s * (delta.abs() + m.mean.abs()),
            force_gradient: [2.0 * s, -2.0 * q],
            force_second: [0.0, 2.0, -2.0 * edge_s],
        }
    }
}

/// `a_k = |P_2k(0)|`, k = 0, 1, …
fn edge_values() -> impl Iterator<Item = f64> {
    std::iter::successors(Some((1.0, 1.0)), |&(k, a): &(f64, f64)| {
        Some((k + 1.0, a * (2.0 * k - 1.0) / (2.0 * k)))
    })
    .map(|(_, a)| a)
}

impl Basis for Spectral {
    fn evaluate(&self, problem: &Reduced, s: f64, delta: f64) -> Evaluation {
        Self::evaluated(&self.edge.moments(problem.gap.as_ref(), s), s, delta, problem.work_of_adhesion)
    }

    fn energy(&self, problem: &Reduced, s: f64, delta: f64) -> f64 {
        let coefficients = self.coefficients(problem.gap.as_ref(), s, delta);
        let elastic: f64 = coefficients
            .iter()
            .zip(edge_values())
            .enumerate()
            .map(|(k, (d, a))| (d / a).powi(2) / (4 * k + 1) as f64)
            .sum();
        s * elastic - PI * problem.work_of_adhesion * s * s
    }

    fn equilibrium(&self, problem: &Reduced, s: f64) -> Option<Evaluation> {
        let moments = self.edge.moments(problem.gap.as_ref(), s);
        let gamma = problem.work_of_adhesion;
        let delta = moments.edge[0] - (TAU * gamma * s).sqrt();
        delta.is_finite().then(|| Self::evaluated(&moments, s, delta, gamma))
    }

    fn pressure(&self, problem: &Reduced, s: f64, delta: f64) -> Vec<(f64, f64)> {
        // Depths ascend, so radii descend.
        let radii: Vec<f64> = self.disc.radii.iter().rev().copied().collect();
        let pressure = self.pressure_at(problem, s, delta, &radii);
        radii.iter().map(|r| s * r).zip(pressure).collect()
    }

    fn pressure_profile(&self, problem: &Reduced, s: f64, delta: f64) -> Vec<(f64, f64)> {
        let waves = problem.gap.feature_length().map_or(0.0, |wave| s / wave);
        let [least, most] = PICTURE_POINTS;
        let points = (PICTURE_POINTS_PER_WAVE * waves).clamp(least, most).ceil();
        // r̃ = sin θ: evenly spaced near the axis and, as t = cos θ, near the edge too, which itself is left out.
        let angles = std::iter::successors(Some(0.0), |j| Some(j + 1.0)).take_while(|j| *j < points);
        let radii: Vec<f64> = angles.map(|j| (FRAC_PI_2 * j / points).sin()).collect();
        let pressure = self.pressure_at(problem, s, delta, &radii);
        radii.iter().map(|r| s * r).zip(pressure).collect()
    }

    fn outside_displacement(&self, problem: &Reduced, s: f64, delta: f64, radii: &[f64]) -> Vec<f64> {
        let coefficients = self.coefficients(problem.gap.as_ref(), s, delta);
        radii.iter().map(|r| outside::by_eigenfunctions(&coefficients, r / s)).collect()
    }

    fn size(&self) -> usize {
        self.functions
    }

    fn trusted_digits(&self, problem: &Reduced, s: f64) -> f64 {
        // Beyond fifteen there is only rounding.
        -self.tail(problem, s).max(1e-15).log10()
    }

    fn cautions(&self, problem: &Reduced, s: f64) -> Vec<Caution> {
        let digits = self.trusted_digits(problem, s);
        if digits >= DIGITS_WANTED {
            return Vec::new();
        }
        let wanted = Self::resolving(problem, s).ok().map(|basis| basis.functions);
        vec![Caution::FewFunctions { functions: self.functions, digits, wanted }]
    }
}

#[cfg(test)]
mod tests {
    use super::super::examples::{check_derivatives, wavy};
    use super::*;
    use crate::contact::{Problem, Shape};

    fn sphere(gamma: f64) -> Reduced {
        let shape = Shape::Sphere { radius_of_curvature: 1.0 };
        Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }.reduced()
    }

    #[test]
    fn smooth_spheres_are_exact_with_the_fewest_functions() {
        let basis = Spectral::new(4).unwrap();
        for gamma in [0.0, 1e-12, 1e-6, 0.01] {
            let problem = sphere(gamma);
            for s in [1e-3_f64, 0.1, 0.7] {
                let at = basis.equilibrium(&problem, s).unwrap();
                let adhesion = (TAU * gamma * s).sqrt();
                let (delta, force) = (s * s - adhesion, 4.0 / 3.0 * s.powi(3) - 2.0 * s * adhesion);
                assert!((at.approach - delta).abs() <= 1e-14 * s * s, "γ={gamma} s={s}");
                assert!((at.force - force).abs() <= 1e-14 * (s.powi(3) + s * adhesion), "γ={gamma} s={s}");
                // Hertz's 8s⁵/15 less what the adhesion takes back, U = ∫₀^s (δ − a²)² da − πγs².
                let energy = s * delta * delta - 2.0 / 3.0 * delta * s.powi(3) + s.powi(5) / 5.0;
                let energy = energy - PI * gamma * s * s;
                let ours = basis.energy(&problem, s, at.approach);
                assert!((ours - energy).abs() <= 1e-14 * (s.powi(5) + gamma * s * s), "γ={gamma} s={s}");
                // Hertz: p = (2/π)√(s² − r²); adhesion adds −√(2πγs)/(π√(s² − r²)).
                for (r, p) in basis.pressure(&problem, s, at.approach) {
                    let t = ((s - r) * (s + r)).sqrt();
                    let exact = 2.0 / PI * t - adhesion / (PI * t);
                    assert!((p - exact).abs() <= 1e-12 * (s + adhesion / t), "γ={gamma} s={s} r={r}");
                }
            }
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        let basis = Spectral::new(64).unwrap();
        for gamma in [0.004, 0.0] {
            let problem = wavy(gamma);
            for i in 0..40 {
                // Off the curve on both sides: the residual is signed.
                let s = 0.05 + 0.011 * f64::from(i);
                let delta = basis.equilibrium(&problem, s).unwrap().approach + 0.003 * f64::from(i % 5 - 2);
                let (here, by_radius) = check_derivatives(&basis, &problem, s, delta);
                // G follows from the residual, and ∂U/∂s = 2πs(G − γ).
                let root = here.residual + gamma.sqrt();
                assert!((by_radius - TAU * s * (root * root - gamma)).abs() < 1e-7, "γ={gamma} s={s}");
            }
        }
    }

    #[test]
    fn the_pressure_carries_the_force_and_the_edge() {
        let (basis, problem, s) = (Spectral::new(64).unwrap(), wavy(0.004), 0.3);
        let at = basis.equilibrium(&problem, s).unwrap();
        // P = 2πs² ∫ p t dt over the nodes of the pressure.
        let force: f64 = basis
            .pressure(&problem, s, at.approach)
            .iter()
            .zip(basis.disc.depths.iter().zip(&basis.disc.weights).rev())
            .map(|((_, p), (depth, weight))| TAU * s * s * p * depth * weight)
            .sum();
        assert!((force / at.force - 1.0).abs() < 1e-11);
        // p √(s² − r²) → −q/π at the edge.
        let r = 1.0 - 1e-9;
        let p = basis.pressure_at(&problem, s, at.approach, &[r])[0];
        let edge = p * s * ((1.0 - r) * (1.0 + r)).sqrt();
        assert!((edge / (-(TAU * 0.004 * s).sqrt() / PI) - 1.0).abs() < 1e-5, "{edge}");
    }

    #[test]
    fn reduced_answers_do_not_depend_on_the_units() {
        let basis = Spectral::new(48).unwrap();
        let reference = basis.equilibrium(&wavy(0.004), 0.3).unwrap();
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
            let ours = basis.equilibrium(&scaled.reduced(), 0.3).unwrap();
            assert!((ours.approach / reference.approach - 1.0).abs() < 1e-12);
            assert!((ours.force / reference.force - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn automatic_numbers_grow_with_the_waves_and_end_with_the_numbers() {
        let resolved = |s: f64| Spectral::resolving(&wavy(0.004), s).unwrap();
        for (s, least, most) in [(0.1, 10, 30), (0.5, 40, 70), (5.0, 320, 480)] {
            let basis = resolved(s);
            assert!((least..=most).contains(&basis.size()), "{s}: {}", basis.size());
            assert!(basis.trusted_digits(&wavy(0.004), s) >= 12.0);
            assert!(basis.cautions(&wavy(0.004), s).is_empty());
        }
        assert_eq!(Spectral::resolving(&sphere(0.01), 0.5).unwrap().size(), *FUNCTION_RANGE.start());
        let refused = Spectral::resolving(&wavy(0.004), 500.0).unwrap_err().to_string();
        assert!(refused.contains("10001 waves") && refused.contains("4096 functions"), "{refused}");
        let few = Spectral::new(20).unwrap().cautions(&wavy(0.004), 0.5);
        assert!(
            matches!(few[..], [Caution::FewFunctions { functions: 20, wanted: Some(50..), .. }]),
            "{few:?}"
        );
    }

    #[test]
    fn the_number_of_functions_is_bounded() {
        assert_eq!(Spectral::new(3).unwrap_err(), SpectralError::OutOfRange(3));
        assert_eq!(Spectral::new(4097).unwrap_err(), SpectralError::OutOfRange(4097));
    }
}
