//! The displacement of the surface outside the contact, r ≥ s, from a basis' own pressures (E* = 1).
//!
//! A disc of radius b under unit pressure displaces the surface at r ≥ b by
//!
//! ```text
//! u(r) = (4r/π) [E(k) − k'²K(k)] = (4r/(3π)) k²k'² R_D(0, 1, k'²),   k = b/r,   k'² = (r − b)(r + b)/r²
//! ```
//!
//! The Carlson form (Carlson, Numer. Algorithms 10, 13 (1995), doi:10.1007/BF02198293) has no difference in it, and
//! a pressure constant on rings is a sum of discs, `Σ (p_j − p_{j+1})` over the outer edges, so that no thin ring is
//! ever the difference of two nearly equal discs.
//!
//! The eigenfunctions `P_2k(t)/t` of the module [`spectral`](super::spectral) are a layer on a flattened spheroid. Outside
//! the disc, with ζ = √((r/s)² − 1), each decays like the Legendre function of the second kind of its degree (P. M.
//! Morse and H. Feshbach, *Methods of Theoretical Physics*, 1953, sec. 10.3),
//!
//! ```text
//! u(r) = (2/π) Σ (−1)ᵏ d_k q_2k(ζ),     q_n(ζ) = iⁿ⁺¹ Q_n(iζ),   q_0 = arccot ζ,   q_2k(0) = (π/2) a_k
//! n q_{n−1} = (2n+1) ζ q_n + (n+1) q_{n+1}
//! ```
//!
//! which equals (2/π)∫₀^s (δ − g(a))/√(r² − a²) da for the `δ − g(a) = Σ (−1)ᵏ (d_k/a_k) P_2k(a/s)` of the same pressure, and
//! meets δ − h(s) at the edge. `q_n` decays with its degree, so the recurrence is run downwards, where every term is
//! positive, except so near to the edge that running upwards loses nothing.

use ellip::elliprd;
use std::f64::consts::{FRAC_2_PI, PI};

/// Degree times η, with `q_n ~ e^{−nη}`, up to which the recurrence runs upwards: rounding grows by e⁴ at most.
const UPWARDS_BELOW: f64 = 2.0;

/// The exponent below which a term counts for nothing: e⁻⁴⁰ is far below rounding.
const NEGLIGIBLE: f64 = 40.0;

/// The exponent by which the recurrence starts above the first wanted degree: what it starts with then matters by
/// e⁻⁴⁰, the decay counting twice.
const LEAD: f64 = 20.0;

/// The displacement at `r ≥ b` by a unit pressure on a disc of radius `b`; radii and result in one length.
pub(super) fn by_disc(b: f64, r: f64) -> f64 {
    let complement = (r - b) * (r + b) / (r * r);
    if complement <= 0.0 {
        return 4.0 * b / PI;
    }
    let k = b / r;
    // The arguments are inside the domain, so this cannot fail.
    let carlson = elliprd(0.0, 1.0, complement).unwrap_or(f64::NAN);
    4.0 / (3.0 * PI) * r * k * k * complement * carlson
}

/// The displacement at r̃ = `ratio` ≥ 1 by the eigenfunctions whose on-disc displacement has the coefficients `d_k`.
pub(super) fn by_eigenfunctions(coefficients: &[f64], ratio: f64) -> f64 {
    let zeta = ((ratio - 1.0) * (ratio + 1.0)).max(0.0).sqrt();
    let eta = zeta.asinh();
    let first = 1f64.atan2(zeta);
    let signed = |k: usize| if k.is_multiple_of(2) { coefficients[k] } else { -coefficients[k] };
    let degree = 2 * (coefficients.len() - 1);
    if degree as f64 * eta <= UPWARDS_BELOW {
        let (mut even, mut odd) = (first, 1.0 - zeta * first);
        let mut sum = signed(0) * even;
        for k in 1..coefficients.len() {
            let n = (2 * k) as f64;
            even = ((n - 1.0) * even - (2.0 * n - 1.0) * zeta * odd) / n;
            odd = (n * odd - (2.0 * n + 1.0) * zeta * even) / (n + 1.0);
            sum += signed(k) * even;
        }
        return FRAC_2_PI * sum;
    }
    // Positive and not above the degree.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let most = ((NEGLIGIBLE / eta).min(degree as f64) * 0.5).ceil() as usize;
    let most = most.min(coefficients.len() - 1);
    // At most LEAD times the degree, by the branch above.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let lead = (0.5 * LEAD / eta).ceil() as usize + 1;
    // `odd` is q_{2k+1} and `even` q_{2k}, up to one factor that q_0 gives in the end.
    let (mut even, mut odd) = (1.0, 0.0);
    let mut sum = 0.0;
    for k in (0..=most + lead).rev() {
        if k <= most {
            sum += signed(k) * even;
        }
        if k > 0 {
            let n = (2 * k) as f64;
            odd = ((2.0 * n + 1.0) * zeta * even + (n + 1.0) * odd) / n;
            even = ((2.0 * n - 1.0) * zeta * odd + n * even) / (n - 1.0);
        }
    }
    FRAC_2_PI * sum * (first / even)
}

#[cfg(test)]
mod tests {
    use super::super::examples::wavy;
    use super::super::{Basis, Rings, Spectral};
    use super::*;
    use crate::contact::Gap;
    use crate::theory::Exact;
    use crate::theory::quadrature::integrate;
    use std::f64::consts::FRAC_PI_2;
    use std::sync::Arc;

    /// From just outside the edge to far away.
    const RATIOS: [f64; 9] = [1.0, 1.0 + 1e-9, 1.0001, 1.003, 1.02, 1.1, 1.4, 3.0, 40.0];

    #[test]
    fn a_disc_far_away_is_a_point_load_and_at_its_edge_known() {
        assert!((by_disc(2.0, 2.0) - 8.0 / PI).abs() < 1e-15);
        assert!((by_disc(2.0, 2.0 * (1.0 + 1e-14)) - 8.0 / PI).abs() < 1e-12);
        // u → πb²/(πr)·(1 + b²/(8r²)).
        let (b, r) = (0.01_f64, 1.0);
        assert!((by_disc(b, r) / (b * b * (1.0 + b * b / 8.0)) - 1.0).abs() < 1e-9);
        // E and K themselves, where their difference is safe.
        for k in [0.3_f64, 0.6, 0.95] {
            let [e, f] = integrate(0.0, FRAC_PI_2, None, |x| {
                let root = (1.0 - (k * x.sin()).powi(2)).sqrt();
                [root, root.recip()]
            })
            .values;
            let exact = 4.0 / PI * (e - (1.0 - k * k) * f);
            assert!((by_disc(k, 1.0) / exact - 1.0).abs() < 1e-13, "{k}");
        }
    }

    /// `P_2k(x)`.
    fn legendre(k: usize, x: f64) -> f64 {
        let (mut before, mut here) = (1.0, x);
        for n in 1..2 * k {
            let n = n as f64;
            (before, here) = (here, ((2.0 * n + 1.0) * x * here - n * before) / (n + 1.0));
        }
        if k == 0 { 1.0 } else { here }
    }

    #[test]
    fn an_eigenfunction_is_the_transform_of_its_legendre_polynomial() {
        // (−1)ᵏ P_2k(a)/a_k = (2/π)∫_a^1 r p/√(r² − a²) dr for p = P_2k(t)/t over λ_k: u follows from it as from δ − g.
        for k in [0, 1, 2, 3, 11, 60, 400] {
            let mut coefficients = vec![0.0; k + 1];
            coefficients[k] = 1.0;
            let edge = legendre(k, 0.0);
            for ratio in RATIOS {
                let wave = (k > 0).then(|| PI / (ratio * k as f64));
                let end = 1f64.atan2(((ratio - 1.0) * (ratio + 1.0)).sqrt());
                let [sum] =
                    integrate(0.0, end, wave, |psi| [legendre(k, (ratio * psi.sin()).min(1.0)) / edge])
                        .values;
                let ours = by_eigenfunctions(&coefficients, ratio);
                // The quadrature sums terms as large as 1/a_k.
                let exact = FRAC_2_PI * sum;
                assert!((ours - exact).abs() < 1e-13 / edge.abs(), "k={k} r={ratio}: {ours} {exact}");
                assert!(ours.abs() <= edge.abs() * (1.0 + 1e-12), "k={k} r={ratio}");
            }
        }
    }

    #[test]
    fn running_up_and_down_meet() {
        let ones: Vec<f64> = (0..12).map(|k| f64::from(k + 1).recip()).collect();
        let at = |degree: f64| (1.0 + (degree / 22.0).sinh().powi(2)).sqrt();
        let (below, above) = (at(UPWARDS_BELOW * (1.0 - 1e-9)), at(UPWARDS_BELOW * (1.0 + 1e-9)));
        let (a, b) = (by_eigenfunctions(&ones, below), by_eigenfunctions(&ones, above));
        assert!((a - b).abs() < 1e-8, "{a} {b}");
    }

    #[test]
    fn both_bases_agree_with_the_exact_transform_and_meet_the_edge() {
        let spectral = Spectral::new(64).unwrap();
        for gamma in [0.0, 0.004] {
            let problem = wavy(gamma);
            let exact = Exact::by_quadrature(1.0, gamma, Arc::clone(&problem.gap));
            for s in [0.03, 0.2, 0.413] {
                let delta = exact.approach(s);
                let radii: Vec<f64> = RATIOS.iter().map(|ratio| s * ratio).collect();
                let ours = spectral.outside_displacement(&problem, s, delta, &radii);
                let edge = delta - problem.gap.jet(s).value;
                assert!((ours[0] - edge).abs() <= 1e-12 * (delta.abs() + s * s), "γ={gamma} s={s}");
                let mut errors = [0.0_f64; 2];
                for (i, rings) in [100, 400].into_iter().enumerate() {
                    let coarse =
                        Rings::shared(rings).unwrap().outside_displacement(&problem, s, delta, &radii);
                    for (a, b) in ours.iter().zip(&coarse).skip(4) {
                        errors[i] = errors[i].max((a - b).abs());
                    }
                }
                // First order in the width of a ring, away from the edge.
                assert!(
                    errors[1] < 0.35 * errors[0] && errors[1] < 0.01 * (s * s + exact.edge(s)),
                    "γ={gamma} s={s}: {errors:?}"
                );
                for (&r, &u) in radii.iter().zip(&ours) {
                    let wave = exact.wave().map(|wave| wave / r);
                    let [sum] = integrate(0.0, (s / r).min(1.0).asin(), wave, |psi| {
                        [delta - exact.transform(r * psi.sin()).value]
                    })
                    .values;
                    assert!((u - FRAC_2_PI * sum).abs() <= 1e-11 * s * s, "γ={gamma} s={s} r={r}");
                }
            }
        }
    }
}
