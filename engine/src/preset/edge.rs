//! How an edge moves and at which rate it is pulled: the table `[edge]`, and the keys of other tables that belong to it.

use super::schema::{Parameter, Row};
use super::value::Value;
use crate::problem::Control;
use crate::units::Quantity;
use std::borrow::Cow;

/// The parts of a test.
pub const STEPS: &str = "path.steps";

/// Makes the keys of an edge, its values, and the ways from one to the other, from a row for each number.
macro_rules! edge {
    ($($(#[doc = $meaning:literal])+ $key:ident $name:literal $field:ident;)+) => {
        $($(#[doc = $meaning])+ pub const $key: &str = $name;)+

        /// All of them.
        pub const KEYS: &[&str] = &[$($key,)+ STEPS];

        /// How an edge moves, and at which rate it is pulled; numbers in SI or reduced units.
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct EdgeSpec {
            $($(#[doc = $meaning])+ pub $field: Option<f64>,)+
            /// The steps of a pull, instead of a single rate, as typed.
            pub steps: String,
        }

        impl EdgeSpec {
            /// The edge with the numbers that `number` gives for their keys, and these steps.
            pub(super) fn read(mut number: impl FnMut(&str) -> Option<f64>, steps: String) -> Self {
                Self { $($field: number($key),)+ steps }
            }

            /// Whether the energy that an opening edge takes up depends on its speed.
            pub fn has_law(&self) -> bool {
                self.exponent.is_some() && self.reference_speed.is_some()
            }

            /// The value of a key.
            pub(super) fn get(&self, key: &str) -> Option<Value> {
                match key {
                    $($key => self.$field.map(Value::from),)+
                    STEPS => Some(&*self.steps).filter(|steps| !steps.is_empty()).map(Value::from),
                    _ => None,
                }
            }
        }
    };
}

edge! {
    /// `γ_a`, the work of adhesion that a closing edge gains; none if it is γ.
    CLOSING_ADHESION "material.closing_work_of_adhesion" closing_work_of_adhesion;
    /// v₀, a speed.
    REFERENCE_SPEED "edge.reference_speed" reference_speed;
    /// n.
    EXPONENT "edge.exponent" exponent;
    /// `v_a`, a speed; none if it is v₀.
    CLOSING_SPEED "edge.closing_speed" closing_speed;
    /// m; none if it is n.
    CLOSING_EXPONENT "edge.closing_exponent" closing_exponent;
    /// The largest G/γ that the bodies can have.
    HIGHEST_RATIO "edge.highest_ratio" highest_ratio;
    /// τ, the longest relaxation time of the bodies.
    RELAXATION_TIME "edge.relaxation_time" relaxation_time;
    /// V, a speed or a force in a time.
    RATE "path.rate" rate;
}

/// The quantity of a rate under this control.
pub(super) fn rate_quantity(is_force: bool) -> Quantity {
    if is_force { Quantity::ForceRate } else { Quantity::Speed }
}

/// The row in a preset with this control: the rate of a force is not a speed.
pub(super) fn own(control: Control, row: &'static Parameter) -> Row {
    if row.key == RATE && control == Control::Force {
        let (dimension, quantity) = (Cow::Borrowed("force / time"), rate_quantity(true));
        return Row::Owned(Parameter { dimension, quantity, ..row.clone() });
    }
    Row::Borrowed(row)
}
