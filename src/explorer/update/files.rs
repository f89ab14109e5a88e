//! Opening, saving and exporting: the requests, and what becomes of the answers.

use super::travel::shelve;
use super::values::{assigned, rows_came};
use crate::explorer::background::Background;
use crate::explorer::command::Id;
use crate::explorer::effect::Effect;
use crate::explorer::export::{Export, Page, ends_in};
use crate::explorer::job::{Content, Done, Job};
use crate::explorer::journal::Beginning;
use crate::explorer::look;
use crate::explorer::model::{Level, Model, Question};
use crate::explorer::pins::changed;
use crate::explorer::requests::{change, file, want_curve};
use crate::explorer::studies::StudyData;
use crate::explorer::undo::SessionPlace;
use crate::print::PictureFormat;
use crate::store::{Overwrite, Source};
use pulloff_engine::gap::Shape;
use pulloff_engine::preset::Preset;
use pulloff_engine::text::sanitize;
use std::path::Path;
use std::sync::Arc;

pub(in crate::explorer) fn save_back(model: &mut Model) -> Vec<Effect> {
    let why = match model.source {
        Source::Shipped(_) => Some("shipped presets are read-only"),
        Source::Piped { .. } => Some("the preset came through a pipe and has no file"),
        Source::User { .. } | Source::File(_) => None,
    };
    if let Some(why) = why {
        let text = format!("{why}: {} saves under a name of your own", Id::SaveAs.named());
        return model.refuse(text);
    }
    let overwrite = model.fingerprint.map_or(Overwrite::Never, Overwrite::IfUnchanged);
    save(model, overwrite)
}

pub(super) fn save(model: &mut Model, overwrite: Overwrite) -> Vec<Effect> {
    let (source, preset) = (model.source.clone(), Box::new(model.preset.clone()));
    vec![file(Job::Save { source, preset, overwrite })]
}

/// The longest title made here, in characters.
const TITLE: usize = 80;

/// Saves under a name. A title that was given to other values would not be true of these: they get one that says where
/// they come from, which stays true whatever is changed next.
pub(super) fn save_as(model: &mut Model, name: String, replace: bool, with_data: bool) -> Vec<Effect> {
    let (from, mut preset) = (model.source.clone(), Box::new(model.preset.clone()));
    if changed(&preset, &model.saved).is_some() && preset.title == model.saved.title {
        let of = match &from {
            Source::File(path) => {
                path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into())
            }
            other => other.shown(),
        };
        preset.title = sanitize(&format!("changed from {of}"), TITLE);
    }
    vec![file(Job::SaveAs { name, preset, replace, with_data, from })]
}

pub(super) fn export(model: &mut Model, what: Export, path: String, replace: bool) -> Vec<Effect> {
    match content(model, what, &path) {
        Ok(content) => vec![file(Job::Export { content, path, replace })],
        Err(reason) => model.refuse(reason),
    }
}

/// What an export to `path` holds, or why there is none.
fn content(model: &Model, what: Export, path: &str) -> Result<Content, String> {
    // The error of a figure also says which formats this build lacks.
    if let Export::Page(Page::Figure(_)) = what {
        PictureFormat::of(Path::new(path)).map_err(|error| error.to_string())?;
    } else if !ends_in(path, what.endings()) {
        return Err(format!("the file must end in .{}", what.endings().join(" or .")));
    }
    let begun = || model.curve.clone().zip(model.journal.start()).ok_or("there is no curve to export yet");
    Ok(match what {
        Export::Page(page) => Content::Page(page),
        Export::Figure(_) | Export::Screen => return Err(format!("nothing here draws a {}", what.name())),
        Export::Curve => Content::Curve(begun()?.0),
        Export::Walk => {
            let path = model.history.path().into_iter();
            Content::Walk(begun()?.0, path.map(|(_, node)| node.clone()).collect())
        }
        Export::Events => Content::Events(begun()?.0, model.path_events().to_vec()),
        Export::Pull => {
            begun()?;
            let pull = model.pull().filter(|pull| pull.is_of(&model.preset));
            let report = pull.and_then(|pull| Some((pull, pull.report.as_ref().ok()?)));
            let (pull, report) =
                report.ok_or("there is no pull to export: edge.exponent and path.rate make one")?;
            Content::Pull(Box::new(report.clone()), Box::new(pull.preset.clone()))
        }
        Export::Study => {
            begun()?;
            let study =
                model.results.share::<StudyData>().filter(|study| study.done() == study.outcomes.len());
            let none = || format!("there is no study to export: {} makes one", Id::Study.named());
            let study = study.ok_or_else(none)?;
            let preset = study.wish.preset.clone();
            Content::Study(study, Box::new(Beginning { source: model.source.clone(), preset }))
        }
        Export::Script => {
            let start = begun()?.1;
            let lines = model.script().map_err(|reason| format!("not exported: {reason}"))?;
            Content::Script(Box::new(start), lines)
        }
    })
}

pub(super) fn file_done(model: &mut Model, done: Done) -> Vec<Effect> {
    match done {
        Done::Listed(listing) => model.question = Some(Question::Preset(listing)),
        Done::Named(names) => model.preset_names = names,
        Done::Deleted(path, listing) => {
            model.tell(Level::Info, format!("deleted {path}; what is on the screen stays"));
            model.question = Some(Question::Preset(listing));
        }
        Done::Browsed(key, folder) => model.question = Some(Question::File(key, folder)),
        Done::Assigned(preset, assignments) => return assigned(model, *preset, &assignments),
        Done::Foreign(foreign, reason) => {
            model.tell(Level::of(&reason), reason.text);
            model.question = Some(Question::Columns(foreign));
        }
        Done::Read(rows) => return rows_came(model, rows),
        Done::Opened(loaded) => {
            let mut opened = Model::new(*loaded);
            // A session without a walk is nothing to come back to.
            let place = (!model.history.is_empty())
                .then(|| SessionPlace { shelved: Some(Arc::new(shelve(model))), ..model.place() });
            opened.replace(model);
            if let Some(place) = place {
                opened.undo.did(place);
            }
            look::carry_on(model, &mut opened);
            *model = opened;
            return vec![want_curve(model)];
        }
        Done::Saved { source, fingerprint, preset } => {
            model.tell(Level::Info, format!("saved as {}", source.shown()));
            let copied = as_saved(&model.preset, &model.saved, &preset);
            if preset.title != model.saved.title {
                model.retitled = Some([model.saved.title.clone(), preset.title.clone()]);
            }
            // The comments of a shipped preset are not written: they describe that preset.
            if matches!(model.source, Source::Shipped(_)) {
                model.comment.clear();
            }
            (model.source, model.fingerprint, model.saved) = (source, Some(fingerprint), *preset);
            return copied.map_or_else(Vec::new, |preset| change(model, preset));
        }
        Done::Conflict => {
            model.question = Some(Question::SaveAnyway);
            model.tell(Level::Error, "the file was changed by someone else since it was read: not saved");
        }
        Done::NameTaken(name, with_data) => {
            model.tell(Level::Error, format!("a preset called {name} exists: not saved"));
            model.question = Some(Question::ReplacePreset(name, with_data));
        }
        Done::Exported(path, note) => {
            let note = note.map_or_else(String::new, |note| format!("; {note}"));
            model.tell(Level::Info, format!("exported to {path}{note}"));
        }
        Done::FileExists(what, path) => {
            model.tell(Level::Error, format!("{path} exists: not exported"));
            model.question = Some(Question::ReplaceFile(what, path));
        }
        Done::Failed(reason) => model.tell(Level::of(&reason), reason.text),
    }
    Vec::new()
}

/// `preset` with the title under which it was saved, if it still has that of the file it was read from, `before`, and
/// with the rows of the profile at the place they were copied to, if `saved` names another file with the same rows.
fn as_saved(preset: &Preset, before: &Preset, saved: &Preset) -> Option<Preset> {
    let mut copied = preset.clone();
    if preset.title == before.title {
        copied.title.clone_from(&saved.title);
    }
    if let (Shape::Profile(now), Shape::Profile(then)) = (&preset.gap, &saved.gap)
        && (&now.rows().radii, &now.rows().gaps) == (&then.rows().radii, &then.rows().gaps)
        && now.smoothing() == then.smoothing()
    {
        copied.gap = saved.gap.clone();
    }
    if let (Some(now), Some(then)) = (&preset.data.source, &saved.data.source)
        && now.bytes == then.bytes
    {
        copied.data.source = Some(Arc::clone(then));
    }
    (copied != *preset).then_some(copied)
}
