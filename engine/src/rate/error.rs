//! Why there is no pull.

use crate::problem::Printer;
use crate::progress::Stopped;

/// Why there is no pull. All numbers are reduced.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{}", self.words(&Printer::reduced()))]
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
    /// It took too many steps.
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
    /// The pull was no longer wanted.
    Stopped(Stopped),
}

impl RateError {
    /// In words.
    pub fn words(&self, printer: &Printer) -> String {
        let length = |x| printer.length(x);
        match *self {
            Self::Lost { contact_radius } => {
                let radius = length(contact_radius);
                format!("the moving edge could not be followed beyond the contact radius {radius}")
            }
            Self::Pressed { contact_radius } => {
                let radius = length(contact_radius);
                format!(
                    "the closing edge is pressed at the contact radius {radius}: the bodies touch ahead of it, and a \
                     pull follows only one disc"
                )
            }
            Self::TooManySteps { steps, contact_radius } => {
                let radius = length(contact_radius);
                format!(
                    "the moving edge was abandoned after {steps} steps, at the contact radius {radius}: where (v/v0)^n \
                     is below about 1e-12, the drive of the edge is lost in rounding, and `unload` is the limit; where \
                     v/v0 is above about 1e12, the time is lost"
                )
            }
            Self::Beyond { radius } => {
                let radius = length(radius);
                format!("the contact would grow beyond the radius {radius}, up to which the gap is known")
            }
            Self::NoAdhesion => {
                "without adhesion an edge has no speed of its own: material.work_of_adhesion must be above 0"
                    .to_owned()
            }
            Self::Stopped(Stopped) => "cancelled".to_owned(),
        }
    }
}
