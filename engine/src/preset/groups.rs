//! The dimensionless groups as values that can be set: each changes the values it follows from, and none is stored.
//!
//! | key | group | set, it changes | and holds |
//! |---|---|---|---|
//! | `groups.amplitude_over_wavelength` | A/λ | A | λ |
//! | `groups.wavelength_over_radius` | λ/R | λ and A | R and A/λ |
//! | `groups.adhesion` | γ' = 2πγ/(E*R) | γ | E* and R |

use super::invalid::Invalid;
use super::model::Preset;
use super::rows::parameter;
use super::schema::{self, Applies, CHOOSERS, Fallback, Key, Kind, Parameter, rivals};
use super::value::Value;
use crate::problem::Groups;
use crate::units::Quantity;
use std::f64::consts::TAU;

const WAVY: Applies = Applies::With { key: CHOOSERS[0], words: &["wavy-sphere"] };

/// The row of a group.
const fn group(key: &'static str, label: &'static str, meaning: &'static str, kind: Kind) -> Parameter {
    schema::row([key, label, meaning], ("", Quantity::Number), kind).or(Fallback::Computed)
}

/// The groups that can be set.
pub static GROUPS: [Parameter; 3] = [
    group(
        "groups.amplitude_over_wavelength",
        "A/lambda",
        "amplitude over wavelength; changes the amplitude",
        Kind::NonNegative,
    )
    .only(WAVY),
    group(
        "groups.wavelength_over_radius",
        "lambda/R",
        "wavelength over radius of curvature; changes wavelength and amplitude",
        Kind::Positive,
    )
    .only(WAVY),
    group("groups.adhesion", "gamma'", "2 pi gamma/(E* R); changes the work of adhesion", Kind::NonNegative),
];

/// The row of a group's key.
pub fn row(key: &str) -> Option<&'static Parameter> {
    GROUPS.iter().find(|row| row.key == key)
}

/// The value of a group, if the gap has the quantities for it.
pub fn get(preset: &Preset, key: &str) -> Option<Value> {
    let groups = Groups::of(&preset.problem(), preset.range_of_action(), preset.cohesion());
    let wavy = preset.gap.wave().is_some();
    match key {
        "groups.amplitude_over_wavelength" => groups.amplitude_over_wavelength.filter(|_| wavy),
        "groups.wavelength_over_radius" => groups.wavelength_over_radius.filter(|_| wavy),
        "groups.adhesion" => groups.adhesion,
        _ => None,
    }
    .map(Value::from)
}

/// What a group changes when it is set, and what it holds fixed, as the labels of rows; `None` for another key.
pub fn effect(key: &str) -> Option<[&'static str; 2]> {
    Some(match key {
        "groups.amplitude_over_wavelength" => ["A", "lambda"],
        "groups.wavelength_over_radius" => ["lambda and A", "R and A/lambda"],
        "groups.adhesion" => ["gamma", "E* and R"],
        _ => return None,
    })
}

/// The keys that a group changes when it is set; none for another key.
pub fn changed(key: &str) -> &'static [&'static str] {
    match key {
        "groups.amplitude_over_wavelength" => &["gap.amplitude"],
        "groups.wavelength_over_radius" => &["gap.wavelength", "gap.amplitude"],
        "groups.adhesion" => &["material.work_of_adhesion"],
        _ => &[],
    }
}

/// Whether two keys give the same thing, so that of two values only the later one would take effect: one key, two starts or turns,
/// a key and a part of it, or a group and a key that it changes.
pub fn are_rivals(one: &str, other: &str) -> bool {
    let is_part_of = |part: &str, whole: &str| {
        parameter(part).is_some_and(|row| row.is_part() && row.table() == Some(whole))
    };
    let is_changed = |group: &str, key: &str| changed(group).contains(&key);
    let both = |is: &dyn Fn(&str, &str) -> bool| is(one, other) || is(other, one);
    one == other || rivals(one).contains(&other) || both(&is_part_of) || both(&is_changed)
}

/// What a group changes when it is set to `x`, in this order.
///
/// # Errors
/// The gap has no such group.
pub fn changes(preset: &Preset, row: &Parameter, x: f64) -> Result<Vec<(Key, Value)>, Invalid> {
    let none = || {
        let belongs = match row.applies {
            Applies::With { key, words } => format!("{key} = {}", words.join(" or ")),
            Applies::Always | Applies::Spring => "gaps with a radius of curvature".to_owned(),
        };
        let chosen = format!("of the shape {}", preset.gap.name());
        Invalid::OtherChoice { key: row.key.clone(), belongs, what: "gap", chosen }
    };
    let wave = || preset.gap.wave().ok_or_else(none);
    let radius = preset.gap.radius_of_curvature().ok_or_else(none);
    Ok(match &*row.key {
        "groups.amplitude_over_wavelength" => vec![("gap.amplitude".into(), (x * wave()?.1).into())],
        "groups.wavelength_over_radius" => {
            let (amplitude, wavelength) = wave()?;
            let longer = x * radius?;
            let higher = amplitude / wavelength * longer;
            vec![("gap.wavelength".into(), longer.into()), ("gap.amplitude".into(), higher.into())]
        }
        _ => {
            let gamma = x * preset.material.effective_modulus * radius? / TAU;
            vec![("material.work_of_adhesion".into(), gamma.into())]
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures;
    use crate::preset::fixtures::wavy;
    use crate::preset::{read_with, write};

    fn number(preset: &Preset, key: &str) -> f64 {
        match preset.get(key) {
            Some(Value::Number(x)) => x,
            other => panic!("{key}: {other:?}"),
        }
    }

    #[test]
    fn a_group_changes_what_it_follows_from_and_holds_the_rest() {
        let near = |a: f64, b: f64| (a - b).abs() <= 4.0 * f64::EPSILON * b.abs();
        let old = wavy();
        for (key, x) in
            [(&GROUPS[0].key, 0.03), (&GROUPS[1].key, 0.1), (&GROUPS[2].key, 0.04), (&GROUPS[2].key, 0.0)]
        {
            let mut preset = old.clone();
            preset.set(key, x.into()).unwrap();
            for row in &GROUPS {
                let expected = if row.key == *key { x } else { number(&old, &row.key) };
                let got = number(&preset, &row.key);
                assert!(near(got, expected), "{key} = {x}: {} = {got}, not {expected}", row.key);
            }
            assert_eq!(preset.gap.radius_of_curvature(), old.gap.radius_of_curvature());
            assert_eq!(preset.material.effective_modulus.to_bits(), old.material.effective_modulus.to_bits());
            assert!(!write(&preset).contains("groups"));
            for row in preset.rows().filter(|row| preset.get(&row.key) != old.get(&row.key)) {
                assert!(changed(key).contains(&&*row.key), "{key}: {}", row.key);
            }
            // The words must name the rows that changed.
            let [labels, _] = effect(key).unwrap();
            let moved = preset.rows().filter(|row| preset.get(&row.key) != old.get(&row.key));
            assert_eq!(moved.filter(|row| !labels.contains(&*row.label)).count(), 0, "{key}");
        }
    }

    #[test]
    fn assignments_of_groups_come_after_all_others_in_their_order() {
        let text = write(&wavy());
        let sets = [
            "groups.amplitude_over_wavelength=1/10",
            "groups.wavelength_over_radius=0.02",
            "gap.radius_of_curvature=2",
        ];
        let preset = read_with("w", &text, &sets).unwrap();
        assert!((number(&preset, "gap.wavelength") - 0.04).abs() < 1e-16);
        assert!((number(&preset, "gap.amplitude") - 0.004).abs() < 1e-16);
        for (sets, words) in [
            (["gap.shape=sphere", "groups.wavelength_over_radius=0.1"], "belongs to gap.shape = wavy-sphere"),
            (
                ["title=x", "groups.adhesion=-1"],
                "--set groups.adhesion=-1: groups.adhesion = -1.0 is out of range",
            ),
            (["title=x", "groups.adhesion=1 N"], "expected a pure number"),
            (["title=x", "groups.johnson=1"], "unknown key groups.johnson"),
        ] {
            let message = read_with("w", &text, &sets).unwrap_err().to_string();
            assert!(message.contains(words), "{sets:?}: {message}");
        }
        let cone = fixtures::preset("cone");
        assert_eq!(get(&cone, "groups.adhesion"), None);
        assert!(cone.clone().set("groups.adhesion", 0.1.into()).is_err());
    }
}
