//! How an edge moves and at which rate it is pulled: the table `[edge]`, and the keys of other tables that belong to it.

use super::given::Given;
use super::invalid::Invalid;
use super::model::Preset;
use super::schema::{Parameter, Row};
use super::value::Value;
use crate::problem::{Adhesion, Control, Part};
use crate::text::quote;
use crate::units::{Quantity, UnitSystem, parse_quantity};
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

/// What a part of [`STEPS`] may be.
const PARTS: &str = "to VALUE at RATE, hold TIME or apart at RATE, with ; between two";

/// How an edge moves, and at which rate it is pulled; numbers in SI or reduced units.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EdgeSpec {
    /// `γ_a`, the work of adhesion that a closing edge gains; none where it is γ.
    pub closing_work_of_adhesion: Option<f64>,
    /// v₀, a speed.
    pub reference_speed: Option<f64>,
    /// n.
    pub exponent: Option<f64>,
    /// `v_a`, a speed; none where it is v₀.
    pub closing_speed: Option<f64>,
    /// m; none where it is n.
    pub closing_exponent: Option<f64>,
    /// The largest G/γ that the bodies can have.
    pub highest_ratio: Option<f64>,
    /// τ, the longest relaxation time of the bodies.
    pub relaxation_time: Option<f64>,
    /// V, a speed or a force in a time.
    pub rate: Option<f64>,
    /// What a pull does instead, as typed.
    pub steps: String,
}

/// What a rate of this control is.
pub(super) fn rate_quantity(is_force: bool) -> Quantity {
    if is_force { Quantity::ForceRate } else { Quantity::Speed }
}

/// The row of a preset with this control: the rate of a force is no speed.
pub(super) fn own(control: Control, row: &'static Parameter) -> Row {
    if row.key == RATE && control == Control::Force {
        let (dimension, quantity) = (Cow::Borrowed("force / time"), rate_quantity(true));
        return Row::Owned(Parameter { dimension, quantity, ..row.clone() });
    }
    Row::Borrowed(row)
}

impl Given<'_> {
    /// The edge.
    pub(super) fn edge(&mut self) -> EdgeSpec {
        let mut number = |key: &str| self.values.contains_key(key).then(|| self.number(key));
        EdgeSpec {
            closing_work_of_adhesion: number(CLOSING_ADHESION),
            reference_speed: number(REFERENCE_SPEED),
            exponent: number(EXPONENT),
            closing_speed: number(CLOSING_SPEED),
            closing_exponent: number(CLOSING_EXPONENT),
            highest_ratio: number(HIGHEST_RATIO),
            relaxation_time: number(RELAXATION_TIME),
            rate: number(RATE),
            steps: self.text(STEPS),
        }
    }
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

    /// What is wrong across keys.
    pub(super) fn faults(&self, preset: &Preset) -> Vec<Invalid> {
        let gamma = preset.material.work_of_adhesion;
        let mut faults = Vec::new();
        if let Some(closing) = self.closing_work_of_adhesion.filter(|closing| *closing > gamma) {
            let units = &preset.units;
            let said = |x| super::resolve::shown(units, Quantity::EnergyPerArea, x);
            faults.push(Invalid::Made {
                key: CLOSING_ADHESION.into(),
                cause: format!(
                    "{} is out of range: a closing edge gains at most the work of adhesion {}",
                    said(closing),
                    said(gamma)
                ),
            });
        }
        let adhesion = preset.material.adhesion;
        if self.exponent.is_some() && adhesion != Adhesion::ShortRange {
            faults.push(Invalid::Made {
                key: EXPONENT.into(),
                cause: format!(
                    "an edge with a speed needs short-range adhesion, and material.adhesion is \"{}\": remove one of the two",
                    adhesion.name()
                ),
            });
        }
        if let Err(cause) = preset.steps() {
            faults.push(Invalid::Made { key: STEPS.into(), cause });
        }
        faults
    }
}

impl Preset {
    /// What a pull does: the parts of `path.steps`, or, where it says none, down at `path.rate` until the bodies are apart. In the units
    /// of the preset's numbers; empty where neither is given.
    ///
    /// # Errors
    /// What is wrong with the text of the parts.
    pub fn steps(&self) -> Result<Vec<Part>, String> {
        if self.edge.steps.trim().is_empty() {
            return Ok(self.edge.rate.map(|rate| Part::Apart { rate }).into_iter().collect());
        }
        self.edge.steps.split(';').map(|text| self.step(text.trim())).collect()
    }

    fn step(&self, text: &str) -> Result<Part, String> {
        let wrong = || format!("\"{}\" is no part of a test: expected {PARTS}", quote(text));
        let is_force = self.path.control == Control::Force;
        let (word, rest) = text.split_once(char::is_whitespace).ok_or_else(wrong)?;
        let value = if is_force { Quantity::Force } else { Quantity::Length };
        let positive = |quantity, text: &str| {
            let number = self.of_step(quantity, text)?;
            let usable = (1e-30..=1e30).contains(&number);
            usable.then_some(number).ok_or_else(|| format!("{} must be above 0", quote(text.trim())))
        };
        match word {
            "hold" => Ok(Part::Hold { time: positive(Quantity::Time, rest)? }),
            "apart" => {
                let rate = rest.trim_start().strip_prefix("at ").ok_or_else(wrong)?;
                Ok(Part::Apart { rate: positive(rate_quantity(is_force), rate)? })
            }
            "to" => {
                let (to, rate) = rest.split_once(" at ").ok_or_else(wrong)?;
                let rate = positive(rate_quantity(is_force), rate)?;
                Ok(Part::Ramp { to: self.of_step(value, to)?, rate })
            }
            _ => Err(wrong()),
        }
    }

    fn of_step(&self, quantity: Quantity, text: &str) -> Result<f64, String> {
        let typed = parse_quantity(text.trim()).map_err(|error| error.to_string())?;
        let number =
            if self.units == UnitSystem::Reduced { typed.pure() } else { typed.in_si(quantity, None) };
        number.map_err(|error| error.to_string())
    }
}
