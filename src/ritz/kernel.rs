//! The interaction of two concentric, uniformly loaded discs on an elastic half-space.
//!
//! For unit pressures on discs of radii a ≤ b, k = a/b, and the Boussinesq kernel (3) with E* = 1,
//!
//! ```text
//! I(a, b) = ∫_{disc a} u[disc b] dS = (8/3) b³ [(1 + k²) E(k) − (1 − k²) K(k)]
//! ```
//!
//! with complete elliptic integrals of modulus k. They are taken in Carlson's forms from the
//! complementary modulus k'² = (b − a)(b + a)/b², which keeps the digits where a ring is thin
//! (Carlson, Numer. Algorithms 10, 13 (1995), doi:10.1007/BF02198293).

use ellip::{elliprd, elliprf, elliprg};

/// I(a, b) for 0 ≤ a ≤ b, radii in any length; the result is that length cubed.
///
/// The arguments lie inside the domain of Carlson's integrals for every such pair, so the special
/// functions cannot fail; should they, the result is not a number and the factorization reports it.
pub fn disc_interaction(a: f64, b: f64) -> f64 {
    if a <= 0.0 {
        return 0.0;
    }
    if a >= b {
        // (1 − k²) K(k) → 0 and E(1) = 1.
        return 16.0 / 3.0 * b * b * b;
    }
    let k = a / b;
    let k2 = k * k;
    let complement = (b - a) * (b + a) / (b * b);
    let first_kind = elliprf(0.0, complement, 1.0).unwrap_or(f64::NAN);
    if k < 0.5 {
        // E = K − k²D removes the common leading term of E and K: no digits lost for small k.
        let d = elliprd(0.0, complement, 1.0).unwrap_or(f64::NAN) / 3.0;
        return 8.0 / 3.0 * b * a * a * (2.0 * first_kind - (1.0 + k2) * d);
    }
    let second_kind = 2.0 * elliprg(0.0, complement, 1.0).unwrap_or(f64::NAN);
    8.0 / 3.0 * b * b * b * ((1.0 + k2) * second_kind - complement * first_kind)
}

#[cfg(test)]
mod tests {
    use super::disc_interaction;
    use std::f64::consts::PI;

    /// u of a uniform disc of radius b at r < b is (4b/π) E(r/b): integrate it over the smaller disc.
    fn by_quadrature(a: f64, b: f64) -> f64 {
        let n = 4000;
        let mut sum = 0.0;
        for i in 0..n {
            let r = a * (f64::from(i) + 0.5) / f64::from(n);
            let complement = 1.0 - (r / b) * (r / b);
            let e = 2.0 * ellip::elliprg(0.0, complement, 1.0).unwrap();
            sum += 4.0 * b / PI * e * 2.0 * PI * r * a / f64::from(n);
        }
        sum
    }

    #[test]
    fn agrees_with_the_displacement_of_a_disc_integrated() {
        for (a, b) in [(0.001, 1.0), (0.3, 1.0), (0.499_999, 1.0), (0.500_001, 1.0), (0.9, 1.0), (1.7, 2.0)] {
            let (ours, reference) = (disc_interaction(a, b), by_quadrature(a, b));
            assert!((ours / reference - 1.0).abs() < 3e-7, "{a} {b}: {ours} {reference}");
        }
    }

    #[test]
    fn small_and_equal_discs_have_their_limits() {
        assert!((disc_interaction(1.0, 1.0) - 16.0 / 3.0).abs() < 1e-15);
        // A small disc feels the central displacement 2b of the large one.
        let a = 1e-6;
        assert!((disc_interaction(a, 1.0) / (2.0 * PI * a * a) - 1.0).abs() < 1e-11);
        assert!((disc_interaction(1.0 - 1e-12, 1.0) / (16.0 / 3.0) - 1.0).abs() < 1e-10);
    }
}
