//! `pulloff sessions`: list, show and delete the sessions that the explorer keeps.

use super::Failure;
use super::console::ask;
use super::format::{Format, FormatArgument};
use super::output;
use crate::explorer::archive::{Archive, ArchiveError, ago};
use crate::explorer::session::{Document, SessionSummary};
use clap::Subcommand;
use pulloff_engine::quasistatic::State;
use pulloff_engine::report::number::significant;
use pulloff_engine::text::{sanitize, show_path};
use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::UNIX_EPOCH;

/// The subcommands of `pulloff sessions`.
#[derive(Debug, Subcommand)]
pub enum SessionsCommand {
    /// List the sessions, the newest first
    List,
    /// Say what a session contains
    Show {
        /// Its name; the newest session when left out
        name: Option<String>,
        #[command(flatten)]
        format: FormatArgument,
    },
    /// Delete sessions
    Delete {
        /// Their names
        #[arg(required = true, value_name = "NAME")]
        names: Vec<String>,
        /// Delete them without asking
        #[arg(long)]
        yes: bool,
    },
    /// Say where the sessions are kept
    Path,
}

/// The longest preset name and the longest reason in a list.
const NAME: usize = 24;
const REASON: usize = 90;

pub fn run(command: &SessionsCommand) -> Result<ExitCode, Failure> {
    let archive = Archive::open();
    match command {
        SessionsCommand::List => output::print(list(&archive)?)?,
        SessionsCommand::Show { name, format } => show(&archive, name.as_deref(), format.format)?,
        SessionsCommand::Delete { names, yes } => {
            for name in names {
                // A question about what does not exist needs no answer.
                archive.bytes(name)?;
                if !yes {
                    ask(&format!("Delete the session {} for good?", sanitize(name, NAME)))?;
                }
                archive.delete(name)?;
            }
        }
        SessionsCommand::Path => match archive.folder() {
            Some(folder) => output::print(format!("{}\n", show_path(folder)))?,
            None => return Err(ArchiveError::NoFolder.into()),
        },
    }
    Ok(ExitCode::SUCCESS)
}

fn show(archive: &Archive, name: Option<&str>, format: Option<Format>) -> Result<(), Failure> {
    let name = match name {
        Some(name) => name.to_owned(),
        None => archive.to_resume()?,
    };
    output::print(match format {
        Some(Format::Json) => {
            let bytes = archive.bytes(&name)?;
            // Read first, because a file that is not a session is an error and must not be printed.
            archive.summary(&name)?;
            bytes
        }
        Some(Format::Csv) => {
            let text = "--format csv: a session is shown as table or json";
            return Err(Failure::Usage(text.to_owned()));
        }
        Some(Format::Table) | None => shown(archive, &name)?.into_bytes(),
    })
}

fn list(archive: &Archive) -> Result<String, Failure> {
    let entries = archive.list()?;
    let width = entries.iter().map(|entry| entry.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for entry in entries {
        let written = entry.written.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        let when = ago(written);
        let what = match archive.summary(&entry.name) {
            Ok(summary) => line(&summary),
            Err(error) => format!("cannot be read: {}", sanitize(&error.to_string(), REASON)),
        };
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{:<width$}  {when:<22}  {what}", entry.name);
    }
    Ok(text)
}

fn line(summary: &SessionSummary) -> String {
    let unsaved = if summary.unsaved { ", preset not saved" } else { "" };
    let steps = if summary.steps == 1 { "1 step" } else { "steps" };
    let steps = if summary.steps == 1 { steps.to_owned() } else { format!("{} {steps}", summary.steps) };
    let name = sanitize(&summary.preset_name, NAME);
    format!("{:<7}  {name}, {steps}{unsaved}", summary.ended.name())
}

fn shown(archive: &Archive, name: &str) -> Result<String, Failure> {
    let summary = archive.summary(name)?;
    let document = Document::read(&archive.bytes(name)?);
    let document = document.map_err(|error| Failure::Usage(format!("{name}: {error}")))?;
    let mut text = String::new();
    let mut row = |label: &str, value: &str| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{label:<12}{value}");
    };
    row("session", name);
    row("preset", &sanitize(&summary.preset_name, REASON));
    row("title", &sanitize(&summary.title, REASON));
    row("written", &ago(summary.saved_at));
    row("ended", summary.ended.name());
    row("steps", &summary.steps.to_string());
    row("unsaved", if summary.unsaved { "the preset has changes that are in no file" } else { "nothing" });
    if let Some(State { approach, force, contact_radius, .. }) = document.walker {
        let [delta, force, s] = [approach, force, contact_radius].map(|x| significant(x, 10));
        row("walker", &format!("delta {delta}, P {force}, s {s}"));
    }
    row("pins", &document.pins().to_string());
    Ok(text)
}
