//! Pulls as lines of text.

use super::super::number::{loss, significant};
use super::super::table::{aligned, ascii_unit, control, head};
use super::{MomentReport, PullReport, RunReport};
use crate::problem::Control;
use crate::units::{Quantity, UnitSystem};
use std::fmt::Write;

impl PullReport {
    /// Everything as lines of text.
    pub fn text(&self) -> String {
        let units = &self.head.units.shown;
        let mut text = format!("control: {}\n", control(units, self.control));
        match &self.runs[..] {
            [] => {}
            [run] => text.push_str(&self.one(run)),
            runs => text.push_str(&self.several(runs)),
        }
        for failure in &self.failures {
            let force = shown(units, Quantity::Force, failure.force);
            let line = match failure.time {
                Some(time) => {
                    format!("a dead load of {force} holds for {}", shown(units, Quantity::Time, time))
                }
                None => format!("a dead load of {force} holds indefinitely"),
            };
            let _ = writeln!(text, "{line}");
        }
        text
    }

    fn one(&self, run: &RunReport) -> String {
        let units = &self.head.units.shown;
        let at = |moment: &MomentReport| {
            let approach = |approach| format!("  delta {}", shown(units, Quantity::Length, approach));
            format!(
                "t {}  contact {}{}  P {}{}",
                shown(units, Quantity::Time, moment.time),
                shown(units, Quantity::Length, moment.contact_radius),
                moment.approach.map_or_else(String::new, approach),
                shown(units, Quantity::Force, moment.force),
                self.over_critical(moment.force),
            )
        };
        let mut text = String::new();
        let mut line = |name: &str, value: &str| {
            let _ = writeln!(text, "{name:<13} {value}");
        };
        if let Some(rate) = run.rate {
            line("rate", &shown(units, self.rate_quantity(), rate));
        }
        line("start", &at(&run.start));
        // After a turn the edge may have closed before.
        let opens = run.pinned_until.filter(|at| at.contact_radius > run.start.contact_radius);
        line(
            if opens.is_some() { "opens from" } else { "pinned until" },
            &run.pinned_until.as_ref().map_or("the end".to_owned(), &at),
        );
        for snap in &run.snaps {
            let value = format!(
                "contact {} > {}  top speed {}  dissipated {}",
                shown(units, Quantity::Length, snap.from),
                shown(units, Quantity::Length, snap.to),
                shown(units, Quantity::Speed, snap.top_speed),
                energy(units, snap.dissipated),
            );
            line("snap", &value);
        }
        for peak in &run.tension_peaks {
            line("tension peak", &at(peak));
        }
        // Bodies that are pressed together all the time do not pull.
        line(if run.peak.force < 0.0 { "largest pull" } else { "least force" }, &at(&run.peak));
        let last = run.last_contact.map_or("not reached".to_owned(), |last| {
            let quantity = if self.control == Control::Force { Quantity::Force } else { Quantity::Length };
            format!(
                "t {}  control {}",
                shown(units, Quantity::Time, last.time),
                shown(units, quantity, last.control)
            )
        });
        line("last contact", &last);
        line(
            "dissipated",
            &run.dissipated.map_or("no bound: the dead load falls".to_owned(), |lost| energy(units, lost)),
        );
        line("balance", &format!("{:.1e} of the work", run.balance));
        text
    }

    fn several(&self, runs: &[RunReport]) -> String {
        let units = &self.head.units.shown;
        let number = |quantity, x: f64| significant(units.shown(quantity, x).number, 6);
        let mut rows = vec![vec![
            head(units, "rate", self.rate_quantity()),
            head(units, "P", Quantity::Force),
            "P/Pc".to_owned(),
            "peaks".to_owned(),
            "snaps".to_owned(),
            head(units, "top speed", Quantity::Speed),
            head(units, "apart at", Quantity::Time),
            head(units, "dissipated", Quantity::Energy),
            "balance".to_owned(),
        ]];
        let dash = || "-".to_owned();
        let critical = self.head.problem.critical_force.filter(|critical| *critical > 0.0);
        rows.extend(runs.iter().map(|run| {
            vec![
                run.rate.map_or_else(dash, |rate| number(self.rate_quantity(), rate)),
                number(Quantity::Force, run.peak.force),
                critical.map_or_else(dash, |critical| significant(run.peak.force / critical, 6)),
                run.tension_peaks.len().to_string(),
                run.snaps.len().to_string(),
                run.top_edge_speed.map_or_else(dash, |speed| number(Quantity::Speed, speed)),
                run.last_contact.map_or_else(dash, |last| number(Quantity::Time, last.time)),
                run.dissipated.map_or_else(dash, |lost| number(Quantity::Energy, lost)),
                format!("{:.0e}", run.balance),
            ]
        }));
        aligned(&rows, 0)
    }

    fn rate_quantity(&self) -> Quantity {
        if self.control == Control::Force { Quantity::ForceRate } else { Quantity::Speed }
    }

    fn over_critical(&self, force: f64) -> String {
        let critical = self.head.problem.critical_force.filter(|critical| *critical > 0.0);
        critical.map_or_else(String::new, |critical| format!("  P/Pc {}", significant(force / critical, 6)))
    }
}

pub(super) fn shown(units: &UnitSystem, quantity: Quantity, x: f64) -> String {
    ascii_unit(units, quantity, x, |x| significant(x, 6))
}

fn energy(units: &UnitSystem, x: f64) -> String {
    ascii_unit(units, Quantity::Energy, x, loss)
}
