//! What documents begin with: the version, the resolved preset, its dimensionless groups, the smooth sphere's force.

use super::SCHEMA;
use crate::case::Case;
use crate::preset::Preset;
use crate::preset::family::is_parameter;
use crate::preset::schema::SYSTEMS;
use crate::problem::{Control, Groups};
use crate::units::{Quantity, Unit, UnitSystem};
use serde::Serialize;
use serde_json::{Map, Value};

/// The units of every number of a document; null where numbers are in reduced units.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct UnitsReport {
    /// `reduced` or `SI`.
    pub system: &'static str,
    /// Of radii, approaches and all other lengths.
    pub length: Option<&'static str>,
    /// Of forces.
    pub force: Option<&'static str>,
    /// Of E* and pressures.
    pub stress: Option<&'static str>,
    /// Of the work of adhesion.
    pub energy_per_area: Option<&'static str>,
    /// Of potentials and losses.
    pub energy: Option<&'static str>,
    /// Of stiffnesses.
    pub force_per_length: Option<&'static str>,
    /// Of speeds and rates of lengths.
    pub speed: Option<&'static str>,
    /// Of rates of forces.
    pub force_rate: Option<&'static str>,
    /// Of times.
    pub time: Option<&'static str>,
    /// The units in which a person sees them.
    #[serde(skip)]
    pub shown: UnitSystem,
}

impl UnitsReport {
    /// The units of the numbers of `system`.
    pub fn new(system: &UnitSystem) -> Self {
        let [reduced, si] = SYSTEMS;
        let unit = |quantity: Quantity| (*system != UnitSystem::Reduced).then(|| quantity.si()).flatten();
        Self {
            system: if *system == UnitSystem::Reduced { reduced } else { si },
            length: unit(Quantity::Length),
            force: unit(Quantity::Force),
            stress: unit(Quantity::Stress),
            energy_per_area: unit(Quantity::EnergyPerArea),
            energy: unit(Quantity::Energy),
            force_per_length: unit(Quantity::ForcePerLength),
            speed: unit(Quantity::Speed),
            force_rate: unit(Quantity::ForceRate),
            time: unit(Quantity::Time),
            shown: system.clone(),
        }
    }
}

/// What every document begins with.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Head {
    /// The version of all documents.
    pub schema: u32,
    /// Which document it is.
    pub document: &'static str,
    /// The version of the program.
    pub program_version: &'static str,
    /// What was computed.
    pub problem: ProblemReport,
    /// The units of every number in the document.
    pub units: UnitsReport,
}

impl Head {
    /// The head of a document of `preset`, made ready as `case`.
    pub fn new(document: &'static str, preset: &Preset, case: &Case) -> Self {
        Self {
            schema: SCHEMA,
            document,
            program_version: env!("CARGO_PKG_VERSION"),
            problem: ProblemReport::new(preset, case),
            units: UnitsReport::new(&preset.units),
        }
    }
}

/// The problem of a document.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ProblemReport {
    /// Every key of the preset with its value, defaults filled in.
    pub preset: Map<String, Value>,
    /// The contact radius at the start, resolved.
    pub start_contact_radius: f64,
    /// The contact radius at the end, resolved.
    pub end_contact_radius: f64,
    /// The dimensionless groups.
    pub groups: Groups,
    /// `P_c = (3/2)πγR`, the pull-off force of the smooth sphere under a dead load, where the gap has an R.
    pub critical_force: Option<f64>,
}

impl ProblemReport {
    /// The problem of `preset`, made ready as `case`.
    pub fn new(preset: &Preset, case: &Case) -> Self {
        Self {
            preset: document(preset),
            start_contact_radius: case.start * case.units().length,
            end_contact_radius: case.end * case.units().length,
            groups: Groups::of(&case.problem, preset.range_of_action(), preset.cohesion()),
            critical_force: case.smooth().map(|jkr| jkr.pull_off_force()),
        }
    }
}

/// The word for a control.
pub fn control_name(control: Control) -> &'static str {
    match control {
        Control::Displacement => "displacement",
        Control::Force => "force",
        Control::Stiffness(_) => "stiffness",
    }
}

/// The same in a sentence: a device with a stiffness is a spring.
pub fn control_word(control: Control) -> &'static str {
    if let Control::Stiffness(_) = control { "spring" } else { control_name(control) }
}

/// Every key with its value, nested as in the file.
fn document(preset: &Preset) -> Map<String, Value> {
    let mut document = Map::new();
    for (row, value) in preset.values() {
        if !row.is_part() {
            let value = unit_of_parameter(preset, &row.key, &value).unwrap_or_else(|| json_value(&value));
            insert(&mut document, &row.key, value);
        }
    }
    document
}

/// The unit of a parameter of a formula in an SI document: its numbers there are in SI, whatever the file wrote, so
/// the unit beside them is too. A unit that is not one of ours stays the remark it was.
fn unit_of_parameter(preset: &Preset, key: &str, value: &crate::preset::Value) -> Option<Value> {
    let parameter = key.strip_suffix(".unit").filter(|key| is_parameter(key))?;
    let crate::preset::Value::Text(unit) = value else { return None };
    if preset.units == UnitSystem::Reduced {
        return None;
    }
    let base = Unit::parse(unit, 0).ok()?.dimension().si();
    Some(preset.row(parameter)?.quantity.si().map_or_else(|| Value::from(base), Value::from))
}

/// Puts a value below its dotted key. Waves are an array; a parameter that has more than a value is an object.
fn insert(table: &mut Map<String, Value>, key: &str, value: Value) {
    let Some((name, rest)) = key.split_once('.') else {
        table.insert(key.to_owned(), value);
        return;
    };
    let wave = rest.split_once('.').and_then(|(number, key)| Some((number.parse::<usize>().ok()?, key)));
    if let Some((number, key)) = wave {
        let waves = table.entry(name).or_insert_with(|| Value::Array(Vec::new()));
        let Value::Array(waves) = waves else { return };
        // Rows come in the order of their numbers.
        if waves.len() < number {
            waves.push(Value::Object(Map::new()));
        }
        if let Some(Value::Object(wave)) = waves.last_mut() {
            insert(wave, key, value);
        }
        return;
    }
    let inner = table.entry(name).or_insert_with(|| Value::Object(Map::new()));
    if !inner.is_object() {
        let own = inner.take();
        *inner = serde_json::json!({ "value": own });
    }
    if let Value::Object(inner) = inner {
        insert(inner, rest, value);
    }
}

fn json_value(value: &crate::preset::Value) -> Value {
    use crate::preset::Value as Preset;
    match value {
        Preset::Number(x) => Value::from(*x),
        Preset::Integer(n) => Value::from(*n),
        Preset::Text(text) | Preset::Typed(text) => Value::from(text.as_str()),
        Preset::Profile(rows) => Value::from(rows.name.as_str()),
        Preset::Points(source) => Value::from(source.name.as_str()),
        Preset::Control(control) => control_json(*control),
    }
}

/// A control as it stands everywhere: `"displacement"`, `"force"` or `{"stiffness": k}`.
fn control_json(control: Control) -> Value {
    serde_json::to_value(control).unwrap_or(Value::Null)
}
