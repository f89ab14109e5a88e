//! The dimensionless groups in common use.

use super::cohesion::{Cohesion, TABOR_OVER_MAUGIS};
use super::reduced::Problem;
use crate::elementary::cbrt;
use std::f64::consts::PI;

/// Dimensionless groups of a problem; those of the wave, of R and of z₀ are `None` where there is none.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Groups {
    /// A/λ.
    pub amplitude_over_wavelength: Option<f64>,
    /// λ/R.
    pub wavelength_over_radius: Option<f64>,
    /// λ²/(AR); above 8.5761 the gap rises monotonically.
    pub connectivity: Option<f64>,
    /// γ' = 2πγ/(E*R).
    pub adhesion: Option<f64>,
    /// Johnson's α = √(2γλ/(π²E*A²)).
    pub johnson: Option<f64>,
    /// Tabor's μ = (Rγ²/(E*²z₀³))^{1/3}, where a range of action z₀ is known; the JKR limit, which this method assumes,
    /// needs [`LARGE_TABOR`] or more. D. Tabor, J. Colloid Interface Sci. 58, 2 (1977), doi:10.1016/0021-9797(77)90366-6.
    pub tabor: Option<f64>,
    /// Maugis' `λ_M` = σ₀(9R/(2πγE*²))^{1/3} of adhesion with a range, of which μ is then `λ_M/1.157`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub maugis: Option<f64>,
}

/// Tabor's μ from which on the adhesion acts as if at the edge alone.
pub const LARGE_TABOR: f64 = 5.0;

impl Groups {
    /// The groups of `problem`, whose adhesion reaches as far as `range_of_action`, z₀, in its unit of length, or acts
    /// as `cohesion`.
    pub fn of(problem: &Problem, range_of_action: Option<f64>, cohesion: Option<Cohesion>) -> Self {
        let Problem { effective_modulus: e, work_of_adhesion: gamma, ref shape } = *problem;
        let radius = shape.radius_of_curvature();
        let wave = shape.wave();
        // With A = 0 the last two are infinite, which means nothing, so they are left out.
        let maugis = cohesion.zip(radius).map(|(cohesion, radius)| cohesion.maugis(radius, e));
        let rough = wave.filter(|(a, _)| *a > 0.0);
        Self {
            amplitude_over_wavelength: wave.map(|(a, l)| a / l),
            wavelength_over_radius: wave.zip(radius).map(|((_, l), radius)| l / radius),
            connectivity: rough.zip(radius).map(|((a, l), radius)| l * l / (a * radius)),
            adhesion: radius.map(|radius| 2.0 * PI * gamma / (e * radius)),
            johnson: rough.map(|(a, l)| (2.0 * gamma * l / (PI * PI * e * a * a)).sqrt()),
            tabor: maugis.map(|maugis| TABOR_OVER_MAUGIS * maugis).or_else(|| {
                radius
                    .zip(range_of_action)
                    .filter(|_| gamma > 0.0)
                    .map(|(radius, z0)| cbrt(radius / z0) * cbrt((gamma / (e * z0)).powi(2)))
            }),
            maugis,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::Shape;

    #[test]
    fn groups_of_figure_9() {
        let problem = Problem {
            effective_modulus: 1.0,
            work_of_adhesion: 0.025 / (2.0 * PI),
            shape: Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 },
        };
        let groups = Groups::of(&problem, None, None);
        let close = |a: Option<f64>, b: f64| (a.unwrap() - b).abs() < 1e-12;
        assert!(close(groups.amplitude_over_wavelength, 0.05));
        assert!(close(groups.wavelength_over_radius, 0.05));
        assert!(close(groups.connectivity, 1.0));
        assert!((groups.adhesion.unwrap() - 0.025).abs() < 1e-15);
        assert!((groups.johnson.unwrap() - 2.54).abs() < 0.01);
        assert_eq!(groups.tabor, None);
    }

    #[test]
    fn tabor_of_a_soft_and_of_a_hard_sphere() {
        let of = |effective_modulus, radius_of_curvature| {
            let shape = Shape::Sphere { radius_of_curvature };
            Groups::of(&Problem { effective_modulus, work_of_adhesion: 0.05, shape }, Some(3e-10), None)
                .tabor
                .unwrap()
        };
        // (5e-3 · 0.05²/(1e6² · 2.7e-29))^{1/3}, and a glass tip of nanometre radius.
        assert!((of(1e6, 5e-3) / 7736.6 - 1.0).abs() < 1e-4, "{}", of(1e6, 5e-3));
        assert!(of(7e10, 1e-8) < LARGE_TABOR);
    }
}
