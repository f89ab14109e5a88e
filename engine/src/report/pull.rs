//! Pulls at a rate, and times to failure under dead loads, as a document.

mod limits;
mod text;

use super::columns::columns;
use super::map::EXACT;
use super::problem::Head;
use super::rows::{ReportTable, RowsError};
use crate::case::{Case, CaseError};
use crate::preset::{BasisSpec, Preset, edge};
use crate::problem::{Control, Part, Printer};
use crate::progress::{self, Progress, Stopped};
use crate::rate::equation::HeldDisc;
use crate::rate::failure::time_to_failure;
use crate::rate::{EdgeLaw, Moment, MovingEdge, Pull, PullSettings, Puller, RateError};
use crate::units::UnitSystem;
use serde::Serialize;
use std::collections::BTreeSet;

/// A least force counts as a peak of tension where the force rises after it by more than this share of `P_c`, or of the largest pull
/// where the gap has no R.
const RISE: f64 = 0.01;
/// Bodies count as relaxed where they move, in a relaxation time, by less than this share of their approach at the last contact.
const RELAXED: f64 = 0.1;

/// Why there is no pull.
#[derive(Debug, thiserror::Error)]
pub enum PullError {
    /// The preset could not be made ready.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// Nothing says how fast an edge is.
    #[error(
        "{key} is not set: an edge has a speed if edge.exponent (often 0.2 to 1) and edge.reference_speed are \
         given (in reduced units the reference speed defaults to 1)"
    )]
    NoLaw {
        /// The key.
        key: &'static str,
    },
    /// Nothing says how fast the device is.
    #[error("no rate is given: set path.rate or path.steps, or give rates")]
    NoRate,
    /// The edge could not be followed.
    #[error("{}", error.words(printer))]
    Rate {
        /// Why.
        error: RateError,
        /// Prints its numbers.
        printer: Box<Printer>,
    },
}

/// A moment of a pull.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MomentReport {
    /// t, from the start of the pull.
    pub time: f64,
    /// s.
    pub contact_radius: f64,
    /// δ; null at the last contact under a dead load, which falls without end.
    pub approach: Option<f64>,
    /// P.
    pub force: f64,
}

/// A stretch in which the edge exceeds ten times its least speed since the last snap and crosses unstable equilibria.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SnapReport {
    /// s where it begins.
    pub from: f64,
    /// s where it ends.
    pub to: f64,
    /// The largest speed of the edge in it.
    pub top_speed: f64,
    /// The energy dissipated in it.
    pub dissipated: f64,
}

/// When the bodies are apart.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LastContactReport {
    /// t.
    pub time: f64,
    /// δ, P, or Δ = δ + P/k.
    pub control: f64,
}

/// One pull.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RunReport {
    /// The rate of the control; null where `path.steps` says what is done.
    pub rate: Option<f64>,
    /// The first moment.
    pub start: MomentReport,
    /// Where the bodies would overlap outside the disc at the start, which then cannot exist alone; null where they do not.
    pub overlaps_at: Option<f64>,
    /// When the edge first opens; null where it never does.
    pub pinned_until: Option<MomentReport>,
    /// The least force on the way.
    pub peak: MomentReport,
    /// The least forces after which the force rises by more than 1 % of `P_c`.
    pub tension_peaks: Vec<MomentReport>,
    /// The snaps in order, except the one in which the bodies come apart.
    pub snaps: Vec<SnapReport>,
    /// The last contact; null where the parts of the pull end before it.
    pub last_contact: Option<LastContactReport>,
    /// What the edge dissipates in all; null where a dead load falls without end.
    pub dissipated: Option<f64>,
    /// The largest speed of the edge before the last contact, in a snap or at the peak; null where a dead load has its peak at
    /// the last contact and the edge no snap.
    pub top_edge_speed: Option<f64>,
    /// What is missing between the work and elastic energy, adhesion and dissipation, relative to the work.
    pub balance: f64,
    /// Every moment that the integrator kept.
    #[serde(skip)]
    pub moments: Vec<MomentRow>,
}

/// How long a dead load holds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FailureReport {
    /// P, negative for a pull.
    pub force: f64,
    /// t until the bodies are apart; null where an equilibrium bears it.
    pub time: Option<f64>,
}

/// A moment as a row of CSV.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MomentRow {
    /// The rate of the control; none where `path.steps` says what is done.
    pub rate: Option<f64>,
    /// t, from the start of the pull.
    pub time: f64,
    /// δ, P, or Δ = δ + P/k.
    pub control: f64,
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// −ds/dt.
    pub speed: f64,
    /// G.
    pub energy_release_rate: f64,
    /// What the edge has dissipated so far.
    pub dissipated: f64,
}

/// A run as a row of CSV, with counts in place of its lists.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct RunRow<'a> {
    #[serde(flatten)]
    run: &'a RunReport,
    // After the run, so that they replace what it has under these names.
    tension_peaks: usize,
    snaps: usize,
}

/// The columns of the runs as CSV; they never change, new ones come after them.
pub const COLUMNS: &[&str] = columns!(
    rate peak_time peak_contact_radius peak_approach peak_force tension_peaks snaps last_contact_time
    last_contact_control dissipated top_edge_speed balance
);

/// The columns of the moments.
pub const MOMENT_COLUMNS: &[&str] = columns!(
    rate time control contact_radius approach force speed energy_release_rate dissipated
);

/// The columns of the times to failure.
pub const FAILURE_COLUMNS: &[&str] = columns!(force time);

/// Pulls of one disc whose edge has a speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PullReport {
    /// The head of the document.
    #[serde(flatten)]
    pub head: Head,
    /// What to be careful about.
    pub warnings: Vec<String>,
    /// What is moved at a rate.
    pub control: Control,
    /// The pulls, in the order asked for.
    pub runs: Vec<RunReport>,
    /// The dead loads, in the order asked for.
    pub failures: Vec<FailureReport>,
}

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AskedPulls {
    /// Rates of the control, in the units of the preset's numbers; if there are none, what the preset says.
    pub rates: Vec<f64>,
    /// Dead loads whose time to failure is wanted. With these and without rates nothing is pulled.
    pub loads: Vec<f64>,
}

/// The factors that turn the numbers of a pull into those of a preset.
struct Factors {
    length: f64,
    force: f64,
    energy: f64,
    adhesion: f64,
    control: f64,
    speed: f64,
}

impl Factors {
    fn time(&self) -> f64 {
        self.length / self.speed
    }

    fn moment(&self, moment: &Moment) -> MomentReport {
        MomentReport {
            time: moment.time * self.time(),
            contact_radius: moment.contact_radius * self.length,
            approach: Some(moment.approach * self.length).filter(|approach| approach.is_finite()),
            force: moment.force * self.force,
        }
    }

    fn row(&self, rate: Option<f64>, moment: &Moment) -> MomentRow {
        MomentRow {
            rate,
            time: moment.time * self.time(),
            control: moment.control * self.control,
            contact_radius: moment.contact_radius * self.length,
            approach: moment.approach * self.length,
            force: moment.force * self.force,
            speed: moment.speed * self.speed,
            energy_release_rate: moment.energy_release_rate * self.adhesion,
            dissipated: moment.dissipated * self.energy,
        }
    }

    fn run(
        &self,
        rate: Option<f64>,
        pull: &Pull,
        (control, overlaps_at): (Control, Option<f64>),
    ) -> RunReport {
        RunReport {
            rate,
            start: self.moment(&pull.start),
            overlaps_at,
            pinned_until: pull.pinned_until.as_ref().map(|moment| self.moment(moment)),
            peak: self.moment(&pull.peak),
            tension_peaks: pull.tension_peaks.iter().map(|moment| self.moment(moment)).collect(),
            snaps: pull
                .snaps
                .iter()
                .map(|snap| SnapReport {
                    from: snap.from * self.length,
                    to: snap.to * self.length,
                    top_speed: snap.top_speed * self.speed,
                    dissipated: snap.dissipated * self.energy,
                })
                .collect(),
            last_contact: pull.last_contact.as_ref().map(|moment| LastContactReport {
                time: moment.time * self.time(),
                control: moment.control * self.control,
            }),
            dissipated: pull.dissipated.map(|energy| energy * self.energy),
            top_edge_speed: top_speed(pull, control).map(|speed| speed * self.speed),
            balance: pull.balance,
            moments: pull.moments.iter().map(|moment| self.row(rate, moment)).collect(),
        }
    }

    /// How long the start bears each of these dead loads.
    fn failures(
        &self,
        case: &Case,
        edge: &MovingEdge,
        loads: &[f64],
        (warnings, progress): (&mut Vec<String>, &dyn Progress),
    ) -> Result<Vec<FailureReport>, PullError> {
        if loads.is_empty() {
            return Ok(Vec::new());
        }
        let panels = case.panels(progress)?;
        let mut failures = Vec::new();
        for &force in loads {
            let load = force / self.force;
            let approach = HeldDisc::new(&panels, Control::Force, case.start, load).approach;
            let overlaps_at = self.overlap_at_start(case, approach, progress);
            warnings.extend(overlaps_at.map(|r| self.warning_of_start(case, r)));
            let time =
                time_to_failure(&panels, edge, case.start, load).map_err(|error| refused(error, case))?;
            failures.push(FailureReport { force, time: time.map(|time| time * self.time()) });
        }
        Ok(failures)
    }
}

/// A pull that cannot be followed, with its numbers as the user sees them.
fn refused(error: RateError, case: &Case) -> PullError {
    match error {
        RateError::Stopped(Stopped) => PullError::Case(CaseError::Stopped(Stopped)),
        error => PullError::Rate { error, printer: Box::new(case.printer()) },
    }
}

/// The largest speed of the edge in a snap or at the least force. Under a dead load that force lasts until the bodies
/// are apart, where the speed has no bound: without a snap there is none.
fn top_speed(pull: &Pull, control: Control) -> Option<f64> {
    let at_peak = (control != Control::Force).then(|| pull.peak.speed.abs());
    pull.snaps.iter().map(|snap| snap.top_speed).chain(at_peak).reduce(f64::max)
}

impl PullReport {
    /// Computes what is `asked` of `preset`; `progress` is told the share that is done, and may stop it.
    ///
    /// # Errors
    /// [`PullError`].
    pub fn compute(preset: &Preset, asked: &AskedPulls, progress: &dyn Progress) -> Result<Self, PullError> {
        let case = Case::prepare(preset, progress)?;
        let (law, speed) = law(preset)?;
        let units = *case.units();
        let opening = case.reduced.work_of_adhesion;
        let closing = case.closing.unwrap_or(opening);
        let edge = MovingEdge { law, opening, closing };
        let is_force = case.control == Control::Force;
        let factors = Factors {
            length: units.length,
            force: units.force,
            energy: units.energy,
            adhesion: units.work_of_adhesion,
            control: if is_force { units.force } else { units.length },
            speed,
        };
        let puller = Puller {
            table: &case.table,
            control: case.control,
            edge,
            start: case.start,
            wave: case.reduced.gap.feature_length(),
            rise: case.critical_force().map(|force| RISE * force / units.force),
            settings: PullSettings::default(),
        };
        let programmes = programmes(preset, asked)?;
        let (mut warnings, mut widest) = (Vec::new(), case.start);
        if preset.basis != BasisSpec::Exact {
            warnings.push(EXACT.to_owned());
        }
        let mut runs = Vec::new();
        let count = programmes.len().max(1) as f64;
        for (k, (rate, parts)) in programmes.iter().enumerate() {
            let parts: Vec<Part> =
                parts.iter().map(|part| part.in_units(1.0 / factors.control, 1.0 / factors.time())).collect();
            let part = progress::ProgressPart::new(progress, [k as f64 / count, (k + 1) as f64 / count]);
            let pull = puller.pull(&parts, &part).map_err(|error| refused(error, &case))?;
            widest = pull.moments.iter().map(|moment| moment.contact_radius).fold(widest, f64::max);
            let overlaps_at = factors.overlap_at_start(&case, pull.start.approach, progress);
            warnings.extend(overlaps_at.map(|r| factors.warning_of_start(&case, r)));
            warnings.extend(factors.limits(preset, &case, rate.as_ref(), &pull, progress));
            if parts[pull.begun..].iter().any(|part| !matches!(part, Part::Apart { .. })) {
                warnings.push(format!(
                    "the bodies are apart in step {} of {}: the steps after it are not made",
                    pull.begun,
                    parts.len()
                ));
            }
            runs.push(factors.run(*rate, &pull, (case.control, overlaps_at)));
        }
        let failures = factors.failures(&case, &edge, &asked.loads, (&mut warnings, progress))?;
        warnings.splice(0..0, case.warnings_of_problem(widest));
        // What holds for all pulls is said once.
        let mut said = BTreeSet::new();
        warnings.retain(|warning| said.insert(warning.clone()));
        Ok(Self {
            head: Head::new("pull", preset, &case),
            warnings,
            control: preset.path.control,
            runs,
            failures,
        })
    }

    /// The runs under the names of their columns; the times to failure where nothing was pulled.
    ///
    /// # Errors
    /// As [`ReportTable::of`].
    pub fn table(&self) -> Result<ReportTable, RowsError> {
        if self.runs.is_empty() {
            return ReportTable::of(FAILURE_COLUMNS, &self.failures);
        }
        let rows = self.runs.iter().map(|run| RunRow {
            run,
            tension_peaks: run.tension_peaks.len(),
            snaps: run.snaps.len(),
        });
        ReportTable::picking(COLUMNS, rows)
    }

    /// The moments of all runs.
    ///
    /// # Errors
    /// As [`ReportTable::of`].
    pub fn moments(&self) -> Result<ReportTable, RowsError> {
        let rows: Vec<MomentRow> = self.runs.iter().flat_map(|run| run.moments.iter().copied()).collect();
        ReportTable::of(MOMENT_COLUMNS, &rows)
    }
}

/// The law of the edge of a preset, and v₀ in its units.
///
/// # Errors
/// [`PullError::NoLaw`].
pub fn law(preset: &Preset) -> Result<(EdgeLaw, f64), PullError> {
    let spec = &preset.edge;
    let exponent = spec.exponent.ok_or(PullError::NoLaw { key: edge::EXPONENT })?;
    let unit = (preset.units == UnitSystem::Reduced).then_some(1.0);
    let speed = spec.reference_speed.or(unit).ok_or(PullError::NoLaw { key: edge::REFERENCE_SPEED })?;
    let closing = spec.closing_speed.map(|closing| closing / speed);
    let law = EdgeLaw::symmetric(exponent).with_closing(closing, spec.closing_exponent);
    Ok((law, speed))
}

/// Why a preset does not say how it is pulled; `None` where it does.
pub fn missing(preset: &Preset) -> Option<PullError> {
    law(preset).err().or_else(|| programmes(preset, &AskedPulls::default()).err())
}

/// What is done in a run, with its rate where it has a single one.
type Programme = (Option<f64>, Vec<Part>);

/// What is done in each run, in the preset's units.
fn programmes(preset: &Preset, asked: &AskedPulls) -> Result<Vec<Programme>, PullError> {
    if !asked.rates.is_empty() {
        return Ok(asked.rates.iter().map(|&rate| (Some(rate), vec![Part::Apart { rate }])).collect());
    }
    if !asked.loads.is_empty() {
        return Ok(Vec::new());
    }
    // A preset whose steps cannot be read is refused when it is made.
    let steps = preset.steps().unwrap_or_default();
    if steps.is_empty() {
        return Err(PullError::NoRate);
    }
    let rate = preset.edge.rate.filter(|_| preset.edge.steps.trim().is_empty());
    Ok(vec![(rate, steps)])
}
