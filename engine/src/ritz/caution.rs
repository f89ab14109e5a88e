//! Warnings about the answers of ring elements.

use super::mesh::Grading;
use std::fmt;

/// Fewer rings than this per shortest wave in the largest contact raise a warning: losses are then off by several per
/// cent.
pub const RINGS_PER_WAVE: f64 = 10.0;

/// γ/(E* R) below which the error of 200 rings on a sphere exceeds the adhesion.
pub const WEAK_ADHESION: f64 = 1e-6;

/// A reason to trust the answers of rings less than usual; its text says what to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Caution {
    /// Too few rings for the waves of the gap.
    FewRings {
        /// Rings per wave.
        per_wave: f64,
        /// Rings that would be enough.
        wanted: f64,
        /// How they are spaced.
        grading: Grading,
    },
    /// The error of ring elements exceeds the adhesion; γ in reduced units.
    WeakAdhesion(f64),
}

impl fmt::Display for Caution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::FewRings { per_wave, wanted, grading } => {
                write!(
                    f,
                    "only {per_wave:.1} rings per wave in the largest contact; {RINGS_PER_WAVE} or more are needed: "
                )?;
                let fits = |grading: Grading| wanted <= *grading.ring_range().end() as f64;
                let most = *grading.ring_range().end();
                if fits(grading) {
                    write!(f, "set basis.rings to {wanted} or more")
                } else if fits(Grading::Uniform) {
                    write!(f, "even {most} graded rings are too few, set basis.grading to \"uniform\"")
                } else {
                    write!(f, "even {most} rings are too few, start from a smaller contact")
                }
            }
            Self::WeakAdhesion(gamma) => write!(
                f,
                "gamma/(E* R) = {gamma:.1e} is below {WEAK_ADHESION:.0e}: the error of ring elements exceeds so weak \
                 an adhesion"
            ),
        }
    }
}
