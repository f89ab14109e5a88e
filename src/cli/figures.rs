//! `pulloff figures`: every figure of the paper, computed again.

use super::{Failure, output};
use crate::plot::{Width, paper, svg, table};
#[cfg(feature = "png")]
use crate::print::Format;
use crate::store::{Overwrite, stream, write_atomically};
use clap::Args;
use std::fmt::Write as _;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The arguments of `pulloff figures`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The folder they are written to: for each figure its numbers as CSV and its picture as SVG, and captions.md
    #[arg(short, value_name = "DIR", default_value = "figures")]
    output: PathBuf,
    /// Write the pictures as PNG too
    #[cfg(feature = "png")]
    #[arg(long)]
    png: bool,
    /// Write the pictures as PDF too
    #[cfg(feature = "pdf")]
    #[arg(long)]
    pdf: bool,
}

/// The captions, in this file.
const CAPTIONS: &str = "captions.md";

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let folder = &arguments.output;
    if stream::is_stream(folder) {
        let text = format!("-o {}: the figures are many files; name a folder", output::shown(folder));
        return Err(Failure::Usage(text));
    }
    std::fs::create_dir_all(folder)
        .map_err(|cause| Failure::System { what: format!("-o {}", output::shown(folder)), cause })?;
    let sheets = paper::sheets(|name| {
        let _ = writeln!(std::io::stderr(), "pulloff: {name}");
    })?;
    let mut captions = String::from("# The figures of the paper, computed again\n");
    for sheet in &sheets {
        let file = |ending: &str| folder.join(sheet.name).with_extension(ending);
        save(&file("csv"), table::csv(&sheet.figure)?.as_bytes())?;
        let picture = svg::svg(&sheet.figure, Width::ONE_COLUMN);
        save(&file("svg"), picture.as_bytes())?;
        #[cfg(feature = "png")]
        if arguments.png {
            save(&file("png"), &Format::Png.bytes(&picture)?)?;
        }
        #[cfg(feature = "pdf")]
        if arguments.pdf {
            save(&file("pdf"), &Format::Pdf.bytes(&picture)?)?;
        }
        // Writing to a String cannot fail.
        let _ = write!(captions, "\n![{0}]({0}.svg)\n\n**{0}.** {1}\n", sheet.name, sheet.caption);
    }
    save(&folder.join(CAPTIONS), captions.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

fn save(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    write_atomically(path, bytes, Overwrite::Always)?;
    Ok(())
}
