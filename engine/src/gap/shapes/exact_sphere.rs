//! The sphere itself, not its paraboloid.
//!
//! ```text
//! h   = R − √(R² − r²) = r²/(R + z),   z = √(R² − r²)
//! h'  = r/z,   h'' = R²/z³,   h''' = 3R²r/z⁵
//! ```
//!
//! The second form of h loses no digits near the axis, and (R − r)(R + r) loses none near the equator. The gap ends at
//! r = R, where the surface of the sphere becomes vertical. R is a length. The exact solution is
//! [`theory::sphere`](crate::theory::sphere).

use crate::gap::{ComplexDisc, Gap, Jet};

/// h = R − √(R² − r²).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactSphere {
    /// R, positive, a length.
    pub radius: f64,
}

impl Gap for ExactSphere {
    fn jet(&self, r: f64) -> Jet {
        let radius = self.radius;
        // At r = R itself the slope is infinite: nothing can be computed there either.
        if r.is_nan() || r >= radius {
            return Jet::UNKNOWN;
        }
        let square = (radius - r) * (radius + r);
        let z = square.sqrt();
        let second = radius * radius / (square * z);
        Jet { value: r * r / (radius + z), first: r / z, second, third: 3.0 * r * second / square }
    }

    fn feature_length(&self) -> Option<f64> {
        None
    }

    /// |h'| = |z|/√(|R − z| |R + z|).
    fn slope_bound(&self, ComplexDisc { centre, radius, .. }: ComplexDisc) -> Option<f64> {
        let reach = centre.abs() + radius;
        let (near, far) = (self.radius - reach, self.radius + centre.abs() - radius);
        Some(if near > 0.0 { reach / (near * far).sqrt() } else { f64::INFINITY })
    }

    fn reference_length(&self) -> f64 {
        self.radius
    }

    fn largest_radius(&self) -> Option<f64> {
        Some(self.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::check_derivatives;
    use super::*;

    #[test]
    fn derivatives_agree_with_central_differences() {
        let sphere = ExactSphere { radius: 1.7 };
        for i in 1..17 {
            let r = 0.1 * f64::from(i);
            check_derivatives(&sphere, r, (1.7 - r).min(1.0));
        }
    }

    #[test]
    fn digits_near_the_axis_and_none_beyond_the_equator() {
        let sphere = ExactSphere { radius: 3.0 };
        // R − √(R² − r²) as written would give 0 here.
        let r = 1e-9;
        assert!((sphere.jet(r).value / (r * r / 6.0) - 1.0).abs() < 1e-15);
        assert!((sphere.jet(2.4).value - 1.2).abs() < 1e-15);
        for r in [3.0, 3.1, f64::INFINITY, f64::NAN] {
            let jet = sphere.jet(r);
            assert!([jet.value, jet.first, jet.second, jet.third].iter().all(|x| x.is_nan()), "{r}");
        }
        assert_eq!(sphere.largest_radius(), Some(3.0));
    }
}
