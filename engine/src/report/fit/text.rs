//! A fit as lines of text.

use super::super::number::{short, significant, with_unit};
use super::super::table::aligned;
use super::{FitReport, MODULUS};
use crate::fit::intervals::FEW_DEGREES;
use crate::measured::Origin;
use crate::text::counted;
use crate::units::Quantity;
use std::fmt::Write;

impl FitReport {
    /// The fit as lines of text.
    pub fn text(&self) -> String {
        let units = &self.shown;
        let mut text = format!("{}: force over {}\n", self.file, self.abscissa);
        let _ = writeln!(text, "verdict: {}", self.verdict.sentence_for(&self.reasons));
        for reason in &self.reasons {
            let _ = writeln!(text, "reason: {}", reason.sentence);
        }
        for note in &self.notes {
            let _ = writeln!(text, "note: {note}");
        }
        self.values(&mut text);
        if let Some([Some(value), error]) = self.youngs_modulus {
            let modulus = self.parameters.iter().find(|of| of.key == MODULUS);
            let holds = modulus.is_some_and(|of| of.error_holds);
            let error = error.map_or_else(String::new, |error| {
                let error = significant(units.shown(Quantity::Stress, error).number, 2);
                if holds { format!(" +- {error}") } else { format!(" +- ({error})") }
            });
            let unit =
                units.unit(Quantity::Stress).map_or_else(String::new, |unit| format!(" {}", unit.ascii()));
            let _ = writeln!(
                text,
                "E = {}{error}{unit}, if the other body is rigid",
                significant(units.shown(Quantity::Stress, value).number, 6)
            );
        }
        text.push('\n');
        if let Some(correlations) = self.correlations.as_ref().filter(|rows| rows.len() > 1) {
            let mut pairs = Vec::new();
            for (i, row) in correlations.iter().enumerate() {
                for (j, r) in row.iter().enumerate().take(i) {
                    let names = [j, i].map(|k| self.parameters[k].letter.as_str());
                    // What is not complete must not look so.
                    let digits = if r.abs() < 0.99 { 2 } else { 4 };
                    pairs.push(format!("{} {} {r:+.digits$}", names[0], names[1]));
                }
            }
            let _ = writeln!(text, "correlations: {}", pairs.join(", "));
        }
        self.close(&mut text);
        text
    }

    /// The values with their errors and intervals.
    fn values(&self, text: &mut String) {
        let units = &self.shown;
        let number = |quantity, x: f64| significant(units.shown(quantity, x).number, 6);
        let mut rows = vec![["key", "", "value", "error", "start", ""].map(str::to_owned).to_vec()];
        for parameter in &self.parameters {
            let [value, error, unit] = parameter.cells(units);
            let start = number(parameter.quantity, parameter.start);
            rows.push(vec![parameter.key.clone(), parameter.letter.clone(), value, error, start, unit]);
        }
        text.push('\n');
        text.push_str(&aligned(&rows, 2));
        if self.parameters.iter().any(|of| of.standard_error.is_some() && !of.error_holds) {
            text.push_str(
                "errors in parentheses do not hold: they assume that the model describes the points, and is linear\n",
            );
        }
        for parameter in &self.parameters {
            let interval = |[lo, hi]: [f64; 2]| {
                format!("{} .. {}", number(parameter.quantity, lo), number(parameter.quantity, hi))
            };
            let key = &parameter.key;
            let known = parameter.interval.zip(parameter.degrees_of_freedom);
            if let Some((found, degrees)) =
                known.filter(|(_, degrees)| parameter.error_holds && *degrees < FEW_DEGREES)
            {
                let degrees = short(degrees, 3);
                let _ = writeln!(
                    text,
                    "{key}: 95 % by Student's t with {degrees} degrees of freedom {}",
                    interval(found)
                );
            }
            if let Some(found) = parameter.profile_interval {
                let _ = writeln!(text, "{key}: 95 % by the profile of chi squared {}", interval(found));
            }
            if let (Some(found), Some([count, block])) = (parameter.bootstrap_interval, self.bootstrap) {
                let drawn = if block > 1 { format!(" in blocks of {block}") } else { String::new() };
                let _ = writeln!(
                    text,
                    "{key}: 95 % of {count} fits to rows drawn at random{drawn} {}",
                    interval(found)
                );
            }
        }
    }

    fn close(&self, text: &mut String) {
        let units = &self.shown;
        text.push_str(&self.rows_text());
        let (chi, fitted) = (short(self.chi_squared, 4), self.rows.fitted());
        let _ = writeln!(
            text,
            "chi squared per degree of freedom {chi}; {fitted} points, {}{}",
            counted(self.outliers, "outlier"),
            self.chi_squared_without_outliers
                .map_or_else(String::new, |chi| format!(", {} without", short(chi, 4)))
        );
        let sigma = |quantity, axis: usize| {
            let told = with_unit(units, quantity, self.sigma[axis], true, |x| short(x, 3));
            let from = match self.sigma_from[axis] {
                Origin::Given => " (given)",
                Origin::Apart => "",
                Origin::Neighbours => " (from neighbouring points)",
                Origin::Assumed => " (assumed)",
            };
            format!("{told}{from}")
        };
        let _ = writeln!(
            text,
            "sigma of x {}, of P {}{}{}",
            sigma(Quantity::Length, 0),
            sigma(Quantity::Force, 1),
            if self.sigma_force_share > 0.0 {
                format!(" and {} % of P", short(100.0 * self.sigma_force_share, 3))
            } else {
                String::new()
            },
            if self.sigma.len() > 2 {
                format!(", of s {}", sigma(Quantity::Length, 2))
            } else {
                String::new()
            }
        );
        let part = |name: &str, chi: Option<f64>| chi.map(|chi| format!("{name} {}", short(chi, 4)));
        let parts = [part("in contact", self.chi_squared_in_contact), part("apart", self.chi_squared_apart)];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        let neighbours = self.noise_of_neighbours.map_or_else(String::new, |s| {
            format!("; neighbouring points in contact show a noise of {} sigma", short(s, 3))
        });
        let correlated = if self.rows_that_count_as_one > 1.0 {
            format!(
                "; the noise of neighbouring rows is alike, and {} rows count as one",
                short(self.rows_that_count_as_one, 2)
            )
        } else {
            String::new()
        };
        let _ = writeln!(text, "chi squared per point {}{neighbours}{correlated}", parts.join(", "));
        let starts: Vec<String> = self
            .starts
            .iter()
            .map(|start| format!("{} ({})", short(start.distance, 3), start.snaps))
            .collect();
        let _ =
            writeln!(text, "starts, by their final mean distance in sigma (snaps): {}", starts.join(", "));
        if let Some(direction) = &self.direction {
            let _ = writeln!(text, "not determined: {direction}");
        }
        let end = match self.ended {
            "converged" => "converged",
            "rounds" => "NOT converged: these are the best values so far",
            _ => "stopped: these are the best values so far",
        };
        let _ = writeln!(text, "end: {end}");
    }

    /// The rows by branch and part, as lines of text.
    fn rows_text(&self) -> String {
        let mut rows = vec![["rows", "contact", "free", "jump", "dropped"].map(str::to_owned).to_vec()];
        let list = self.rows.branches().into_iter();
        let counts = list.map(|(name, of)| (name, [of.contact, of.free, of.jump, of.dropped]));
        for (name, counts) in counts.filter(|(_, counts)| counts.iter().any(|count| *count > 0)) {
            rows.push(std::iter::once(name.to_owned()).chain(counts.map(|n| n.to_string())).collect());
        }
        if self.rows.pause > 0 {
            let pause = self.rows.pause.to_string();
            rows.push(["pause", "", "", "", &pause].map(str::to_owned).to_vec());
        }
        aligned(&rows, 1)
    }
}
