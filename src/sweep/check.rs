//! Checks results without computing anything: whether they belong to the sweep beside them, and how far they are.

use super::ensemble::members;
use super::output::{FaultCounts, OutputError};
use super::rows::{RowFault, RowReader};
use super::shard::Shard;
use super::sidecar::{self, Sidecar, SidecarError};
use crate::store::hash::sha256;
use pulloff_engine::text::show_path;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// The state of results.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checked {
    /// The hash of everything that determines the numbers.
    pub identity: String,
    pub shard: Shard,
    /// The number of complete rows that exist, and of all rows of the shard.
    pub rows: u64,
    pub of: u64,
    /// The names of the columns.
    pub columns: Vec<String>,
    pub faults: FaultCounts,
    /// Whether the last line is torn; a run continues before it.
    pub is_torn: bool,
}

impl Checked {
    /// Whether every row of a whole sweep exists and none of them has a quantity.
    pub fn is_failure(&self) -> bool {
        self.shard == Shard::WHOLE && self.rows == self.of && self.faults.failures == self.of
    }
}

/// Checks the results at `path`: the hash beside them, the header, and the number, axes and cells of each row; those of
/// an ensemble, then its members.
/// Errors: The first line that is not the expected one, and [`OutputError::Sidecar`].
pub fn check(path: &Path) -> Result<Checked, OutputError> {
    let shown = || show_path(path);
    let (sidecar, text) = Sidecar::read(path)?;
    let layout = sidecar.layout(path, &text)?;
    if hash(&text).as_ref() != Some(&sidecar.identity) {
        let what = "the sweep in it does not have the hash given there: it was changed by hand".to_owned();
        let path = show_path(&sidecar::path(path));
        return Err(SidecarError::Unknown { path, what }.into());
    }
    let shard = sidecar.shard();
    let of = shard.len(sidecar.rows);
    let failed = |cause| OutputError::Io { path: shown(), doing: "read", cause };
    let file = File::open(path).map_err(failed)?;
    let mut reader = RowReader::new(BufReader::new(file), &layout, shard, sidecar.rows);
    let mut faults = FaultCounts::default();
    loop {
        match reader.next() {
            Ok(Some(outcome)) => faults.count(outcome),
            Ok(None) => break,
            Err(RowFault::Io(cause)) => return Err(failed(cause)),
            Err(RowFault::Wrong(what)) => {
                return Err(OutputError::Changed { path: shown(), line: reader.lines, what });
            }
        }
    }
    if sidecar.is_statistics() {
        // They are as good, and as complete, as the rows of the members that they are of.
        let members = check(&members(path))?;
        if members.rows < members.of {
            return Ok(members);
        }
    }
    let (rows, is_torn) = (reader.rows(), reader.is_torn());
    let columns = layout.columns.clone();
    Ok(Checked { identity: sidecar.identity, shard, rows, of, columns, faults, is_torn })
}

/// The hash of the canonical form in the file beside the results.
fn hash(text: &str) -> Option<String> {
    Some(sha256(sidecar::canonical_in(text)?.as_bytes()))
}
