//! What turns one preset into another: assignments as a user would type them.

use super::groups;
use super::model::Preset;
use super::schema::{CHOOSERS, Fallback, Key, Kind, NONE, Parameter, SYSTEMS};
use super::value::Value;
use crate::units::UnitSystem;

/// Keys that come first, because they decide which other keys there are.
const FIRST: [&str; 6] = [CHOOSERS[2], CHOOSERS[0], CHOOSERS[1], CHOOSERS[3], "gap.formula", "gap.file"];

/// The assignments that turn `from` into `to`, in an order in which each is valid; `None` if there are none, for
/// example because an optional key would have to be removed. Numbers keep every digit.
pub fn changes(from: &Preset, to: &Preset) -> Option<Vec<(Key, String)>> {
    let (mut now, mut made) = (from.clone(), Vec::new());
    if to.units == UnitSystem::Reduced && now.units != to.units {
        now.assign(CHOOSERS[2], SYSTEMS[0]).ok()?;
        made.push((CHOOSERS[2].into(), SYSTEMS[0].to_owned()));
    }
    for row in FIRST.iter().filter_map(|key| to.row(key)) {
        change(&mut now, to, &row, &mut made);
    }
    // A value may be valid only after another has changed.
    while now != *to {
        let left: Vec<_> =
            to.rows().filter(|row| !row.is_part() && groups::row(&row.key).is_none()).collect();
        let changed = left.iter().filter(|row| change(&mut now, to, row, &mut made)).count();
        if changed == 0 {
            return None;
        }
    }
    Some(made)
}

/// Every value in which `to` differs from `from`, to be applied all together as `--set` does. The caller must check
/// whether the result is `to`.
pub fn differences(from: &Preset, to: &Preset) -> Vec<(Key, String)> {
    let rows = to.rows().filter(|row| !row.is_part() && groups::row(&row.key).is_none());
    rows.filter_map(|row| {
        let value = wanted(from, to, &row).filter(|value| from.get(&row.key).as_ref() != Some(value))?;
        Some((row.key.clone(), typed(&row, &to.units, &value)))
    })
    .collect()
}

/// The value that `to` has, or else the word that removes the value that `now` has.
fn wanted(now: &Preset, to: &Preset, row: &Parameter) -> Option<Value> {
    let word = match row.fallback {
        Fallback::Text(word) if row.table() == Some("data") => Some(word),
        _ => row.is_optional().then_some(NONE),
    };
    to.get(&row.key).or_else(|| word.filter(|_| now.get(&row.key).is_some()).map(Value::from))
}

/// Gives `now` the value that `to` has; false if it has it already or cannot have it yet.
fn change(now: &mut Preset, to: &Preset, row: &Parameter, made: &mut Vec<(Key, String)>) -> bool {
    let Some(value) = wanted(now, to, row) else { return false };
    if now.get(&row.key).as_ref() == Some(&value) {
        return false;
    }
    let text = typed(row, &to.units, &value);
    let mut changed = now.clone();
    // The rows of a file are already in memory and need not be read for this.
    let done = match row.kind {
        Kind::File | Kind::Points => changed.set(&row.key, value),
        _ => changed.assign(&row.key, &text),
    };
    // A bare number may be in a unit that `now` still has and `to` does not.
    let done = done.is_ok() && changed.get(&row.key) == to.get(&row.key);
    if done {
        *now = changed;
        made.push((row.key.clone(), text));
    }
    done
}

/// A value as a user types it, quoted where it would otherwise be read as something else.
fn typed(row: &Parameter, units: &UnitSystem, value: &Value) -> String {
    if let Value::Number(x) = value
        && let Some(exact) = row.exact_in_si(units, *x)
    {
        return exact;
    }
    let plain = value.to_string();
    match row.parse(&plain) {
        Ok(back) if back == *value => plain,
        _ if matches!(value, Value::Text(_)) => value.to_toml(),
        _ => plain,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::preset;
    use crate::preset::fixtures::any_preset;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    #[test]
    fn nothing_changed_is_nothing_and_a_turned_value_is_one_assignment() {
        let from = preset("wavy-sphere");
        assert_eq!(changes(&from, &from), Some(Vec::new()));
        let mut to = from.clone();
        to.assign("gap.amplitude", "0.1").unwrap();
        to.assign("title", "\"12\"").unwrap();
        let expected = [("title", "12"), ("gap.amplitude", "0.1")];
        let expected = expected.map(|(key, text)| (Key::from(key), text.to_owned()));
        assert_eq!(changes(&from, &to), Some(expected.to_vec()));
        // A value that need not be given can be removed.
        let mut from = from;
        from.reset("path.end_contact_radius").unwrap();
        to.assign("path.end_contact_radius", "0.01").unwrap();
        to.assign("material.closing_work_of_adhesion", "0.001").unwrap();
        for (from, to) in [(&from, &to), (&to, &from)] {
            let mut changed = from.clone();
            changed.assign_all(&changes(from, to).unwrap()).unwrap();
            assert_eq!(changed, *to);
        }
        // A measured curve can be removed.
        let (with, mut without) = (preset("lens"), preset("lens"));
        without.set("data.file", "none".into()).unwrap();
        without.set("data.free", "".into()).unwrap();
        let expected = [("data.file", "none"), ("data.free", "")];
        let expected = expected.map(|(key, text)| (Key::from(key), text.to_owned()));
        assert_eq!(changes(&with, &without), Some(expected.to_vec()));
        assert_eq!(changes(&without, &with).unwrap()[0].1, "shipped:lens.csv");
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 200, rng_seed: RngSeed::Fixed(11), failure_persistence: None, ..ProptestConfig::default()
        })]

        #[test]
        fn the_assignments_lead_from_one_preset_to_the_other(from in any_preset(), to in any_preset()) {
            if let Some(all) = changes(&from, &to) {
                let mut now = from.clone();
                for (key, text) in all {
                    now.assign(&key, &text).unwrap();
                }
                prop_assert_eq!(&now, &to);
            }
            // From a preset to itself there is always a way, and it is empty.
            prop_assert_eq!(changes(&to, &to), Some(Vec::new()));
        }
    }
}
