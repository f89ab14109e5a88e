//! Reduced numbers in sentences: scaled to the user's units and printed in one call, so that neither can be forgotten.

use super::control::Control;
use super::reduced::Units;
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};

/// Prints reduced numbers for a message: six digits, in the user's units.
#[derive(Debug, Clone, PartialEq)]
pub struct Printer {
    units: Units,
    shown: UnitSystem,
    /// The reduced control, where there is one.
    control: Option<Control>,
}

impl Printer {
    /// A printer of numbers that are reduced by `units`, as `shown` has them.
    pub fn new(units: &Units, shown: &UnitSystem) -> Self {
        Self { units: *units, shown: shown.clone(), control: None }
    }

    /// A printer of reduced numbers as they are.
    pub fn reduced() -> Self {
        Self::new(&Units::REDUCED, &UnitSystem::Reduced)
    }

    /// The same for a path under `control`, reduced.
    #[must_use]
    pub fn under(self, control: Control) -> Self {
        Self { control: Some(control), ..self }
    }

    /// A length.
    pub fn length(&self, x: f64) -> String {
        said(&self.shown, Quantity::Length, x * self.units.length)
    }

    /// A force.
    pub fn force(&self, x: f64) -> String {
        said(&self.shown, Quantity::Force, x * self.units.force)
    }

    /// A value of the control: a force under force control, else a length.
    pub fn control_value(&self, x: f64) -> String {
        if self.control == Some(Control::Force) { self.force(x) } else { self.length(x) }
    }

    /// How the path is controlled, as in `under displacement control`; nothing where that is not known.
    pub fn under_control(&self) -> String {
        match self.control {
            Some(Control::Stiffness(k)) => {
                let k = said(&self.shown, Quantity::ForcePerLength, k * self.units.stiffness);
                format!(" under stiffness={k} control")
            }
            Some(control) => format!(" under {control} control"),
            None => String::new(),
        }
    }
}
