//! Changed values, and the curve that follows from them.

use crate::explorer::command::{Assignment, Id};
use crate::explorer::effect::Effect;
use crate::explorer::fit::not_fitted;
use crate::explorer::job::Job;
use crate::explorer::model::{Level, Model, Untried};
use crate::explorer::nudge::{Amount, nudge};
use crate::explorer::pins::{labelled, labelled_with};
use crate::explorer::requests::{change, file, read, stop};
use crate::explorer::script::key_called;
use pulloff_engine::fit::doubt_of_wave;
use pulloff_engine::gap::shapes::ProfileRows;
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::preset::edge;
use pulloff_engine::preset::family::is_parameter;
use pulloff_engine::preset::invalid::Invalid;
use pulloff_engine::preset::schema::{Kind, NONE, RADIUS_OVER_CURVATURE, START_KEYS};
use pulloff_engine::preset::{Preset, Row, Value, groups};
use pulloff_engine::problem::Start;
use pulloff_engine::report::number::{short, with_unit};
use pulloff_engine::text::{closest, counted, greek, show_name, show_path};
use pulloff_engine::units::{Quantity, Unit, UnitSystem, parse_quantity};
use std::path::Path;
use std::sync::Arc;

/// The key of the formula of a gap.
const FORMULA: &str = "gap.formula";

/// The stiffness of the contact at the start in the user's units; while there is no curve, the unit of stiffness.
fn contact_stiffness(model: &Model) -> f64 {
    let known = model.curve.as_ref().and_then(|curve| {
        let base = &curve.base;
        Some(base.stiffness?.in_units(base.case.units()).contact)
    });
    known.unwrap_or_else(|| model.preset.problem().reduced().units.stiffness)
}

/// Turns the selected value, or that of `key`, by one of the turning commands.
pub(in crate::explorer) fn turn(model: &mut Model, id: Id, key: Option<&str>) -> Vec<Effect> {
    let (up, amount) = match id {
        Id::FineLess => (false, Amount::Third),
        Id::FineMore => (true, Amount::Third),
        Id::Less => (false, Amount::Second),
        Id::More => (true, Amount::Second),
        Id::MuchLess => (false, Amount::First),
        _ => (true, Amount::First),
    };
    let row = match key {
        Some(key) => model.knobs().into_iter().map(|(row, _)| row).find(|row| row.key == key),
        None => model.selected_knob().map(|(row, _)| row),
    };
    let Some(row) = row else { return Vec::new() };
    let contact = contact_stiffness(model);
    match nudge(&model.preset, &row, up, amount, contact) {
        Ok(preset) => {
            tell_effect(model, &row.key, &preset);
            tell_points(model, &preset);
            change(model, preset)
        }
        Err(reason) => model.refuse(reason),
    }
}

/// A group is not stored, so the message says what changed instead, with the new values.
fn tell_effect(model: &mut Model, key: &str, changed: &Preset) {
    let Some([_, held]) = groups::effect(key) else { return };
    let moved = changed.rows().filter(|row| model.preset.get(&row.key) != changed.get(&row.key));
    let values: Vec<String> =
        moved.filter_map(|row| Some(labelled(&row, &changed.get(&row.key)?, &changed.units))).collect();
    if !values.is_empty() {
        model.tell(Level::Info, greek(&format!("changed: {}; {held} held", values.join(", "))));
    }
}

/// Says in which unit a bare number was taken, where another one is shown.
fn tell_bare(model: &mut Model, key: &str, text: &str, changed: &Preset) {
    let Some((row, value)) = changed.row(key).zip(changed.get(key)) else { return };
    if let Some(unit) = unit_beside_bare(changed, &row, text.rsplit('=').next().unwrap_or(text)) {
        let now = greek(&labelled(&row, &value, &changed.units));
        model.tell(Level::Info, format!("{now} now: {}", of_bare(&unit)));
    }
}

/// The unit in which a row is shown, if a bare number means another one.
fn unit_beside_bare(preset: &Preset, row: &Row, number: &str) -> Option<Unit> {
    let is_bare = parse_quantity(number.trim()).is_ok_and(|value| value.unit.is_none());
    // A unit of its own is that of bare numbers too.
    let unit = row.unit_in(&preset.units).filter(|_| is_bare && row.unit.is_none())?;
    ((unit.from_si(1.0) - 1.0).abs() > 1e-9).then(|| unit.clone())
}

fn of_bare(unit: &Unit) -> String {
    format!("a bare number is SI, as in files; one in {} needs its unit", unit.ascii())
}

/// The same for a range, as in KEY=FROM..TO.
pub(in crate::explorer) fn tell_bare_range(model: &mut Model, text: &str) {
    let Some((key, range)) = text.split_once('=') else { return };
    let end = range.trim().trim_start_matches("log:").rsplit("..").next().unwrap_or(range);
    let row = key_called(&model.preset, key.trim()).ok().and_then(|key| model.preset.row(&key));
    let found = row.and_then(|row| Some((greek(&row.label), unit_beside_bare(&model.preset, &row, end)?)));
    if let Some((label, unit)) = found {
        model.tell(Level::Info, format!("the range of {label}: {}", of_bare(&unit)));
    }
}

/// Says that a value has no effect yet.
fn tell_idle(model: &mut Model, key: &str, changed: &Preset) {
    // A work of adhesion of closing makes a dead band, whatever the speed.
    let is_of_speed = edge::KEYS.contains(&key) && key != edge::CLOSING_ADHESION;
    if !is_of_speed || changed.get(key).is_none() {
        return;
    }
    let edge = &changed.edge;
    let missing = match edge.exponent {
        None => "edge.exponent gives the edge a speed",
        Some(_) if edge.rate.is_none() && edge.steps.is_empty() => {
            "path.rate or path.steps is set; a fit takes the rate from the times of its file"
        }
        Some(_) => return,
    };
    model.tell(Level::Info, format!("{key} has no effect until {missing}"));
}

/// Says that the values are the same already.
fn tell_same(model: &mut Model, assignments: &[Assignment]) {
    let preset = &model.preset;
    let said = assignments.iter().filter_map(|(key, _)| {
        let (row, value) = (preset.row(key)?, preset.get(key).unwrap_or_else(|| NONE.into()));
        Some(labelled_with(&row, &value, &preset.units, " is already "))
    });
    let said = greek(&said.collect::<Vec<_>>().join(", "));
    model.tell(Level::Info, said);
}

/// The initial values of a formula's new parameters; a former parameter with a similar name may be what was meant.
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
        model.tell(Level::Info, told.join("; "));
    }
}

/// Sets a key to another value, in place of those tried for it.
pub(super) fn set(model: &mut Model, key: &str, text: &str) -> Vec<Effect> {
    let mut preset = before_tried(model).clone();
    let Some(row) = preset.row(key) else { return Vec::new() };
    let result = match preset.typed(&row, text) {
        // A file is read by a worker, which may wait for it.
        Ok(Value::Text(name)) if row.kind == Kind::File => return vec![read(model, key, name)],
        Ok(Value::Text(name)) if row.kind == Kind::Points => {
            let assignments = vec![(row.key.clone(), name)];
            return vec![file(Job::Assign { preset: Box::new(preset), assignments })];
        }
        value => value.and_then(|value| put(&mut preset, key, value)),
    };
    match (result, loses_points(model, &preset)) {
        (Ok(_), Some(why)) => model.refuse(why),
        (Ok(said), None) => {
            if row.key == FORMULA {
                let before = before_tried(model).clone();
                tell_new_parameters(model, &before, &preset);
            }
            model.untried = None;
            tell_effect(model, &row.key, &preset);
            tell_idle(model, &row.key, &preset);
            tell_points(model, &preset);
            if let Some(said) = said {
                model.tell(Level::Info, said);
            }
            change(model, preset)
        }
        (Err(invalid), _) => model.refuse(invalid.to_string()),
    }
}

/// Whether another value of this key brings another gap.
fn is_gap(key: &str) -> bool {
    matches!(key, "gap.shape" | "gap.file")
}

/// Gives `preset` another value; returns in words what else there is to know about it.
fn put(preset: &mut Preset, key: &str, value: Value) -> Result<Option<String>, Invalid> {
    let before = preset.clone();
    let moved = set_in_range(preset, key, value)?;
    // Turning a value of the gap does not replace the gap.
    let lengths = if is_gap(key) { other_lengths(&before, preset) } else { None };
    let said: Vec<String> = moved.into_iter().chain(lengths).collect();
    Ok((!said.is_empty()).then(|| said.join("; ")))
}

/// What to know when a gap is replaced by one of another size and lengths have no unit: the numbers that stay then mean
/// something else.
fn other_lengths(before: &Preset, changed: &Preset) -> Option<String> {
    /// Between gaps of similar size, the numbers may well be meant the same way.
    const LIKE: f64 = 3.0;
    let [was, is] = [before, changed].map(|preset| preset.gap.length());
    let (was, is) = was.zip(is)?;
    let apart = (is / was).max(was / is);
    (changed.units == UnitSystem::Reduced && apart > LIKE).then(|| {
        format!(
            "lengths have another scale here, {} for this gap, {} for the last: E*, γ and the path keep their numbers",
            short(is, 4),
            short(was, 4)
        )
    })
}

/// Gives `preset` another value; a start that is not on its new profile moves onto it, which is returned in words.
fn set_in_range(preset: &mut Preset, key: &str, value: Value) -> Result<Option<String>, Invalid> {
    /// The start on a profile that the previous start does not fit, over the last radius.
    const START: f64 = 0.8;
    /// A start below this share of the last radius is on another scale than the profile.
    const FITTING: f64 = 0.05;
    let Start::ContactRadius(start) = preset.path.start else { return preset.set(key, value).map(|()| None) };
    if !is_gap(key) {
        return preset.set(key, value).map(|()| None);
    }
    let mut changed = preset.clone();
    let result = changed.set(key, value.clone());
    if result.is_err() {
        // Perhaps only because of the range: try once more with nothing of the path in the way.
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
        "the start s {} is not on the profile, known up to {}: it is now {}",
        shown(start),
        shown(largest),
        shown(moved)
    );
    *preset = changed;
    Ok(Some(told))
}

/// Tries another value for a key while it is being typed, always from the preset before, so that nothing that an
/// intermediate text lacked is lost.
pub(super) fn try_out(model: &mut Model, key: &str, text: &str) -> Vec<Effect> {
    let before = model
        .untried
        .clone()
        .unwrap_or_else(|| Box::new(Untried { place: model.place(), mark: model.history.mark() }));
    let effects = set(model, key, text);
    model.untried = Some(before);
    effects
}

/// Restores the values and the walker's state from before the ones tried.
pub(super) fn untry(model: &mut Model) -> Vec<Effect> {
    let Some(before) = model.untried.take() else { return Vec::new() };
    let mut effects = stop(model);
    model.walking = None;
    model.history.return_to(before.mark);
    model.journal.abandoned();
    model.stands();
    effects.extend(change(model, before.place.preset));
    effects
}

/// The preset before the values tried.
fn before_tried(model: &Model) -> &Preset {
    model.untried.as_deref().map_or(&model.preset, |before| &before.place.preset)
}

/// Sets other values for some keys, as one change; a file among them waits for a worker to read it.
pub(super) fn assign(model: &mut Model, assignments: Vec<Assignment>) -> Vec<Effect> {
    let mut preset = before_tried(model).clone();
    let whole = |(key, text): Assignment| Ok((key_called(&preset, &key)?, text));
    let read: Result<Vec<Assignment>, String> = assignments.into_iter().map(whole).collect();
    let assignments = match read {
        Ok(assignments) => assignments,
        Err(why) => return model.refuse(why),
    };
    let is_file =
        |key: &str| preset.row(key).is_some_and(|row| matches!(row.kind, Kind::File | Kind::Points));
    if assignments.iter().any(|(key, _)| is_file(key)) {
        return vec![file(Job::Assign { preset: Box::new(preset), assignments })];
    }
    match preset.assign_all(&assignments) {
        Ok(()) => {
            for (key, text) in &assignments {
                tell_bare(model, key, text, &preset);
                tell_idle(model, key, &preset);
            }
            assigned(model, preset, &assignments)
        }
        Err(invalid) => model.refuse(invalid.to_string()),
    }
}

/// The rows of a profile have been read: they become the gap.
pub(super) fn rows_came(model: &mut Model, rows: Arc<ProfileRows>) -> Vec<Effect> {
    // Each note begins with the path, which is given once, in short form.
    let path = Path::new(&rows.name);
    let whole =
        show_path(&rows.folder.as_deref().map_or_else(|| path.to_owned(), |folder| folder.join(path)));
    let notes = rows.notes.iter().map(|note| {
        note.strip_prefix(&*whole).and_then(|note| note.strip_prefix(": ")).unwrap_or(note).to_owned()
    });
    let name = path.file_name().map_or_else(String::new, |name| show_name(&name.to_string_lossy()));
    let read = format!("{name}: {}", counted(rows.radii.len(), "row"));
    let said = std::iter::once(read).chain(notes).collect::<Vec<_>>().join("; ");
    let mut preset = model.preset.clone();
    match put(&mut preset, "gap.file", Value::Profile(rows)) {
        Ok(more) => {
            model.tell(Level::Info, std::iter::once(said).chain(more).collect::<Vec<_>>().join("; "));
            change(model, preset)
        }
        Err(invalid) => model.refuse(invalid.to_string()),
    }
}

/// The outcome of assignments, after a file was read or at once: reports a measured curve and what was found in it.
pub(super) fn assigned(model: &mut Model, preset: Preset, assignments: &[Assignment]) -> Vec<Effect> {
    if let Some(why) = loses_points(model, &preset) {
        return model.refuse(why);
    }
    let is_new = preset.data.free != model.preset.data.free;
    let refused = preset.data.free().filter(|_| is_new).find_map(|name| not_fitted(&preset, name));
    if let Some(why) = refused {
        return model.refuse(why);
    }
    if preset == *before_tried(model) {
        tell_same(model, assignments);
    }
    if assignments.iter().any(|(key, _)| key == FORMULA) {
        let before = before_tried(model).clone();
        tell_new_parameters(model, &before, &preset);
    }
    model.untried = None;
    tell_points(model, &preset);
    change(model, preset)
}

/// Why the data of `preset` yield no points, if those of the session did until now: it keeps them.
fn loses_points(model: &Model, preset: &Preset) -> Option<String> {
    let before = before_tried(model);
    let why = preset.branches()?.err().filter(|_| preset.data != before.data)?;
    let had_none = before.branches().is_some_and(|branches| branches.is_err());
    (!had_none).then(|| format!("{}: {why}; the data stay as they were", file_name(preset)))
}

/// The name of the file of the measured curve, safe to show.
fn file_name(preset: &Preset) -> String {
    let path = preset.data.source.as_ref().map(|source| source.path()).unwrap_or_default();
    path.file_name().map_or_else(String::new, |name| show_name(&name.to_string_lossy()))
}

/// Reports how many points `preset` has by branch and part, if they differ from before or are read differently, or that it has
/// none any more.
fn tell_points(model: &mut Model, preset: &Preset) {
    let taken = |preset: &Preset| (preset.data.columns.clone(), preset.reading().asked);
    let is_same = model.preset.data.source == preset.data.source && taken(&model.preset) == taken(preset);
    let Some(branches) = preset.branches() else { return };
    // A position is none without a spring.
    let is_lost = || branches.is_err() && model.preset.branches().is_some_and(|before| before.is_ok());
    if is_same && !is_lost() {
        return;
    }
    let name = file_name(preset);
    match branches {
        Ok(branches) => {
            let parts = branches.list.iter().map(|branch| {
                let (contact, apart) = (branch.attached.len(), branch.free.len());
                let jump =
                    if branch.jump > 0 { format!(", {} in the jump", branch.jump) } else { String::new() };
                format!("{}: {contact} in contact, {apart} apart{jump}", branch.segment.name())
            });
            let read = format!("{name}: {}", parts.collect::<Vec<_>>().join("; "));
            // What was assumed about the columns, and how many rows were left out.
            let of_file = preset.notes_of_reading().unwrap_or_default();
            let notes = of_file.into_iter().chain(branches.notes.iter().cloned());
            let doubts = branches.swapped().into_iter().chain(branches.doubt());
            let doubts = doubts.chain(doubt_of_wave(preset, &branches));
            let said: Vec<String> =
                doubts.chain([read]).chain(preset.dropped_of(&model.preset)).chain(notes).collect();
            model.tell(Level::Info, said.join("; "));
        }
        Err(why) => model.tell(Level::Error, format!("{name} is not drawn: {why}")),
    }
}
