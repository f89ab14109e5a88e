//! Why there is no pull.

use crate::problem::Units;
use crate::progress::Stopped;
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};

/// Why there is no pull; lengths reduced until [`RateError::in_units`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RateError {
    /// The integrator found no next step at this radius.
    Lost {
        /// s.
        contact_radius: f64,
    },
    /// A closing edge is pressed there: the bodies would touch ahead of it.
    Pressed {
        /// s.
        contact_radius: f64,
    },
    /// It took too many.
    TooManySteps {
        /// How many.
        steps: usize,
        /// s there.
        contact_radius: f64,
    },
    /// The gap is not known as far as the contact would grow.
    Beyond {
        /// How far it is known.
        radius: f64,
    },
    /// Without adhesion the law of the edge says nothing.
    NoAdhesion,
    /// It was no longer wanted.
    Stopped(Stopped),
}

impl RateError {
    /// The same in the user's units.
    #[must_use]
    pub fn in_units(self, units: &Units) -> Self {
        match self {
            Self::Lost { contact_radius } => Self::Lost { contact_radius: contact_radius * units.length },
            Self::Pressed { contact_radius } => {
                Self::Pressed { contact_radius: contact_radius * units.length }
            }
            Self::TooManySteps { steps, contact_radius } => {
                Self::TooManySteps { steps, contact_radius: contact_radius * units.length }
            }
            Self::Beyond { radius } => Self::Beyond { radius: radius * units.length },
            other => other,
        }
    }

    /// In words, with lengths as `shown` has them.
    #[must_use]
    pub fn words(&self, shown: &UnitSystem) -> String {
        let length = |x| said(shown, Quantity::Length, x);
        match self {
            Self::Lost { contact_radius } => {
                format!(
                    "the moving edge could not be followed beyond the contact radius {}",
                    length(*contact_radius)
                )
            }
            Self::Pressed { contact_radius } => format!(
                "the closing edge is pressed at the contact radius {}: the bodies touch ahead of it, and a pull follows one disc",
                length(*contact_radius)
            ),
            Self::TooManySteps { steps, contact_radius } => format!(
                "the moving edge was given up after {steps} steps, at the contact radius {}",
                length(*contact_radius)
            ),
            Self::Beyond { radius } => {
                format!(
                    "the contact would grow beyond the radius {}, up to which the gap is known",
                    length(*radius)
                )
            }
            Self::NoAdhesion => {
                "without adhesion an edge has no speed of its own: material.work_of_adhesion must be above 0"
                    .to_owned()
            }
            Self::Stopped(Stopped) => "cancelled".to_owned(),
        }
    }
}
