//! The displacement of the surface outside the contact, r ≥ s, from the pressures on rings (E* = 1).
//!
//! A disc of radius b under unit pressure displaces the surface at r ≥ b by
//!
//! ```text
//! u(r) = (4r/π) [E(k) − k'²K(k)] = (4r/π) K(k) [½ k² − S],   k = b/r,   k'² = (r − b)(r + b)/r²
//! ```
//!
//! with K and S of the arithmetic-geometric mean of [`super::kernel`]. Far out, where S is nothing but rounding,
//! `u = r k² (1 + k²/8 + 3k⁴/64 + …)`. A pressure constant on rings is a sum of discs, `Σ (p_j − p_{j+1})` over the
//! outer edges, so a thin ring is never the difference of two nearly equal discs.

use super::kernel::mean;
use std::f64::consts::PI;

/// k² below which the next term of the series, of the order of k⁶, is less than rounding.
const FAR: f64 = 1e-5;

/// The displacement at `r ≥ b` by a unit pressure on a disc of radius `b`; radii and result in the same unit.
pub(super) fn by_disc(b: f64, r: f64) -> f64 {
    let complement = (r - b) * (r + b) / (r * r);
    if complement <= 0.0 {
        return 4.0 * b / PI;
    }
    let k = b / r;
    let k2 = k * k;
    if k2 < FAR {
        return r * k2 * (1.0 + k2 / 8.0 * (1.0 + 0.375 * k2));
    }
    let (first_kind, sum) = mean(complement);
    4.0 / PI * r * first_kind * (0.5 * k2 - sum)
}

#[cfg(test)]
mod tests {
    use super::super::Rings;
    use super::super::fixtures::wavy;
    use super::*;
    use crate::disc::{Basis, ExactBasis};
    use crate::theory::quadrature::integrate;
    use std::f64::consts::{FRAC_PI_2, TAU};

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

    #[test]
    fn a_disc_agrees_with_carlson_to_rounding() {
        // E − k'²K = k²k'² R_D(0, 1, k'²)/3 (B. C. Carlson, Numer. Algorithms 10, 13 (1995), doi:10.1007/BF02198293).
        for i in 1..60 {
            for k in [1.0 - 0.6_f64.powi(i), 0.6_f64.powi(i)] {
                let complement = (1.0 - k) * (1.0 + k);
                // At equal arguments, where the library divides zero by zero, R_D = 3π/4.
                let equal = 0.75 * PI;
                let carlson =
                    if complement < 1.0 { ellip::elliprd(0.0, 1.0, complement).unwrap() } else { equal };
                let exact = 4.0 / (3.0 * PI) * k * k * complement * carlson;
                assert!((by_disc(k, 1.0) / exact - 1.0).abs() < 3e-15, "{k}");
            }
        }
    }

    #[test]
    fn rings_leave_the_exact_gap() {
        for gamma in [0.0, 0.004] {
            let problem = wavy(gamma);
            for s in [0.03, 0.2, 0.413] {
                let exact = ExactBasis::of(&problem, 40.0 * s).unwrap();
                let delta = exact.equilibrium(&problem, s).unwrap().approach;
                let radii: Vec<f64> = RATIOS.iter().map(|ratio| s * ratio).collect();
                let ours = exact.gap_outside(&problem, s, delta, &radii);
                let mut errors = [0.0_f64; 2];
                for (i, rings) in [100, 400].into_iter().enumerate() {
                    let coarse = Rings::shared(rings).unwrap().gap_outside(&problem, s, delta, &radii);
                    for (a, b) in ours.iter().zip(&coarse).skip(4) {
                        errors[i] = errors[i].max((a - b).abs());
                    }
                }
                // Away from the edge, first order in the width of a ring.
                let size = s * s + (TAU * gamma * s).sqrt();
                assert!(
                    errors[1] < 0.35 * errors[0] && errors[1] < 0.01 * size,
                    "γ={gamma} s={s}: {errors:?}"
                );
            }
        }
    }
}
