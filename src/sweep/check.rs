//! Checks results without computing anything: whether they belong to the sweep beside them, and how far they are.

use super::output::{FaultCounts, OutputError};
use super::record::{Layout, RowOutcome, Wrong};
use super::shard::Shard;
use super::sidecar::{self, Sidecar, SidecarError};
use crate::store::hash::sha256;
use pulloff_engine::text::show_path;
use std::fs::File;
use std::io::{BufRead, BufReader};
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

/// Checks the results at `path`: the hash beside them, the header, and the number, axes and cells of each row.
/// Errors: The first line that is not the expected one, and [`OutputError::NotOurs`].
pub fn check(path: &Path) -> Result<Checked, OutputError> {
    let shown = || show_path(path);
    let not_ours = |cause| OutputError::NotOurs { path: shown(), cause };
    let (sidecar, text) = Sidecar::read(path).map_err(not_ours)?;
    let layout = sidecar.layout(path, &text).map_err(not_ours)?;
    if hash(&text).as_ref() != Some(&sidecar.identity) {
        let what = "the sweep in it does not have the hash given there: it was changed by hand".to_owned();
        let path = show_path(&sidecar::path(path));
        return Err(not_ours(SidecarError::Unknown { path, what }));
    }
    let shard = sidecar.shard();
    let of = shard.len(sidecar.rows);
    let failed = |cause| OutputError::Io { path: shown(), doing: "read", cause };
    let mut reader = BufReader::new(File::open(path).map_err(failed)?);
    let mut checked = Checked {
        identity: sidecar.identity.clone(),
        shard,
        rows: 0,
        of,
        columns: layout.columns.clone(),
        faults: FaultCounts::default(),
        is_torn: false,
    };
    let (mut line, mut number) = (Vec::new(), 0);
    loop {
        line.clear();
        if reader.read_until(b'\n', &mut line).map_err(failed)? == 0 {
            return Ok(checked);
        }
        if line.last() != Some(&b'\n') {
            checked.is_torn = true;
            return Ok(checked);
        }
        number += 1;
        let changed = |what| OutputError::Changed { path: shown(), line: number, what };
        if number == 1 {
            layout.check_header(&line).map_err(changed)?;
            continue;
        }
        let found = outcome(&layout, shard, checked.rows, of, &line);
        checked.faults.count(found.map_err(changed)?);
        checked.rows += 1;
    }
}

/// The outcome of a row.
fn outcome(layout: &Layout, shard: Shard, index: u64, of: u64, line: &[u8]) -> Result<RowOutcome, Wrong> {
    if index < of { layout.outcome(shard.row(index), line) } else { Err(Wrong::behind_the_last()) }
}

/// The hash of the canonical form in the file beside the results.
fn hash(text: &str) -> Option<String> {
    Some(sha256(sidecar::canonical_in(text)?.as_bytes()))
}
