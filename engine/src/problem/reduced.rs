//! The problem and its reduced form.

use crate::gap::function::{Gap, Scaled};
use crate::gap::shape::Shape;
use std::sync::Arc;

/// An adhesive contact problem in the user's units.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// E*, a stress: 1/E* = (1−ν₁²)/E₁ + (1−ν₂²)/E₂.
    pub effective_modulus: f64,
    /// γ, the energy gained per unit area of contact (the work of adhesion), a stress times a length.
    pub work_of_adhesion: f64,
    /// The initial gap.
    pub shape: Shape,
}

/// The factors between reduced units and the user's: user = reduced × factor.
///
/// Reduced units have E* = 1 and lengths divided by a length of the problem (R = 1, where the gap has an R).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Of r, s, δ, λ, A.
    pub length: f64,
    /// Of P.
    pub force: f64,
    /// Of U and losses.
    pub energy: f64,
    /// Of the device stiffness k and of dP/dδ.
    pub stiffness: f64,
    /// Of pressures.
    pub pressure: f64,
    /// Of γ.
    pub work_of_adhesion: f64,
}

impl Units {
    /// Those of numbers that stay reduced.
    pub const REDUCED: Self =
        Self { length: 1.0, force: 1.0, energy: 1.0, stiffness: 1.0, pressure: 1.0, work_of_adhesion: 1.0 };
}

/// A problem in reduced units: what the core solves.
#[derive(Debug, Clone)]
pub struct Reduced {
    /// γ/(E* L).
    pub work_of_adhesion: f64,
    /// The gap in units of the length.
    pub gap: Arc<dyn Gap>,
    /// The factors back to the user's units.
    pub units: Units,
}

/// Contacts may come this close to the radius up to which the gap is known: at the equator of a sphere nothing is
/// finite.
const SHARE_OF_KNOWN: f64 = 0.995;

impl Reduced {
    /// The largest contact radius that can be computed; infinite where the gap is known everywhere.
    pub fn largest_contact(&self) -> f64 {
        self.gap.largest_radius().map_or(f64::INFINITY, |known| SHARE_OF_KNOWN * known)
    }
}

impl Problem {
    /// The same problem with E* = 1 and lengths in units of the gap's own length. If the gap has none, such as a cone,
    /// lengths are in units of γ/E*, or without adhesion in the user's unit.
    pub fn reduced(&self) -> Reduced {
        let adhesive = Some(self.work_of_adhesion / self.effective_modulus).filter(|length| *length > 0.0);
        self.reduced_by(self.shape.length().or(adhesive).unwrap_or(1.0))
    }

    /// The same problem with E* = 1 and lengths in units of `length`, a positive length.
    pub fn reduced_by(&self, length: f64) -> Reduced {
        let modulus = self.effective_modulus;
        let units = Units {
            length,
            force: modulus * length * length,
            energy: modulus * length * length * length,
            stiffness: modulus * length,
            pressure: modulus,
            work_of_adhesion: modulus * length,
        };
        Reduced {
            work_of_adhesion: self.work_of_adhesion / units.work_of_adhesion,
            gap: Arc::new(Scaled::new(self.shape.clone(), length)),
            units,
        }
    }
}
