//! Preset → TOML text: every key, every digit, each with its meaning.

use super::family::{self, is_parameter};
use super::model::Preset;
use super::rows::parameter;
use super::schema::Parameter;
use super::shape::is_range;
use super::value::Value;
use crate::problem::Control;
use crate::units::{Quantity, UnitSystem, parse_quantity};

/// The preset as a file.
///
/// Keys that do not apply (the waves of a sphere, the starts not used) are left out. An end that follows from the start
/// is written as a comment, so that reading the file back gives the preset that was written.
pub fn write(preset: &Preset) -> String {
    let mut text = head(&preset.units).to_owned();
    let mut table = None;
    for row in preset.rows().filter(|row| !row.is_part() && !is_range(&row.key)) {
        let line = match preset.get(&row.key) {
            Some(value) if is_parameter(&row.key) => {
                line(row.name(), &toml_of_parameter(preset, &row, &value), &comment(&row))
            }
            Some(value) => line(row.name(), &toml(preset, &row, &value), &comment(&row)),
            None if row.key == FOLLOWING => following(&row),
            None => continue,
        };
        if row.table() != table.as_deref() {
            table = row.table().map(str::to_owned);
            text.push_str(&table.as_deref().map_or_else(String::new, |name| format!("\n{}\n", header(name))));
        }
        text.push_str(&line);
        text.push('\n');
    }
    text
}

/// The first line, which says what units bare numbers have.
pub fn head(units: &UnitSystem) -> &'static str {
    match units {
        UnitSystem::Reduced => "# A pulloff preset. Any consistent units.\n",
        UnitSystem::Si(_) => "# A pulloff preset. Numbers without a unit are SI.\n",
    }
}

/// The header of a table. All waves are elements of one array.
pub(super) fn header(table: &str) -> String {
    match family::below(table, family::WAVE_TABLE) {
        Some(_) => format!("[[{}]]", family::WAVE_TABLE),
        None => format!("[{table}]"),
    }
}

/// The column at which comments begin, after a space.
pub(super) const COMMENTS: usize = 40;

/// The key that is written as a comment if it follows from others.
pub(super) const FOLLOWING: &str = "path.end_contact_radius";

/// The comment in its place.
pub(super) fn following(row: &Parameter) -> String {
    line(&format!("# {}", row.name()), &row.fallback_text(), &comment(row))
}

/// A line with a key, its value and its meaning.
pub(super) fn line(name: &str, value: &str, comment: &str) -> String {
    format!("{:<COMMENTS$}{comment}", format!("{name} = {value}")).trim_end().to_owned()
}

/// A parameter of a formula as TOML, with its range and its unit if it has them.
pub(super) fn toml_of_parameter(preset: &Preset, row: &Parameter, value: &Value) -> String {
    let value = toml(preset, row, value);
    let ranges = family::PARAMETER_KEYS.iter().filter_map(|part| {
        let value = preset.get(&format!("{}.{part}", row.key))?;
        Some(format!(", {part} = {}", toml(preset, row, &value)))
    });
    match ranges.collect::<String>().as_str() {
        "" => value,
        ranges => format!("{{ value = {value}{ranges} }}"),
    }
}

/// A value of a row as TOML. In an SI preset it is text with the unit in which it is shown, provided that exactly the
/// same number is read back; it is bare if a unit of its own stands beside it.
pub(super) fn toml(preset: &Preset, row: &Parameter, value: &Value) -> String {
    let text = |quantity, number| {
        let shown = preset.units.shown(quantity, number);
        let text = shown.text(&format!("{:?}", shown.number), true);
        let back = parse_quantity(&text).and_then(|read| read.in_si(quantity, None));
        (shown.unit.is_some() && back == Ok(number)).then(|| toml::Value::String(text).to_string())
    };
    match value {
        Value::Number(x) if row.own_unit_in(&preset.units).is_some() => {
            let shown = row.shown(&preset.units, *x);
            let same = shown.unit.is_some_and(|unit| unit.to_si(shown.number).to_bits() == x.to_bits());
            if same {
                Some(format!("{:?}", shown.number))
            } else {
                row.exact_in_si(&preset.units, *x).map(|text| toml::Value::String(text).to_string())
            }
        }
        Value::Number(x) => text(row.quantity, *x),
        Value::Control(Control::Stiffness(k)) => {
            text(Quantity::ForcePerLength, *k).map(|text| format!("{{ stiffness = {text} }}"))
        }
        _ => None,
    }
    .unwrap_or_else(|| value.to_toml())
}

/// What a row means, as a comment; format and title are self-explanatory.
pub(super) fn comment(row: &Parameter) -> String {
    if row.table().is_none() {
        return String::new();
    }
    // If a part of the value has a dimension, that is the one worth naming.
    let part = parameter("path.control.stiffness").filter(|part| part.table() == Some(&*row.key));
    match (&*row.dimension, part) {
        ("", Some(part)) => format!(" # {} ({}: {})", row.meaning, part.name(), part.dimension),
        ("", None) => format!(" # {}", row.meaning),
        (dimension, _) => format!(" # {}, {} ({dimension})", row.label, row.meaning),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::read;
    use crate::gap::Shape;
    use crate::preset::fixtures::{any_preset, wavy};
    use crate::problem::Start;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    #[test]
    fn every_key_is_written() {
        let mut preset = wavy();
        preset.path.control = Control::Stiffness(0.15);
        let text = write(&preset);
        let lines: Vec<_> = text.lines().map(|line| line.split(" #").next().unwrap().trim()).collect();
        for expected in [
            "format = 1",
            "title = \"a wave\"",
            "[material]",
            "work_of_adhesion = 0.004",
            "[gap]",
            "shape = \"wavy-sphere\"",
            "radius_of_curvature = 1.0",
            "amplitude = 0.0025",
            "wavelength = 0.05",
            "kind = \"rings\"",
            "rings = 200",
            "control = { stiffness = 0.15 }",
            "start_contact_radius = 0.5",
            "end_contact_radius = 0.002",
        ] {
            assert!(lines.contains(&expected), "{expected} in\n{text}");
        }
        preset.gap = Shape::Sphere { radius_of_curvature: 1.0 };
        preset.path.start = Start::Force(0.1);
        preset.path.end_contact_radius = None;
        let text = write(&preset);
        assert!(!text.contains("amplitude") && text.contains("\nstart_force = 0.1"), "{text}");
        assert!(text.contains("\n# end_contact_radius = 0.004 x"), "{text}");
    }

    #[test]
    fn a_title_cannot_break_out_of_its_line() {
        let mut preset = wavy();
        for title in ["\"\"\"", "'''", "\\", "\"\nrings = 3", "# no comment", "'\"\\"] {
            preset.title = title.replace('\n', "\\n");
            assert_eq!(read("t", &write(&preset)).unwrap(), preset);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 256, rng_seed: RngSeed::Fixed(3), failure_persistence: None, ..ProptestConfig::default()
        })]

        #[test]
        fn what_is_written_reads_back(preset in any_preset()) {
            prop_assert_eq!(preset.check(), Ok(()));
            let text = write(&preset);
            prop_assert_eq!(read("p.toml", &text).unwrap(), preset, "{}", text);
        }
    }
}
