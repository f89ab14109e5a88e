//! Complete elliptic integrals by the arithmetic-geometric mean, four at a time.
//!
//! ```text
//! a₀ = 1, b₀ = k',   a_{n+1} = (a_n + b_n)/2, b_{n+1} = √(a_n b_n), c_{n+1} = (a_n − b_n)/2
//! K(k) = π/2a_∞,     E(k) = K (1 − Σ 2^{n−1} c_n²),  c₀ = k
//! ln(16 q/m) = −Σ_{n≥1} 2^{1−n} ln a_n,   q the nome of the parameter m = k²
//! ```
//!
//! The last follows from q(m)² = q(m₁) under Landen's transformation: with m → 0 both sides vanish. R. Brent, J. ACM 23, 242
//! (1976), for K and E.

use std::f64::consts::{FRAC_PI_2, PI};
use wide::f64x4;

/// K, (K − E)/m and ln(16 q/m) of a parameter m, 0 ≤ m < 1.
#[derive(Debug, Clone, Copy)]
pub struct Near {
    /// K.
    pub k: f64x4,
    /// (K − E)/m, π/4 at m = 0.
    pub d: f64x4,
    /// The power `ROOT` of 16 q/m: ln(16 q/m) = ln(`power`)/`ROOT`.
    pub power: f64x4,
}

/// Parameters up to here take four means.
pub const FOUR_MEANS: f64 = 0.75;

/// The power of 16 q/m in [`Near`].
pub const ROOT: f64 = -4.0;

/// The integrals of parameters up to [`FOUR_MEANS`], or of any below 1 − 1e-12 where `more` means are taken.
#[inline]
pub fn near(m: f64x4, more: bool) -> Near {
    let half = f64x4::splat(0.5);
    let k1 = (f64x4::ONE - m).sqrt();
    let a1 = half * (f64x4::ONE + k1);
    let c1 = half * m / (f64x4::ONE + k1);
    let b1 = k1.sqrt();
    let a2 = half * (a1 + b1);
    let c2 = half * (a1 - b1);
    let b2 = (a1 * b1).sqrt();
    let a3 = half * (a2 + b2);
    let c3 = half * (a2 - b2);
    let b3 = (a2 * b2).sqrt();
    let a4 = half * (a3 + b3);
    let c4 = half * (a3 - b3);
    let (two, four, eight) = (f64x4::splat(2.0), f64x4::splat(4.0), f64x4::splat(8.0));
    let mut sum = c1 * c1 + two * (c2 * c2) + four * (c3 * c3) + eight * (c4 * c4);
    let (mut last, mut fourth) = (a4, a4);
    if more {
        let (mut a, mut b) = (a4, (a3 * b3).sqrt());
        let mut weight = 16.0;
        let mut means = [a4; 4];
        for mean in &mut means[1..] {
            let c = half * (a - b);
            (a, b) = (half * (a + b), (a * b).sqrt());
            sum += f64x4::splat(weight) * (c * c);
            weight *= 2.0;
            *mean = a;
        }
        // (a₄^½ a₅^¼ …)², which is a₄ if the means end with a₄: then ln a₄ carries the weight of all that would follow.
        fourth = (a4 * (means[1] * (means[2] * means[3]).sqrt()).sqrt()).sqrt();
        last = a;
    }
    let k = f64x4::splat(FRAC_PI_2) / last;
    let d = k * (half + sum / m.max(f64x4::splat(f64::MIN_POSITIVE)));
    let a1_square = a1 * a1;
    Near { k, d, power: a1_square * a1_square * (a2 * a2) * a3 * fourth }
}

/// K and E of complementary moduli k', all of them at least the one that `means` was counted for.
#[inline]
pub fn far(complement: f64x4, means: u32) -> [f64x4; 2] {
    let half = f64x4::splat(0.5);
    let (mut a, mut b) = (f64x4::ONE, complement);
    let mut sum = half * (f64x4::ONE - complement) * (f64x4::ONE + complement);
    let mut weight = f64x4::ONE;
    for _ in 0..means {
        let c = half * (a - b);
        (a, b) = (half * (a + b), (a * b).sqrt());
        sum += weight * (c * c);
        weight += weight;
    }
    // The next mean, for which only the square of c is missing from the sum.
    let k = f64x4::splat(PI) / (a + b);
    [k, k * (f64x4::ONE - sum - half * weight * half * (a - b) * (a - b))]
}

/// K of complementary moduli k', all of them at least the one that `means` was counted for.
#[inline]
pub fn far_first(complement: f64x4, means: u32) -> f64x4 {
    let half = f64x4::splat(0.5);
    let (mut a, mut b) = (f64x4::ONE, complement);
    for _ in 0..means {
        (a, b) = (half * (a + b), (a * b).sqrt());
    }
    f64x4::splat(PI) / (a + b)
}

/// The means that [`far`] takes for complementary moduli of at least `least`.
pub fn means(least: f64) -> u32 {
    const ENOUGH: f64 = 1e-8;
    let (mut a, mut b) = (1.0, least.clamp(f64::MIN_POSITIVE, 1.0));
    let mut count = 0;
    while a - b > ENOUGH * a && count < 40 {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
        count += 1;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_those_of_the_library() {
        for m in [1e-9_f64, 1e-3, 0.01, 0.1, 0.3, 0.6, 0.749, 0.849, 0.9, 0.99, 0.9999, 0.999_999] {
            let near = near(f64x4::splat(m), m > FOUR_MEANS);
            let (k, e) = (ellip::ellipk(m).unwrap(), ellip::ellipe(m).unwrap());
            assert!((near.k.to_array()[1] / k - 1.0).abs() < 2e-15, "{m}: {:?} {k}", near.k);
            let d = if m > 1e-4 { (k - e) / m } else { std::f64::consts::FRAC_PI_4 * (1.0 + 0.375 * m) };
            assert!((near.d.to_array()[1] / d - 1.0).abs() < 1e-14 + 4e-16 / m.max(1e-4), "{m}");
            let nome = -PI * ellip::ellipk(1.0 - m).unwrap() / k;
            let ours = near.power.to_array()[2].ln() / ROOT;
            let theirs = nome + (16.0 / m).ln();
            // The library is asked for 1 − m, which has lost digits.
            assert!((ours - theirs).abs() < 2e-14 + 1e-15 / m, "{m}: {ours} {theirs}");
            let complement = (1.0 - m).sqrt();
            let [fk, fe] = far(f64x4::splat(complement), means(complement));
            assert!((fk.to_array()[0] / k - 1.0).abs() < 4e-14);
            assert!((fe.to_array()[0] / e - 1.0).abs() < 1e-13, "{m}");
        }
        let zero = near(f64x4::ZERO, false);
        assert!((zero.power.to_array()[0] - 1.0).abs() < 1e-16);
        assert!((zero.d.to_array()[0] - std::f64::consts::FRAC_PI_4).abs() < 1e-16);
    }
}
