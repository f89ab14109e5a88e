//! How the adhesion acts across the gap.

use crate::elementary::{cbrt, cos};
use std::f64::consts::PI;

/// Tabor's μ over Maugis' `λ_M`, where the largest tension is that of a Lennard-Jones gap: `h_c` = 0.97 z₀.
/// D. Maugis, J. Colloid Interface Sci. 150, 243 (1992), doi:10.1016/0021-9797(92)90285-T.
pub const TABOR_OVER_MAUGIS: f64 = 1.0 / 1.157;

/// `h_c` over z₀ for the same match.
pub const RANGE_OVER_ACTION: f64 = 0.97;

/// How the bodies adhere, as stated; every number is in the units of the preset.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Adhesion {
    /// At the edge of contact alone, the limit of Johnson, Kendall and Roberts.
    #[default]
    ShortRange,
    /// A constant tension within a range.
    Dugdale(StatedCohesion),
    /// A liquid bridge at a fixed humidity: the pressure of its meniscus acts within twice the meniscus radius.
    Capillary {
        /// `γ_L`, the surface tension of the liquid, an energy per area.
        surface_tension: f64,
        /// `r_K`, the radius of the meniscus, a length.
        kelvin_radius: f64,
        /// θ, the angle at which the liquid meets the bodies, in degrees, below 90.
        contact_angle: f64,
    },
}

/// What is stated about a constant tension besides its work of adhesion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StatedCohesion {
    /// σ₀, a stress.
    Strength(f64),
    /// `h_c`, a length.
    Range(f64),
    /// Neither: `h_c` = 0.97 z₀ of the range of action.
    Action,
}

impl Adhesion {
    /// The names, in the order of the variants.
    pub const NAMES: [&'static str; 3] = ["short-range", "dugdale", "capillary"];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::ShortRange => Self::NAMES[0],
            Self::Dugdale(_) => Self::NAMES[1],
            Self::Capillary { .. } => Self::NAMES[2],
        }
    }

    /// The tension and the range of this adhesion with the work of adhesion `gamma` and the range of action `z0`;
    /// `None` for one without a range, or if neither is known or there is no adhesion.
    pub fn cohesion(self, gamma: f64, z0: Option<f64>) -> Option<Cohesion> {
        let found = match self {
            Self::ShortRange => return None,
            Self::Dugdale(StatedCohesion::Strength(strength)) => {
                Cohesion { strength, range: gamma / strength }
            }
            Self::Dugdale(StatedCohesion::Range(range)) => Cohesion { strength: gamma / range, range },
            Self::Dugdale(StatedCohesion::Action) => {
                let range = RANGE_OVER_ACTION * z0?;
                Cohesion { strength: gamma / range, range }
            }
            Self::Capillary { surface_tension, kelvin_radius, contact_angle } => Cohesion {
                strength: surface_tension / kelvin_radius,
                range: 2.0 * kelvin_radius * cos(contact_angle.to_radians()),
            },
        };
        (found.work() > 0.0).then_some(found)
    }
}

/// Dugdale's law: the tension `strength` wherever the bodies are closer to each other than `range`, and none beyond.
/// The work of adhesion is their product.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cohesion {
    /// σ₀, a stress, positive.
    pub strength: f64,
    /// `h_c`, a length, positive.
    pub range: f64,
}

impl Cohesion {
    /// γ = `σ₀h_c`, an energy per area.
    pub fn work(self) -> f64 {
        self.strength * self.range
    }

    /// The same with lengths divided by `length` and stresses by `stress`.
    #[must_use]
    pub fn reduced_by(self, length: f64, stress: f64) -> Self {
        Self { strength: self.strength / stress, range: self.range / length }
    }

    /// Maugis' `λ_M` = σ₀(9R/(2πγE*²))^{1/3} for a radius of curvature R and a modulus E*.
    pub fn maugis(self, radius: f64, modulus: f64) -> f64 {
        cbrt(9.0 * radius * self.strength / (2.0 * PI * self.range * modulus)) * cbrt(self.strength / modulus)
    }
}
