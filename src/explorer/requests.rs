//! What the model asks of the worker on behalf of several commands: a curve, a check, the end of a walk, work on files.

use super::effect::{Check, Effect, Wish};
use super::job::Job;
use super::loops::{LoopWish, has_crests, same_loop};
use super::maps::{MapAxes, MapWish};
use super::model::{Awaits, Checking, Model, Walking};
use super::node::NodeKind;
use super::reach::study_range;
use super::studies::StudyWish;
use super::view::View;
use pulloff_engine::preset::{Key, Preset, Value};
use pulloff_engine::problem::{Begin, Control};
use std::path::PathBuf;
use std::sync::Arc;

/// Asks for the curve of the preset as it is.
pub(super) fn want_curve(model: &mut Model) -> Effect {
    let id = model.number();
    model.curve_wanted = id;
    (model.stage, model.curve_error) = (None, None);
    // The curve does not depend on the control: under another one it is reused.
    let known = model.curve.as_ref().map(|curve| &curve.base).filter(|base| base.is_of(&model.preset));
    let base = known.map(Arc::clone);
    Effect::Curve(Box::new(Wish { id, preset: model.preset.clone(), base }))
}

/// Asks for the admissibility of the curve on the screen, once no newer curve is being computed.
pub(super) fn want_check(model: &mut Model) -> Option<Effect> {
    let curve = model.curve.as_ref().filter(|curve| !model.is_computing() && !curve.is_checked()).cloned();
    let Some(curve) = curve else {
        model.checking = None;
        return None;
    };
    if model.checking.is_some() {
        return None;
    }
    let id = model.number();
    model.checking = Some(Checking::Asked(id));
    let with_onset = !model.snaps_from.as_ref().is_some_and(|found| found.is_of(&model.preset));
    Some(Effect::Check(Check { id, curve, with_onset }))
}

/// Asks for the loop of the values as they are, once their curve is there; where the gap has no crests,
/// only when it is looked at.
pub(super) fn want_loop(model: &mut Model) -> Option<Effect> {
    let curve = model.curve.as_ref().filter(|_| model.shows_its_curve() && !model.is_computing()).cloned()?;
    // From apart the loop is the path.
    let is_path = model.preset.path.begin == Begin::Touch;
    let is_shown = is_path || model.shown_views().into_iter().any(View::is_cycle);
    if !is_shown && !has_crests(&curve) {
        (model.cycle, model.cycle_wanted) = (None, None);
        return None;
    }
    let is_there = model.cycle.as_ref().is_some_and(|cycle| cycle.is_of(&model.preset));
    // A script computes only the loop that is looked at, and so asks again for one that was not.
    let is_asked = model
        .cycle_wanted
        .as_ref()
        .is_some_and(|wanted| same_loop(&wanted.preset, &model.preset) && (wanted.is_shown || !is_shown));
    if is_there || is_asked {
        return None;
    }
    let wish = LoopWish { id: model.number(), preset: model.preset.clone(), curve, is_shown };
    model.cycle_wanted = Some(Box::new(wish.clone()));
    Some(Effect::Loop(Box::new(wish)))
}

/// Asks for the map of the values as they are, while it is looked at.
pub(super) fn want_map(model: &mut Model) -> Option<Effect> {
    let is_shown = model.shown_views().contains(&View::Map) && !model.is_computing();
    if !is_shown {
        return None;
    }
    let axes = model.map_axes.clone().unwrap_or_else(|| MapAxes::usual(&model.preset));
    let is_there = model.map.as_ref().is_some_and(|map| map.is_of(&model.preset, &axes));
    let is_asked = |wanted: &MapWish| wanted.preset == model.preset && wanted.axes == axes;
    if is_there || model.map_wanted.as_deref().is_some_and(is_asked) {
        return None;
    }
    let wish = MapWish { id: model.number(), preset: model.preset.clone(), axes };
    model.map_wanted = Some(Box::new(wish.clone()));
    Some(Effect::Map(Box::new(wish)))
}

/// Asks for the study of the selected value, while it is looked at.
pub(super) fn want_study(model: &mut Model) -> Option<Effect> {
    let is_shown = model.shown_views().contains(&View::Study) && !model.is_computing();
    let (key, values) = study_range(model).ok().filter(|_| is_shown)?;
    let (preset, column) = (&model.preset, model.studied);
    let is_there = model.study.as_ref().is_some_and(|study| study.is_of(preset, &key, column));
    let is_asked = model.study_wanted.as_ref().is_some_and(|wanted| wanted.is_of(preset, &key, column));
    if is_there || is_asked {
        return None;
    }
    let preset = preset.clone();
    let wish = StudyWish { id: model.number(), preset, key, column, values };
    model.study_wanted = Some(Box::new(wish.clone()));
    Some(Effect::Study(Box::new(wish)))
}

/// Takes the parameters of the walker's state where the curve on the screen has others.
pub(super) fn adopt_parameters(model: &mut Model) -> Vec<Effect> {
    let Some(node) = model.history.current() else { return Vec::new() };
    if model.is_on_curve(node) || matches!(node.kind, NodeKind::Stale(_)) {
        return Vec::new();
    }
    take_back(model)
}

/// Takes the parameters of the walker's state instead of those typed since.
pub(super) fn take_back(model: &mut Model) -> Vec<Effect> {
    let Some(node) = model.history.current() else { return Vec::new() };
    let mut preset = node.setting.preset.clone();
    preset.title.clone_from(&model.preset.title);
    preset.data.clone_from(&model.preset.data);
    preset.path.control = model.preset.path.control;
    change(model, preset)
}

/// Takes a changed preset and asks for its curve.
pub(super) fn change(model: &mut Model, preset: Preset) -> Vec<Effect> {
    if preset == model.preset {
        return Vec::new();
    }
    let same_problem = {
        let mut old = model.preset.clone();
        old.title.clone_from(&preset.title);
        // Measured points lie behind the curve, and do not change it.
        old.data.clone_from(&preset.data);
        old == preset
    };
    // The last stiffness is remembered, to come back to it.
    for control in [model.preset.path.control, preset.path.control] {
        if let Control::Stiffness(k) = control {
            model.stiffness = Some(k);
        }
    }
    model.preset = preset;
    if same_problem {
        return Vec::new();
    }
    model.is_tried = false;
    let knobs = model.knobs().len();
    model.parameter = model.parameter.min(knobs.saturating_sub(1));
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

/// Ends the walk that runs and forgets the commands that wait for it.
pub(super) fn stop(model: &mut Model) -> Vec<Effect> {
    model.queue.clear();
    model.awaits = Awaits::Nothing;
    model.walking = model.walking.map(|walking| Walking { stops: true, ..walking });
    stop_walk(model)
}

/// Ends the walk that runs.
pub(super) fn stop_walk(model: &Model) -> Vec<Effect> {
    model.walking.map(|walking| Effect::StopWalk(walking.id)).into_iter().collect()
}

/// The folder that the name of the preset's own file of this key is relative to.
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
