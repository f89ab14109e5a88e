//! Values changed, and the curve that follows from them.

use super::files::{file, read};
use super::walk::{begin_walk, go_on, stop, walk};
use super::words::of_before;
use super::{number, tell};
use crate::explorer::command::{Assignment, Id};
use crate::explorer::curve::CurveData;
use crate::explorer::driver::{Check, Effect, Wish};
use crate::explorer::files::Job;
use crate::explorer::history::NodeKind;
use crate::explorer::model::{Checking, CurveError, Level, Model, Untried};
use crate::explorer::nudge::{Amount, next_control, nudge};
use crate::explorer::pins::{labelled, labelled_with};
use crate::explorer::walk::Action;
use crate::mend::Reason;
use pulloff_engine::gap::shapes::Rows;
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::preset::family::is_parameter;
use pulloff_engine::preset::invalid::Invalid;
use pulloff_engine::preset::schema::{Kind, RADIUS_OVER_CURVATURE, START_KEYS};
use pulloff_engine::preset::{Preset, Row, Value, groups};
use pulloff_engine::problem::{Control, Start};
use pulloff_engine::report::number::{short, with_unit};
use pulloff_engine::text::closest;
use pulloff_engine::text::{greek, show_name, show_path};
use pulloff_engine::units::Quantity;
use std::path::Path;
use std::sync::Arc;

pub(in crate::explorer) fn want_curve(model: &mut Model) -> Effect {
    let id = number(model);
    model.curve_wanted = id;
    (model.progress, model.curve_error) = (None, None);
    // The curve does not know what is controlled: under another control it need not be swept again.
    let known = model.curve.as_ref().map(|curve| &curve.sweep).filter(|sweep| sweep.is_of(&model.preset));
    let sweep = known.map(Arc::clone);
    Effect::Curve(Box::new(Wish { id, preset: model.preset.clone(), sweep }))
}

/// The curve on the screen stays; the one being computed is no longer wanted.
pub(super) fn give_up(model: &mut Model) -> Vec<Effect> {
    model.queue.clear();
    model.curve_shown = model.curve_wanted;
    let control = model.curve.as_ref().filter(|curve| curve.sweep.is_of(&model.preset)).map(|curve| {
        // Only the control was changed, which undo does not take back.
        curve.setting.preset.path.control
    });
    let text = match (&model.curve, control) {
        (Some(_), Some(control)) => {
            model.preset.path.control = control;
            "cancelled: the control is as before".to_owned()
        }
        (Some(_), None) => format!("cancelled: {}", of_before()),
        (None, _) => {
            format!(
                "cancelled: there is no curve; {} computes it again, or change a value",
                Id::Restart.named()
            )
        }
    };
    if control.is_none() {
        model.curve_error = Some(CurveError::GivenUp(text.clone()));
    }
    tell(model, Level::Info, text);
    vec![Effect::StopCurve(model.curve_wanted)]
}

pub(super) fn curve_came(model: &mut Model, id: u64, result: Result<Arc<CurveData>, Reason>) -> Vec<Effect> {
    if id <= model.curve_shown {
        return Vec::new();
    }
    model.curve_shown = id;
    match result {
        Err(reason) => {
            model.queue.clear();
            let text = format!("no curve for these values: {reason}");
            tell(model, Level::of(&reason), text.clone());
            model.curve_error = Some(CurveError::Failed(text));
            Vec::new()
        }
        Ok(curve) => {
            model.curve_error = None;
            let first = model.history.current().is_none();
            model.curve = Some(Arc::clone(&curve));
            let lines = model.shown_events().len() + model.shown_inadmissible().len();
            model.event = model.event.min(lines.saturating_sub(1));
            if first {
                begin_walk(model, &curve);
                return go_on(model);
            }
            let is_tried = std::mem::take(&mut model.is_tried);
            if model.walking.is_some() {
                // Solved again once that is over.
                return Vec::new();
            }
            let Some(node) = model.history.current() else { return Vec::new() };
            let is_stale = matches!(node.kind, NodeKind::Stale(_));
            if is_tried && is_stale || model.is_on_curve(node) || node.is_apart() {
                return go_on(model);
            }
            let state = node.state.in_units(node.setting.units());
            walk(model, Action::Solve { state })
        }
    }
}

/// Asks which states of the curve on the screen are admissible, once no newer curve is on its way.
///
/// A newer one drops the question with the curve; where it fails or is given up, it is asked again.
pub(super) fn want_check(model: &mut Model) -> Option<Effect> {
    let curve = model.curve.as_ref().filter(|curve| !model.is_computing() && !curve.is_checked()).cloned();
    let Some(curve) = curve else {
        model.checking = None;
        return None;
    };
    if model.checking.is_some() {
        return None;
    }
    let id = number(model);
    model.checking = Some(Checking::Asked(id));
    Some(Effect::Check(Check { id, curve }))
}

pub(super) fn checked(model: &mut Model, id: u64, curve: Arc<CurveData>) {
    if model.checking == Some(Checking::Asked(id)) {
        model.curve = Some(curve);
    }
}

/// The parameters of the walker's state, where the curve on the screen has others.
pub(super) fn adopt_parameters(model: &mut Model) -> Vec<Effect> {
    let Some(node) = model.history.current() else { return Vec::new() };
    if model.is_on_curve(node) || matches!(node.kind, NodeKind::Stale(_)) {
        return Vec::new();
    }
    take_back(model)
}

/// The parameters of the walker's state instead of those typed since.
pub(super) fn take_back(model: &mut Model) -> Vec<Effect> {
    let Some(node) = model.history.current() else { return Vec::new() };
    let mut preset = node.setting.preset.clone();
    preset.title.clone_from(&model.preset.title);
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
    if !model.queue.is_empty() {
        tell(model, Level::Info, "what was asked of the walk and not begun is left: the values changed");
    }
    let mut effects = stop(model);
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

/// The stiffness of the contact at the start in the user's units; before there is a curve, the unit of stiffness.
fn contact_stiffness(model: &Model) -> f64 {
    let known = model.curve.as_ref().and_then(|curve| {
        let sweep = &curve.sweep;
        Some(sweep.stiffness?.in_units(sweep.case.units()).contact)
    });
    known.unwrap_or_else(|| model.preset.problem().reduced().units.stiffness)
}

pub(super) fn turn(model: &mut Model, up: bool, amount: Amount) -> Vec<Effect> {
    let Some((row, _)) = model.selected_knob() else { return Vec::new() };
    let contact = contact_stiffness(model);
    match nudge(&model.preset, &row, up, amount, contact) {
        Ok(preset) => {
            tell_effect(model, &row.key, &preset);
            change(model, preset)
        }
        Err(reason) => {
            tell(model, Level::Error, reason);
            Vec::new()
        }
    }
}

/// A group is not stored: what it changed instead is said, with the new values.
fn tell_effect(model: &mut Model, key: &str, changed: &Preset) {
    let Some([_, held]) = groups::effect(key) else { return };
    let moved = changed.rows().filter(|row| model.preset.get(&row.key) != changed.get(&row.key));
    let values: Vec<String> =
        moved.filter_map(|row| Some(labelled(&row, &changed.get(&row.key)?, &changed.units))).collect();
    if !values.is_empty() {
        tell(model, Level::Info, greek(&format!("changed: {}; {held} held", values.join(", "))));
    }
}

/// What a formula's parameters that the one before had not begin with; a like name that is gone may be what was meant.
fn tell_new_parameters(model: &mut Model, before: &Preset, changed: &Preset) {
    let names = |preset: &Preset| -> Vec<Row> {
        preset.rows().filter(|row| is_parameter(&row.key)).map(|row| Row::Owned(row.into_owned())).collect()
    };
    let (old, new) = (names(before), names(changed));
    let lacks = |rows: &[Row], row: &Row| !rows.iter().any(|other| other.key == row.key);
    let gone = || old.iter().filter(|row| lacks(&new, row)).map(|row| &*row.label);
    let told: Vec<String> = new
        .iter()
        .filter(|row| lacks(&old, row))
        .filter_map(|row| {
            let value = labelled_with(row, &changed.get(&row.key)?, &changed.units, " = ");
            let meant = closest(&row.label, gone());
            Some(format!(
                "new parameter {value}{}",
                meant.map_or_else(String::new, |meant| format!("; did you mean {meant}?"))
            ))
        })
        .collect();
    if !told.is_empty() {
        tell(model, Level::Info, told.join("; "));
    }
}

/// Another value for a key, in place of those tried for it.
pub(super) fn set(model: &mut Model, key: &str, text: &str) -> Vec<Effect> {
    let mut preset = before_tried(model).clone();
    let Some(row) = preset.row(key) else { return Vec::new() };
    let result = match preset.typed(&row, text) {
        // A file is read by those who may wait for it.
        Ok(Value::Text(name)) if row.kind == Kind::File => return vec![read(model, name)],
        value => value.and_then(|value| set_in_range(&mut preset, key, value)),
    };
    match result {
        Ok(moved) => {
            if row.key == "gap.formula" {
                let before = before_tried(model).clone();
                tell_new_parameters(model, &before, &preset);
            }
            model.untried = None;
            tell_effect(model, &row.key, &preset);
            if let Some(moved) = moved {
                tell(model, Level::Info, moved);
            }
            change(model, preset)
        }
        Err(invalid) => {
            tell(model, Level::Error, invalid.to_string());
            Vec::new()
        }
    }
}

/// Gives `preset` another value; a start that is not on the profile it gets moves onto it, which is returned in words.
fn set_in_range(preset: &mut Preset, key: &str, value: Value) -> Result<Option<String>, Invalid> {
    /// The start on a profile that the start before does not fit, over the last radius.
    const START: f64 = 0.8;
    /// A start below this share of the last radius is of another size than the profile.
    const FITTING: f64 = 0.05;
    let Start::ContactRadius(start) = preset.path.start else { return preset.set(key, value).map(|()| None) };
    if !matches!(key, "gap.shape" | "gap.file") {
        return preset.set(key, value).map(|()| None);
    }
    let mut changed = preset.clone();
    let result = changed.set(key, value.clone());
    if result.is_err() {
        // Perhaps for the range alone: once more with nothing of the path in the way.
        changed.reset("path.end_contact_radius")?;
        changed.set(START_KEYS[0], Value::Number(1e-6 * start))?;
        if changed.set(key, value).is_err() {
            return result.map(|()| None);
        }
    }
    let largest = match &changed.gap {
        Shape::Profile(measured) => measured.profile().largest_radius(),
        _ => None,
    };
    let Some(largest) = largest else {
        *preset = if result.is_ok() { changed } else { return result.map(|()| None) };
        return Ok(None);
    };
    if result.is_ok() && start >= FITTING * largest {
        *preset = changed;
        return Ok(None);
    }
    let within =
        changed.gap.radius_of_curvature().map_or(f64::INFINITY, |radius| RADIUS_OVER_CURVATURE * radius);
    let moved = (START * largest).min(within);
    changed.set(START_KEYS[0], Value::Number(moved))?;
    let shown = |s| with_unit(&changed.units, Quantity::Length, s, false, |s| short(s, 4));
    let told = format!(
        "the start s {} is not on the profile, known up to {}: it is {} now",
        shown(start),
        shown(largest),
        shown(moved)
    );
    *preset = changed;
    Ok(Some(told))
}

/// Another value for a key while it is typed, always from the preset before: what the texts between lacked is not lost.
pub(super) fn try_out(model: &mut Model, key: &str, text: &str) -> Vec<Effect> {
    let before = model.untried.clone().unwrap_or_else(|| {
        let (preset, mark, journal) = (model.preset.clone(), model.history.mark(), model.journal.clone());
        Box::new(Untried { preset, mark, journal })
    });
    let effects = set(model, key, text);
    model.untried = Some(before);
    effects
}

/// The values and the walker's state before those tried.
pub(super) fn untry(model: &mut Model) -> Vec<Effect> {
    let Some(before) = model.untried.take() else { return Vec::new() };
    let mut effects = stop(model);
    model.walking = None;
    model.history.return_to(before.mark);
    model.journal = before.journal;
    model.journal.abandoned();
    effects.extend(change(model, before.preset));
    effects
}

/// The preset before the values tried.
fn before_tried(model: &Model) -> &Preset {
    model.untried.as_deref().map_or(&model.preset, |before| &before.preset)
}

/// Other values for some keys, as one change; those of a file wait for who may read it.
pub(super) fn assign(model: &mut Model, assignments: Vec<Assignment>) -> Vec<Effect> {
    let mut preset = before_tried(model).clone();
    let is_file = |key: &str| preset.row(key).is_some_and(|row| row.kind == Kind::File);
    if assignments.iter().any(|(key, _)| is_file(key)) {
        return vec![file(Job::Assign { preset: Box::new(preset), assignments })];
    }
    match assignments.iter().try_for_each(|(key, text)| preset.assign(key, text)) {
        Ok(()) => {
            model.untried = None;
            change(model, preset)
        }
        Err(invalid) => {
            tell(model, Level::Error, invalid.to_string());
            Vec::new()
        }
    }
}

/// The rows of a profile were read: they are the gap now.
pub(super) fn rows_came(model: &mut Model, rows: Arc<Rows>) -> Vec<Effect> {
    // Each note begins with the path, which is said once and short.
    let path = Path::new(&rows.name);
    let whole =
        show_path(&rows.folder.as_deref().map_or_else(|| path.to_owned(), |folder| folder.join(path)));
    let notes = rows.notes.iter().map(|note| {
        note.strip_prefix(&*whole).and_then(|note| note.strip_prefix(": ")).unwrap_or(note).to_owned()
    });
    let name = path.file_name().map_or_else(String::new, |name| show_name(&name.to_string_lossy()));
    let read = format!("{name}: {} rows", rows.radii.len());
    let said = std::iter::once(read).chain(notes).collect::<Vec<_>>().join("; ");
    let mut preset = model.preset.clone();
    match set_in_range(&mut preset, "gap.file", Value::Profile(rows)) {
        Ok(moved) => {
            let said = moved.map_or(said.clone(), |moved| format!("{said}; {moved}"));
            tell(model, Level::Info, said);
            change(model, preset)
        }
        Err(invalid) => {
            tell(model, Level::Error, invalid.to_string());
            Vec::new()
        }
    }
}

pub(super) fn change_control(model: &mut Model) -> Vec<Effect> {
    let mut preset = model.preset.clone();
    preset.path.control = next_control(&model.preset, model.stiffness);
    change(model, preset)
}
