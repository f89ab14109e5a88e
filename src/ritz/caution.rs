//! What to be careful about in the answers of a basis.

use super::rings::{RING_RANGE, RINGS_PER_WAVE, WEAK_ADHESION};
use super::spectral::{DIGITS_WANTED, FUNCTION_RANGE};
use std::fmt;

/// A reason to trust the answers of a basis less than one would; its text says what to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Caution {
    /// Too few rings for the waves of the gap.
    FewRings {
        /// Rings per wave.
        per_wave: f64,
        /// Rings that would be enough.
        wanted: f64,
    },
    /// The error of ring elements exceeds the adhesion; γ in reduced units.
    WeakAdhesion(f64),
    /// Too few eigenfunctions for the waves of the gap.
    FewFunctions {
        /// Their number.
        functions: usize,
        /// Decimal digits they can be trusted for.
        digits: f64,
        /// A number that is enough, where there is one.
        wanted: Option<usize>,
    },
}

impl fmt::Display for Caution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::FewRings { per_wave, wanted } => {
                write!(
                    f,
                    "only {per_wave:.1} rings per wave in the largest contact; {RINGS_PER_WAVE} or more are needed: "
                )?;
                let most = RING_RANGE.end();
                if wanted <= *most as f64 {
                    write!(f, "set basis.rings to {wanted} or more")
                } else {
                    write!(f, "even {most} rings are too few, start from a smaller contact")
                }
            }
            Self::FewFunctions { functions, digits, wanted } => {
                write!(
                    f,
                    "{functions} functions are good for {digits:.1} digits in the largest contact; {DIGITS_WANTED} or more \
                     are needed: "
                )?;
                let most = FUNCTION_RANGE.end();
                match wanted {
                    Some(wanted) => write!(f, "set basis.functions to {wanted} or \"auto\""),
                    None => write!(f, "even {most} functions are too few, start from a smaller contact"),
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
