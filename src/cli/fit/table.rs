//! The table of many fits: one row for each file, whole after each, so that a rerun goes on where it ended.

use crate::cli::{Failure, output};
use crate::store::hash::sha256;
use pulloff_engine::text::show_path;
use std::path::{Path, PathBuf};

/// The table of many files: whole after each.
pub(super) struct Table {
    path: PathBuf,
    settings: String,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// The last column: what a row was computed from.
const FINGERPRINT: &str = "fingerprint";

impl Table {
    /// The table in `path`, or a new one.
    pub(super) fn open(path: &Path, settings: &str) -> Result<Self, Failure> {
        output::csv_only(path)?;
        let mut table = Self {
            path: path.to_owned(),
            settings: settings.to_owned(),
            header: Vec::new(),
            rows: Vec::new(),
        };
        if !path.exists() {
            return Ok(table);
        }
        let (text, _) = crate::store::file::read_text(path, pulloff_engine::cells::LARGEST)?;
        let mut reader =
            csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
        for record in reader.records() {
            table.rows.push(record?.iter().map(str::to_owned).collect());
        }
        if table.rows.is_empty() {
            return Ok(table);
        }
        table.header = table.rows.remove(0);
        if table.header.first().map(String::as_str) != Some("file")
            || table.header.last().map(String::as_str) != Some(FINGERPRINT)
        {
            return Err(Failure::Usage(format!(
                "--table {}: holds something else than fits; name another",
                output::shown(path)
            )));
        }
        Ok(table)
    }

    /// What a row of `path` is computed from.
    pub(super) fn fingerprint(&self, path: &Path) -> String {
        let bytes = std::fs::read(path).unwrap_or_default();
        let mut whole = sha256(&bytes);
        whole.push_str(&self.settings);
        sha256(whole.as_bytes())[..16].to_owned()
    }

    /// Whether the file was fitted before, in the same way.
    pub(super) fn has(&self, path: &Path) -> bool {
        let (shown, fingerprint) = (show_path(path), self.fingerprint(path));
        self.rows.iter().any(|row| row.first() == Some(&shown) && row.last() == Some(&fingerprint))
    }

    /// Puts a row in, in place of an older one of the same file; one without a fingerprint is tried again by a rerun.
    pub(super) fn add(
        &mut self,
        path: &Path,
        fingerprint: Option<String>,
        [header, row]: &[Vec<String>; 2],
    ) -> Result<(), Failure> {
        let shown = show_path(path);
        self.rows.retain(|row| row.first() != Some(&shown));
        let mut header = header.clone();
        header.push(FINGERPRINT.to_owned());
        if header.len() > self.header.len() || self.header.is_empty() {
            self.header = header;
        }
        let mut row = row.clone();
        // A file that could not be fitted has its reason, and nothing else.
        row.resize(self.header.len().max(row.len() + 1) - 1, String::new());
        row.push(fingerprint.unwrap_or_default());
        self.rows.push(row);
        let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
        writer.write_record(&self.header)?;
        for row in &mut self.rows {
            let last = row.pop().unwrap_or_default();
            row.resize(self.header.len() - 1, String::new());
            row.push(last);
            writer.write_record(&*row)?;
        }
        let bytes = writer.into_inner().map_err(|error| Failure::Usage(error.to_string()))?;
        output::write_bytes(&bytes, Some(&self.path))
    }
}
