//! One connected contact disc on any gap, from the Abel transform of the gap.
//!
//! ```text
//! g(a) = a ∫₀^{π/2} h'(a sin θ) dθ,   T(s) = √(2πγs/E*)
//! δ = g(s) − T,                       P = 2E*∫₀^s (δ − g) da   = 2E*[M₁ − sT],   M₁ = ∫₀^s a g' da
//! U = E*∫₀^s (δ − g)² da − πγs²     = E*[M₂ − 2T M₁] + πγs²,   M₂ = ∫₀^s (g(s) − g)² da = 2∫₀^s g' M₁ da
//! δ' = g'(s) − T/(2s),                P' = 2E*[s δ' − T],       U' = P δ'
//! p(r) = (E*/π) [∫_r^s g'(a)/√(a² − r²) da − T/√(s² − r²)]
//! ```
//!
//! The forms with M₁ and M₂ do not cancel where s is small and adhesion dominates. Along the curve `dU = P dδ`, so the
//! energy at one radius follows from that at another by the rise of M₂ between them. The root with −T is the one whose
//! edge is in tension.
//!
//! I. N. Sneddon, Int. J. Eng. Sci. 3, 47 (1965), doi:10.1016/0020-7225(65)90019-4; the adhesive edge as in K. L.
//! Johnson, K. Kendall and A. D. Roberts, Proc. R. Soc. A 324, 301 (1971), doi:10.1098/rspa.1971.0141. The formulas
//! hold for one connected disc; whether the gap outside stays open is not checked here.

use super::quadrature::{Integral, integrate, integrate_broken};
use crate::elementary::hypot;
use crate::gap::Breaks;
use std::f64::consts::{PI, TAU};

/// The Abel transform of a gap at one radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// g, a length: the approach at which the disc would have this radius without adhesion.
    pub value: f64,
    /// g' = dg/da.
    pub slope: f64,
    /// M₁ = ∫₀ᵃ a g' da, an area.
    pub moment: f64,
    /// Whether the three are good to rounding: closed forms are; a quadrature is not if the gap had structure too fine
    /// for it.
    pub resolved: bool,
}

/// One exact equilibrium, in the units of the disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactEquilibrium {
    /// s, a length.
    pub contact_radius: f64,
    /// δ, a length, positive when pressed together.
    pub approach: f64,
    /// P, compression positive.
    pub force: f64,
    /// U, the elastic energy minus γ times the area of contact.
    pub energy: f64,
    /// The larger of the two forces whose difference P is, 2E*|M₁| of the gap and 2E*sT of the edge.
    ///
    /// The fair scale for an error of P, because P itself passes through zero.
    pub force_scale: f64,
    /// Whether every integral used for it was [resolved](super::quadrature::Integral::resolved), so that everything is
    /// good to rounding.
    pub resolved: bool,
}

/// One connected contact disc: what follows from a gap, E* and γ.
///
/// Radii are positive unless said otherwise; any consistent units.
pub trait Disc: std::fmt::Debug + Send + Sync {
    /// The name of the solution, with its year.
    fn name(&self) -> &'static str;

    /// E*, a stress, and γ, a stress times a length.
    fn material(&self) -> [f64; 2];

    /// E*.
    fn effective_modulus(&self) -> f64 {
        self.material()[0]
    }

    /// γ.
    fn work_of_adhesion(&self) -> f64 {
        self.material()[1]
    }

    /// The shortest wave of the gap, which sets the panels of integrals.
    fn wave(&self) -> Option<f64> {
        None
    }

    /// Where the gap is not smooth and its transform is singular.
    fn breaks(&self) -> Breaks<'_> {
        Breaks::default()
    }

    /// g, g' and M₁ at the radius `a ≥ 0`.
    fn transform(&self, a: f64) -> Transform;

    /// T(s) = √(2πγs/E*), by which the adhesive edge lowers the approach.
    fn edge(&self, s: f64) -> f64 {
        (TAU * self.work_of_adhesion() * s / self.effective_modulus()).sqrt()
    }

    /// δ(s).
    fn approach(&self, s: f64) -> f64 {
        self.transform(s).value - self.edge(s)
    }

    /// P(s).
    fn force(&self, s: f64) -> f64 {
        2.0 * self.effective_modulus() * (self.transform(s).moment - s * self.edge(s))
    }

    /// U(s).
    fn energy(&self, s: f64) -> f64 {
        let [square] = self.rise(0.0, s).values;
        self.equilibrium(s, square).energy
    }

    /// dδ/ds and dP/ds along the curve.
    fn slopes(&self, s: f64) -> (f64, f64) {
        let edge = self.edge(s);
        let approach = self.transform(s).slope - 0.5 * edge / s;
        (approach, 2.0 * self.effective_modulus() * (s * approach - edge))
    }

    /// The pressure p(r), compression positive, in a disc of radius `s` at `0 ≤ r < s`.
    ///
    /// Its integral contains the waves of g', which the transform of the gap has resolved if it says so.
    fn pressure(&self, s: f64, r: f64) -> f64 {
        let depth = ((s - r) * (s + r)).sqrt();
        self.effective_modulus() / PI * (pressed(self, s, r) - self.edge(s) / depth)
    }

    /// The pressure in a disc of radius `s` at each of `radii`, as [`Disc::pressure`].
    fn pressures(&self, s: f64, radii: &[f64]) -> Vec<f64> {
        radii.iter().map(|&r| self.pressure(s, r)).collect()
    }

    /// M₂ at `to` minus M₂ at `from`.
    fn rise(&self, from: f64, to: f64) -> Integral<1> {
        // A product of two waves has waves of half the length.
        let wave = self.wave().map(|wave| 0.5 * wave);
        integrate_broken(self.breaks(), from, to, wave, |a| {
            let g = self.transform(a);
            [2.0 * g.slope * g.moment]
        })
    }

    /// The equilibrium at `s`, given M₂ there.
    fn equilibrium(&self, s: f64, square: f64) -> ExactEquilibrium {
        let modulus = self.effective_modulus();
        let (g, edge) = (self.transform(s), self.edge(s));
        ExactEquilibrium {
            contact_radius: s,
            approach: g.value - edge,
            force: 2.0 * modulus * (g.moment - s * edge),
            energy: modulus * (square - 2.0 * edge * g.moment) + PI * self.work_of_adhesion() * s * s,
            force_scale: 2.0 * modulus * g.moment.abs().max(s * edge),
            resolved: g.resolved,
        }
    }

    /// The equilibria at `radii`, in any order, with their energies from one pass over the whole curve.
    fn curve(&self, radii: &[f64]) -> Vec<ExactEquilibrium> {
        let mut order: Vec<usize> = (0..radii.len()).collect();
        order.sort_by(|&i, &j| radii[i].total_cmp(&radii[j]));
        let mut squares = vec![(0.0, true); radii.len()];
        let (mut at, mut square, mut resolved) = (0.0, 0.0, true);
        for i in order {
            let rise = self.rise(at, radii[i]);
            square += rise.values[0];
            resolved &= rise.resolved;
            at = radii[i];
            squares[i] = (square, resolved);
        }
        let state = |(&s, (square, resolved))| {
            let state = self.equilibrium(s, square);
            ExactEquilibrium { resolved: resolved && state.resolved, ..state }
        };
        radii.iter().zip(squares).map(state).collect()
    }
}

/// ∫_r^s g'(a)/√(a² − r²) da.
pub(super) fn pressed(disc: &(impl Disc + ?Sized), s: f64, r: f64) -> f64 {
    let depth = ((s - r) * (s + r)).sqrt();
    // With a² = r² + t² the root disappears and the integrand is smooth: g'/a is even in a.
    let pressed = integrate(0.0, depth, disc.wave(), |t| {
        let a = hypot(r, t);
        [disc.transform(a).slope / a]
    });
    pressed.values[0]
}
