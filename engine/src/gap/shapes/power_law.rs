//! The power law, from the cone to the flat punch with a rounded edge.
//!
//! ```text
//! h = c rⁿ,   h' = n c rⁿ⁻¹,   h'' = n (n−1) c rⁿ⁻²,   h''' = n (n−1) (n−2) c rⁿ⁻³
//! ```
//!
//! n ≥ 1 is a real number. Whole powers are computed by multiplication, so that derivatives that vanish are exactly
//! zero. c is a length to the power 1 − n; for the cone, n = 1, it is the slope, the cotangent of the half apex angle.
//! On the axis h'' is infinite for 1 < n < 2, and h''' for 2 < n < 3. No rule of this program feels that, since both
//! enter multiplied by powers of r; the jet gives zero there, as the product is.
//!
//! The length by which the problem is reduced is the radius where the gap is half the radius, (2c)^(−1/(n−1)). It is R
//! for the paraboloid n = 2, c = 1/(2R). A cone has no length of its own, and the formula diverges towards it, so below
//! n = [`NEARLY_A_CONE`] the user's unit of length is used.
//!
//! The exact solution is [`theory::power_law`](crate::theory::power_law). L. A. Galin, *Contact Problems in the Theory
//! of Elasticity* (1953); I. N. Sneddon, Int. J. Eng. Sci. 3, 47 (1965), doi:10.1016/0020-7225(65)90019-4.

use crate::elementary::pow;
use crate::gap::{Breaks, ComplexDisc, Form, Gap, Jet, Parity};

/// Exponents below this are reduced like the cone: (2c)^(−1/(n−1)) may be decades away from every contact radius.
pub const NEARLY_A_CONE: f64 = 1.5;

/// h = c rⁿ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLaw {
    /// c, positive, a length to the power 1 − n.
    pub factor: f64,
    /// n, from 1 to 100. Below 1 the tip is a cusp without a disc of contact; above 100 the body is a flat punch.
    pub exponent: f64,
}

impl PowerLaw {
    /// Where a cone is not smooth: at its tip.
    pub const CONE_BREAKS: Breaks<'static> = Breaks { knots: &[], axis: Parity::Odd, cubic: false };

    /// The cone h = c r of slope `slope`, the cotangent of its half apex angle.
    #[must_use]
    pub fn cone(slope: f64) -> Self {
        Self { factor: slope, exponent: 1.0 }
    }

    /// rᵐ, or zero where it is singular on the axis.
    fn power(&self, r: f64, lowered: u8) -> f64 {
        let m = self.exponent - f64::from(lowered);
        if m < 0.0 && r <= 0.0 {
            return 0.0;
        }
        // Whole powers by multiplication: exact where the product is exact.
        #[expect(clippy::cast_possible_truncation, reason = "whole and at most 100")]
        if m.fract() == 0.0 { r.powi(m as i32) } else { pow(r, m) }
    }
}

impl Gap for PowerLaw {
    fn jet(&self, r: f64) -> Jet {
        let (n, c) = (self.exponent, self.factor);
        // A zero factor drops its power: the cone's h'' is 0 on the axis too.
        let term = |factor: f64, lowered: u8| {
            if factor == 0.0 { 0.0 } else { c * factor * self.power(r, lowered) }
        };
        Jet {
            value: term(1.0, 0),
            first: term(n, 1),
            second: term(n * (n - 1.0), 2),
            third: term(n * (n - 1.0) * (n - 2.0), 3),
        }
    }

    fn feature_length(&self) -> Option<f64> {
        None
    }

    fn breaks(&self) -> Breaks<'_> {
        let axis = match self.exponent {
            n if n.fract() != 0.0 => Parity::Broken,
            n if n % 2.0 == 0.0 => Parity::Even,
            _ => Parity::Odd,
        };
        Breaks { axis, ..Breaks::default() }
    }

    /// |zⁿ⁻¹| = |z|ⁿ⁻¹; a broken power has no bound around the axis, where it has a branch point.
    fn slope_bound(&self, ComplexDisc { centre, radius, .. }: ComplexDisc) -> Option<f64> {
        let n = self.exponent;
        if n.fract() != 0.0 && centre <= radius {
            return Some(f64::INFINITY);
        }
        Some((n * self.factor).abs() * pow(centre.abs() + radius, n - 1.0))
    }

    fn form(&self) -> Form {
        Form::Power { factor: self.factor, exponent: self.exponent }
    }

    fn reference_length(&self) -> f64 {
        if self.exponent < NEARLY_A_CONE { 1.0 } else { pow(2.0 * self.factor, -1.0 / (self.exponent - 1.0)) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::check_derivatives;
    use super::*;
    use crate::gap::Shape;

    #[test]
    fn derivatives_agree_with_central_differences() {
        for exponent in [1.0, 1.3, 1.5, 2.0, 2.5, 3.0, 4.0, 7.0, 19.0] {
            for r in [0.02, 0.3, 1.0, 4.0] {
                check_derivatives(&PowerLaw { factor: 0.4, exponent }, r, r / exponent);
            }
        }
    }

    #[test]
    fn the_paraboloid_is_the_sphere_of_the_paper() {
        let (law, sphere) =
            (PowerLaw { factor: 0.25, exponent: 2.0 }, Shape::Sphere { radius_of_curvature: 2.0 });
        assert!((law.reference_length() - sphere.reference_length()).abs() < 1e-15);
        for r in [0.0, 0.3, 1.7] {
            assert_eq!(law.jet(r), sphere.jet(r));
        }
    }

    #[test]
    fn the_axis_is_finite() {
        for exponent in [1.0, 1.2, 2.0, 2.3, 3.0, 5.0] {
            let jet = PowerLaw { factor: 3.0, exponent }.jet(0.0);
            assert!([jet.value, jet.first, jet.second, jet.third].iter().all(|x| x.is_finite()), "{jet:?}");
        }
        let cone = PowerLaw::cone(0.3);
        assert_eq!(cone.jet(0.0), Jet { first: 0.3, ..Jet::default() });
        assert!((cone.reference_length() - 1.0).abs() < 1e-15);
    }
}
