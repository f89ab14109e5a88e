//! Errors and warnings of a path in the user's units and in words.

use super::error::{PathError, Warning, beyond_zone};
use crate::annuli::{AnnuliError, ContactsError};
use crate::problem::{Control, Units};
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use crate::zone::FaultKind;

/// What a control value measures: a spring's other end is moved.
fn quantity(control: Control) -> Quantity {
    if control == Control::Force { Quantity::Force } else { Quantity::Length }
}

fn of_control(control: Control, units: &Units) -> f64 {
    if control == Control::Force { units.force } else { units.length }
}

/// What ends a path of one disc in one zone at a state δ, P, with its numbers as `shown` has them.
pub(super) fn beyond_zone_at(
    kind: Option<FaultKind>,
    radius: f64,
    [approach, force]: [f64; 2],
    shown: &UnitSystem,
) -> String {
    format!(
        "at the approach {} and the force {} {}",
        said(shown, Quantity::Length, approach),
        said(shown, Quantity::Force, force),
        beyond_zone(kind, &said(shown, Quantity::Length, radius))
    )
}

impl PathError {
    /// Whether another value would do, of the turn, the load or the gap; else the computation itself failed.
    #[must_use]
    pub fn is_of_values(&self) -> bool {
        !matches!(
            self,
            Self::State(_)
                | Self::NoLanding { .. }
                | Self::Lost { .. }
                | Self::TooLong { .. }
                | Self::Stopped(_)
        )
    }

    /// The same error with its numbers in the user's units.
    #[must_use]
    pub fn in_units(self, control: Control, units: &Units) -> Self {
        let (value, length) = (of_control(control, units), units.length);
        match self {
            Self::TurnBeforeTouch { turn, touch } => {
                Self::TurnBeforeTouch { turn: turn * value, touch: touch * value }
            }
            Self::NoTension { load } => Self::NoTension { load: load * units.force },
            Self::UnstableStart { contact_radius, searched } => {
                Self::UnstableStart { contact_radius: contact_radius * length, searched: searched * length }
            }
            Self::BeyondGap { radius, approach, force } => Self::BeyondGap {
                radius: radius * length,
                approach: approach * length,
                force: force * units.force,
            },
            Self::RadiusBeyondGap { radius, known } => {
                Self::RadiusBeyondGap { radius: radius * length, known: known * length }
            }
            Self::TooMany { error, approach } => Self::TooMany { error, approach: approach * length },
            Self::BeyondZone { kind, radius, approach, force } => Self::BeyondZone {
                kind,
                radius: radius * length,
                approach: approach * length,
                force: force * units.force,
            },
            Self::Unseen { radius } => Self::Unseen { radius: radius * length },
            Self::NeverTouches { searched } => Self::NeverTouches { searched: searched * length },
            Self::State(error) => Self::State(error.in_lengths(length)),
            Self::NoLanding { control_value, steps } => {
                Self::NoLanding { control_value: control_value * value, steps }
            }
            Self::Lost { control_value } => Self::Lost { control_value: control_value * value },
            Self::TooLong { steps, control_value } => {
                Self::TooLong { steps, control_value: control_value * value }
            }
            other => other,
        }
    }

    /// What is wrong, with the numbers, which are in the user's units, as `shown` has them.
    #[must_use]
    pub fn words(&self, control: Control, shown: &UnitSystem) -> String {
        let at = |x| said(shown, quantity(control), x);
        let length = |x| said(shown, Quantity::Length, x);
        let force = |x| said(shown, Quantity::Force, x);
        match *self {
            Self::TurnBeforeTouch { turn, touch } => {
                format!(
                    "the loop would turn at {}, before the bodies touch: turn above {}",
                    at(turn),
                    at(touch)
                )
            }
            Self::NoTension { load } => format!(
                "without adhesion a dead load of {} carries no contact: turn at a force above {}",
                force(load),
                force(0.0)
            ),
            Self::UnstableStart { contact_radius, searched } => {
                let control = match control {
                    Control::Stiffness(k) => {
                        format!("stiffness={}", said(shown, Quantity::ForcePerLength, k))
                    }
                    other => other.to_string(),
                };
                format!(
                    "the start state (contact radius {}) is unstable under {control} control and no stable state lies outward \
                     up to the contact radius {}",
                    length(contact_radius),
                    length(searched)
                )
            }
            Self::BeyondGap { radius, approach, force: load } => format!(
                "the contact grew to r = {}, up to where the gap is known, at the approach {} and the force {}: turn before",
                length(radius),
                length(approach),
                force(load)
            ),
            Self::RadiusBeyondGap { radius, known } => format!(
                "a turn at the radius {} lies beyond the gap, which is known up to r = {}: turn below that",
                length(radius),
                length(known)
            ),
            Self::State(AnnuliError::Contacts(ContactsError::NotAscending { before, .. })) => format!(
                "at r = {} the edges of a contact are closer to each other than numbers can tell apart: the gap is too high or \
                 too steep there",
                length(before)
            ),
            Self::TooMany { ref error, approach } => {
                format!("{error}, at the approach {}: turn before", length(approach))
            }
            Self::BeyondZone { kind, radius, approach, force: load } => {
                beyond_zone_at(kind, radius, [approach, load], shown)
            }
            Self::Unseen { radius } => format!("what lies up to r = {} is not known", length(radius)),
            Self::NeverTouches { searched } => {
                format!("the gap has no least value up to r = {}: the bodies never touch", length(searched))
            }
            Self::NoLanding { control_value, steps } => {
                format!(
                    "at the control value {} the edges did not land after {steps} steps",
                    at(control_value)
                )
            }
            Self::Lost { control_value } => {
                format!("the equilibria could not be followed beyond the control value {}", at(control_value))
            }
            Self::TooLong { steps, control_value } => format!(
                "the loop takes more than {steps} steps: it reached the control value {}; turn earlier",
                at(control_value)
            ),
            ref other => other.to_string(),
        }
    }
}

impl Warning {
    /// The warning, of a loop in reduced units, with its numbers in the user's.
    #[must_use]
    pub fn words(&self, control: Control, units: &Units, shown: &UnitSystem) -> String {
        match *self {
            Self::Digits { digits, control_value } => {
                let value = said(shown, quantity(control), control_value * of_control(control, units));
                format!("at the control value {value} edges are known to {digits:.1} digits only")
            }
            ref other => other.to_string(),
        }
    }
}
