//! Reads the results of a sweep: columns by name.

use super::record::{ERROR, ROW, statistic};
use super::shard::Shard;
use super::sidecar::{ColumnInfo, Sidecar, SidecarError};
use crate::mend::mend;
use pulloff_engine::text::{closest, quote, sanitize, show_path};
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why results cannot be read. Texts are safe to show.
#[derive(Debug, Error)]
pub enum ResultsError {
    #[error(transparent)]
    Sidecar(#[from] SidecarError),
    #[error("{path}: has no column \"{name}\"{hint}")]
    NoColumn { path: String, name: String, hint: String },
    #[error("{path}: {what}")]
    Table { path: String, what: String },
}

mend!(ResultsError, as 0 of Sidecar, always NoColumn | Table);

/// The results of a sweep, or of a part of it; they may still be growing.
#[derive(Debug, Clone)]
pub struct SweepResults {
    path: PathBuf,
    /// What is known of the columns, in their order: the row, the axes, the quantities, the error.
    pub columns: Vec<ColumnInfo>,
    /// The columns of the axes, in the order of the spec.
    pub axes: Vec<String>,
    /// Whether the values of the axes are drawn at random.
    pub is_random: bool,
    /// Whether the rows are statistics of an ensemble.
    pub is_statistics: bool,
    /// The text of the swept preset.
    pub preset: String,
    /// The number of rows of the whole sweep; fewer may exist.
    pub rows: u64,
    /// The part of the sweep that the results are to have.
    pub shard: Shard,
}

impl SweepResults {
    /// Opens the results; only the file beside them is read.
    pub fn open(path: &Path) -> Result<Self, ResultsError> {
        let (sidecar, _) = Sidecar::read(path)?;
        let axes = sidecar.axes();
        let (is_random, is_statistics) = (sidecar.is_random(), sidecar.is_statistics());
        let (path, shard, rows) = (path.to_owned(), sidecar.shard(), sidecar.rows);
        let preset = sidecar.preset().to_owned();
        Ok(Self { path, columns: sidecar.columns, axes, is_random, is_statistics, preset, rows, shard })
    }

    /// The title of an axis that shows this column.
    pub fn title(&self, name: &str) -> String {
        let column = self.columns.iter().find(|column| column.name == name);
        column.map_or_else(|| name.to_owned(), ColumnInfo::title)
    }

    /// The same for a quantity of which this column is a statistic.
    pub fn title_of(&self, quantity: &str, name: &str) -> String {
        let column = self.columns.iter().find(|column| column.name == name);
        let named = |column: &ColumnInfo| ColumnInfo { name: quantity.to_owned(), ..column.clone() }.title();
        column.map_or_else(|| quantity.to_owned(), named)
    }

    /// The quantities that can be drawn over the axes.
    pub fn quantities(&self) -> Vec<&str> {
        let names = self.columns.iter().map(|column| column.name.as_str());
        if self.is_statistics {
            let median = statistic("", "q50");
            return names.filter_map(|name| name.strip_suffix(&*median)).collect();
        }
        let is_other = |name: &&str| [ROW, ERROR].contains(name) || self.axes.iter().any(|axis| axis == name);
        names.filter(|name| !is_other(name)).collect()
    }

    /// How much of the sweep the results have, in words; `None` where they have all of it.
    /// Errors: As [`texts`](Self::texts).
    pub fn partial(&self) -> Result<Option<String>, ResultsError> {
        let found = self.cells(ROW, |_| Some(()))?.len();
        let part =
            if self.shard == Shard::WHOLE { String::new() } else { format!(" (shard {})", self.shard) };
        let (path, rows) = (show_path(&self.path), self.rows);
        Ok(((found as u64) < rows)
            .then(|| format!("{path}: has {found} of the {rows} rows of the sweep{part}")))
    }

    /// How many rows have no value of a quantity, in words; `None` where all have one.
    /// Errors: As [`texts`](Self::texts).
    pub fn without(&self, quantity: &str) -> Result<Option<String>, ResultsError> {
        let median = statistic(quantity, "q50");
        let column = if self.has_statistics_of(quantity) { &median } else { quantity };
        let cells = self.cells(column, |cell| Some(cell.is_empty()))?;
        let empty = cells.iter().filter(|is_empty| **is_empty).count();
        Ok((empty > 0).then(|| {
            format!(
                "{}: {empty} of {} rows have no {quantity} and are left out",
                show_path(&self.path),
                cells.len()
            )
        }))
    }

    /// Whether there are statistics of this quantity and no column of its own.
    pub fn has_statistics_of(&self, quantity: &str) -> bool {
        let median = statistic(quantity, "q50");
        self.is_statistics && self.columns.iter().any(|column| column.name == median)
    }

    fn place(&self, name: &str) -> Result<usize, ResultsError> {
        let names = || self.columns.iter().map(|column| column.name.as_str());
        names().position(|known| known == name).ok_or_else(|| ResultsError::NoColumn {
            path: show_path(&self.path),
            name: quote(name),
            hint: closest(name, names()).map_or_else(String::new, |meant| format!("; did you mean {meant}?")),
        })
    }

    /// The cells of some columns, one vector each; only these are held in memory. A torn line at the end is left out.
    pub fn texts(&self, names: &[&str]) -> Result<Vec<Vec<String>>, ResultsError> {
        self.read(names, |cell| Some(cell.to_owned()))
    }

    /// The same as numbers, in the units in which they are shown; an empty cell gives `None`.
    /// Errors: As [`texts`](Self::texts), or a cell is neither empty nor a number.
    pub fn numbers(&self, names: &[&str]) -> Result<Vec<Vec<Option<f64>>>, ResultsError> {
        let number = |cell: &str| if cell.is_empty() { Some(None) } else { cell.parse().ok().map(Some) };
        let mut columns = self.read(names, number)?;
        for (column, name) in columns.iter_mut().zip(names) {
            let Some(info) = self.columns.iter().find(|info| info.name == *name) else { continue };
            column.iter_mut().flatten().for_each(|number| *number = info.shown(*number));
        }
        Ok(columns)
    }

    /// The cells of one column, as parsed by `value`.
    /// Errors: As [`texts`](Self::texts), or `value` rejects one.
    pub fn cells<T>(&self, name: &str, value: impl Fn(&str) -> Option<T>) -> Result<Vec<T>, ResultsError> {
        Ok(self.read(&[name], value)?.pop().unwrap_or_default())
    }

    fn read<T>(
        &self,
        names: &[&str],
        value: impl Fn(&str) -> Option<T>,
    ) -> Result<Vec<Vec<T>>, ResultsError> {
        let places: Vec<usize> = names.iter().map(|name| self.place(name)).collect::<Result<_, _>>()?;
        let wrong =
            |what: &str| ResultsError::Table { path: show_path(&self.path), what: sanitize(what, 200) };
        let file = File::open(&self.path).map_err(|error| wrong(&error.to_string()))?;
        let whole = whole_lines(&file).map_err(|error| wrong(&error.to_string()))?;
        let mut reader = csv::Reader::from_reader(BufReader::new(file.take(whole)));
        let header = reader.headers().map_err(|error| wrong(&error.to_string()))?;
        if !header.iter().eq(self.columns.iter().map(|column| column.name.as_str())) {
            return Err(wrong("its columns are not those in the file beside it"));
        }
        let mut columns: Vec<Vec<T>> = places.iter().map(|_| Vec::new()).collect();
        let mut record = csv::StringRecord::new();
        while reader.read_record(&mut record).map_err(|error| wrong(&error.to_string()))? {
            for ((column, &place), name) in columns.iter_mut().zip(&places).zip(names) {
                let cell = record.get(place).unwrap_or_default();
                let line = record.position().map_or(0, csv::Position::line);
                let refused = || wrong(&format!("line {line}: {name} = \"{}\" is not a number", quote(cell)));
                column.push(value(cell).ok_or_else(refused)?);
            }
        }
        Ok(columns)
    }
}

/// The number of bytes up to the last line end; a row that is just being written does not count.
fn whole_lines(mut file: &File) -> io::Result<u64> {
    /// Far more than one line.
    const STEP: u64 = 1 << 16;
    let mut end = file.metadata()?.len();
    while end > 0 {
        let from = end.saturating_sub(STEP);
        file.seek(SeekFrom::Start(from))?;
        let mut bytes = Vec::new();
        file.take(end - from).read_to_end(&mut bytes)?;
        if let Some(last) = bytes.iter().rposition(|byte| *byte == b'\n') {
            end = from + last as u64 + 1;
            break;
        }
        end = from;
    }
    file.rewind()?;
    Ok(end)
}
