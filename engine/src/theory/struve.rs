//! The Struve functions H₀ and H₁ of a real argument, the basis of the closed form of the wavy sphere.
//!
//! ```text
//! x < 4        H₀ = (2/π) Σ (−1)ᵏ x²ᵏ⁺¹/((2k+1)!!)²                     the power series
//! 4 … 30       H₀ = (4/π) Σ J₂ₖ₊₁/(2k+1),  k ≥ 0                        series of Bessel functions,
//!              H₁ = (2/π)(1 − J₀) + (4/π) Σ J₂ₖ/(4k² − 1),  k ≥ 1       these by Miller's backward recurrence
//! x > 30       Hᵥ = Yᵥ + (1/π) Σ Γ(k+½)(x/2)ᵛ⁻²ᵏ⁻¹/Γ(ν+½−k)            asymptotic, to its smallest term
//! ```
//!
//! Abramowitz and Stegun, *Handbook of Mathematical Functions*, 12.1.4, 12.1.5, 12.1.19, 12.1.20, 12.1.29. The power
//! series loses digits by cancellation beyond 4; below 30 the smallest term of the asymptotic series is still above
//! rounding.

use std::f64::consts::{FRAC_1_PI, FRAC_2_PI};

/// Where the power series ends: up to there its largest term is a few units, so cancellation costs one digit at most.
const SERIES_BELOW: f64 = 4.0;

/// Where the asymptotic series begins: from there its smallest term, about e⁻ˣ/x, is below 1e-14.
const ASYMPTOTIC_ABOVE: f64 = 30.0;

/// H₀(x) and H₁(x) for `x ≥ 0`, each with an absolute error of about 1e-15.
///
/// Below 4 the error is relative to the leading term, so that small arguments keep their digits.
pub fn struve(x: f64) -> (f64, f64) {
    if x < SERIES_BELOW {
        power_series(x)
    } else if x <= ASYMPTOTIC_ABOVE {
        bessel_series(x)
    } else {
        asymptotic(x)
    }
}

fn power_series(x: f64) -> (f64, f64) {
    let x2 = x * x;
    // The terms x²ᵏ⁺¹/((2k+1)!!)² of H₀ and x²ᵏ/((2k−1)!!)²/(2k+1) of H₁.
    let (mut t0, mut t1) = (x, x2 / 3.0);
    let (mut h0, mut h1) = (t0, t1);
    let mut odd = 1.0;
    // At x = 4 the fourteenth term is below 1e-20.
    for _ in 0..16 {
        odd += 2.0;
        t0 *= -x2 / (odd * odd);
        t1 *= -x2 / (odd * (odd + 2.0));
        h0 += t0;
        h1 += t1;
    }
    (FRAC_2_PI * h0, FRAC_2_PI * h1)
}

fn bessel_series(x: f64) -> (f64, f64) {
    // Far enough out J falls below 1e-17 of its largest value, so the recurrence may start with (tiny, 0).
    let mut order = 2.0 * (0.6 * x + 20.0).ceil();
    let (mut above, mut here) = (0.0, 1e-280);
    // With n the order of `here`: sums of J_odd/n, J_even/(n² − 1), and of J_even for the norm.
    let (mut sum0, mut sum1, mut norm) = (0.0, 0.0, 0.0);
    let step = 2.0 / x;
    while order > 0.0 {
        sum1 += here / (order * order - 1.0);
        norm += here;
        let odd = step * order * here - above;
        sum0 += odd / (order - 1.0);
        let even = step * (order - 1.0) * odd - here;
        (above, here) = (odd, even);
        order -= 2.0;
    }
    // J₀ + 2 Σ J₂ₖ = 1.
    let scale = 1.0 / (here + 2.0 * norm);
    (2.0 * FRAC_2_PI * sum0 * scale, FRAC_2_PI * (1.0 - here * scale) + 2.0 * FRAC_2_PI * sum1 * scale)
}

fn asymptotic(x: f64) -> (f64, f64) {
    let inverse = 1.0 / (x * x);
    let (mut t0, mut t1) = (2.0 * FRAC_1_PI / x, FRAC_2_PI);
    let (mut h0, mut h1) = (t0, t1);
    let mut odd = 1.0;
    loop {
        // The series diverges eventually: it is summed as long as its terms fall and still matter.
        let ratio = odd * odd * inverse;
        if ratio >= 1.0 || t0.abs() < 1e-18 {
            break;
        }
        t0 *= -ratio;
        t1 *= -odd * (odd - 2.0) * inverse;
        h0 += t0;
        h1 += t1;
        odd += 2.0;
    }
    (libm::y0(x) + h0, libm::y1(x) + h1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x, H₀(x), H₁(x): 20 digits, computed with 60.
    #[allow(clippy::excessive_precision, clippy::unreadable_literal, reason = "a table, digits as computed")]
    const TABLE: &[(f64, f64, f64)] = &[
        (1e-08, 6.3661977236758134932e-9, 2.1220659078919378849e-17),
        (0.001, 0.00063661970163205392268, 2.1220657664208814145e-7),
        (0.1, 0.063591269994933562282, 0.0021206516014255540975),
        (0.5, 0.30955591458375471816, 0.052173744242341070376),
        (1.0, 0.56865662704828795099, 0.19845733620194439894),
        (2.0, 0.79085884950809589255, 0.64676372828356211712),
        (3.0, 0.57430614881439839798, 1.0201095691864503608),
        (3.75, 0.24653701665101036968, 1.0920332809924300079),
        (3.9999999, 0.1350146167331758825, 1.0697266745506268624),
        (4.0, 0.13501457342248639716, 1.0697266613089193593),
        (4.5, -0.058543315969203845013, 0.96597435301165109978),
        (5.5, -0.22684990543059234946, 0.63238102638767273175),
        (7.0, 0.063382961188815946737, 0.34630573167866372618),
        (8.0, 0.30198811171013776689, 0.48811604612142114027),
        (10.0, 0.11874368368746126814, 0.89183249209453811111),
        (12.5, -0.12059425423131319775, 0.48678392023884316533),
        (15.0, 0.24772383098115124236, 0.66048729851196596531),
        (18.0, -0.15229072721822801602, 0.64672235231830120382),
        (20.0, 0.094393698081323450897, 0.47268818429104287988),
        (22.5, 0.075057802626939054832, 0.80049003104769754029),
        (25.0, -0.10182482016001510271, 0.53880362132692947616),
        (27.5, 0.17525438468022539136, 0.64121587754665044834),
        (29.0, 0.03140773440237148553, 0.78540821701124049956),
        (29.9999999, -0.096098413041100811803, 0.72175039036266647377),
        (30.0, -0.096098421554162110012, 0.72175037834698998506),
        (31.0, -0.11331771317777574776, 0.58390736410293126417),
        (33.0, 0.1184087620749217677, 0.54142265217051865043),
        (36.0, -0.063185758136932824228, 0.74156463340661633674),
        (40.0, 0.14184201928766455227, 0.63122341471176445168),
        (50.0, -0.085337674826118998952, 0.580078447945441899),
        (62.5, -0.080625179452570010499, 0.5920160826846568482),
        (75.0, -0.076882290637052720045, 0.60151910385440804463),
        (100.0, -0.070878751689647343204, 0.61631110327201338454),
        (150.0, -0.060898278245966600984, 0.63720501915919693456),
        (200.0, -0.051082755947557795729, 0.65193751124906568086),
        (500.0, 0.011779943191791686009, 0.67073339944525203343),
        (1000.0, 0.00535253711337635181, 0.61183607769309210107),
    ];

    #[test]
    fn both_agree_with_the_table() {
        for &(x, h0, h1) in TABLE {
            let (ours0, ours1) = struve(x);
            assert!((ours0 - h0).abs() <= 4e-15, "H0({x}) = {ours0}, {:e}", ours0 - h0);
            assert!((ours1 - h1).abs() <= 4e-15, "H1({x}) = {ours1}, {:e}", ours1 - h1);
            if x <= 1.0 {
                assert!((ours0 / h0 - 1.0).abs() <= 1e-15 && (ours1 / h1 - 1.0).abs() <= 1e-15, "{x}");
            }
        }
        assert_eq!(struve(0.0), (0.0, 0.0));
    }

    #[test]
    fn the_three_methods_meet() {
        for (x, one, other) in [
            (SERIES_BELOW, power_series(SERIES_BELOW), bessel_series(SERIES_BELOW)),
            (ASYMPTOTIC_ABOVE, bessel_series(ASYMPTOTIC_ABOVE), asymptotic(ASYMPTOTIC_ABOVE)),
        ] {
            assert!((one.0 - other.0).abs() <= 5e-15 && (one.1 - other.1).abs() <= 5e-15, "{x}");
        }
    }
}
