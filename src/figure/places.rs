//! The positions of numbers on an axis of a map.

use super::parts::{Axis, AxisScale};
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::Control;
use pulloff_engine::report::map::AxisReport;
use pulloff_engine::report::number::significant;
use pulloff_engine::stability::COMPLIANCE;
use pulloff_engine::text::greek;
use pulloff_engine::units::Quantity;

/// The positions of numbers on an axis.
#[derive(Debug, Clone)]
pub struct Places {
    /// The axis itself, with its title.
    pub axis: Axis,
    factor: f64,
    middle: Option<f64>,
    pub(super) ends: Option<[f64; 2]>,
}

impl Places {
    /// The positions on an axis of a map of `preset` under `control`, or that of the preset.
    pub fn of(axis: &AxisReport, preset: &Preset, control: Option<Control>) -> Self {
        let control = control.unwrap_or(preset.path.control);
        let quantity = match axis.key.as_str() {
            "control" if control == Control::Force => Quantity::Force,
            "force" => Quantity::Force,
            "control" | "approach" => Quantity::Length,
            key => preset.row(key).map_or(Quantity::Number, |row| row.quantity),
        };
        let symbol = match axis.key.as_str() {
            "control" if control == Control::Force => "P".to_owned(),
            "control" if matches!(control, Control::Stiffness(_)) => "Δ".to_owned(),
            "control" | "approach" => "δ".to_owned(),
            "force" => "P".to_owned(),
            COMPLIANCE => "1/k".to_owned(),
            key => preset.row(key).map_or_else(|| key.to_owned(), |row| greek(&row.label)),
        };
        let row = preset.row(&axis.key);
        let own = row.as_ref().and_then(|row| row.unit_in(&preset.units));
        let unit = own.or_else(|| preset.units.unit(quantity));
        let shown = unit.map_or_else(String::new, ToString::to_string);
        let factor = unit.map_or(1.0, |unit| unit.from_si(1.0));
        let symbol = match axis.middle {
            Some(middle) => format!("c/(c + {}), c = 1/k", significant(middle, 3)),
            None => symbol,
        };
        let run = if axis.logarithmic { AxisScale::Logarithmic } else { AxisScale::Linear };
        let axis_of = Axis { shown, ..Axis::pure(symbol).running(run) };
        let mut places = Self { axis: axis_of, factor, middle: axis.middle, ends: None };
        places.ends = axis.from.map(|from| [places.at(Some(from)), places.at(axis.to)]);
        places
    }

    /// The position of a number, in SI or reduced units; `None` is infinity.
    pub fn at(&self, value: Option<f64>) -> f64 {
        match (self.middle, value) {
            (Some(_), None) => 1.0,
            (Some(middle), Some(value)) => value / (value + middle),
            (None, Some(value)) => value * self.factor,
            (None, None) => f64::NAN,
        }
    }

    /// The number at a position; `None` is infinity.
    pub fn value(&self, place: f64) -> Option<f64> {
        match self.middle {
            Some(_) if place >= 1.0 => None,
            Some(middle) => Some(middle * place.max(0.0) / (1.0 - place)),
            None => Some(place / self.factor),
        }
    }
}
