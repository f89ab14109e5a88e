//! The whole loop of loading and unloading as a document.

use super::SCHEMA;
use super::problem::ProblemReport;
use super::rows::{RowsError, Table};
use super::unload::LOSS_AGREEMENT;
use crate::case::{Case, CaseError};
use crate::gap::{Gap, wave_index};
use crate::preset::{BasisSpec, Preset};
use crate::problem::Turn;
use crate::problem::{Control, Reduced, Units};
use crate::progress::{Part, Progress};
use crate::quasistatic::path::{Areas, Event, Passed, Path, PathState, Totals, TurnReached};
use serde::Serialize;

/// A loop: from apart to the first touch, up to a turn, and down until the bodies are apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CycleReport {
    /// The version of the document.
    pub schema: u32,
    /// `cycle`.
    pub document: &'static str,
    /// The version of the program.
    pub program_version: &'static str,
    /// What was computed.
    pub problem: ProblemReport,
    /// What to be careful about.
    pub warnings: Vec<String>,
    /// What else is worth knowing.
    pub notes: Vec<String>,
    /// Why the loop ended, in words.
    pub stop: String,
    /// What was controlled.
    pub control: Control,
    /// Where the control turned round.
    pub turn: TurnReport,
    /// What happened, in order.
    pub events: Vec<CycleEventReport>,
    /// The sums.
    #[serde(rename = "loop")]
    pub totals: LoopReport,
    /// Stable states in order, dense enough to be drawn.
    pub states: Vec<PathStateReport>,
}

/// Where a loop turned round.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TurnReport {
    /// `approach`, `force`, `contact_radius` or `control_value`.
    pub of: &'static str,
    /// What was asked for.
    pub asked: f64,
    /// What the state at the turn has of it: more where loading jumped over the value.
    pub reached: f64,
}

/// A state of a loop.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CycleStateReport {
    /// The outermost edge.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// The crest of the outermost edge; none for a gap without waves.
    pub wave: Option<u64>,
    /// U: the elastic energy less γ times the contact area.
    pub energy: f64,
    /// Every contact as [inner, outer], from the axis outward; a disc is [0, s].
    pub contacts: Vec<[f64; 2]>,
    /// The area in contact.
    pub contact_area: f64,
}

/// A state of a loop and where on it it lies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PathStateReport {
    /// The stable stretch between two jumps, counted from 0.
    pub piece: usize,
    /// `loading` or `unloading`.
    pub direction: &'static str,
    /// δ, P, or Δ = δ + P/k.
    pub control_value: f64,
    /// The state.
    #[serde(flatten)]
    pub state: CycleStateReport,
}

/// One event of a loop.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CycleEventReport {
    /// `first-touch`, `touch`, `advance`, `turn`, `recede`, `pull-off`, `merge`, `split` or `vanish`.
    pub kind: &'static str,
    /// `loading` or `unloading`.
    pub direction: &'static str,
    /// δ, P, or Δ = δ + P/k at which it happens.
    pub control_value: f64,
    /// Where a crest touched, contacts merged or split or one vanished.
    pub radius: Option<f64>,
    /// The state before; null while the bodies are apart.
    pub before: Option<CycleStateReport>,
    /// The state after; null once they are apart.
    pub after: Option<CycleStateReport>,
    /// Energy lost, by the drop of the potential of bodies and device; null where a dead load leaves no bound.
    pub dissipated: Option<f64>,
    /// The same by the work that the edges leave over on their way; null where it was not asked for.
    pub dissipated_by_area: Option<f64>,
    /// What the jump passed; its order means nothing.
    pub passed: Vec<PassedReport>,
}

/// What a jump passed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PassedReport {
    /// `touch`, `merge` or `vanish`.
    pub kind: &'static str,
    /// Where.
    pub radius: f64,
}

/// The sums of a loop; null where a dead load leaves no bound, or what was not asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LoopReport {
    /// All losses.
    pub dissipated: Option<f64>,
    /// The same by area.
    pub dissipated_by_area: Option<f64>,
    /// The losses before the pull-off.
    pub dissipated_before_pull_off: f64,
    /// The work done on bodies and device up to the turn.
    pub work_of_loading: f64,
    /// The same from the turn on.
    pub work_of_unloading: Option<f64>,
}

/// One contact of one state, as a row of CSV.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct ContactRow {
    state: usize,
    piece: usize,
    direction: &'static str,
    control_value: f64,
    approach: f64,
    force: f64,
    energy: f64,
    contact_area: f64,
    contact: usize,
    inner_radius: f64,
    outer_radius: f64,
}

/// The columns of the states as CSV, a row for each contact; they never change, new ones come behind them.
pub const COLUMNS: &[&str] = &[
    "state",
    "piece",
    "direction",
    "control_value",
    "approach",
    "force",
    "energy",
    "contact_area",
    "contact",
    "inner_radius",
    "outer_radius",
];

impl CycleReport {
    /// The loop of `preset`.
    ///
    /// # Errors
    /// [`CaseError`] when it cannot be computed, and when `progress` said stop.
    pub fn compute(preset: &Preset, areas: Areas, progress: &dyn Progress) -> Result<Self, CaseError> {
        Self::compute_to(preset, None, areas, progress)
    }

    /// The loop of `preset` that turns round at `turn`, in the units of the preset, in place of what that says.
    ///
    /// # Errors
    /// As [`compute`](Self::compute).
    pub fn compute_to(
        preset: &Preset,
        turn: Option<Turn>,
        areas: Areas,
        progress: &dyn Progress,
    ) -> Result<Self, CaseError> {
        let case = Case::prepare(preset, &Part::new(progress, [0.0, 0.1]))?;
        let units = case.units();
        let turn = turn.map(|turn| turn.in_units(1.0 / units.length, 1.0 / units.force, case.control));
        let cycle = case.cycle(case.control, turn, areas, &Part::new(progress, [0.1, 1.0]))?;
        Ok(Self::new(preset, &case, &cycle))
    }

    /// The document of a loop of `case`.
    #[must_use]
    pub fn new(preset: &Preset, case: &Case, cycle: &Path) -> Self {
        let units = case.units();
        let of_control = of_control(cycle.control, units);
        let mut warnings = case.warnings_of_problem();
        let told = cycle.warnings.iter().map(|w| w.words(cycle.control, units, &preset.units));
        warnings.extend(told);
        let mut notes = case.problem.shape.remarks(&case.shown);
        if matches!(preset.basis, BasisSpec::Rings { .. }) {
            notes.push("a loop is computed exactly, without ring elements, whatever the basis".to_owned());
        }
        let problem = &case.reduced;
        Self {
            schema: SCHEMA,
            document: "cycle",
            program_version: env!("CARGO_PKG_VERSION"),
            problem: ProblemReport::new(preset, case),
            warnings,
            notes,
            stop: "the bodies are apart".to_owned(),
            control: case.shown_control(cycle.control),
            turn: TurnReport::new(cycle.turn, cycle.control, units),
            events: cycle
                .events
                .iter()
                .map(|event| CycleEventReport::new(problem, cycle.control, event))
                .collect(),
            totals: LoopReport::new(&cycle.totals, units),
            states: cycle
                .states
                .iter()
                .map(|state| PathStateReport {
                    piece: state.piece,
                    direction: state.direction.name(),
                    control_value: state.control_value * of_control,
                    state: CycleStateReport::new(problem, state),
                })
                .collect(),
        }
    }

    /// The states as CSV, a row for each contact.
    ///
    /// # Errors
    /// As [`Table::csv`].
    pub fn csv(&self) -> Result<String, RowsError> {
        self.table()?.csv()
    }

    /// The states under the names of their columns, a row for each contact.
    ///
    /// # Errors
    /// As [`Table::of`].
    pub fn table(&self) -> Result<Table, RowsError> {
        let rows: Vec<ContactRow> = self
            .states
            .iter()
            .enumerate()
            .flat_map(|(number, at)| {
                at.state.contacts.iter().enumerate().map(move |(contact, edges)| ContactRow {
                    state: number,
                    piece: at.piece,
                    direction: at.direction,
                    control_value: at.control_value,
                    approach: at.state.approach,
                    force: at.state.force,
                    energy: at.state.energy,
                    contact_area: at.state.contact_area,
                    contact,
                    inner_radius: edges[0],
                    outer_radius: edges[1],
                })
            })
            .collect();
        Table::of(COLUMNS, &rows)
    }
}

fn of_control(control: Control, units: &Units) -> f64 {
    if control == Control::Force { units.force } else { units.length }
}

impl TurnReport {
    fn new(turn: TurnReached, control: Control, units: &Units) -> Self {
        let (of, unit) = match turn.asked {
            Turn::Approach(_) => ("approach", units.length),
            Turn::Force(_) => ("force", units.force),
            Turn::Radius(_) => ("contact_radius", units.length),
            Turn::Control(_) => ("control_value", of_control(control, units)),
        };
        Self { of, asked: turn.asked.value() * unit, reached: turn.reached * unit }
    }
}

impl CycleStateReport {
    fn new(problem: &Reduced, state: &PathState) -> Self {
        let Units { length, force, energy, .. } = problem.units;
        Self {
            contact_radius: state.contact_radius * length,
            approach: state.approach * length,
            force: state.force * force,
            wave: wave_index(state.contact_radius, problem.gap.wavelength()),
            energy: state.energy * energy,
            contacts: state.contacts.iter().map(|edges| edges.map(|r| r * length)).collect(),
            contact_area: state.contact_area * length * length,
        }
    }
}

impl CycleEventReport {
    fn new(problem: &Reduced, control: Control, event: &Event) -> Self {
        let units = problem.units;
        let state =
            |state: &Option<PathState>| state.as_ref().map(|state| CycleStateReport::new(problem, state));
        let passed =
            |passed: &Passed| PassedReport { kind: passed.kind.name(), radius: passed.radius * units.length };
        Self {
            kind: event.kind.name(),
            direction: event.direction.name(),
            control_value: event.control_value * of_control(control, &units),
            radius: event.radius.map(|r| r * units.length),
            before: state(&event.before),
            after: state(&event.after),
            dissipated: event.dissipated.map(|x| x * units.energy),
            dissipated_by_area: event.dissipated_by_area.map(|x| x * units.energy),
            passed: event.passed.iter().map(passed).collect(),
        }
    }

    /// Whether the loss by area confirms the one by energy; `None` where there are not both.
    #[must_use]
    pub fn losses_agree(&self) -> Option<bool> {
        let (energy, area) = self.dissipated.zip(self.dissipated_by_area)?;
        Some((energy - area).abs() <= LOSS_AGREEMENT * energy.abs())
    }
}

impl LoopReport {
    fn new(totals: &Totals, units: &Units) -> Self {
        let energy = |x: f64| x * units.energy;
        Self {
            dissipated: totals.dissipated.map(energy),
            dissipated_by_area: totals.dissipated_by_area.map(energy),
            dissipated_before_pull_off: energy(totals.dissipated_before_pull_off),
            work_of_loading: energy(totals.work_of_loading),
            work_of_unloading: totals.work_of_unloading.map(energy),
        }
    }
}
