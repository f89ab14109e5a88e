//! The points beside a fit, row by row, as part of its document and as CSV.

use super::number::exact;
use crate::fit::outcome::Fit;
use crate::fit::residuals::Residual;
use serde::Serialize;
use std::fmt::Write;

/// The header of [`csv()`].
pub const HEADER: &str = "row,line,segment,part,x,force,residual,outlier";

/// One row of a file beside the fit, in base units: SI, or those of a reduced problem.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ResidualRow {
    /// Its number among the rows that are read, from 1.
    pub row: usize,
    /// Its line in the file, from 1; `None` for points that come from no file.
    pub line: Option<usize>,
    /// Its branch.
    pub segment: &'static str,
    /// `contact` or `free`.
    pub part: &'static str,
    /// x, with its sign put right.
    pub x: f64,
    /// P, with its sign put right.
    pub force: f64,
    /// Its signed distance from the curve, in σ.
    pub residual: f64,
    /// Whether it is an outlier.
    pub outlier: bool,
}

/// The rows that are fitted, in the order of the file.
pub fn rows(fit: &Fit) -> Vec<ResidualRow> {
    let data = &fit.preset.data;
    let measured = data.source.as_ref().and_then(|source| source.measured(&data.columns).ok());
    let line = |row: usize| measured.as_ref().and_then(|measured| measured.lines.get(row - 1).copied());
    let of = |Residual { datum, residual, outlier }: &Residual| ResidualRow {
        row: datum.point.row,
        line: line(datum.point.row),
        segment: datum.segment.name(),
        part: if datum.free { "free" } else { "contact" },
        x: datum.point.x,
        force: datum.point.force,
        residual: *residual,
        outlier: *outlier,
    };
    let mut rows: Vec<ResidualRow> = fit.residuals.iter().map(of).collect();
    rows.sort_by_key(|row| row.row);
    rows
}

/// The rows as CSV with the header [`HEADER`].
pub fn csv(rows: &[ResidualRow]) -> String {
    let mut text = format!("{HEADER}\n");
    for of in rows {
        let line = of.line.map_or_else(String::new, |line| line.to_string());
        let [x, force, residual] = [of.x, of.force, of.residual].map(exact);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{},{line},{},{},{x},{force},{residual},{}",
            of.row, of.segment, of.part, of.outlier
        );
    }
    text
}
