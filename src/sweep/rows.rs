//! Reads the lines of results one after another, and checks each.

use super::record::{Layout, RowOutcome, Wrong};
use super::shard::Shard;
use std::io::{self, BufRead};

/// A line that could not be read, or is not the expected one.
pub(super) enum RowFault {
    Io(io::Error),
    Wrong(Wrong),
}

/// Reads the rows of a shard.
pub(super) struct RowReader<'a, R> {
    reader: R,
    layout: &'a Layout,
    shard: Shard,
    /// The number of rows of the shard.
    of: u64,
    /// The complete lines so far, with the header, and their length in bytes.
    pub lines: u64,
    pub bytes: u64,
    /// The line last read.
    pub line: Vec<u8>,
}

impl<'a, R: BufRead> RowReader<'a, R> {
    /// Reads from `reader`, in a sweep of `rows` rows in all.
    pub fn new(reader: R, layout: &'a Layout, shard: Shard, rows: u64) -> Self {
        Self { reader, layout, shard, of: shard.len(rows), lines: 0, bytes: 0, line: Vec::new() }
    }

    /// The number of complete rows so far.
    pub fn rows(&self) -> u64 {
        self.lines.saturating_sub(1)
    }

    /// Whether the line last read is torn, which does not count.
    pub fn is_torn(&self) -> bool {
        self.line.last().is_some_and(|end| *end != b'\n')
    }

    /// Whether there is another complete line.
    fn advance(&mut self) -> Result<bool, RowFault> {
        self.line.clear();
        let length = self.reader.read_until(b'\n', &mut self.line).map_err(RowFault::Io)?;
        let is_whole = self.line.last() == Some(&b'\n');
        if is_whole {
            self.lines += 1;
            self.bytes += length as u64;
        }
        Ok(is_whole)
    }

    /// Checks the first line, if there is one.
    pub fn header(&mut self) -> Result<(), RowFault> {
        if self.lines == 0 && self.advance()? {
            self.layout.check_header(&self.line).map_err(RowFault::Wrong)?;
        }
        Ok(())
    }

    /// The outcome of the next row; `None` at the end.
    pub fn next(&mut self) -> Result<Option<RowOutcome>, RowFault> {
        self.header()?;
        let index = self.rows();
        if self.lines == 0 || !self.advance()? {
            return Ok(None);
        }
        if index >= self.of {
            return Err(RowFault::Wrong(Wrong::behind_the_last()));
        }
        self.layout.outcome(self.shard.row(index), &self.line).map(Some).map_err(RowFault::Wrong)
    }
}
