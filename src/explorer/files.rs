//! Runs the jobs on files: opening, saving, exporting, and reading profiles.

use super::command::{Assignment, Command};
use super::curve::CurveData;
use super::data::Foreign;
use super::export::{Page, ends_in};
use super::job::{Content, Done, Job};
use super::journal::Beginning;
use super::walk_table::changed_keys;
use super::{data, script, study_table, walk_table};
use crate::mend::WordedFault;
use crate::print::PictureFormat;
use crate::store::{Listed, Overwrite, Source, Store, StoreError, WriteError, write_atomically};
use pulloff_engine::preset::changes::{changes, differences};
use pulloff_engine::preset::data::DataSpec;
use pulloff_engine::preset::schema::NONE;
use pulloff_engine::preset::{Invalid, Preset, Value, data as data_keys};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::report::columns;
use pulloff_engine::report::path::{EventReport, events_table};
use pulloff_engine::report::walk::{WALK_COLUMNS, WalkReport, WalkRow};
use pulloff_engine::report::{Head, TraceReport, json, rows};
use pulloff_engine::text::show_path;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Gives `preset` other values. Another measured curve drops what held for the previous one, but keeps columns without which it
/// cannot be read.
fn assign(preset: &mut Preset, assignments: &[Assignment]) -> Result<(), Invalid> {
    if !assignments.iter().any(|(key, _)| key == data_keys::FILE) {
        return preset.assign_all(assignments);
    }
    let given = with_curve(preset, preset.data.clone(), assignments);
    let is_same = given.as_ref().is_ok_and(|given| {
        let sources = preset.data.source.as_ref().zip(given.data.source.as_ref());
        sources.is_none_or(|(before, now)| now.path() == before.path() || now.has_bytes_of(before))
            && (given.data.source.is_some() || preset.data.source.is_none())
    });
    let bare = preset.data.without_file();
    let with_columns = DataSpec { columns: preset.data.columns.clone(), ..bare.clone() };
    *preset = if is_same {
        given?
    } else {
        with_curve(preset, bare, assignments)
            .or_else(|invalid| with_curve(preset, with_columns, assignments).map_err(|_| invalid))?
    };
    Ok(())
}

/// The preset with other values and with `data` in place of its own, without the file; a measured curve comes last, together
/// with the values that describe its columns. One that is taken away, or replaced, no longer refuses what it states
/// otherwise.
fn with_curve(preset: &Preset, data: DataSpec, assignments: &[Assignment]) -> Result<Preset, Invalid> {
    let mut changed = preset.clone();
    changed.data = data;
    changed.assign(data_keys::FILE, NONE)?;
    let is_curve = |assignment: &&Assignment| [data_keys::FILE, data_keys::COLUMNS].contains(&&*assignment.0);
    let (curve, others): (Vec<_>, Vec<_>) = assignments.iter().partition(is_curve);
    changed.assign_all(&others.into_iter().cloned().collect::<Vec<_>>())?;
    changed.set_all(curve.into_iter().map(|(key, text)| (&**key, Value::Text(text.clone()))))?;
    Ok(changed)
}

/// Does a job.
pub fn run(store: &Store, job: Job) -> Done {
    match job {
        Job::List => Done::Listed(Box::new(store.list())),
        Job::Names => {
            let named = |listed: Listed| [listed.name, listed.title.unwrap_or_else(|why| why)];
            Done::Named(store.list().presets.into_iter().map(named).collect())
        }
        Job::Assign { mut preset, assignments } => {
            match assign(&mut preset, &assignments) {
                Ok(()) => {
                    // Found here, its branches need not be found later where nobody may wait for them.
                    let _ = preset.branches();
                    Done::Assigned(preset, assignments)
                }
                Err(invalid) => {
                    let reason = WordedFault::mendable(invalid.to_string());
                    match Foreign::of(&preset, &assignments) {
                        Some(foreign) => Done::Foreign(Box::new(foreign), reason),
                        None => Done::Failed(reason),
                    }
                }
            }
        }
        Job::Open { name, assignments } => {
            let assignments: Vec<String> =
                assignments.iter().map(|(key, text)| format!("{key}={text}")).collect();
            let loaded = store.resolve(&name).and_then(|source| store.load(&source, &assignments));
            loaded.map_or_else(
                |e| Done::Failed(WordedFault::of("", &e)),
                |loaded| Done::Opened(Box::new(loaded)),
            )
        }
        Job::Delete(name) => match store.delete(&name) {
            Ok(path) => Done::Deleted(show_path(&path), Box::new(store.list())),
            Err(error) => Done::Failed(WordedFault::of("not deleted: ", &error)),
        },
        Job::Browse { key, folder, own } => match data::list(folder.as_deref(), own.as_deref()) {
            Ok(folder) => Done::Browsed(key, Box::new(folder)),
            Err(reason) => Done::Failed(WordedFault::mendable(reason)),
        },
        Job::Read { folder, name } => {
            let path = target(&name).to_string_lossy().into_owned();
            match crate::store::load(folder.as_deref(), &path) {
                Ok(rows) => Done::Read(Arc::new(rows)),
                Err(reason) => Done::Failed(WordedFault::mendable(reason)),
            }
        }
        Job::Save { source, preset, overwrite } => {
            let Some(path) = source.path() else {
                let why = "the preset has no file of its own; save it under a name";
                return Done::Failed(WordedFault::mendable(why));
            };
            match crate::store::save_file(path, &preset, Some(&source), overwrite) {
                Ok(fingerprint) => Done::Saved { source, fingerprint, preset },
                Err(StoreError::Write(WriteError::Changed { .. })) => Done::Conflict,
                Err(error) => Done::Failed(WordedFault::of("not saved: ", &error)),
            }
        }
        Job::SaveAs { name, preset, replace, with_data, from } => {
            save_as(store, name, preset, replace, with_data, &from)
        }
        Job::Export { content, path, replace } => export(store, &content, path, replace),
    }
}

/// Saves under a name, together with the data of a profile if wanted.
fn save_as(
    store: &Store,
    name: String,
    preset: Box<Preset>,
    replace: bool,
    with_data: bool,
    from: &Source,
) -> Done {
    let overwrite = if replace { Overwrite::Always } else { Overwrite::Never };
    let saved = if with_data {
        let saved = store.save_with_data(&name, &preset, Some(from), overwrite);
        saved.map(|(source, fingerprint, preset)| (source, fingerprint, Box::new(preset)))
    } else {
        store
            .save(&name, &preset, Some(from), overwrite)
            .map(|(source, fingerprint)| (source, fingerprint, preset))
    };
    match saved {
        Ok((source, fingerprint, preset)) => Done::Saved { source, fingerprint, preset },
        Err(StoreError::Write(WriteError::Exists { .. })) => Done::NameTaken(name, with_data),
        Err(error) => Done::Failed(WordedFault::of("not saved: ", &error)),
    }
}

fn export(store: &Store, content: &Content, path: String, replace: bool) -> Done {
    let as_json = Path::new(&path).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    let bytes = match content {
        Content::Page(Page::Figure(svg)) => picture(svg, &path),
        Content::Script(start, lines) => {
            script_text(store, start, lines).map(String::into_bytes).map_err(WordedFault::mendable)
        }
        Content::Study(study, start) if ends_in(&path, &["toml"]) => named(store, start)
            .map(|(name, over)| study_table::spec(study, &name, &over).into_bytes())
            .map_err(WordedFault::mendable),
        text => self::text(text, as_json)
            .map(String::into_bytes)
            .map_err(|error| WordedFault { text: error.to_string(), can_be_mended: false }),
    };
    let bytes = match bytes {
        Ok(bytes) => bytes,
        Err(reason) => return Done::Failed(WordedFault::of("not exported: ", &reason)),
    };
    let overwrite = if replace { Overwrite::Always } else { Overwrite::Never };
    match write_atomically(&target(&path), &bytes, overwrite) {
        Ok(_) => Done::Exported(path, note(content, &bytes, as_json)),
        Err(WriteError::Exists { .. }) => Done::FileExists(content.export(), path),
        Err(error) => Done::Failed(WordedFault::of("not exported: ", &error)),
    }
}

/// The bytes of the file `path` of a figure.
fn picture(svg: &str, path: &str) -> Result<Vec<u8>, WordedFault> {
    let format = PictureFormat::of(Path::new(path)).map_err(|error| WordedFault::of("", &error))?;
    format.bytes(svg).map_err(|error| WordedFault::of("", &error))
}

/// What an export of these bytes says of itself: the units of the columns of a CSV file, as the commands note them.
fn note(content: &Content, csv: &[u8], as_json: bool) -> Option<String> {
    let preset = match content {
        Content::Script(..) => return Some("without pins, studies and exports".to_owned()),
        _ if as_json => return None,
        Content::Curve(curve) | Content::Walk(curve, _) | Content::Events(curve, _) => &curve.setting.preset,
        Content::Pull(_, preset) => preset,
        Content::Study(..) | Content::Page(_) => return None,
    };
    let columns: Vec<&str> = std::str::from_utf8(csv).ok()?.lines().next()?.split(',').collect();
    columns::units(&columns, preset.path.control, &preset.units)
}

/// The path a person typed, `~/` meaning the home folder.
pub fn target(path: &str) -> PathBuf {
    match (path.strip_prefix("~/"), std::env::var_os("HOME")) {
        (Some(rest), Some(home)) => Path::new(&home).join(rest),
        _ => PathBuf::from(path),
    }
}

/// A session as a script: opens the preset it began with, with the values that differ from its file, followed by its
/// lines.
fn script_text(store: &Store, start: &Beginning, lines: &[String]) -> Result<String, String> {
    let (name, assignments) = named(store, start)?;
    let open = script::line(&Command::OpenWith { name, assignments }).ok_or_else(|| lost(&start.source))?;
    Ok(std::iter::once(script::HEAD).chain([&*open]).chain(lines.iter().map(String::as_str)).fold(
        String::new(),
        |mut text, line| {
            text.push_str(line);
            text.push('\n');
            text
        },
    ))
}

/// Why a preset cannot be expressed by its name and assignments.
fn lost(source: &Source) -> String {
    format!("its preset cannot be reached from {} by assigning values", source.shown())
}

/// How to refer to a preset: its name or path, and the values that differ from its file.
fn named(store: &Store, start: &Beginning) -> Result<(String, Vec<Assignment>), String> {
    let name = match &start.source {
        Source::Shipped(shipped) => shipped.name.to_owned(),
        Source::User { name, .. } => name.clone(),
        // The script may be run from another folder.
        Source::File(path) => {
            std::path::absolute(path).unwrap_or_else(|_| path.clone()).display().to_string()
        }
        Source::Piped { .. } => {
            let why = "the preset came through a pipe, and a script cannot open it: save it under a name, and open that";
            return Err(why.to_owned());
        }
    };
    let none = &[] as &[&str];
    let source = store.resolve(&name).map_err(|error| error.to_string())?;
    let now = store.load(&source, none).map_err(|error| error.to_string())?.preset;
    let wanted = start.preset.anywhere();
    // Applied to the file as a whole, as a replay does.
    let leads_there = |assignments: &Vec<Assignment>| {
        let laid: Vec<String> = assignments.iter().map(|(key, text)| format!("{key}={text}")).collect();
        store.load(&source, &laid).is_ok_and(|back| back.preset == wanted)
    };
    let ways = [Some(differences(&now, &wanted)), changes(&now, &wanted)];
    let assignments = ways.into_iter().flatten().find(leads_there).ok_or_else(|| lost(&start.source))?;
    Ok((name, assignments))
}

/// The text of a document; for a script, only its lines.
fn text(content: &Content, as_json: bool) -> Result<String, Box<dyn std::error::Error>> {
    let walked = |curve: &CurveData, points: Vec<WalkRow>, events: &[EventReport]| {
        json(&WalkReport {
            head: Head::new("walk", &curve.setting.preset, &curve.case),
            warnings: curve.warnings(),
            notes: curve.base.notes.clone(),
            points,
            events: events.to_vec(),
        })
    };
    Ok(match content {
        Content::Curve(curve) => {
            let (drawn, of) = (&curve.base.curve, &curve.base.curve.equilibrium);
            let own = drawn.samples.iter().filter(|_| !drawn.is_of_zones());
            let points: Vec<_> = own.filter_map(|at| of.explicit(at.contact_radius)).collect();
            let (preset, case) = (&curve.setting.preset, &curve.case);
            let report = if drawn.is_of_zones() {
                TraceReport::compute(preset, &Unwatched)?
            } else {
                TraceReport::new(preset, case, drawn, &points, drawn.stop, &Unwatched)?
            };
            if as_json { json(&report)? } else { report.csv()? }
        }
        Content::Walk(curve, walk) => {
            let changed = changed_keys(walk);
            let points: Vec<WalkRow> = walk.iter().map(|node| walk_table::row(node, &changed)).collect();
            if as_json {
                walked(curve, points, &[])?
            } else {
                let columns = WALK_COLUMNS.iter().copied().chain(changed.iter().map(AsRef::as_ref));
                rows::csv(&columns.collect::<Vec<_>>(), &points)?
            }
        }
        Content::Events(curve, events) => {
            if as_json {
                walked(curve, Vec::new(), events)?
            } else {
                events_table(events)?.csv()?
            }
        }
        Content::Pull(report, _) => {
            if as_json {
                json(&**report)?
            } else {
                report.moments()?.csv()?
            }
        }
        Content::Study(study, _) => study_table::csv(study)?,
        Content::Script(_, lines) => lines.join("\n"),
        Content::Page(Page::Screen(text) | Page::Figure(text)) => text.clone(),
    })
}
