//! The walk as a table: one row per state, for CSV and JSON.

use super::node::{Node, NodeKind};
use pulloff_engine::gap::wave_index;
use pulloff_engine::preset::{Key, Preset, Row};
use pulloff_engine::report::trace::StableReport;
use pulloff_engine::report::walk::WalkRow;
use serde_json::Value;
use std::sync::Arc;

/// The keys that changed during a walk, in the order of their changes; without the title and the display units.
pub(super) fn changed_keys(walk: &[Node]) -> Vec<Key> {
    // States of one problem share its preset.
    let mut presets: Vec<&Preset> = Vec::new();
    for nodes in walk.chunk_by(|a, b| Arc::ptr_eq(&a.setting, &b.setting)) {
        presets.push(&nodes[0].setting.preset);
    }
    let Some((first, rest)) = presets.split_first() else { return Vec::new() };
    let mut keys: Vec<Key> = Vec::new();
    for preset in rest {
        // A key may exist in only one of the two.
        let is_of_states =
            |row: &Row| !(row.is_part() || row.key == "title" || row.key.starts_with("display."));
        for row in first.rows().chain(preset.rows()).filter(is_of_states) {
            if first.get(&row.key) != preset.get(&row.key) && !keys.contains(&row.key) {
                keys.push(row.key.clone());
            }
        }
    }
    keys
}

/// One state of the walk as a row.
pub(super) fn row(node: &Node, changed: &[Key]) -> WalkRow {
    let setting = &node.setting;
    let state = node.state.in_units(setting.units());
    let event = if let NodeKind::Jump(event) = &node.kind { Some(event) } else { None };
    let energy = |x: f64| x * setting.units().energy;
    let wave = setting.preset.gap.wave();
    let apart = node.is_apart();
    WalkRow {
        step: node.step,
        kind: kind_name(&node.kind),
        control: setting.shown_control(node.control).to_string(),
        contact_radius: if apart { 0.0 } else { state.contact_radius },
        approach: state.approach,
        force: if apart { 0.0 } else { state.force },
        energy: if apart { 0.0 } else { state.energy },
        wave: if apart {
            None
        } else {
            wave_index(node.state.contact_radius, setting.reduced.gap.wavelength())
        },
        newton_iterations: node.point.rounds,
        stable: StableReport::of(&node.stability, node.control),
        dissipated: event.and_then(|e| e.dissipated).map(energy),
        dissipated_by_area: event.and_then(|e| e.dissipated_by_area).map(energy),
        work_of_adhesion: setting.preset.material.work_of_adhesion,
        radius_of_curvature: setting.preset.gap.radius_of_curvature(),
        amplitude: wave.map(|(a, _)| a),
        wavelength: wave.map(|(_, l)| l),
        admissible: Some(node.admissibility.holds).filter(|_| !apart),
        changed: changed.iter().map(|key| (key.to_string(), value_of(&setting.preset, key))).collect(),
    }
}

/// The value of a key as written in a cell: numbers in SI or reduced units, a control as it is typed.
fn value_of(preset: &Preset, key: &str) -> Value {
    match preset.get(key) {
        None => Value::Null,
        Some(pulloff_engine::preset::Value::Number(x)) => Value::from(x),
        Some(pulloff_engine::preset::Value::Integer(n)) => Value::from(n),
        Some(other) => Value::from(other.to_string()),
    }
}

/// The word for the kind of a node.
pub fn kind_name(kind: &NodeKind) -> &'static str {
    match kind {
        NodeKind::Start => "start",
        NodeKind::Step => "step",
        NodeKind::Limit => "limit",
        NodeKind::Touch(_) => "touch",
        NodeKind::Jump(event) => event.kind.name(),
        NodeKind::Moved => "moved",
        NodeKind::Solved => "solved",
        NodeKind::Stale(_) => "unsolved",
    }
}
