//! How an edge moves and at which rate it is pulled: the table `[edge]`, and the keys of other tables that belong to it.

use super::schema::{Parameter, Row};
use super::value::Value;
use crate::problem::Control;
use crate::units::Quantity;
use std::borrow::Cow;

/// `γ_a`.
pub const CLOSING_ADHESION: &str = "material.closing_work_of_adhesion";
/// v₀.
pub const REFERENCE_SPEED: &str = "edge.reference_speed";
/// n.
pub const EXPONENT: &str = "edge.exponent";
/// `v_a`.
pub const CLOSING_SPEED: &str = "edge.closing_speed";
/// m.
pub const CLOSING_EXPONENT: &str = "edge.closing_exponent";
/// The largest G/γ.
pub const HIGHEST_RATIO: &str = "edge.highest_ratio";
/// τ.
pub const RELAXATION_TIME: &str = "edge.relaxation_time";
/// V.
pub const RATE: &str = "path.rate";
/// The parts of a test.
pub const STEPS: &str = "path.steps";

/// All of them.
pub const KEYS: [&str; 9] = [
    CLOSING_ADHESION,
    REFERENCE_SPEED,
    EXPONENT,
    CLOSING_SPEED,
    CLOSING_EXPONENT,
    HIGHEST_RATIO,
    RELAXATION_TIME,
    RATE,
    STEPS,
];

/// How an edge moves, and at which rate it is pulled; numbers in SI or reduced units.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EdgeSpec {
    /// `γ_a`, the work of adhesion that a closing edge gains; none if it is γ.
    pub closing_work_of_adhesion: Option<f64>,
    /// v₀, a speed.
    pub reference_speed: Option<f64>,
    /// n.
    pub exponent: Option<f64>,
    /// `v_a`, a speed; none if it is v₀.
    pub closing_speed: Option<f64>,
    /// m; none if it is n.
    pub closing_exponent: Option<f64>,
    /// The largest G/γ that the bodies can have.
    pub highest_ratio: Option<f64>,
    /// τ, the longest relaxation time of the bodies.
    pub relaxation_time: Option<f64>,
    /// V, a speed or a force in a time.
    pub rate: Option<f64>,
    /// The steps of a pull, instead of a single rate, as typed.
    pub steps: String,
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

impl EdgeSpec {
    /// The value of a key.
    pub(super) fn get(&self, key: &str) -> Option<Value> {
        let number = match key {
            CLOSING_ADHESION => self.closing_work_of_adhesion,
            REFERENCE_SPEED => self.reference_speed,
            EXPONENT => self.exponent,
            CLOSING_SPEED => self.closing_speed,
            CLOSING_EXPONENT => self.closing_exponent,
            HIGHEST_RATIO => self.highest_ratio,
            RELAXATION_TIME => self.relaxation_time,
            RATE => self.rate,
            STEPS => return Some(&*self.steps).filter(|steps| !steps.is_empty()).map(Value::from),
            _ => None,
        };
        number.map(Value::from)
    }
}
