//! The problem both documents carry: the resolved preset, its dimensionless groups, the smooth sphere's force.

use crate::case::Case;
use crate::contact::{Control, Groups};
use crate::preset::Preset;
use serde::Serialize;
use serde_json::{Map, Value};

/// The problem of a document.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProblemReport {
    /// Every key of the preset with its value, defaults filled in.
    pub preset: Map<String, Value>,
    /// The contact radius at the start, resolved.
    pub start_contact_radius: f64,
    /// The contact radius at the end, resolved.
    pub end_contact_radius: f64,
    /// The dimensionless groups.
    pub groups: Groups,
    /// `P_c = (3/2)πγR`, the pull-off force of the smooth sphere under a dead load.
    pub critical_force: f64,
}

impl ProblemReport {
    /// The problem of `preset`, made ready as `case`.
    pub fn new(preset: &Preset, case: &Case) -> Self {
        let mut document = Map::new();
        for (row, value) in preset.values() {
            if row.is_part() {
                continue;
            }
            let value = json_value(&value);
            match row.table() {
                None => drop(document.insert(row.name().to_owned(), value)),
                Some(table) => {
                    let entry = document.entry(table).or_insert_with(|| Value::Object(Map::new()));
                    if let Value::Object(table) = entry {
                        table.insert(row.name().to_owned(), value);
                    }
                }
            }
        }
        Self {
            preset: document,
            start_contact_radius: case.start * case.units().length,
            end_contact_radius: case.end * case.units().length,
            groups: Groups::of(&case.problem),
            critical_force: case.smooth().pull_off_force(),
        }
    }
}

fn json_value(value: &crate::preset::Value) -> Value {
    use crate::preset::Value as Preset;
    match value {
        Preset::Number(x) => Value::from(*x),
        Preset::Integer(n) => Value::from(*n),
        Preset::Text(text) => Value::from(text.as_str()),
        Preset::Control(control) => control_json(*control),
    }
}

/// A control as it stands everywhere: `"displacement"`, `"force"` or `{"stiffness": k}`.
fn control_json(control: Control) -> Value {
    serde_json::to_value(control).unwrap_or(Value::Null)
}
