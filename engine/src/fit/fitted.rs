//! One value that a fit finds, and what a key measures.

use super::intervals::Bootstrapped;
use super::problem::ADHESION;
use crate::preset::Preset;
use crate::preset::data::{BASELINE, OFFSET, TILT};
use crate::units::Quantity;

/// One fitted value, in base units.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// Its dotted key.
    pub key: String,
    /// The value.
    pub value: f64,
    /// Its standard error; `None` where it is not determined.
    pub standard_error: Option<f64>,
    /// The degrees of freedom of the square of that error; `None` where it is not determined.
    pub degrees: Option<f64>,
    /// The 95 % interval by Student's t; `None` where it is not determined.
    pub interval: Option<[f64; 2]>,
    /// Where the fit started.
    pub start: f64,
    /// The 95 % interval by the profile of χ², where it was asked for and found.
    pub profile: Option<[f64; 2]>,
    /// What the bootstrap found.
    pub bootstrap: Option<Bootstrapped>,
}

/// What a key measures.
#[must_use]
pub fn quantity(preset: &Preset, key: &str) -> Quantity {
    match key {
        OFFSET => Quantity::Length,
        BASELINE => Quantity::Force,
        TILT => Quantity::ForcePerLength,
        key if key.starts_with(ADHESION) => Quantity::EnergyPerArea,
        key => preset.row(key).map_or(Quantity::Number, |row| row.quantity),
    }
}
