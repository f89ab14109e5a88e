//! `pulloff figures`: computes every figure of the paper again, and the effect of the range of adhesion.

use super::Failure;
use super::console::Messages;
use super::output::{Inputs, OUTPUT, OutputSink, Outputs, Replacing, shown};
use crate::plot::paper::PaperSheet;
use crate::plot::{Width, adhesion, paper, svg, table};
#[cfg(feature = "png")]
use crate::print::PictureFormat;
use crate::store::stream;
use clap::Args;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

/// The arguments of `pulloff figures`.
#[derive(Debug, Args)]
pub struct FiguresArguments {
    /// The folder to write to: for each figure its numbers as CSV and its picture as SVG, and captions.md
    #[arg(short, long, value_name = "DIR", default_value = "figures")]
    output: PathBuf,
    #[command(flatten)]
    replacing: Replacing,
    /// Write the pictures as PNG too
    #[cfg(feature = "png")]
    #[arg(long)]
    png: bool,
    /// Write the pictures as PDF too
    #[cfg(feature = "pdf")]
    #[arg(long)]
    pdf: bool,
    #[command(flatten)]
    messages: Messages,
}

/// The file for the captions.
const CAPTIONS: &str = "captions.md";

/// Where the files of a figure go.
struct FigureFiles {
    numbers: OutputSink,
    picture: OutputSink,
    #[cfg(feature = "png")]
    png: Option<OutputSink>,
    #[cfg(feature = "pdf")]
    pdf: Option<OutputSink>,
}

pub fn run(arguments: &FiguresArguments) -> Result<ExitCode, Failure> {
    let console = arguments.messages.open();
    let folder = &arguments.output;
    if stream::is_stream(folder) {
        let text = format!("{OUTPUT} {}: the figures are many files; name a folder", shown(folder));
        return Err(Failure::Usage(text));
    }
    std::fs::create_dir_all(folder)
        .map_err(|cause| Failure::System { what: format!("{OUTPUT} {}", shown(folder)), cause })?;
    let mut outputs = Outputs::beside(Inputs::default(), arguments.replacing);
    let mut files = BTreeMap::new();
    for name in paper::NAMES.into_iter().chain(adhesion::NAMES) {
        files.insert(name, arguments.files(&mut outputs, name)?);
    }
    let last = outputs.file(OUTPUT, &folder.join(CAPTIONS))?;
    let mut captions = String::from("# The figures of the paper, computed again\n");
    let mut write = |sheets: &[PaperSheet]| -> Result<(), Failure> {
        for sheet in sheets {
            let missing = || Failure::Incomplete(format!("{}: its files were not checked", sheet.name));
            let files = files.get(sheet.name).ok_or_else(missing)?;
            files.numbers.write(table::csv(&sheet.figure)?)?;
            let picture = svg::svg(&sheet.figure, Width::ONE_COLUMN);
            files.picture.write(&picture)?;
            #[cfg(feature = "png")]
            if let Some(png) = &files.png {
                png.write(PictureFormat::Png.bytes(&picture)?)?;
            }
            #[cfg(feature = "pdf")]
            if let Some(pdf) = &files.pdf {
                pdf.write(PictureFormat::Pdf.bytes(&picture)?)?;
            }
            // Writing to a String cannot fail.
            let _ = write!(captions, "\n![{0}]({0}.svg)\n\n**{0}.** {1}\n", sheet.name, sheet.caption);
        }
        Ok(())
    };
    // The figures of the paper come first, since the others take longer.
    write(&paper::sheets(|name| console.say(name))?)?;
    console.say("Adhesion with a range");
    write(&adhesion::sheets()?)?;
    last.write(captions)?;
    console.end()
}

impl FiguresArguments {
    fn files(&self, outputs: &mut Outputs, name: &str) -> Result<FigureFiles, Failure> {
        let mut file = |ending: &str| outputs.file(OUTPUT, &self.output.join(name).with_extension(ending));
        Ok(FigureFiles {
            numbers: file("csv")?,
            picture: file("svg")?,
            #[cfg(feature = "png")]
            png: self.png.then(|| file("png")).transpose()?,
            #[cfg(feature = "pdf")]
            pdf: self.pdf.then(|| file("pdf")).transpose()?,
        })
    }
}
