//! The interaction of two concentric, uniformly loaded discs on an elastic half-space.
//!
//! For unit pressures on discs of radii a ≤ b, k = a/b, and the Boussinesq kernel (3) with E* = 1,
//!
//! ```text
//! I(a, b) = ∫_{disc a} u[disc b] dS = (8/3) b³ [(1 + k²) E(k) − (1 − k²) K(k)]
//! ```
//!
//! with complete elliptic integrals of modulus k. Both come from one arithmetic-geometric mean that begins with 1 and
//! the complementary modulus k' = √((b − a)(b + a))/b, which keeps its digits for a thin ring. With `c_n` half the
//! difference of the two means, `S = Σ 2ⁿ⁻¹ c_n²` (n ≥ 1) and K = π/2 over their limit,
//!
//! ```text
//! E = K [(1 + k'²)/2 − S]     ⇒     (1 + k²) E − (1 − k²) K = K [½ k² (2 + k'²) − (1 + k²) S]
//! ```
//!
//! which also loses no digit at small k, where E and K agree (Abramowitz and Stegun 17.6).

use std::f64::consts::FRAC_PI_2;

/// A half-difference of the means below this share is the last that counts: the next one is its square.
const LAST_HALF_DIFFERENCE: f64 = 1e-8;

/// Most rounds of the mean: eight suffice for the smallest k' of two doubles that differ.
const MOST_ROUNDS: usize = 12;

/// I(a, b) for 0 ≤ a ≤ b, with radii in any unit of length; the result is in that unit cubed.
///
/// NaN if a radius is NaN; the factorization then reports it.
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
    let (first_kind, sum) = mean(complement);
    8.0 / 3.0 * b * b * b * first_kind * (0.5 * k2 * (2.0 + complement) - (1.0 + k2) * sum)
}

/// K and S of a squared complementary modulus 0 < k'² ≤ 1.
pub(super) fn mean(complement: f64) -> (f64, f64) {
    let (mut arithmetic, mut geometric) = (1.0, complement.sqrt());
    let (mut sum, mut weight) = (0.0, 1.0);
    for _ in 0..MOST_ROUNDS {
        let half = 0.5 * (arithmetic - geometric);
        geometric = (arithmetic * geometric).sqrt();
        arithmetic -= half;
        sum += weight * half * half;
        weight *= 2.0;
        if half <= LAST_HALF_DIFFERENCE * arithmetic {
            break;
        }
    }
    (FRAC_PI_2 / arithmetic, sum)
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
    fn agrees_with_carlson_to_rounding() {
        // E and K by Carlson's forms; for the thinnest rings the complementary modulus is about 1e-5.
        for i in 1..60 {
            for k in [1.0 - 0.7_f64.powi(i), 0.7_f64.powi(i)] {
                let complement = (1.0 - k) * (1.0 + k);
                let first = ellip::elliprf(0.0, complement, 1.0).unwrap();
                // E = K − k²D.
                let d = ellip::elliprd(0.0, complement, 1.0).unwrap() / 3.0;
                let exact = if k < 0.5 {
                    k * k * (2.0 * first - (1.0 + k * k) * d)
                } else {
                    (1.0 + k * k) * 2.0 * ellip::elliprg(0.0, complement, 1.0).unwrap() - complement * first
                };
                let ours = disc_interaction(k, 1.0) / (8.0 / 3.0);
                assert!((ours / exact - 1.0).abs() < 4e-15, "{k}: {ours} {exact}");
            }
        }
    }

    #[test]
    fn small_and_equal_discs_have_their_limits() {
        assert!((disc_interaction(1.0, 1.0) - 16.0 / 3.0).abs() < 1e-15);
        assert!(disc_interaction(f64::NAN, 1.0).is_nan() && disc_interaction(0.5, f64::NAN).is_nan());
        // A small disc feels the central displacement 2b of the large one.
        let a = 1e-6;
        assert!((disc_interaction(a, 1.0) / (2.0 * PI * a * a) - 1.0).abs() < 1e-11);
        assert!((disc_interaction(1.0 - 1e-12, 1.0) / (16.0 / 3.0) - 1.0).abs() < 1e-10);
    }
}
