//! The format of a result: the one requested, or the one named by the file's extension.

use super::Failure;
use super::output::{OUTPUT, shown};
use crate::print::PictureFormat;
use crate::store::stream;
use clap::{Args, ValueEnum};
use std::path::Path;

/// How a result is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For reading
    Table,
    /// One row for each point, event or number
    Csv,
    /// Everything
    Json,
}

impl Format {
    fn name(self) -> &'static str {
        match self {
            Self::Table => "table",
            Self::Csv => "csv",
            Self::Json => "json",
        }
    }
}

/// The extension of any text file, which says nothing about the format.
const TEXT: &str = "txt";

/// The format of a command's result.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct FormatArgument {
    /// How the result is written [default: by the file's extension, else csv for points and lines, table otherwise]
    #[arg(long, value_enum)]
    pub format: Option<Format>,
}

impl FormatArgument {
    /// The format to write to `file`; the `usual` one where nothing else decides.
    /// Errors: The extension is not that of a result, or contradicts the requested format.
    pub fn of(self, file: &Path, usual: Format) -> Result<Format, Failure> {
        self.among(file, usual, " (`pulloff plot` draws figures)")
    }

    fn among(self, file: &Path, usual: Format, figures: &str) -> Result<Format, Failure> {
        let ending = ending(file);
        let named = match ending.as_deref() {
            Some("csv") => Some(Format::Csv),
            Some("json") => Some(Format::Json),
            None | Some("" | TEXT) => None,
            Some(_) if stream::is_stream(file) => None,
            Some(_) => {
                return Err(Failure::Usage(format!(
                    "{OUTPUT} {}: a result is written as table, csv or json, and its file ends in .csv, .json or .txt, or has \
                     no extension{figures}",
                    shown(file)
                )));
            }
        };
        match (self.format, named) {
            (Some(asked), Some(named)) if asked != named => Err(self.contradicts(file)),
            (asked, named) => Ok(asked.or(named).unwrap_or(usual)),
        }
    }

    /// As [`of`](Self::of), for a command that also draws figures.
    pub fn beside_figures(self, file: &Path, usual: Format) -> Result<Format, Failure> {
        self.among(file, usual, "; a figure's in .svg, .png or .pdf")
    }

    /// The format of the figure that the extension of `file` names; `None` where it names none.
    /// Errors: As [`of`](Self::of), or this build cannot write the format.
    pub fn of_figure(self, file: &Path) -> Result<Option<PictureFormat>, Failure> {
        let is_figure = ending(file).is_some_and(|ending| ["svg", "png", "pdf"].contains(&&*ending));
        match self.format {
            Some(_) if is_figure => Err(self.contradicts(file)),
            _ if is_figure => Ok(Some(PictureFormat::of(file)?)),
            _ => Ok(None),
        }
    }

    fn contradicts(self, file: &Path) -> Failure {
        let ending = ending(file).unwrap_or_default();
        let asked = self.format.map_or("", Format::name);
        Failure::Usage(format!(
            "{OUTPUT} {}: its extension says {ending}, --format says {asked}",
            shown(file)
        ))
    }
}

/// Refuses a file of another format for the output of `option`, which is always `format`.
pub fn only(option: &str, file: &Path, format: Format) -> Result<(), Failure> {
    let name = format.name();
    match ending(file).as_deref() {
        None | Some("" | TEXT) => Ok(()),
        Some(ending) if ending == name || stream::is_stream(file) => Ok(()),
        Some(_) => Err(Failure::Usage(format!(
            "{option} {}: is written as {}, and its file ends in .{name} or .txt, or has no extension",
            shown(file),
            name.to_uppercase()
        ))),
    }
}

/// The extension of a file in lower case.
pub fn ending(file: &Path) -> Option<String> {
    file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase())
}
