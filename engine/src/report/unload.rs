//! The unloading as a document.

use super::SCHEMA;
use super::number::{significant, with_unit};
use super::overlap::{self, OverlapReport};
use super::problem::ProblemReport;
use super::rows::{RowsError, Table};
use crate::case::{Case, CaseError};
use crate::gap::Gap;
use crate::gap::wave_index;
use crate::preset::Preset;
use crate::problem::{Control, Reduced};
use crate::progress::{Part, Progress, Unwatched};
use crate::quasistatic::overlap::passed;
use crate::quasistatic::{Detail, Event, EventKind, Losses, Overlap, State, Unloading};
use crate::units::Quantity;
use serde::Serialize;

/// A quasi-static unloading.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UnloadReport {
    /// The version of the document.
    pub schema: u32,
    /// The version of the program.
    pub program_version: &'static str,
    /// What was computed.
    pub problem: ProblemReport,
    /// What to be careful about.
    pub warnings: Vec<String>,
    /// What else is worth knowing.
    pub notes: Vec<String>,
    /// Why the path ended, in words.
    pub stop: String,
    /// What was controlled.
    pub control: Control,
    /// The first state on the path.
    pub start: StartReport,
    /// The smallest force on the path.
    pub min_force: f64,
    /// The smallest approach on the path.
    pub min_approach: f64,
    /// The sum of the losses that are defined.
    pub total_dissipated: f64,
    /// Where the path, its stable pieces and landings, is not admissible, from the start inward; null where that is
    /// not known yet.
    pub inadmissible: Option<Vec<OverlapReport>>,
    /// The instabilities in order.
    pub events: Vec<EventReport>,
}

/// A state on the path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StateReport {
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// The crest of the edge; none for a gap without waves.
    pub wave: Option<u64>,
}

/// The first state on the path.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StartReport {
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// The crest of the edge; none for a gap without waves.
    pub wave: Option<u64>,
    /// Said when the state asked for was unstable and the edge first ran outward.
    pub note: Option<String>,
}

/// One instability.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EventReport {
    /// `snap` or `pull-off`.
    pub kind: &'static str,
    /// δ, P, or Δ = δ + P/k at which it happens.
    pub control_value: f64,
    /// The limit point.
    pub before: StateReport,
    /// The landing; null after a pull-off.
    pub after: Option<StateReport>,
    /// Energy lost, by the drop of the potential of bodies and device.
    pub dissipated: Option<f64>,
    /// The same by the area between the curve and the control line.
    pub dissipated_by_area: Option<f64>,
    /// Why it happens, or why no loss is given.
    pub reason: String,
    /// Whether limit point and landing are admissible; null where that is not known yet.
    pub admissible: Option<bool>,
}

/// The columns of the events as CSV; they never change, new ones come behind them.
pub const COLUMNS: &[&str] = &[
    "kind",
    "control_value",
    "before_contact_radius",
    "before_approach",
    "before_force",
    "before_wave",
    "after_contact_radius",
    "after_approach",
    "after_force",
    "after_wave",
    "dissipated",
    "dissipated_by_area",
    "reason",
    "admissible",
];

impl UnloadReport {
    /// Unloads `preset` and reports it.
    ///
    /// # Errors
    /// [`CaseError`] when it cannot be computed.
    pub fn compute(preset: &Preset) -> Result<Self, CaseError> {
        Self::compute_while(preset, &Unwatched)
    }

    /// The same; `progress` is asked often.
    ///
    /// # Errors
    /// As [`UnloadReport::compute`], and [`CaseError::Cancelled`] when `progress` said stop.
    pub fn compute_while(preset: &Preset, progress: &dyn Progress) -> Result<Self, CaseError> {
        Self::compute_with(preset, Losses::Twice, true, progress)
    }

    /// The same with these losses; without `admissibility` it is not known. Each of the two takes longer than all the rest.
    ///
    /// # Errors
    /// As [`UnloadReport::compute_while`].
    pub fn compute_with(
        preset: &Preset,
        losses: Losses,
        admissibility: bool,
        progress: &dyn Progress,
    ) -> Result<Self, CaseError> {
        let case = Case::prepare(preset, &Part::new(progress, [0.0, 0.5]))?;
        let detail = if admissibility { Detail::Drawn } else { Detail::Borders };
        let curve = case.curve_in(detail, &Part::new(progress, [0.5, 0.7]))?;
        let unloading = case.unload_while(&curve, case.control, losses, &Part::new(progress, [0.7, 0.8]))?;
        let mut report = Self::new(preset, &case, &unloading);
        if admissibility {
            let passed = passed(&curve, &unloading.pieces, &Part::new(progress, [0.8, 1.0]))
                .ok_or(CaseError::Cancelled)?;
            report = report.checked(&case, &unloading, &passed);
        }
        report.warnings.extend(case.unsettled(&unloading, progress));
        // What was given up may lack its warning.
        if progress.stop() { Err(CaseError::Cancelled) } else { Ok(report) }
    }

    /// The document of an unloading of `case`, whose admissibility is not known yet: to find it takes longer than all
    /// the rest.
    pub fn new(preset: &Preset, case: &Case, unloading: &Unloading) -> Self {
        let units = case.units();
        let start = StateReport::new(&case.reduced, &unloading.start);
        let length = |s| with_unit(&preset.units, Quantity::Length, s, true, |s| significant(s, 6));
        let note = unloading.asked.map(|asked| {
            let radius = asked.state.in_units(units).contact_radius;
            let reached = length(start.contact_radius);
            let start = if asked.falls {
                format!("the edge first ran outward to {reached}")
            } else {
                format!(
                    "the path starts at the next stable state outward, {reached}, to which the edge would not run by \
                     itself (the potential rises on the way)"
                )
            };
            format!(
                "the state asked for (contact radius {}) is unstable under {} control: {start}",
                length(radius),
                control_name(unloading.control),
            )
        });
        let start = StartReport {
            contact_radius: start.contact_radius,
            approach: start.approach,
            force: start.force,
            wave: start.wave,
            note,
        };
        Self {
            schema: SCHEMA,
            program_version: env!("CARGO_PKG_VERSION"),
            problem: ProblemReport::new(preset, case),
            warnings: case.warnings(unloading.start.contact_radius.max(case.start)),
            notes: case.notes(unloading.start.contact_radius.max(case.start)),
            stop: unloading.stop.in_units(units).words(&preset.units),
            control: case.shown_control(unloading.control),
            start,
            min_force: unloading.min_force.in_units(units).force,
            min_approach: unloading.min_approach.in_units(units).approach,
            total_dissipated: unloading.total_dissipated() * units.energy,
            inadmissible: None,
            events: unloading
                .events
                .iter()
                .map(|event| EventReport::new(&case.reduced, unloading.control, event))
                .collect(),
        }
    }

    /// The same document with the inadmissible states that its path passes, reduced: those of
    /// [`passed`] on the pieces of `unloading`.
    #[must_use]
    pub fn checked(mut self, case: &Case, unloading: &Unloading, passed: &[Overlap]) -> Self {
        let holds = |state: &State| !passed.iter().any(|overlap| overlap.contains(state.contact_radius));
        for (report, event) in self.events.iter_mut().zip(&unloading.events) {
            report.admissible = Some(holds(&event.before) && event.after.as_ref().is_none_or(holds));
        }
        let inadmissible = OverlapReport::all(passed, case.units());
        self.warnings.extend(overlap::warning("the path", &inadmissible, &case.shown));
        self.inadmissible = Some(inadmissible);
        self
    }

    /// The events under the names of their columns.
    ///
    /// # Errors
    /// As [`Table::of`].
    pub fn table(&self) -> Result<Table, RowsError> {
        Table::of(COLUMNS, &self.events)
    }

    /// The events as CSV.
    ///
    /// # Errors
    /// As [`Table::csv`].
    pub fn csv(&self) -> Result<String, RowsError> {
        self.table()?.csv()
    }
}

impl StateReport {
    /// A state of `problem` in the user's units.
    pub fn new(problem: &Reduced, state: &State) -> Self {
        let wave = wave_index(state.contact_radius, problem.gap.wavelength());
        let State { contact_radius, approach, force, .. } = state.in_units(&problem.units);
        Self { contact_radius, approach, force, wave }
    }
}

impl EventReport {
    /// An event of `problem` under `control` in the user's units.
    pub fn new(problem: &Reduced, control: Control, event: &Event) -> Self {
        let units = problem.units;
        let of_control = if control == Control::Force { units.force } else { units.length };
        Self {
            kind: kind_name(event.kind),
            control_value: event.control_value * of_control,
            before: StateReport::new(problem, &event.before),
            after: event.after.as_ref().map(|after| StateReport::new(problem, after)),
            dissipated: event.dissipated.map(|loss| loss * units.energy),
            dissipated_by_area: event.dissipated_by_area.map(|loss| loss * units.energy),
            reason: reason(control, event).to_owned(),
            admissible: None,
        }
    }
}

/// The two losses agree when they differ by at most this share of the loss.
pub const LOSS_AGREEMENT: f64 = 1e-6;

impl EventReport {
    /// Whether the loss by area confirms the one by energy; `None` where a loss is not defined.
    pub fn losses_agree(&self) -> Option<bool> {
        let (energy, area) = self.dissipated.zip(self.dissipated_by_area)?;
        Some((energy - area).abs() <= LOSS_AGREEMENT * energy.abs())
    }
}

/// The word for a kind of event.
pub fn kind_name(kind: EventKind) -> &'static str {
    match kind {
        EventKind::Snap => "snap",
        EventKind::PullOff => "pull-off",
    }
}

/// The word for a control.
pub fn control_name(control: Control) -> &'static str {
    match control {
        Control::Displacement => "displacement",
        Control::Force => "force",
        Control::Stiffness(_) => "stiffness",
    }
}

fn reason(control: Control, event: &Event) -> &'static str {
    match (event.kind, control) {
        (EventKind::Snap, _) => "limit point of the control: the edge runs inward to the next stable state",
        (EventKind::PullOff, Control::Force) => {
            "limit point of the control with no stable state left: under a dead load the bodies fall apart for ever, \
             so the loss has no bound"
        }
        (EventKind::PullOff, _) => {
            "limit point of the control with no stable state left: the bodies come apart"
        }
    }
}
