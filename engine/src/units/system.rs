//! Reduced or SI: how a quantity is typed and shown.

use super::dimension::Quantity;
use super::table::{JOULE, KILO, METRE, MICRO, MILLI, NEWTON, NONE, NamedUnit, PASCAL, PICO, Prefix, SECOND};
use super::unit::{Factor, Unit};
use super::value::ValueError;
use std::fmt;

/// The units in which a problem is typed and shown.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a preset has one, and an error boxes it")]
pub enum UnitSystem {
    /// Pure numbers: E* and R are whatever the user makes them.
    Reduced,
    /// SI, with each quantity shown in its own unit.
    Si(DisplayUnits),
}

/// The unit in which each quantity is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct DisplayUnits {
    length: Unit,
    force: Unit,
    stress: Unit,
    energy_per_area: Unit,
    energy: Unit,
    force_per_length: Unit,
    time: Unit,
    /// The length per second and the force per second.
    speed: Unit,
    force_rate: Unit,
    /// The powers −1, −2, … of the length.
    inverse_lengths: Vec<Unit>,
}

impl Default for DisplayUnits {
    /// µm, µN, kPa, mJ/m², pJ and N/m: suited to a soft sphere of a millimetre.
    fn default() -> Self {
        let factor =
            |prefix: &'static Prefix, unit: &'static NamedUnit, power| Factor { prefix, unit, power };
        let one = |prefix, unit| Unit::of(vec![factor(prefix, unit, 1)]);
        let (length, force) = (one(&MICRO, &METRE), one(&MICRO, &NEWTON));
        Self {
            time: one(&NONE, &SECOND),
            speed: length.per_second(),
            force_rate: force.per_second(),
            inverse_lengths: inverses(&length),
            length,
            force,
            stress: one(&KILO, &PASCAL),
            energy_per_area: Unit::of(vec![factor(&MILLI, &JOULE, 1), factor(&NONE, &METRE, -2)]),
            energy: one(&PICO, &JOULE),
            force_per_length: Unit::of(vec![factor(&NONE, &NEWTON, 1), factor(&NONE, &METRE, -1)]),
        }
    }
}

/// The units of the powers −1, −2, … of a length.
fn inverses(length: &Unit) -> Vec<Unit> {
    (1..=Quantity::DEEPEST).map(|k| length.to_power(-i32::from(k))).collect()
}

impl DisplayUnits {
    /// The unit of a quantity; a pure number has none.
    pub fn unit(&self, quantity: Quantity) -> Option<&Unit> {
        Some(match quantity {
            Quantity::Length => &self.length,
            Quantity::Force => &self.force,
            Quantity::Stress => &self.stress,
            Quantity::EnergyPerArea => &self.energy_per_area,
            Quantity::Energy => &self.energy,
            Quantity::ForcePerLength => &self.force_per_length,
            Quantity::Speed => &self.speed,
            Quantity::ForceRate => &self.force_rate,
            Quantity::Time => &self.time,
            Quantity::InverseLength(k) => return self.inverse_lengths.get(usize::from(k).checked_sub(1)?),
            Quantity::Number => return None,
        })
    }

    /// The same units except for `quantity`, which is shown in the unit of this name. A pure number stays without a
    /// unit, inverse powers of a length and speeds follow the length, and rates of a force follow the force.
    ///
    /// # Errors
    /// A text that is not a unit, or a unit of another dimension.
    pub fn with(mut self, quantity: Quantity, name: &str) -> Result<Self, ValueError> {
        let unit = Unit::parse(name, 0)?;
        if unit.dimension() != quantity.dimension() {
            let got = unit.measures();
            return Err(ValueError::Dimension { expected: quantity, text: unit.to_string(), got });
        }
        match quantity {
            Quantity::Length => {
                self.inverse_lengths = inverses(&unit);
                self.speed = unit.per_second();
                self.length = unit;
            }
            Quantity::Force => {
                self.force_rate = unit.per_second();
                self.force = unit;
            }
            Quantity::Stress => self.stress = unit,
            Quantity::EnergyPerArea => self.energy_per_area = unit,
            Quantity::Energy => self.energy = unit,
            Quantity::ForcePerLength => self.force_per_length = unit,
            Quantity::Time => self.time = unit,
            Quantity::Speed => self.speed = unit,
            Quantity::ForceRate => self.force_rate = unit,
            Quantity::InverseLength(_) | Quantity::Number => {}
        }
        Ok(self)
    }
}

/// A value as shown: its [`Display`](fmt::Display) has every digit, so that it is read back as the same value.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown<'a> {
    /// The number, in the unit.
    pub number: f64,
    /// The unit, if it has one.
    pub unit: Option<&'a Unit>,
}

impl Shown<'_> {
    /// The text with the number written as `number`, in ASCII if the terminal can show nothing else.
    pub fn text(&self, number: &str, ascii: bool) -> String {
        match self.unit {
            None => number.to_owned(),
            Some(unit) if ascii => format!("{number} {}", unit.ascii()),
            Some(unit) => format!("{number} {unit}"),
        }
    }
}

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text(&format!("{:?}", self.number), false))
    }
}

impl UnitSystem {
    /// The unit in which a quantity is shown, if it has one.
    pub fn unit(&self, quantity: Quantity) -> Option<&Unit> {
        match self {
            Self::Reduced => None,
            Self::Si(units) => units.unit(quantity),
        }
    }

    /// The SI value of one display unit; 1 if there is none.
    pub fn factor(&self, quantity: Quantity) -> f64 {
        self.unit(quantity).map_or(1.0, |unit| unit.to_si(1.0))
    }

    /// How `value`, in SI or reduced units, is shown.
    pub fn shown(&self, quantity: Quantity, value: f64) -> Shown<'_> {
        let unit = self.unit(quantity);
        Shown { number: unit.map_or(value, |unit| unit.from_si(value)), unit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_in_micrometres() {
        let si = UnitSystem::Si(DisplayUnits::default());
        let shown = si.shown(Quantity::Length, 12.5e-6);
        assert_eq!((shown.to_string().as_str(), shown.text("12.5", true).as_str()), ("12.5 µm", "12.5 um"));
        assert_eq!(si.factor(Quantity::Stress).to_bits(), 1e3f64.to_bits());
        assert_eq!(si.shown(Quantity::Number, 0.25).to_string(), "0.25");
        assert_eq!(UnitSystem::Reduced.shown(Quantity::Length, 0.25).to_string(), "0.25");
    }

    #[test]
    fn display_units_have_the_dimension_of_their_quantity() {
        let units = DisplayUnits::default();
        for quantity in Quantity::ALL {
            assert_eq!(
                units.unit(quantity).map_or(quantity.dimension(), Unit::dimension),
                quantity.dimension()
            );
        }
        let units = units.with(Quantity::EnergyPerArea, "J/m^2").unwrap();
        assert_eq!(
            UnitSystem::Si(units.clone()).shown(Quantity::EnergyPerArea, 0.03).to_string(),
            "0.03 J/m²"
        );
        assert_eq!(
            units.with(Quantity::Length, "kPa").unwrap_err().to_string(),
            "expected a length such as um, got kPa, a stress"
        );
    }
}
