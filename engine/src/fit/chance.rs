//! How likely a statistic is by chance: Student's t and Fisher's F, by the incomplete beta function.
//!
//! ```text
//! I_x(a, b) = x^a (1 − x)^b / (a B(a, b)) · 1/(1 + d₁/(1 + d₂/(1 + …)))       W. Gautschi; DLMF 8.17.22
//! P(t > τ) = ½ I_{ν/(ν + τ²)}(ν/2, ½),     P(F > f) = I_{d₂/(d₂ + d₁ f)}(d₂/2, d₁/2)
//! ```
//!
//! The fraction is summed by Lentz's method, to 1e-13 of its value. Crates of special functions use the machine's
//! library, whose last digits differ from machine to machine.

use crate::elementary::{exp, ln, ln_1p};
use crate::root;

/// The incomplete beta function.
fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    // Beyond the mean the fraction converges badly.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(1.0 - x, b, a);
    }
    let ln_beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    exp(a * ln(x) + b * ln_1p(-x) - ln_beta) / a / fraction(x, a, b)
}

/// The continued fraction, from its front.
fn fraction(x: f64, a: f64, b: f64) -> f64 {
    const TERMS: u32 = 20_000;
    const ENOUGH: f64 = 1e-14;
    let apart = |x: f64| if x.abs() < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { x };
    let (mut value, mut above, mut below) = (1.0, 1.0, 0.0);
    for i in 1..TERMS {
        let m = f64::from(i / 2);
        let d = if i.is_multiple_of(2) {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        below = 1.0 / apart(1.0 + d * below);
        above = apart(1.0 + d / above);
        let factor = above * below;
        value *= factor;
        if (factor - 1.0).abs() < ENOUGH {
            break;
        }
    }
    value
}

/// The chance that Student's t of `degrees` degrees of freedom is beyond ±`t`.
pub fn beyond_t(t: f64, degrees: f64) -> f64 {
    incomplete_beta(degrees / (degrees + t * t), 0.5 * degrees, 0.5)
}

/// The chance that F of `above` over `below` degrees of freedom is larger than `f`.
pub fn beyond_f(f: f64, above: f64, below: f64) -> f64 {
    incomplete_beta(below / (below + above * f), 0.5 * below, 0.5 * above)
}

/// The t beyond which, on either side, only this share lies: 1.96 for 0.05 and many degrees of freedom.
pub fn t_of(share: f64, degrees: f64) -> f64 {
    let mut hi = 1.0;
    while beyond_t(hi, degrees) > share && hi < 1e300 {
        hi *= 2.0;
    }
    root::halved(0.0, hi, |t| beyond_t(t, degrees) > share)[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quantiles_of_the_tables_are_found() {
        // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2 and 1.3.6.7.3.
        for (share, degrees, t) in [
            (0.05, 1.0, 12.706),
            (0.05, 4.0, 2.776),
            (0.05, 10.0, 2.228),
            (0.05, 100.0, 1.984),
            (0.05, 1e7, 1.959_964),
            (0.002, 10.0, 4.144),
            (0.01, 30.0, 2.750),
        ] {
            let found = t_of(share, degrees);
            assert!((found - t).abs() < 6e-4, "{share} {degrees}: {found}");
        }
        for (f, above, below, share) in [
            (4.965, 1.0, 10.0, 0.05),
            (2.978, 10.0, 10.0, 0.05),
            (4.849, 10.0, 10.0, 0.01),
            (1.975, 9.0, 100.0, 0.05),
        ] {
            let found = beyond_f(f, above, below);
            assert!((found - share).abs() < 0.02 * share, "{f}: {found}");
        }
        // With one degree above, F is the square of t, whatever the sizes.
        for degrees in [3.0, 50.0, 1e5] {
            assert!((beyond_f(9.0, 1.0, degrees) / beyond_t(3.0, degrees) - 1.0).abs() < 1e-10);
        }
    }
}
