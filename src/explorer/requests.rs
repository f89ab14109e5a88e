//! Requests that the model makes to the worker for several commands: a curve, the end of a walk, work on files.

use super::command::Id;
use super::effect::{Effect, Wish};
use super::job::Job;
use super::model::{Awaits, Level, Model, Walking};
use super::node::NodeKind;
use super::pins::{labelled, labelled_with};
use pulloff_engine::Shape;
use pulloff_engine::preset::{Key, Preset, Row, Value, edge};
use pulloff_engine::problem::Control;
use pulloff_engine::text::greek;
use pulloff_engine::units::UnitSystem;
use std::path::PathBuf;
use std::sync::Arc;

impl Model {
    /// Says why something is not done.
    pub(super) fn refuse(&mut self, why: impl Into<String>) -> Vec<Effect> {
        self.tell(Level::Error, why);
        Vec::new()
    }
}

/// Requests the curve of the present preset.
pub(super) fn want_curve(model: &mut Model) -> Effect {
    let id = model.number();
    model.curve_wanted = id;
    (model.stage, model.curve_error) = (None, None);
    // The curve does not depend on the control, so it is reused under another one.
    let known = model.curve.as_ref().map(|curve| &curve.base).filter(|base| base.is_of(&model.preset));
    let base = known.map(Arc::clone);
    Effect::Curve(Box::new(Wish { id, preset: model.preset.clone(), base }))
}

/// Adopts the parameters of the walker's state if the curve on the screen has others.
pub(super) fn adopt_parameters(model: &mut Model) -> Vec<Effect> {
    let Some(node) = model.history.current() else { return Vec::new() };
    if model.is_on_curve(node) || matches!(node.kind, NodeKind::Stale(_)) {
        return Vec::new();
    }
    take_back(model)
}

/// Adopts the parameters of the walker's state in place of those typed since.
pub(super) fn take_back(model: &mut Model) -> Vec<Effect> {
    let Some(node) = model.history.current() else { return Vec::new() };
    let mut preset = node.setting.preset.clone();
    preset.title.clone_from(&model.preset.title);
    preset.data.clone_from(&model.preset.data);
    preset.path.control = model.preset.path.control;
    change(model, preset)
}

/// Adopts a changed preset and requests its curve.
pub(super) fn change(model: &mut Model, preset: Preset) -> Vec<Effect> {
    if preset == model.preset {
        return Vec::new();
    }
    let same_problem = {
        let mut old = model.preset.clone();
        old.title.clone_from(&preset.title);
        // Measured points lie behind the curve and do not change it.
        old.data.clone_from(&preset.data);
        old == preset
    };
    // The last stiffness is remembered so that one can return to it.
    for control in [model.preset.path.control, preset.path.control] {
        if let Control::Stiffness(k) = control {
            model.stiffness = Some(k);
        }
    }
    let upto = model.parameter + 1;
    let listed: Vec<_> = model.knobs().into_iter().take(upto).map(|(row, _)| row.key.clone()).collect();
    let rate = model.preset.row(edge::RATE).zip(model.preset.get(edge::RATE));
    let [before, now] = [&model.preset, &preset].map(|preset| preset.path.control == Control::Force);
    let rate =
        rate.filter(|_| before != now && preset.units != UnitSystem::Reduced && preset.edge.rate.is_none());
    if let Some((row, value)) = rate {
        let rate = labelled(&row, &value, &model.preset.units);
        model.tell(Level::Info, format!("{rate} is dropped: it is no rate under the new control"));
    }
    if let Some(brought) = brought_by_shape(&model.preset, &preset) {
        let before = model.message.take().filter(|(level, _)| *level == Level::Info);
        let said = before.map_or_else(|| brought.clone(), |(_, said)| format!("{said}; {brought}"));
        model.tell(Level::Info, said);
    }
    if preset.units != model.preset.units {
        model.history.show_in(&preset.units);
    }
    model.preset = preset;
    if same_problem {
        return Vec::new();
    }
    model.is_tried = false;
    // The list may now have a key more or less: the same value stays selected, or the last one above it that is left.
    let knobs = model.knobs();
    let at = |key: &Key| knobs.iter().position(|(row, _)| row.key == *key);
    model.parameter = listed.iter().rev().find_map(at).unwrap_or(0);
    let mut effects = stop_walk(model);
    if model.shows_its_curve() {
        // Back at the values of the curve on the screen: the one being computed is no longer wanted.
        model.curve_shown = model.curve_wanted;
        model.curve_error = None;
        effects.push(Effect::StopCurve(model.curve_wanted));
    } else {
        effects.push(want_curve(model));
    }
    effects
}

/// The values of the gap that another shape brings with it, or the profile that stands in for the user's, in words; `None` where
/// there are none.
fn brought_by_shape(before: &Preset, now: &Preset) -> Option<String> {
    const SHAPE: &str = "gap.shape";
    if before.get(SHAPE) == now.get(SHAPE) {
        return None;
    }
    if let Shape::Profile(measured) = &now.gap
        && measured.rows().is_shipped()
    {
        let choose = Id::Edit.named();
        return Some(format!("a shipped profile stands in for yours: {choose} on the value file chooses it"));
    }
    let is_new = |row: &Row| {
        let is_value = row.table() == Some("gap") && row.key != SHAPE && row.kind.is_number();
        is_value && !row.is_part() && before.get(&row.key) != now.get(&row.key)
    };
    let told = |row: Row| Some(labelled_with(&row, &now.get(&row.key)?, &now.units, " = "));
    let values: Vec<String> = now.rows().filter(is_new).filter_map(told).collect();
    (!values.is_empty()).then(|| greek(&format!("this shape brings {}", values.join(", "))))
}

/// Ends the walk under way and drops the commands that wait for it.
pub(super) fn stop(model: &mut Model) -> Vec<Effect> {
    model.queue.clear();
    model.awaits = Awaits::Nothing;
    model.walking = model.walking.map(|walking| Walking { stops: true, ..walking });
    stop_walk(model)
}

/// Ends the walk under way.
pub(super) fn stop_walk(model: &Model) -> Vec<Effect> {
    model.walking.map(|walking| Effect::StopWalk(walking.id)).into_iter().collect()
}

/// The folder that the name of the preset's own file for this key is relative to.
fn own_folder(model: &Model, key: &str) -> Option<PathBuf> {
    match &model.preset.get(key)? {
        Value::Profile(rows) => rows.folder.clone(),
        Value::Points(source) => source.folder.clone(),
        _ => None,
    }
}

pub(super) fn browse(model: &Model, key: Key, folder: Option<PathBuf>) -> Effect {
    let own = own_folder(model, &key);
    file(Job::Browse { key, folder, own })
}

pub(super) fn read(model: &Model, key: &str, name: String) -> Effect {
    file(Job::Read { folder: own_folder(model, key), name })
}

pub(super) fn file(job: Job) -> Effect {
    Effect::File(Box::new(job))
}
