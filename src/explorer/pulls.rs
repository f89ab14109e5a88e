//! The pull at the rate of the preset, computed in the background if its edge has a law.

use super::background::{Background, Tell, Want, Watcher};
use super::model::Model;
use super::setting::same_curve;
use crate::mend::WordedFault;
use pulloff_engine::case::CaseError;
use pulloff_engine::gap::Shape;
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::{Control, Start};
use pulloff_engine::progress::{Progress, Stopped};
use pulloff_engine::report::PullReport;
use pulloff_engine::report::map::EXACT;
use pulloff_engine::report::number::{short, with_unit};
use pulloff_engine::report::pull::{AskedPulls, PullError, RunReport, missing};
use pulloff_engine::units::{Quantity, UnitSystem};
use std::time::Duration;

/// A pull, or why there is none.
#[derive(Debug, Clone)]
pub struct PullData {
    pub preset: Preset,
    pub report: Result<PullReport, WordedFault>,
    /// The least force on the smooth sphere of the same R, pulled from the same contact radius; `None` without R, and
    /// for that sphere itself.
    pub smooth: Option<f64>,
}

impl Background for PullData {
    type Key = Preset;
    const NAME: &'static str = "pull";
    const PATIENCE: Duration = Duration::from_millis(50);

    /// The pull of the present values, once their curve is there, since computing it makes the table that a pull reads.
    fn wanted(model: &Model) -> Want<Preset> {
        if missing(&model.preset).is_some() {
            Want::Not
        } else if model.shows_its_curve() {
            Want::Now(model.preset.clone())
        } else {
            Want::Later
        }
    }

    fn is_same(asked: &Preset, wanted: &Preset) -> bool {
        let of = |preset: &Preset| (preset.path.control, preset.edge.clone());
        same_curve(asked, wanted) && of(asked) == of(wanted)
    }

    fn is_of(&self, wanted: &Preset) -> bool {
        Self::is_same(&self.preset, wanted)
    }

    fn compute(preset: &Preset, progress: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        Self::of(preset, progress)
    }
}

impl PullData {
    /// Pulls as the preset says; `None` if it was stopped.
    pub fn of(preset: &Preset, progress: &dyn Progress) -> Option<Self> {
        let pulled = |preset: &Preset| PullReport::compute(preset, &AskedPulls::default(), progress);
        let report = match pulled(preset) {
            Err(PullError::Case(CaseError::Stopped(Stopped))) => return None,
            report => report.map_err(|error| WordedFault::of("", &error)),
        };
        let start = report.as_ref().ok().and_then(|report| report.runs.first()).map(|run| &run.start);
        let smooth = start.zip(preset.gap.radius_of_curvature()).and_then(|(start, radius_of_curvature)| {
            let mut smooth = Preset { gap: Shape::Sphere { radius_of_curvature }, ..preset.clone() };
            smooth.path.start = Start::ContactRadius(start.contact_radius);
            let report = (smooth.gap != preset.gap).then(|| pulled(&smooth).ok())??;
            Some(report.runs.first()?.peak.force)
        });
        Some(Self { preset: preset.clone(), report, smooth })
    }

    /// The pull.
    pub fn run(&self) -> Option<&RunReport> {
        self.report.as_ref().ok()?.runs.first()
    }

    /// Its numbers as a sentence that fits into 80 columns, the largest pull first; `jumps` is the number of jumps on
    /// the quasi-static path, including the last contact.
    fn sentence(&self, jumps: usize) -> Option<String> {
        let (run, report) = (self.run()?, self.report.as_ref().ok()?);
        let units = &self.preset.units;
        let three = |x: f64| short(x, 3);
        let of_force = self.preset.path.control == Control::Force;
        let quantity = if of_force { Quantity::ForceRate } else { Quantity::Speed };
        // The law is given; otherwise there is no report.
        let speed = self.preset.edge.reference_speed.unwrap_or(1.0);
        let over = |x: f64| format!("{} v₀", three(x / speed));
        let shown = |rate: f64| with_unit(units, quantity, rate, false, three);
        let rate = match run.rate {
            None => "as in path.steps".to_owned(),
            Some(rate) if of_force => format!("at {}", shown(rate)),
            Some(rate) if *units == UnitSystem::Reduced => format!("at {}", over(rate)),
            Some(rate) => format!("at {} ({})", shown(rate), over(rate)),
        };
        let peak = report.head.problem.critical_force.filter(|critical| *critical > 0.0).map_or_else(
            || with_unit(units, Quantity::Force, -run.peak.force, false, three),
            |critical| format!("{} P_c", three(-run.peak.force / critical)),
        );
        let smooth = self.smooth.filter(|force| *force < 0.0);
        let smooth = smooth.map(|force| format!(", {} × smooth", three(run.peak.force / force)));
        let peaks = run.tension_peaks.len();
        let seen =
            (!of_force && (1..=jumps).contains(&peaks)).then(|| format!("; {peaks}/{jumps} jumps seen"));
        Some(format!(
            "Largest pull {peak} {rate}{}{}{}",
            smooth.unwrap_or_default(),
            seen.unwrap_or_default(),
            run.top_edge_speed.map_or_else(String::new, |speed| format!("; edge to {}", over(speed)))
        ))
    }
}

impl Model {
    /// The pull at the rate of the preset, if there is one; it can be that of earlier values.
    pub fn pull(&self) -> Option<&PullData> {
        self.results.shown()
    }

    /// Whether the present values are pulled at a rate, so that the numbers of the path are not those of the pull.
    pub fn is_pulled(&self) -> bool {
        missing(&self.preset).is_none()
    }

    /// The least force of the pull of the present values, where it is known.
    pub fn pull_peak(&self) -> Option<f64> {
        let pull = self.pull().filter(|pull| pull.is_of(&self.preset))?;
        Some(pull.run()?.peak.force)
    }

    /// The outcome of the pull: first where the law ends, then its numbers; `None` if there is no pull of the present
    /// values.
    pub(super) fn pull_said(&self) -> Option<String> {
        let pull = self.pull().filter(|pull| pull.is_of(&self.preset))?;
        let report = match &pull.report {
            Err(reason) => return Some(format!("No pull: {reason}")),
            Ok(report) => report,
        };
        let known = self.warnings();
        // That the equation is exact is no news that the numbers should wait for.
        let warning = report.warnings.iter().find(|warning| !known.contains(warning) && **warning != EXACT);
        let events = self.path().map_or(&[][..], |path| &path.events);
        let jumps = events.iter().filter(|event| matches!(event.kind, "snap" | "last-contact")).count();
        let said = pull.sentence(jumps)?;
        Some(warning.map_or_else(|| said.clone(), |warning| format!("{warning}. {said}")))
    }
}
