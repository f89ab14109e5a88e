//! What a file states about the instrument besides its columns: the stiffness of the spring and the radius of the tip.
//!
//! Settings are lines such as `Force Constant, nN/nm: 0.2`, `k (N/m)<tab>0.018` or `# springConstant: 0.04`; afmformats
//! writes a block of JSON in the remarks (A. Müller et al., afmformats, github.com/AFM-analysis/afmformats,
//! `formats/fmt_tab.py`).

use super::names::squashed;
use super::words::{Words, last_digit};
use crate::cells::{LARGEST_NUMBER, Separator, heads};
use crate::text::quote;
use crate::units::{Dimension, Quantity, Unit};

/// The longest block of metadata that is read, in bytes.
const LONGEST_METADATA: usize = 1 << 20;
/// The longest line that is searched for a setting, in bytes.
const LONGEST_SETTING: usize = 1 << 14;
/// What a file states and what a preset says are equal up to this share: files round.
const SAME: f64 = 1e-3;

/// A value that a file states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatedValue {
    /// The value, in SI.
    pub value: f64,
    /// Half the place of its last digit.
    pub rounding: f64,
}

impl StatedValue {
    /// Whether `value`, in SI, may be the value that the file states.
    pub fn is(&self, value: f64) -> bool {
        (self.value - value).abs() <= self.rounding.max(SAME * value.abs())
    }
}

/// What a file states about its instrument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum InstrumentValue {
    Stiffness,
    Radius,
    Diameter,
}

/// The settings of a file.
#[derive(Debug, Default)]
pub(super) struct FileSettings {
    /// The stiffness of the spring, N/m.
    pub stiffness: Option<StatedValue>,
    /// The radius of the tip, m.
    pub radius: Option<StatedValue>,
    /// Whether there is a block written by afmformats: its columns are in SI.
    pub is_si: bool,
    /// What was found but not used, in words.
    pub notes: Vec<String>,
}

impl FileSettings {
    /// The settings in the words of a file.
    pub(super) fn of(words: &[Words]) -> Self {
        let mut settings = Self::default();
        let mut metadata: Option<String> = None;
        for words in words {
            match &mut metadata {
                None if words.text.starts_with("BEGIN METADATA") => metadata = Some(String::new()),
                Some(text) if words.text.starts_with("END METADATA") => {
                    settings.takes_json(text);
                    metadata = None;
                }
                Some(text) if text.len() + words.text.len() <= LONGEST_METADATA => {
                    text.push_str(words.text);
                    text.push('\n');
                }
                None if words.text.len() <= LONGEST_SETTING => settings.takes_line(words),
                _ => {}
            }
        }
        settings
    }

    fn takes_json(&mut self, text: &str) {
        self.is_si = true;
        let Ok(value) = serde_json::from_str::<serde_json::Value>(text) else {
            self.notes.push("the metadata block is not JSON, and nothing is taken from it".to_owned());
            return;
        };
        for key in ["spring constant", "tip radius"] {
            let Some(number) = value.get(key).and_then(serde_json::Value::as_f64) else { continue };
            if let Some((setting, ..)) = setting(key) {
                self.add(setting, number, 0.0, None);
            }
        }
    }

    /// Reads the settings in a line.
    fn takes_line(&mut self, words: &Words) {
        // Igor keeps many settings in one note.
        for part in words.text.split("\\r").flat_map(|part| part.split("\\n")) {
            let part = match part.split_once('"') {
                Some((note, rest)) if note.trim_start().starts_with("X Note") => rest,
                _ => part,
            };
            let part = part.trim_matches(|c: char| c.is_whitespace() || "\"\\@*".contains(c));
            let cells: Vec<&str> = match part.find(['\t', ';']).map(|at| &part[at..=at]) {
                Some("\t") => part.split('\t').collect(),
                Some(_) => part.split(';').collect(),
                None => Vec::new(),
            };
            for pair in cells.windows(2) {
                self.takes(pair[0], pair[1]);
            }
            if let Some((key, value)) = part.split_once([':', '=']) {
                self.takes(key, value);
            } else if let Some((key, value)) = part.split_once(',').filter(|_| cells.is_empty()) {
                self.takes(key, value);
            }
        }
    }

    /// Reads a setting, if `key` names one.
    fn takes(&mut self, key: &str, value: &str) {
        let clean =
            |text: &str| text.trim_matches(|c: char| c.is_whitespace() || "\":=,".contains(c)).to_owned();
        let (key, value) = (clean(key), clean(value));
        let dimensions = [Quantity::ForcePerLength.dimension(), Quantity::Length.dimension()];
        let is_unit =
            |unit: &str| Unit::parse(unit, 0).is_ok_and(|unit| dimensions.contains(&unit.dimension()));
        // The unit is in brackets, or is the last word: a slash may belong to the unit.
        let bracketed = heads(&key, Separator::Character('\0'), &[]).pop();
        let (name, unit) = match (bracketed, key.rsplit_once([' ', ','])) {
            (Some((_, None)), Some((name, unit))) if is_unit(unit) => {
                (name.to_owned(), Some(unit.to_owned()))
            }
            (Some(head), _) => head,
            (None, _) => return,
        };
        let Some((setting, dimension, needs_unit)) = setting(&name) else { return };
        let found = number_and_rest(&value);
        let found = found.map(|(number, pointed, behind)| (number, pointed, unit_in(behind)));
        let (number, pointed, own) = match found {
            Some((number, pointed, Some(own))) => (number, pointed, own.to_owned()),
            None if !value.starts_with(['<', '>', '~', '≈', '≤', '≥']) => return,
            _ => {
                let (name, value) = (quote(&name), quote(&value));
                self.notes.push(format!(
                    "the file states {name}: {value}, which is no single value: it is not used"
                ));
                return;
            }
        };
        let unit = Some(own).filter(|unit| !unit.is_empty()).or(unit);
        let parsed = unit.as_deref().map(|unit| Unit::parse(unit, 0).ok());
        let unit = match parsed {
            Some(Some(unit)) if unit.dimension() == dimension => Some(unit),
            None if !needs_unit => None,
            _ => {
                if !matches!(setting, InstrumentValue::Stiffness) || key.len() > 1 {
                    let (name, value) = (quote(&name), quote(&value));
                    self.notes.push(format!(
                        "the file states {name}: {value}, without a known unit: it is not used"
                    ));
                }
                return;
            }
        };
        self.add(setting, number, 0.5 * last_digit(&pointed), unit.as_ref());
    }

    /// Adds a value stated in `unit`, or in SI if there is none.
    fn add(&mut self, setting: InstrumentValue, number: f64, rounding: f64, unit: Option<&Unit>) {
        let si = |number: f64| {
            let value = unit.map_or(number, |unit| unit.to_si(number));
            if setting == InstrumentValue::Diameter { 0.5 * value } else { value }
        };
        let stated = StatedValue { value: si(number), rounding: si(rounding) };
        if stated.value.is_nan() || stated.value <= 0.0 || stated.value > LARGEST_NUMBER {
            return;
        }
        if setting == InstrumentValue::Stiffness && stated.value.total_cmp(&1.0).is_eq() {
            let note = "the file states a spring of 1 N/m, as uncalibrated instruments do: it is not used";
            if self.notes.iter().all(|known| known != note) {
                self.notes.push(note.to_owned());
            }
            return;
        }
        let slot = if setting == InstrumentValue::Stiffness { &mut self.stiffness } else { &mut self.radius };
        match slot {
            None => *slot = Some(stated),
            Some(before) if !before.is(stated.value) => {
                let (what, unit) = if setting == InstrumentValue::Stiffness {
                    ("springs", "N/m")
                } else {
                    ("tip radii", "m")
                };
                self.notes.push(format!(
                    "the file states two {what}, {:?} and {:?} {unit}: the first is taken",
                    before.value, stated.value
                ));
            }
            Some(_) => {}
        }
    }
}

/// The number at the beginning of a value, its text with a decimal point, and the rest, which may follow without a space.
fn number_and_rest(value: &str) -> Option<(f64, String, &str)> {
    let is_of_number = |c: char| c.is_ascii_digit() || "+-.,eE".contains(c);
    let most = value.find(|c| !is_of_number(c)).unwrap_or(value.len());
    (1..=most).rev().find_map(|end| {
        let pointed = value[..end].replace(',', ".");
        Some((pointed.parse().ok()?, pointed, &value[end..]))
    })
}

/// The unit behind a number, empty where there is none: without its brackets, behind an error or before one. `None` where what is said
/// further makes the number another one, such as the largest.
fn unit_in(behind: &str) -> Option<&str> {
    const SIGNS: [&str; 3] = ["±", "+-", "+/-"];
    const OTHERS: [&str; 5] = ["max", "min", "diam", "radius", "range"];
    let begun = |text: &str| {
        text.len() - text.trim_start_matches([' ', '\t', '(', '[', ',', ';', ')', ']', '%']).len()
    };
    let mut rest = &behind[begun(behind)..];
    while let Some(error) = SIGNS.iter().find_map(|sign| rest.strip_prefix(sign)) {
        let (.., further) = number_and_rest(error.trim_start())?;
        rest = &further[begun(further)..];
    }
    let ends = [',', ';', '(', '[', ')', ']', '±'];
    let end =
        SIGNS.iter().filter_map(|sign| rest.find(sign)).chain(rest.find(ends)).min().unwrap_or(rest.len());
    // A sentence continues with other settings.
    let further = rest[end..].split([',', ';']).next().unwrap_or_default().to_lowercase();
    let mut words = further.split(|c: char| !c.is_alphabetic());
    let is_other = words.any(|word| OTHERS.iter().any(|other| word.starts_with(other)));
    (!is_other).then(|| rest[..end].trim())
}

/// The setting that `name` names, its dimension, and whether a unit is required.
fn setting(name: &str) -> Option<(InstrumentValue, Dimension, bool)> {
    const BODIES: [&str; 9] =
        ["tip", "probe", "indenter", "sphere", "bead", "ball", "lens", "colloid", "particle"];
    let name = squashed(name);
    let ends = |word: &str| name.ends_with(word) && !name.contains("sensitivity");
    if ends("springconstant")
        || ends("forceconstant")
        || ends("cantileverstiffness")
        || ends("springstiffness")
    {
        return Some((InstrumentValue::Stiffness, Quantity::ForcePerLength.dimension(), false));
    }
    if ["k", "kc", "kcantilever", "cantileverk"].contains(&name.as_str()) {
        return Some((InstrumentValue::Stiffness, Quantity::ForcePerLength.dimension(), true));
    }
    let length = Quantity::Length.dimension();
    let of_body = |word: &str| {
        let before = name.strip_suffix(word)?;
        BODIES.iter().any(|body| before.ends_with(body)).then_some(())
    };
    if of_body("radius").is_some() || ends("radiusofcurvature") || name == "r" {
        // afmformats and JPK write SI.
        return Some((InstrumentValue::Radius, length, true));
    }
    of_body("diameter").map(|()| (InstrumentValue::Diameter, length, true))
}
