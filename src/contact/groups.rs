//! The dimensionless groups people quote.

use super::problem::Problem;
use std::f64::consts::PI;

/// Dimensionless groups of a problem; those of the wave and of R are `None` for a gap without one.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
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
}

impl Groups {
    /// The groups of `problem`.
    pub fn of(problem: &Problem) -> Self {
        let Problem { effective_modulus: e, work_of_adhesion: gamma, ref shape } = *problem;
        let radius = shape.radius_of_curvature();
        let wave = shape.wave();
        // With A = 0 the last two are infinite, which says nothing: left out.
        let rough = wave.filter(|(a, _)| *a > 0.0);
        Self {
            amplitude_over_wavelength: wave.map(|(a, l)| a / l),
            wavelength_over_radius: wave.zip(radius).map(|((_, l), radius)| l / radius),
            connectivity: rough.zip(radius).map(|((a, l), radius)| l * l / (a * radius)),
            adhesion: radius.map(|radius| 2.0 * PI * gamma / (e * radius)),
            johnson: rough.map(|(a, l)| (2.0 * gamma * l / (PI * PI * e * a * a)).sqrt()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Shape;

    #[test]
    fn groups_of_figure_9() {
        let problem = Problem {
            effective_modulus: 1.0,
            work_of_adhesion: 0.025 / (2.0 * PI),
            shape: Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 },
        };
        let groups = Groups::of(&problem);
        let close = |a: Option<f64>, b: f64| (a.unwrap() - b).abs() < 1e-12;
        assert!(close(groups.amplitude_over_wavelength, 0.05));
        assert!(close(groups.wavelength_over_radius, 0.05));
        assert!(close(groups.connectivity, 1.0));
        assert!((groups.adhesion.unwrap() - 0.025).abs() < 1e-15);
        assert!((groups.johnson.unwrap() - 2.54).abs() < 0.01);
    }
}
