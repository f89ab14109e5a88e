//! Curves kept on the screen for comparison with later ones.
//!
//! A pin is named by the values in which it differs from the current preset, so its name changes with the preset.

use super::command::Id;
use super::curve::CurveData;
use pulloff_engine::case::Case;
use pulloff_engine::preset::model::BasisSpec;
use pulloff_engine::preset::schema::NONE;
use pulloff_engine::preset::{Preset, Row, Value};
use pulloff_engine::problem::{Begin, Control};
use pulloff_engine::report::PathReport;
use pulloff_engine::report::number::short;
use pulloff_engine::ritz::{NewtonSettings, solve};
use pulloff_engine::units::UnitSystem;
use std::collections::HashSet;
use std::mem::{self, discriminant};
use std::sync::Arc;

/// The most curves that can be pinned: each has its own letter and colour.
pub const MOST: usize = LETTERS.len();

/// What the pins are called: digits are those of events, and no mark or other line of a chart has these letters.
pub(super) const LETTERS: [&str; 6] = ["D", "E", "F", "G", "H", "I"];

/// The letter of the pin with this number.
pub fn letter(number: usize) -> &'static str {
    LETTERS[number.saturating_sub(1) % MOST]
}

/// The number of the pin with this letter.
pub(super) fn number_called(name: &str) -> Option<usize> {
    LETTERS.iter().position(|letter| letter.eq_ignore_ascii_case(name)).map(|at| at + 1)
}

/// The number of differences that are named; the others are counted.
const NAMED: usize = 3;

/// A pinned curve.
#[derive(Debug, Clone)]
pub struct Pin {
    /// Its number, from 1 to [`MOST`]; it keeps the number when others are removed.
    pub number: usize,
    /// The curve, with the preset it was computed from.
    pub curve: Arc<CurveData>,
    /// The loop, where the walk of its values follows one.
    pub whole: Option<Arc<PathReport>>,
    /// If either it or the curve beside it uses ring elements and the other is exact: how accurate the elements are.
    pub elements: Option<Elements>,
}

/// The accuracy of the paper's ring elements, compared with the exact solution of the same problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elements {
    /// N.
    pub count: usize,
    /// The largest pull over the exact one, minus 1.
    pub off: f64,
    /// The Newton-Raphson iterations from the exact contact radius of that state to theirs; `None` if they do not
    /// converge.
    pub iterations: Option<usize>,
}

impl Elements {
    /// Compares two curves of one problem, one in ring elements and one exact, in either order.
    pub fn of(a: &CurveData, b: &CurveData) -> Option<Self> {
        let basis = |curve: &CurveData| curve.setting.preset.basis;
        let (rings, exact) = if basis(a) == BasisSpec::Exact { (b, a) } else { (a, b) };
        let BasisSpec::Rings { rings: count, .. } = basis(rings) else { return None };
        if (Preset { basis: BasisSpec::Exact, ..rings.setting.preset.clone() }) != exact.setting.preset {
            return None;
        }
        let [own, at] = [rings, exact].map(|curve| curve.report.as_ref()?.totals.pull());
        let (own, at) = (own?, at?);
        let Case { basis, reduced, .. } = &rings.case;
        let [approach, s] = [own.approach, at.contact_radius].map(|x| x / reduced.units.length);
        let found = solve(&**basis, reduced, Control::Displacement, approach, s, NewtonSettings::default());
        let iterations = found.ok().map(|found| found.rounds);
        Some(Self { count, off: own.force / at.force - 1.0, iterations })
    }

    /// In words: `which` of the two, and the labels for off and iterations.
    pub fn said(&self, which: &str, [off, iterations]: [&str; 2]) -> String {
        let found = self.iterations.map_or(String::new(), |count| format!(", {count} {iterations}"));
        let sign = if self.off < 0.0 { "" } else { "+" };
        format!("{which}: {off} {sign}{} %{found}", short(100.0 * self.off, 2))
    }
}

impl Pin {
    fn new(number: usize, curve: Arc<CurveData>, elements: Option<Elements>) -> Self {
        let preset = &curve.setting.preset;
        let along = curve.along.as_ref().filter(|_| preset.path.begin == Begin::Apart);
        let along = along.and_then(|along| along.as_ref().ok());
        let whole = along.map(|along| Arc::new(PathReport::new(preset, &curve.case, along)));
        Self { number, curve, whole, elements }
    }

    /// The preset the curve was computed from.
    pub fn preset(&self) -> &Preset {
        &self.curve.setting.preset
    }

    /// The differences from `now`, as labels and values; for ring elements, their accuracy too.
    pub fn name(&self, now: &Preset) -> String {
        let elements = self.elements.filter(|_| self.preset().basis != now.basis);
        let same = || Preset { basis: now.basis, title: now.title.clone(), ..self.preset().clone() } == *now;
        let Some(elements) = elements.filter(|_| same()) else { return name(self.preset(), now) };
        let which = match self.preset().basis {
            BasisSpec::Rings { rings, .. } => format!("rings {rings}"),
            BasisSpec::Exact => "exact".to_owned(),
        };
        elements.said(&which, ["A", "Newton"])
    }
}

/// The pinned curves, by number.
#[derive(Debug, Clone, Default)]
pub struct Pins {
    shown: Vec<Pin>,
    /// Pins of a resumed session whose curves are still to be computed.
    awaited: Vec<(usize, Preset)>,
}

impl Pins {
    /// Pins whose curves are still to be computed.
    pub fn awaiting(presets: impl IntoIterator<Item = (usize, Preset)>) -> Self {
        Self { shown: Vec::new(), awaited: presets.into_iter().take(MOST).collect() }
    }

    /// The pins whose curves are still to be computed.
    pub fn awaited(&self) -> &[(usize, Preset)] {
        &self.awaited
    }

    /// The curve of an awaited pin has arrived; `None` gives the pin up. False if it is no longer awaited.
    pub fn came(&mut self, number: usize, curve: Option<(Arc<CurveData>, Option<Elements>)>) -> bool {
        let Some(at) = self.awaited.iter().position(|(awaited, _)| *awaited == number) else { return false };
        self.awaited.remove(at);
        if let Some((curve, elements)) = curve {
            self.shown.push(Pin::new(number, curve, elements));
            self.shown.sort_by_key(|pin| pin.number);
        }
        true
    }

    /// Gives up the pins whose curves are still to be computed.
    pub fn give_up(&mut self) {
        self.awaited.clear();
    }

    /// All pinned curves.
    pub fn all(&self) -> &[Pin] {
        &self.shown
    }

    /// The pinned curves whose numbers belong on the axes of `now`, reduced like its own or in SI like them; then the
    /// numbers of the others.
    pub fn beside(&self, now: &Preset) -> (Vec<&Pin>, Vec<usize>) {
        let is_like = |pin: &&Pin| discriminant(&pin.preset().units) == discriminant(&now.units);
        let (like, others): (Vec<&Pin>, Vec<&Pin>) = self.shown.iter().partition(is_like);
        (like, others.into_iter().map(|pin| pin.number).collect())
    }

    /// Whether both show the same curves under the same numbers, computed or still awaited.
    pub fn is_like(&self, other: &Self) -> bool {
        self.numbers().count() == other.numbers().count()
            && self.presets().all(|(number, preset)| other.number_of(preset) == Some(number))
    }

    /// Every pin's number and the preset of its curve, computed or still awaited.
    pub fn presets(&self) -> impl Iterator<Item = (usize, &Preset)> {
        let shown = self.shown.iter().map(|pin| (pin.number, pin.preset()));
        shown.chain(self.awaited.iter().map(|(number, preset)| (*number, preset)))
    }

    /// Becomes `other` again; a curve that has arrived since is not awaited again.
    pub fn go_back_to(&mut self, other: &Self) {
        let here = mem::replace(self, other.clone());
        for pin in here.shown {
            let of = |(number, preset): &(usize, Preset)| (*number, preset) == (pin.number, pin.preset());
            if let Some(at) = self.awaited.iter().position(of) {
                self.awaited.remove(at);
                self.shown.push(pin);
            }
        }
        self.shown.sort_by_key(|pin| pin.number);
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.shown.is_empty() && self.awaited.is_empty()
    }

    /// Pins `curve` under the smallest free number, which is returned.
    pub fn add(&mut self, curve: &Arc<CurveData>) -> Result<usize, String> {
        let own = &curve.setting.preset;
        // The units of the screen change no curve.
        let has_all = |of: &Preset, other: &Preset| {
            differences(of, other).iter().all(|(row, _)| row.key.starts_with("display."))
        };
        let same = |(_, pinned): &(usize, &Preset)| has_all(own, pinned) && has_all(pinned, own);
        if let Some((number, _)) = self.presets().find(same) {
            return Err(format!("the same values are pinned as {}", letter(number)));
        }
        let number = self.free()?;
        self.shown.push(Pin::new(number, Arc::clone(curve), None));
        self.shown.sort_by_key(|pin| pin.number);
        Ok(number)
    }

    /// The smallest free number; an error says that there is none.
    fn free(&self) -> Result<usize, String> {
        let free = (1..=MOST).find(|number| !self.numbers().any(|taken| taken == *number));
        free.ok_or_else(|| {
            format!("{MOST} curves are pinned, which is the most: {} removes one", Id::Pins.named())
        })
    }

    /// Pins the curve of `preset` once it is computed, under the number that is returned.
    pub fn want(&mut self, preset: Preset) -> Result<usize, String> {
        let number = self.free()?;
        self.awaited.push((number, preset));
        Ok(number)
    }

    /// The number of the pin of `preset`, shown or awaited.
    pub fn number_of(&self, preset: &Preset) -> Option<usize> {
        self.presets().find(|(_, other)| *other == preset).map(|(number, _)| number)
    }

    /// Removes the pin with this number, or all; false if there is nothing to remove.
    pub fn remove(&mut self, number: Option<usize>) -> bool {
        let before = self.numbers().count();
        let stays = |other: usize| number.is_some_and(|number| other != number);
        self.shown.retain(|pin| stays(pin.number));
        self.awaited.retain(|(awaited, _)| stays(*awaited));
        self.numbers().count() < before
    }

    fn numbers(&self) -> impl Iterator<Item = usize> {
        self.presets().map(|(number, _)| number)
    }
}

/// The values of `pinned` that differ from those of `now`, in the order of the table.
fn differences(pinned: &Preset, now: &Preset) -> Vec<(Row, Value)> {
    pinned
        .rows()
        .filter(|row| !matches!(&*row.key, "format" | "title"))
        .filter_map(|row| pinned.get(&row.key).map(|value| (row, value)))
        .filter(|(row, value)| now.get(&row.key).as_ref() != Some(value))
        // The stiffness has a row of its own, which already says that the device is a spring.
        .filter(|(row, _)| row.key != "path.control" || pinned.get("path.control.stiffness").is_none())
        .collect()
}

/// The label of a row and one of its values, short and in its unit.
pub(super) fn labelled(row: &Row, value: &Value, units: &UnitSystem) -> String {
    labelled_with(row, value, units, " ")
}

/// The same, with `between` separating the two.
pub(super) fn labelled_with(row: &Row, value: &Value, units: &UnitSystem, between: &str) -> String {
    labelled_in(row, value, units, (between, 4))
}

/// The same with this many digits.
fn labelled_in(row: &Row, value: &Value, units: &UnitSystem, (between, digits): (&str, usize)) -> String {
    let shown = match value {
        Value::Number(x) => {
            let shown = row.shown(units, *x);
            shown.text(&short(shown.number, digits), false)
        }
        other => other.to_string(),
    };
    format!("{}{between}{shown}", row.label)
}

/// The values of `pinned` that differ from those of `now`, as labels and values, and those that only `now` has. Only
/// the first few.
pub fn name(pinned: &Preset, now: &Preset) -> String {
    let own = named(&differences(pinned, now), &now.units);
    let mut others = differences(now, pinned);
    // The units of the screen change no curve; another gap has other values anyway, and another start takes its place.
    others.retain(|(row, _)| match row.table() {
        _ if own.is_none() => !row.key.starts_with("display."),
        Some("material" | "edge") => row.is_optional() && pinned.get(&row.key).is_none(),
        _ => false,
    });
    let lacking = named(&others, &now.units).map(|lacking| format!("without {lacking}"));
    let told: Vec<String> = own.into_iter().chain(lacking).collect();
    if told.is_empty() { "same values".to_owned() } else { told.join(", ") }
}

/// Each value in which `after` differs from `before`, as label and both values: `A 0.0025 → 0.0031`.
pub fn changes(before: &Preset, after: &Preset) -> Vec<String> {
    // A value of its own that is taken away again, as undoing a fit does; those of another gap are no such values.
    let gone = differences(before, after).into_iter().filter(|(row, _)| {
        row.is_optional() && !row.key.starts_with("path.control") && after.get(&row.key).is_none()
    });
    let gone = gone.map(|(row, _)| (row, Value::from(NONE)));
    let told = differences(after, before).into_iter().chain(gone).map(|(row, value)| {
        let said =
            |value: &Value, preset: &Preset, digits| labelled_in(&row, value, &preset.units, (" ", digits));
        let Some(was) = before.get(&row.key) else {
            let now = said(&value, after, 4);
            return match now.strip_prefix(&*row.label).filter(|_| row.is_optional()) {
                Some(value) => format!("{} {NONE} →{value}", row.label),
                None => now,
            };
        };
        // As many digits as needed to tell them apart.
        let both = [4, 7, 10, 17].map(|digits| (said(&was, before, digits), said(&value, after, digits)));
        let (was, now) = both.iter().find(|(was, now)| was != now).unwrap_or(&both[0]);
        format!("{was} →{}", now.strip_prefix(&*row.label).unwrap_or(now))
    });
    told.collect()
}

/// The labels of the values in which `after` differs from `before`.
pub fn changed_labels(before: &Preset, after: &Preset) -> Vec<String> {
    differences(after, before).into_iter().map(|(row, _)| row.label.to_string()).collect()
}

/// The values of `after` that differ from those of `before`, as labels and values; `None` if there are none.
pub fn changed(after: &Preset, before: &Preset) -> Option<String> {
    named(&differences(after, before), &after.units)
}

/// The name of `now` among the pins: its values that differ from those of some pin; `None` if there are none.
pub fn name_among(now: &Preset, pins: &[&Pin]) -> Option<String> {
    let keys: HashSet<String> = pins
        .iter()
        .flat_map(|pin| differences(now, pin.preset()))
        .map(|(row, _)| row.key.to_string())
        .collect();
    let own = now.rows().filter(|row| keys.contains(&*row.key));
    let own: Vec<(Row, Value)> = own.filter_map(|row| now.get(&row.key).map(|value| (row, value))).collect();
    named(&own, &now.units)
}

/// The first few differences, as labels and values.
fn named(differences: &[(Row, Value)], units: &UnitSystem) -> Option<String> {
    let named: Vec<String> =
        differences.iter().take(NAMED).map(|(row, value)| labelled(row, value, units)).collect();
    let more = differences.len().saturating_sub(NAMED);
    let rest = if more > 0 { format!(" +{more}") } else { String::new() };
    (!named.is_empty()).then(|| format!("{}{rest}", named.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::command::by_name;
    use crate::explorer::progress::Staged;
    use crate::store::{read, shipped};

    fn preset(changes: &[(&str, &str)]) -> Preset {
        let mut preset = read("wavy-sphere", shipped::find("wavy-sphere").unwrap().text).unwrap();
        for (key, text) in changes {
            let value = pulloff_engine::preset::parameter(key).unwrap().parse(text).unwrap();
            preset.set(key, value).unwrap();
        }
        preset
    }

    #[test]
    fn a_pin_is_named_by_what_differs() {
        let now = preset(&[]);
        for (changes, expected) in [
            (&[][..], "same values"),
            (&[("title", "another")], "same values"),
            (&[("gap.amplitude", "0.002")], "A 0.002"),
            (&[("path.control.stiffness", "0.3")], "k 0.3"),
            (&[("path.control", "force")], "control force"),
            (&[("gap.shape", "sphere")], "gap sphere"),
            (&[("path.start_approach", "0.05")], "delta start 0.05"),
            (
                &[
                    ("material.effective_modulus", "2"),
                    ("gap.amplitude", "0.0021"),
                    ("gap.wavelength", "0.06"),
                    ("path.control", "force"),
                ],
                "E* 2, A 0.0021, lambda 0.06 +1",
            ),
        ] {
            assert_eq!(name(&preset(changes), &now), expected);
        }
        // The name changes as the preset does.
        assert_eq!(name(&now, &preset(&[("gap.amplitude", "0.002")])), "A 0.0025");
        assert!(name(&now, &preset(&[("gap.shape", "sphere")])).starts_with("gap wavy-sphere, A 0.0025"));
        // One that lacks a value is not the same either.
        let mut with_range = now.clone();
        with_range
            .assign_all(&[
                ("material.adhesion".into(), "dugdale".into()),
                ("material.cohesive_strength".into(), "1".into()),
            ])
            .unwrap();
        assert_eq!(name(&now, &with_range), "without adhesion dugdale, sigma0 1");
        let closing = preset(&[("material.closing_work_of_adhesion", "0.001"), ("path.control", "force")]);
        assert_eq!(name(&now, &closing), "control displacement, without gamma_a 0.001");
        assert_eq!(super::changes(&now, &closing), ["gamma_a none → 0.001", "control displacement → force"]);
    }

    #[test]
    fn numbers_stay_and_free_ones_are_taken_again() {
        let curve = |amplitude: &str| {
            let preset = preset(&[("gap.amplitude", amplitude), ("path.end_contact_radius", "0.35")]);
            Arc::new(CurveData::compute(&preset, &Staged::unwatched()).unwrap())
        };
        let mut pins = Pins::default();
        let first = curve("0.001");
        assert_eq!(pins.add(&first), Ok(1));
        assert!(pins.add(&first).unwrap_err().contains("the same values are pinned as D"));
        // What is the same curve on a screen with other units is the same.
        let name = "fig-9-si";
        let mut si = read(name, shipped::find(name).unwrap().text).unwrap();
        let mut of_screen = Pins::default();
        for unit in ["mN", "uN"] {
            si.set("display.force", unit.into()).unwrap();
            let again = of_screen.add(&Arc::new(CurveData::compute(&si, &Staged::unwatched()).unwrap()));
            assert_eq!(again.is_ok(), unit == "mN");
        }
        for (number, amplitude) in [(2, "0.0011"), (3, "0.0012"), (4, "0.0013"), (5, "0.0014"), (6, "0.0015")]
        {
            assert_eq!(pins.add(&curve(amplitude)), Ok(number));
        }
        let refused = pins.add(&curve("0.0016")).unwrap_err();
        assert!(by_name(&refused).contains("pins removes one"), "{refused}");
        assert!(pins.remove(Some(3)) && !pins.remove(Some(3)));
        assert_eq!(pins.add(&curve("0.0016")), Ok(3));
        assert!(pins.remove(None) && pins.is_empty() && !pins.remove(None));
    }
}
