//! Joins the parts of a sweep: byte for byte the results of a single run.

use super::output::{Existing, FaultCounts, OutputError};
use super::record::{Layout, Wrong};
use super::rows::{RowFault, RowReader};
use super::shard::Shard;
use super::sidecar::{self, Sidecar, SidecarError};
use crate::mend::mend;
use crate::store::atomic::{Overwrite, WriteError, explained, write_atomically, write_filled};
use crate::store::stream;
use pulloff_engine::text::show_path;
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why parts cannot be joined. Paths are safe to show.
#[derive(Debug, Error)]
pub enum MergeError {
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error("{path}: already exists; --overwrite replaces it")]
    Exists { path: String },
    /// No file beside the part says what it is.
    #[error("{path}: is not known to be a part of a sweep ({cause})")]
    NotOurs { path: String, cause: SidecarError },
    #[error("{path}: belongs to a different sweep from {first}")]
    OtherSweep { path: String, first: String },
    #[error("{path}: is shard {found}, while {first} is one of {of}")]
    OtherDivision {
        path: String,
        found: Shard,
        first: String,
        /// The number of parts that the first one belongs to.
        of: u64,
    },
    /// Two parts that are the same shard.
    #[error("{path}: is shard {shard}, as is {other}")]
    Doubled { path: String, shard: Shard, other: String },
    #[error("shards are missing: {0}")]
    Missing(String),
    /// A part that is not complete.
    #[error("{path}: has {rows} of the {of} rows of shard {shard}; run it again to go on")]
    Incomplete { path: String, rows: u64, of: u64, shard: Shard },
    /// A row that is not the expected one.
    #[error("{path}:{line}: {what}: the file was changed")]
    Changed {
        path: String,
        /// The line, from 1.
        line: u64,
        what: Wrong,
    },
    #[error("{path}: cannot read: {cause}")]
    Io { path: String, cause: io::Error },
}

mend!(
    MergeError, as 0 of Output, as cause of Io | NotOurs,
    always Exists | OtherSweep | OtherDivision | Doubled | Missing | Incomplete | Changed
);

impl From<WriteError> for MergeError {
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Exists { path } => Self::Exists { path },
            error => Self::Output(error.into()),
        }
    }
}

/// A part being read.
struct MergePart<'a> {
    path: &'a Path,
    shard: Shard,
    reader: RowReader<'a, BufReader<File>>,
}

impl<'a> MergePart<'a> {
    fn open(path: &'a Path, shard: Shard, layout: &'a Layout, rows: u64) -> Result<Self, MergeError> {
        let file = File::open(path).map_err(|cause| MergeError::Io { path: show_path(path), cause })?;
        Ok(Self { path, shard, reader: RowReader::new(BufReader::new(file), layout, shard, rows) })
    }

    /// What `read` finds next.
    fn read<T>(
        &mut self,
        read: impl FnOnce(&mut RowReader<'a, BufReader<File>>) -> Result<T, RowFault>,
    ) -> Result<T, MergeError> {
        let found = read(&mut self.reader);
        found.map_err(|fault| match fault {
            RowFault::Io(cause) => MergeError::Io { path: show_path(self.path), cause },
            RowFault::Wrong(what) => {
                MergeError::Changed { path: show_path(self.path), line: self.reader.lines, what }
            }
        })
    }
}

/// The outcome of joining parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Merged {
    pub rows: u64,
    pub faults: FaultCounts,
}

/// Joins `parts`, in any order, to `results`.
/// Errors: A part is missing, doubled, incomplete or from another sweep, or a file exists and `existing` does not
/// replace it; nothing has changed then.
pub fn merge(parts: &[PathBuf], results: &Path, existing: Existing) -> Result<Merged, MergeError> {
    let Some(first) = parts.first() else { return Err(MergeError::Missing("none is given".to_owned())) };
    let not_ours = |path: &Path| {
        let path = show_path(path);
        move |cause| MergeError::NotOurs { path, cause }
    };
    let (sidecar, text) = Sidecar::read(first).map_err(not_ours(first))?;
    let layout = sidecar.layout(first, &text).map_err(not_ours(first))?;
    let of = sidecar.shard().of;
    let whole = sidecar::of_whole(&text, sidecar.shard());
    let mut found: Vec<Option<&PathBuf>> = vec![None; usize::try_from(of).unwrap_or_default()];
    for path in parts {
        let (other, text) = Sidecar::read(path).map_err(not_ours(path))?;
        let (shard, shown) = (other.shard(), show_path(path));
        if shard.of != of && other.identity == sidecar.identity {
            return Err(MergeError::OtherDivision { path: shown, found: shard, first: show_path(first), of });
        }
        if sidecar::of_whole(&text, shard) != whole {
            return Err(MergeError::OtherSweep { path: shown, first: show_path(first) });
        }
        // From 1 to `of`, as in every shard.
        let place = &mut found[usize::try_from(shard.number - 1).unwrap_or_default()];
        if let Some(before) = place.replace(path) {
            return Err(MergeError::Doubled { path: shown, shard, other: show_path(before) });
        }
    }
    let missing: Vec<String> = (1..=of)
        .zip(&found)
        .filter(|(_, path)| path.is_none())
        .map(|(number, _)| Shard { number, of }.to_string())
        .collect();
    if !missing.is_empty() {
        return Err(MergeError::Missing(listed(&missing)));
    }
    let open = || -> Result<Vec<MergePart<'_>>, MergeError> {
        let numbered = (1..=of).zip(found.iter().flatten().copied());
        numbered
            .map(|(number, path)| MergePart::open(path, Shard { number, of }, &layout, sidecar.rows))
            .collect()
    };
    if stream::is_stream(results) {
        // What was written to a stream cannot be taken back, so all parts are checked first.
        let faults = fill(&mut io::sink(), results, &mut open()?, &layout, sidecar.rows)?;
        let failed = |cause| OutputError::Io { path: stream::shown(results), doing: "open", cause };
        fill(&mut stream::open(results).map_err(failed)?, results, &mut open()?, &layout, sidecar.rows)?;
        return Ok(Merged { rows: sidecar.rows, faults });
    }
    let mut open = open()?;
    let overwrite = if existing == Existing::Overwrite { Overwrite::Always } else { Overwrite::Never };
    let mut faults = FaultCounts::default();
    write_filled(results, overwrite, |file| -> Result<(), MergeError> {
        faults = fill(file, results, &mut open, &layout, sidecar.rows)?;
        Ok(())
    })?;
    write_atomically(&sidecar::path(results), whole.as_bytes(), Overwrite::Always)?;
    Ok(Merged { rows: sidecar.rows, faults })
}

fn listed(names: &[String]) -> String {
    /// The largest number listed.
    const TOLD: usize = 10;
    let more = names.len().saturating_sub(TOLD);
    let told = names[..names.len() - more].join(", ");
    if more == 0 { told } else { format!("{told} and {more} more") }
}

/// Writes the rows of all parts, taken in turn, and counts how many of them failed.
fn fill(
    file: &mut dyn Write,
    results: &Path,
    parts: &mut [MergePart<'_>],
    layout: &Layout,
    rows: u64,
) -> Result<FaultCounts, MergeError> {
    let failed = |cause| -> MergeError {
        OutputError::Io { path: stream::shown(results), doing: "write", cause: explained(cause) }.into()
    };
    let mut out = BufWriter::new(file);
    for part in parts.iter_mut() {
        // A torn line alone means no rows, which is reported below.
        part.read(RowReader::header)?;
    }
    out.write_all(layout.header().as_bytes()).map_err(failed)?;
    let (mut row, mut faults) = (0, FaultCounts::default());
    while row < rows {
        for part in parts.iter_mut() {
            if row == rows {
                break;
            }
            let Some(outcome) = part.read(RowReader::next)? else {
                let (path, had, shard) = (show_path(part.path), part.reader.rows(), part.shard);
                return Err(MergeError::Incomplete { path, rows: had, of: shard.len(rows), shard });
            };
            faults.count(outcome);
            out.write_all(&part.reader.line).map_err(failed)?;
            row += 1;
        }
    }
    for part in parts {
        // Rows after the last are refused.
        part.read(RowReader::next)?;
    }
    out.flush().map_err(failed)?;
    Ok(faults)
}
