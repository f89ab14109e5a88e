//! What is wrong with the table `[edge]`, and the parts of a test at a rate.

use super::edge::{CLOSING_ADHESION, EXPONENT, EdgeSpec, RATE, STEPS, rate_quantity};
use super::given::GivenValues;
use super::invalid::Invalid;
use super::model::Preset;
use super::resolve::shown;
use crate::problem::{Adhesion, Control, Part};
use crate::text::quote;
use crate::units::{Quantity, UnitSystem, parse_quantity};

/// What a part of [`STEPS`] may be.
const PARTS: &str = "to VALUE at RATE, hold TIME or apart at RATE, separated by ;";

impl GivenValues<'_> {
    /// The edge.
    pub(super) fn edge(&mut self) -> EdgeSpec {
        let steps = self.text(STEPS);
        EdgeSpec::read(|key| self.values.contains_key(key).then(|| self.number(key)), steps)
    }
}

impl EdgeSpec {
    /// What is wrong across several keys.
    pub(super) fn faults(&self, preset: &Preset) -> Vec<Invalid> {
        let gamma = preset.material.work_of_adhesion;
        let mut faults = Vec::new();
        if let Some(closing) = self.closing_work_of_adhesion.filter(|closing| *closing > gamma) {
            let units = &preset.units;
            let said = |x| shown(units, Quantity::EnergyPerArea, x);
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
        let short = [
            (self.exponent, EXPONENT, "an edge with a speed"),
            (self.closing_work_of_adhesion, CLOSING_ADHESION, "an edge that gains less on closing"),
        ];
        for (_, key, what) in short.into_iter().filter(|(set, ..)| set.is_some()) {
            if adhesion != Adhesion::ShortRange {
                let cause = format!(
                    "{what} needs short-range adhesion, and material.adhesion is \"{}\": remove one of the two",
                    adhesion.name()
                );
                faults.push(Invalid::Made { key: key.into(), cause });
            }
        }
        if self.rate.is_some() && !self.steps.trim().is_empty() {
            let cause = format!(
                "{STEPS} says what a pull does instead: remove one of the two, as with {RATE}=none or {STEPS}=none"
            );
            faults.push(Invalid::Made { key: RATE.into(), cause });
        }
        if let Err(cause) = preset.steps() {
            faults.push(Invalid::Made { key: STEPS.into(), cause });
        }
        faults
    }
}

impl Preset {
    /// What a pull does: the parts of `path.steps` or, if there are none, down at `path.rate` until the bodies are
    /// apart. In the units of the preset's numbers; empty if neither is given.
    ///
    /// # Errors
    /// What is wrong with the text of the parts.
    pub fn steps(&self) -> Result<Vec<Part>, String> {
        if self.edge.steps.trim().is_empty() {
            return Ok(self.edge.rate.map(|rate| Part::Apart { rate }).into_iter().collect());
        }
        let steps: Vec<Part> =
            self.edge.steps.split(';').map(|text| self.step(text.trim())).collect::<Result<_, _>>()?;
        if let Some(at) = steps.iter().position(|step| matches!(step, Part::Apart { .. }))
            && at + 1 < steps.len()
        {
            return Err("nothing follows \"apart\": the bodies have come apart".to_owned());
        }
        Ok(steps)
    }

    fn step(&self, text: &str) -> Result<Part, String> {
        let wrong = || format!("\"{}\" is not a part of a test: expected {PARTS}", quote(text));
        let is_force = self.path.control == Control::Force;
        let (word, rest) = text.split_once(char::is_whitespace).ok_or_else(wrong)?;
        let value = if is_force { Quantity::Force } else { Quantity::Length };
        let positive = |quantity, text: &str| {
            let number = self.of_step(quantity, text)?;
            let usable = (1e-30..=1e30).contains(&number);
            usable.then_some(number).ok_or_else(|| {
                format!("{} is out of range: it must be a number from 1e-30 to 1e30", quote(text.trim()))
            })
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
