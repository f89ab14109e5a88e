//! The table of many fits: one row per file. It is complete after each fit, so that a rerun continues where it ended.

use crate::cli::Failure;
use crate::cli::output::{OutputSink, Replacing, shown};
use crate::store::hash::sha256;
use pulloff_engine::text::show_path;
use std::path::Path;

/// The table of many files, complete after each fit.
pub(super) struct FitTable {
    sink: OutputSink,
    settings: String,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// The first two columns. The last one identifies what a row was computed from.
const FILE: &str = "file";
const STATE: &str = "verdict";
const FINGERPRINT: &str = "fingerprint";

/// Whether a line is the header of such a table.
pub(super) fn is_header(line: &str) -> bool {
    let names: Vec<&str> = line.trim_end().split(',').collect();
    names.starts_with(&[FILE, STATE]) && names.ends_with(&[FINGERPRINT])
}

impl FitTable {
    /// The table in `path`, or a new one; with `--overwrite` always a new one.
    pub(super) fn open(
        path: &Path,
        sink: OutputSink,
        replacing: Replacing,
        settings: &str,
    ) -> Result<Self, Failure> {
        let mut table = Self {
            sink,
            settings: settings.to_owned(),
            header: [FILE, STATE, FINGERPRINT].map(str::to_owned).to_vec(),
            rows: Vec::new(),
        };
        if replacing.overwrite || !path.is_file() {
            return Ok(table);
        }
        let (text, _) = crate::store::file::read_text(path, pulloff_engine::cells::LARGEST)?;
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
        let wrong = |what: &str| Failure::Usage(format!("--table {}: {what}", shown(path)));
        let other = "already exists and holds something other than fits; --overwrite replaces it";
        for record in reader.records() {
            let record = record.map_err(|_| wrong(other))?;
            table.rows.push(record.iter().map(str::to_owned).collect());
        }
        if table.rows.is_empty() {
            return Ok(table);
        }
        table.header = table.rows.remove(0);
        if !is_header(&table.header.join(",")) {
            return Err(wrong(other));
        }
        Ok(table)
    }

    /// The names of its columns.
    pub(super) fn header(&self) -> &[String] {
        &self.header
    }

    /// Its rows.
    pub(super) fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// Identifies what a row of `path` is computed from.
    pub(super) fn fingerprint(&self, path: &Path) -> String {
        let bytes = std::fs::read(path).unwrap_or_default();
        let mut whole = sha256(&bytes);
        whole.push_str(&self.settings);
        sha256(whole.as_bytes())[..16].to_owned()
    }

    /// The verdict of an earlier fit of the file, if it was fitted in the same way.
    pub(super) fn state(&self, path: &Path) -> Option<&str> {
        let (shown, fingerprint) = (show_path(path), self.fingerprint(path));
        let mut rows = self.rows.iter();
        let row = rows.find(|row| row.first() == Some(&shown) && row.last() == Some(&fingerprint))?;
        row.get(1).map(String::as_str)
    }

    /// Adds a row and replaces an older one of the same file; a rerun tries a row without a fingerprint again.
    pub(super) fn add(
        &mut self,
        path: &Path,
        fingerprint: Option<&str>,
        [header, row]: &[Vec<String>; 2],
    ) -> Result<(), Failure> {
        let shown = show_path(path);
        self.rows.retain(|row| row.first() != Some(&shown));
        self.widen(header);
        let cell = |name: &String| match header.iter().position(|known| known == name) {
            Some(at) => row.get(at).cloned().unwrap_or_default(),
            None if name == FINGERPRINT => fingerprint.unwrap_or_default().to_owned(),
            None => String::new(),
        };
        self.rows.push(self.header.iter().map(cell).collect());
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.header)?;
        for row in &self.rows {
            writer.write_record(row)?;
        }
        let bytes = writer.into_inner().map_err(|error| Failure::Usage(error.to_string()))?;
        self.sink.write(bytes)
    }

    /// Makes room for the columns of `wanted`; rows that were computed differently keep their cells under their own column names.
    fn widen(&mut self, wanted: &[String]) {
        if wanted.iter().all(|name| self.header.contains(name)) {
            return;
        }
        let others = self.header.iter().filter(|name| !wanted.contains(name) && *name != FINGERPRINT);
        let mut header: Vec<String> = wanted.iter().chain(others).cloned().collect();
        header.push(FINGERPRINT.to_owned());
        let places: Vec<Option<usize>> =
            header.iter().map(|name| self.header.iter().position(|known| known == name)).collect();
        for row in &mut self.rows {
            *row = places.iter().map(|at| at.map_or_else(String::new, |at| row[at].clone())).collect();
        }
        self.header = header;
    }
}

/// The rows of fits under one common header; a cell that a fit lacks is empty.
pub(super) fn csv_rows(fits: &[[Vec<String>; 2]]) -> (Vec<String>, Vec<Vec<String>>) {
    let mut columns: Vec<String> = Vec::new();
    for [header, _] in fits {
        columns.extend(header.iter().filter(|name| !columns.contains(name)).cloned().collect::<Vec<_>>());
    }
    let row = |[header, row]: &[Vec<String>; 2]| {
        let cell = |name: &String| {
            let place = header.iter().position(|own| own == name);
            place.and_then(|place| row.get(place)).cloned().unwrap_or_default()
        };
        columns.iter().map(cell).collect()
    };
    let rows = fits.iter().map(row).collect();
    (columns, rows)
}

/// The same as CSV text.
pub(super) fn csv(fits: &[[Vec<String>; 2]]) -> Result<String, Failure> {
    let (columns, rows) = csv_rows(fits);
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&columns)?;
    for row in rows {
        writer.write_record(row)?;
    }
    let bytes = writer.into_inner().map_err(|error| Failure::Usage(error.to_string()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::output::{Inputs, Outputs};

    fn fitted(file: &str, keys: &[&str]) -> [Vec<String>; 2] {
        let header = [FILE, STATE].into_iter().chain(keys.iter().copied()).map(str::to_owned).collect();
        let values = keys.iter().map(|key| format!("{key} of {file}"));
        [header, [file.to_owned(), "ok".to_owned()].into_iter().chain(values).collect()]
    }

    fn sink(path: &Path) -> OutputSink {
        Outputs::beside(Inputs::default(), Replacing::default()).kept("--table", path).unwrap()
    }

    /// Rows with different keys keep their own columns.
    #[test]
    fn a_value_stays_under_its_key() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        for (file, keys) in [("a", &["E", "gamma"][..]), ("b", &["E", "R"]), ("c", &["gamma"]), ("d", &[])] {
            let mut table = FitTable::open(&path, sink(&path), Replacing::default(), "s").unwrap();
            let fingerprint = table.fingerprint(Path::new(file));
            table.add(Path::new(file), Some(&fingerprint), &fitted(file, keys)).unwrap();
            assert_eq!(table.state(Path::new(file)), Some("ok"));
        }
        let mut reader = csv::Reader::from_path(&path).unwrap();
        let header = reader.headers().unwrap().clone();
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 4);
        for (row, keys) in rows.iter().zip([&["E", "gamma"][..], &["E", "R"], &["gamma"], &[]]) {
            for (name, cell) in header.iter().zip(row).filter(|(name, _)| ["E", "gamma", "R"].contains(name))
            {
                let expected =
                    if keys.contains(&name) { format!("{name} of {}", &row[0]) } else { String::new() };
                assert_eq!(cell, expected, "{name} of {row:?}");
            }
        }
    }
}
