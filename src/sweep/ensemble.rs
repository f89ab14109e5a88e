//! The two files of an ensemble: `RESULTS.members.csv`, with a row for each member at each point, and `RESULTS.csv`,
//! with their statistics.
//!
//! The rows of the first are those of any sweep: they can be continued, computed in shards and joined. The second
//! follows from them alone. It is rewritten when a run or a merge ends, and covers the members that exist by then.

use super::merge::{MergeError, Merged, merge};
use super::output::{Existing, OutputError};
use super::record::{ERROR, Layout, ROW};
use super::results::{ResultsError, SweepResults};
use super::sidecar::{self, Sidecar};
use super::spec::identity;
use crate::store::atomic::{Overwrite, check, write_atomically};
use pulloff_engine::sweep::ensemble::{Statistics, at_points};
use pulloff_engine::sweep::spec::{Design, points};
use pulloff_engine::sweep::{Fault, Spec};
use pulloff_engine::text::show_path;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The file with the rows of the members, beside these results.
pub fn members(results: &Path) -> PathBuf {
    let is_csv = results.extension().is_some_and(|ending| ending == "csv");
    let stem = if is_csv { results.with_extension("") } else { results.to_owned() };
    let mut name = stem.into_os_string();
    name.push(".members.csv");
    PathBuf::from(name)
}

/// The file for the rows of a sweep with these results.
pub fn file_of_rows(results: &Path, spec: &Spec) -> PathBuf {
    if spec.is_ensemble() { members(results) } else { results.to_owned() }
}

/// The rows of a sweep that was told to write these results: the results themselves, or the members beside them.
pub fn found_rows(results: &Path) -> PathBuf {
    let members = members(results);
    let is_there = |path: &Path| sidecar::path(path).exists();
    if !is_there(results) && is_there(&members) { members } else { results.to_owned() }
}

/// The file for the rows of `parts` when they are joined to `results`.
pub fn joined_rows(parts: &[PathBuf], results: &Path) -> PathBuf {
    // Faults in a part are reported when it is joined.
    let is_of_members =
        |part: &PathBuf| Sidecar::read(part).is_ok_and(|(sidecar, _)| sidecar.is_of_members());
    if parts.first().is_some_and(is_of_members) { members(results) } else { results.to_owned() }
}

/// Joins the parts of a sweep to `results`, for an ensemble with their statistics. Parts are named by the results that
/// they were told to write, or by the actual files.
/// Errors: As [`merge`]; nothing has changed then.
pub fn join(parts: &[PathBuf], results: &Path, existing: Existing) -> Result<Merged, MergeError> {
    let parts: Vec<PathBuf> = parts.iter().map(|part| found_rows(part)).collect();
    let rows = joined_rows(&parts, results);
    let is_ensemble = rows != results;
    if is_ensemble && existing != Existing::Overwrite && results.exists() {
        return Err(MergeError::Exists { path: show_path(results) });
    }
    let merged = merge(&parts, &rows, existing)?;
    if is_ensemble {
        summarize(results)?;
    }
    Ok(merged)
}

/// Refuses to replace existing results with statistics unless they belong to this sweep.
pub fn may_write(results: &Path, spec: &Spec, existing: Existing) -> Result<(), OutputError> {
    if !spec.is_ensemble() || existing == Existing::Overwrite {
        return Ok(());
    }
    let path = || show_path(results);
    match Sidecar::read(results) {
        Ok((sidecar, _)) if sidecar.is_statistics() && sidecar.identity == identity(spec) => Ok(()),
        Ok((_, text)) => {
            Err(OutputError::OtherSweep { path: path(), what: sidecar::differences(&text, spec) })
        }
        Err(_) if !results.exists() && !sidecar::path(results).exists() => Ok(()),
        Err(cause) => Err(OutputError::NotOurs { path: path(), cause }),
    }
}

/// The members at a point.
#[derive(Debug, Clone, Default)]
pub struct AtPoint {
    /// How many exist.
    pub there: u64,
    refused: BTreeMap<&'static str, u64>,
}

impl AtPoint {
    /// The number of members with an error.
    pub fn refused(&self) -> u64 {
        self.refused.values().sum()
    }

    /// The fault of a point that should have `of` members.
    pub fn fault(&self, of: u64) -> Option<Fault> {
        Fault::of_members([self.there, of], &self.refused)
    }
}

/// The members at each of `points`, from the errors in their rows, in the order of the rows.
pub fn members_at<'a>(points: usize, errors: impl IntoIterator<Item = &'a str>) -> Vec<AtPoint> {
    let mut all = vec![AtPoint::default(); points];
    for (row, error) in errors.into_iter().enumerate() {
        let point = &mut all[row % points];
        point.there += 1;
        if let Some(reason) = Fault::reason_of(error) {
            *point.refused.entry(reason).or_default() += 1;
        }
    }
    all
}

/// Writes the statistics of the existing members to `results`.
pub fn summarize(results: &Path) -> Result<(), OutputError> {
    let members = members(results);
    let rows = SweepResults::open(&members)?;
    let (sidecar, text) = Sidecar::read(&members).map_err(ResultsError::from)?;
    let layout = sidecar.layout(&members, &text).map_err(ResultsError::from)?;
    let Design::Ensemble { members: of, seed, .. } = layout.design else { return Ok(()) };
    let count = points(&layout.axes, layout.design.of_points());
    let at = usize::try_from(count).unwrap_or(usize::MAX);
    let errors = rows.cells(ERROR, |cell| Some(cell.to_owned()))?;
    let all = members_at(at, errors.iter().map(String::as_str));
    // One column at a time, so that only one is in memory.
    let number = |cell: &str| if cell.is_empty() { Some(f64::NAN) } else { cell.parse().ok() };
    let mut found: Vec<Vec<Option<Statistics>>> = Vec::new();
    for name in quantities(&layout) {
        found.push(at_points(&rows.cells(name, number)?, at, seed));
    }
    let beside = sidecar.of_statistics(&text, &layout, count);
    let mut table = beside.layout.header();
    for (point, own) in (0..count).zip(&all) {
        let cells = found.iter().map(|column| column[usize::try_from(point).unwrap_or_default()]);
        let cells = cells.flat_map(|found| Statistics::cells(found.as_ref()));
        let cells = cells.map(|cell| cell.map_or_else(String::new, |cell| cell.to_string()));
        let fault = own.fault(of).map_or_else(String::new, |fault| fault.to_string());
        let last = [own.there.to_string(), own.refused().to_string(), fault];
        table.push_str(&beside.layout.line(point, cells.chain(last)));
    }
    check(results, Overwrite::Always)?;
    write_atomically(&sidecar::path(results), beside.text.as_bytes(), Overwrite::Always)?;
    write_atomically(results, table.as_bytes(), Overwrite::Always)?;
    Ok(())
}

/// The names of the quantities in the layout of the members.
fn quantities(layout: &Layout) -> impl Iterator<Item = &str> {
    let names = layout.columns.iter().map(String::as_str).filter(|name| ![ROW, ERROR].contains(name));
    names.filter(|name| !layout.axes.iter().any(|axis| axis.key == **name))
}
