//! Where a script may write, and what it may replace.

use crate::explorer::command::{Command, Id};
use crate::explorer::files::target;
use crate::explorer::model::Model;
use crate::store::Source;
use crate::store::atomic::{folder_of, follow};
use pulloff_engine::text::show_path;
use std::fs;
use std::path::Path;

/// What a script may do to files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Permission {
    pub overwrite: bool,
    pub anywhere: bool,
}

pub(super) fn allowed(model: &Model, command: Command, permission: Permission) -> Result<Command, String> {
    let Permission { overwrite, anywhere } = permission;
    let may_replace = |replace: bool| match (replace, overwrite) {
        (true, false) => Err("a script replaces files only with --overwrite".to_owned()),
        (_, overwrite) => Ok(overwrite),
    };
    let within = |path: &Path| if anywhere { Ok(()) } else { below_current_folder(path) };
    Ok(match command {
        Command::Export { what, path, replace } => {
            within(&target(&path))?;
            Command::Export { what, path, replace: may_replace(replace)? }
        }
        // A plain name goes to the folder of presets and nowhere else.
        Command::SaveAs { name, replace, with_data } => {
            Command::SaveAs { name, with_data, replace: may_replace(replace)? }
        }
        Command::Plain(Id::Save) | Command::SaveAnyway => {
            may_replace(true)?;
            if let Source::File(path) = &model.source {
                within(path)?;
            }
            command
        }
        command => command,
    })
}

/// Links and `..` are resolved to where the file would be.
fn below_current_folder(path: &Path) -> Result<(), String> {
    let refused = |cause: &dyn std::fmt::Display| format!("{}: {cause}", show_path(path));
    let target = follow(path).map_err(|error| error.to_string())?;
    let folder = fs::canonicalize(folder_of(&target)).map_err(|error| refused(&error))?;
    let here = fs::canonicalize(".").map_err(|error| refused(&error))?;
    if folder.starts_with(here) {
        Ok(())
    } else {
        Err(refused(&"is not below the current folder; --anywhere lets a script write there"))
    }
}
