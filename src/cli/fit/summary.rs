//! Many fits in a few lines: the mean and spread of each value, and the files that the model does not describe.

use super::table::csv_rows;
use pulloff_engine::fit::Verdict;
use pulloff_engine::fit::fitted::quantity;
use pulloff_engine::preset::Preset;
use pulloff_engine::report::fit::FitReport;
use pulloff_engine::units::number::said;
use serde::Serialize;
use std::fmt::Write;

/// The summary of many fits.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct FitSummary {
    /// How many files there are.
    files: usize,
    /// How many of them the model describes.
    described: usize,
    /// The values over the described files, in base units.
    values: Vec<ValueSpread>,
    /// The other files.
    flagged: Vec<Flagged>,
}

/// One value over the files that the model describes.
#[derive(Debug, PartialEq, Serialize)]
struct ValueSpread {
    /// Its dotted key.
    key: String,
    /// The number of files with this value.
    count: usize,
    /// The mean.
    mean: f64,
    /// The standard deviation, with n − 1; `None` for a single file.
    standard_deviation: Option<f64>,
    /// The root mean square of the standard errors: equal to the deviation where the files differ only by noise.
    standard_error: f64,
}

/// A file that the model does not describe.
#[derive(Debug, PartialEq, Serialize)]
struct Flagged {
    file: String,
    /// The word for its verdict, or why it was not fitted.
    verdict: String,
    /// What speaks against the model, in words.
    reasons: String,
}

impl FitSummary {
    /// The summary of the rows of a table under its header; the file and the verdict are the first two columns.
    pub(super) fn of(header: &[String], rows: &[Vec<String>]) -> Self {
        let at = |row: &[String], place: Option<usize>| {
            place.and_then(|at| row.get(at)).cloned().unwrap_or_default()
        };
        let place = |name: &str| header.iter().position(|known| known == name);
        let (good, bad): (Vec<&Vec<String>>, Vec<_>) =
            rows.iter().partition(|row| at(row, Some(1)) == Verdict::Describes.word());
        let of = |key: &String| {
            let error = place(&format!("{key} error"))?;
            let number = |row: &[String], at_place: usize| at(row, Some(at_place)).parse::<f64>().ok();
            let pairs = good.iter().filter_map(|row| Some([number(row, place(key)?)?, number(row, error)?]));
            let pairs: Vec<[f64; 2]> = pairs.collect();
            let n = pairs.len() as f64;
            let mean = pairs.iter().map(|[value, _]| value).sum::<f64>() / n;
            let square = pairs.iter().map(|[value, _]| (value - mean).powi(2)).sum::<f64>();
            (n > 0.0).then(|| ValueSpread {
                key: key.clone(),
                count: pairs.len(),
                mean,
                standard_deviation: (n > 1.0).then(|| (square / (n - 1.0)).sqrt()),
                standard_error: (pairs.iter().map(|[_, error]| error * error).sum::<f64>() / n).sqrt(),
            })
        };
        let flagged = |row: &&Vec<String>| Flagged {
            file: at(row, Some(0)),
            verdict: at(row, Some(1)),
            reasons: at(row, place("reasons")),
        };
        Self {
            files: rows.len(),
            described: good.len(),
            values: header.iter().filter_map(of).collect(),
            flagged: bad.iter().map(flagged).collect(),
        }
    }

    /// The summary of these fits.
    pub(super) fn of_reports(reports: &[FitReport]) -> Self {
        let (header, rows) = csv_rows(&reports.iter().map(FitReport::row).collect::<Vec<_>>());
        Self::of(&header, &rows)
    }

    /// Lines for a terminal, with numbers in the units of `preset`.
    pub(super) fn text(&self, preset: &Preset) -> String {
        let mut text = format!("{} of {} files are described by the model\n", self.described, self.files);
        for ValueSpread { key, count, mean, standard_deviation, standard_error } in &self.values {
            let shown = |number| said(&preset.units, quantity(preset, key), number);
            let spread = standard_deviation.map_or_else(String::new, |deviation| {
                format!(", standard deviation {} of {count} files", shown(deviation))
            });
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "  {key}: mean {}{spread}, standard error of one {}",
                shown(*mean),
                shown(*standard_error)
            );
        }
        for Flagged { file, verdict, reasons } in &self.flagged {
            let why = if reasons.is_empty() { String::new() } else { format!(": {reasons}") };
            let _ = writeln!(text, "  {file}: {verdict}{why}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_described_files_have_a_mean_and_the_others_a_name() {
        let header = ["file", "verdict", "E", "E error", "points", "reasons"].map(str::to_owned);
        let row = |cells: [&str; 6]| cells.map(str::to_owned).to_vec();
        let rows = [
            row(["a", "describes", "1.0", "0.3", "9", ""]),
            row(["b", "describes", "3.0", "0.1", "9", ""]),
            row(["c", "does-not-describe", "70", "1", "9", "too soft"]),
            row(["d", "no points", "", "", "", ""]),
        ];
        let summary = FitSummary::of(&header, &rows);
        let [spread] = &summary.values[..] else { panic!("{summary:?}") };
        assert_eq!((&*spread.key, spread.count, spread.mean), ("E", 2, 2.0));
        assert!((spread.standard_deviation.unwrap() - 2.0_f64.sqrt()).abs() < 1e-15);
        assert!((spread.standard_error - 0.05_f64.sqrt()).abs() < 1e-15);
        let flagged: Vec<_> =
            summary.flagged.iter().map(|flagged| (&*flagged.file, &*flagged.reasons)).collect();
        assert_eq!(flagged, [("c", "too soft"), ("d", "")]);
        assert_eq!((summary.files, summary.described), (4, 2));
        let one = FitSummary::of(&header, &rows[..1]);
        assert_eq!(one.values[0].standard_deviation, None);
        assert!(FitSummary::of(&header, &rows[2..]).values.is_empty());
    }
}
