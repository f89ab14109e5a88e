//! What the columns of CSV measure, for the person who reads their numbers.
//!
//! Programs read these files, so the header names stay as they are and no comment stands above them. The units are
//! given beside the files instead.

use crate::problem::Control;
use crate::units::{Quantity, UnitSystem};

/// The names of columns, separated by spaces: a header is read as it stands in the file.
macro_rules! columns {
    ($($name:ident)+) => { &[$(stringify!($name)),+] };
}
pub(super) use columns;

/// What a column of numbers measures; `None` for pure numbers, words and verdicts.
fn quantity(column: &str, control: Control) -> Option<Quantity> {
    let of_state = ["before_", "after_", "exact_", "peak_", "last_contact_"]
        .iter()
        .find_map(|prefix| column.strip_prefix(prefix));
    match of_state.unwrap_or(column) {
        "contact_radius" | "zone_radius" | "approach" | "area_slope" | "radius" | "inner_radius"
        | "outer_radius" => Some(Quantity::Length),
        "force" => Some(Quantity::Force),
        "time" => Some(Quantity::Time),
        "energy_release_rate" | "error" => Some(Quantity::EnergyPerArea),
        "rate" if control == Control::Force => Some(Quantity::ForceRate),
        "rate" | "speed" | "speed_error" | "top_edge_speed" => Some(Quantity::Speed),
        "energy" | "dissipated" | "dissipated_by_area" => Some(Quantity::Energy),
        "contact_stiffness" | "tangent_stiffness" | "held_stiffness" => Some(Quantity::ForcePerLength),

        // For a spring, how far its other end is moved.
        "control" => Some(if control == Control::Force { Quantity::Force } else { Quantity::Length }),
        _ => None,
    }
}

/// The SI unit of a column; nobody types an area, so it is not one of our quantities.
fn unit(column: &str, control: Control) -> Option<&'static str> {
    match column {
        "area" | "before_area" | "after_area" => Some("m^2"),
        column => quantity(column, control).and_then(Quantity::si),
    }
}

/// The units of the columns in one line; `None` in reduced units, which have none.
pub fn units(columns: &[&str], control: Control, units: &UnitSystem) -> Option<String> {
    if *units == UnitSystem::Reduced {
        return None;
    }
    sentence(columns.iter().filter_map(|column| Some((*column, unit(column, control)?))))
}

/// The names of columns with their units in one line, each name once; `None` if there are none.
pub fn sentence<'a>(columns: impl IntoIterator<Item = (&'a str, &'a str)>) -> Option<String> {
    let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
    for (column, unit) in columns {
        match groups.iter_mut().find(|(known, _)| *known == unit) {
            Some((_, names)) if names.contains(&column) => {}
            Some((_, names)) => names.push(column),
            None => groups.push((unit, vec![column])),
        }
    }
    let told: Vec<String> =
        groups.iter().map(|(unit, names)| format!("{} in {unit}", names.join(", "))).collect();
    (!told.is_empty()).then(|| format!("units of the columns: {}", told.join("; ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{path, speeds, trace};
    use crate::units::DisplayUnits;

    #[test]
    fn every_column_has_its_unit_or_needs_none() {
        let pure = [
            "step",
            "newton_iterations",
            "stable_displacement",
            "stable_force",
            "stable_chosen",
            "admissible",
            "exact_relative_difference",
            "kind",
            "number",
            "direction",
            "before_wave",
            "after_wave",
            "before_rings",
            "after_rings",
            "state",
            "piece",
            "contact",
            "window",
            "segment",
            "row",
        ];
        let all = trace::COLUMNS
            .iter()
            .chain(trace::EXACT_COLUMNS)
            .chain(path::COLUMNS)
            .chain(path::STATE_COLUMNS)
            .chain(speeds::COLUMNS);
        for column in all {
            assert_eq!(unit(column, Control::Force).is_none(), pure.contains(column), "{column}");
        }
        let si = UnitSystem::Si(DisplayUnits::default());
        assert_eq!(
            units(trace::COLUMNS, Control::Force, &si).unwrap(),
            "units of the columns: contact_radius, approach, area_slope in m; force in N; energy in J; \
             contact_stiffness, tangent_stiffness in N/m"
        );
        let value = |control| units(&["control"], control, &si).unwrap();
        assert!(
            value(Control::Force).ends_with(" in N") && value(Control::Stiffness(1.0)).ends_with(" in m")
        );
        assert_eq!(units(trace::COLUMNS, Control::Force, &UnitSystem::Reduced), None);
    }
}
