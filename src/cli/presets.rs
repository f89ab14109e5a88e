//! `pulloff presets`: list, show, delete, their keys, and where they are kept.

use super::console::ask;
use super::problem::store;
use super::{Failure, output};
use crate::store::Source;
use clap::Subcommand;
use pulloff_engine::preset::{Parameter, manual};
use pulloff_engine::text::{quote, sanitize, show_path};
use std::ffi::OsString;
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::ExitCode;

/// The subcommands of `pulloff presets`.
#[derive(Debug, Subcommand)]
pub enum PresetsCommand {
    /// List the shipped presets and your own
    List,
    /// Write a preset's file to standard output
    Show {
        /// Its name, or a preset file; - is standard input
        name: OsString,
    },
    /// Delete a preset of your own, after asking
    Delete {
        /// Its name
        name: String,
        /// Delete it without asking
        #[arg(long, short)]
        yes: bool,
    },
    /// List all keys that a preset can have, with their meanings, values and defaults
    Keys {
        /// The first letters of the keys, as in gap. or edge.
        #[arg(default_value = "")]
        beginning: String,
    },
    /// Say where your own presets are kept
    Path,
}

/// The longest title in a list.
const TITLE: usize = 100;

pub fn run(command: &PresetsCommand) -> Result<ExitCode, Failure> {
    let store = store();
    match command {
        PresetsCommand::List => {
            let listing = store.list();
            let width = listing.presets.iter().map(|entry| entry.name.chars().count()).max().unwrap_or(0);
            let mut text = String::new();
            for entry in &listing.presets {
                let whose = if matches!(entry.source, Source::Shipped(_)) { "shipped" } else { "yours  " };
                let title = match &entry.title {
                    Ok(title) => sanitize(title, TITLE),
                    Err(error) => format!("cannot be read: {error}"),
                };
                // Writing to a String cannot fail.
                let _ = writeln!(text, "{:<width$}  {whose}  {title}", entry.name);
            }
            if let Some(notice) = &listing.notice {
                let _ = writeln!(std::io::stderr(), "pulloff: {notice}");
            }
            output::print(text)?;
        }
        PresetsCommand::Show { name } => {
            let source = super::problem::source(&store, name)?;
            // Loaded first, because a file that is not a preset is an error and must not be printed.
            let loaded = store.load(&source, &[] as &[&str])?;
            output::print(loaded.text)?;
        }
        PresetsCommand::Delete { name, yes } => {
            let path = store.own(name)?;
            if !yes {
                ask(&format!("Delete {} for good?", show_path(&path)))?;
            }
            store.delete(name)?;
            let _ = writeln!(std::io::stderr(), "pulloff: deleted {}", show_path(&path));
        }
        PresetsCommand::Keys { beginning } => {
            let keys = manual::keys().filter(|row| row.key.starts_with(&**beginning));
            let text: String = keys.map(|row| described(&row)).collect();
            if text.is_empty() {
                let what = format!("no key begins with {}; pulloff presets keys lists all", quote(beginning));
                return Err(Failure::Usage(what));
            }
            output::print(text)?;
        }
        PresetsCommand::Path => match store.folder() {
            Some(folder) => output::print(format!("{}\n", show_path(folder)))?,
            None => return Err(Failure::Usage("no home folder is known: set XDG_CONFIG_HOME".to_owned())),
        },
    }
    Ok(ExitCode::SUCCESS)
}

/// A key in two lines.
fn described(row: &Parameter) -> String {
    format!(
        "{}  ({})\n    {}: {}; default: {}\n",
        row.key,
        row.label,
        manual::meaning(row),
        row.allowed(),
        row.fallback_text()
    )
}
