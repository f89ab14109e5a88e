//! A path as a document: an unloading, or a whole loop of loading and unloading.

use super::columns::columns;
use super::number::{significant, with_unit};
use super::overlap::{self, OverlapReport};
use super::problem::{Head, control_name};
use super::rows::{ReportTable, RowsError};
use crate::case::{Case, CaseError};
use crate::gap::wave_index;
use crate::preset::{BasisSpec, Preset};
use crate::problem::cohesion::TABOR_OVER_MAUGIS;
use crate::problem::{ContactKind, Control, Reduced, Turn, Units};
use crate::progress::{Progress, ProgressPart};
use crate::quasistatic::overlap::passed;
use crate::quasistatic::path::{
    AskedState, Direction, Event, Losses, Passed, Path, PathSetting, PathState, PathStop, Totals,
    TurnReached, WhyNot,
};
use crate::quasistatic::{Curve, Detail, Overlap, State};
use crate::units::Quantity;
use serde::Serialize;

/// What happens on the way of a device.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PathReport {
    /// The head of the document.
    #[serde(flatten)]
    pub head: Head,
    /// What to be careful about.
    pub warnings: Vec<String>,
    /// What else is worth knowing.
    pub notes: Vec<String>,
    /// What was controlled.
    pub control: Control,
    /// `rings`, or `one-disc`.
    pub contact: &'static str,
    /// Why the path does not start from the state asked for; null where it does.
    pub start_note: Option<String>,
    /// Where the control turned round; null for an unloading alone.
    pub turn: Option<TurnReport>,
    /// Why the path ended, in words.
    pub stop: String,
    /// Whether it went on until the bodies were apart, or to where it was to end.
    #[serde(skip)]
    pub has_reached_its_end: bool,
    /// What happened, in order.
    pub events: Vec<EventReport>,
    /// The sums.
    pub totals: TotalsReport,
    /// Where a path of one disc passes states in which the bodies would overlap, from the start inward; null where
    /// that is not known, and for a path with rings, which passes none.
    pub inadmissible: Option<Vec<OverlapReport>>,
    /// Stable states in order, dense enough to be drawn.
    pub states: Vec<PathStateReport>,
}

/// Where a path turned round.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TurnReport {
    /// `approach`, `force`, `contact_radius` or `control`.
    pub of: &'static str,
    /// What was asked for.
    pub asked: f64,
    /// The value in the state at the turn: more than asked for where loading jumped over it.
    pub reached: f64,
}

/// A state of a path.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StateReport {
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// The outermost edge; 0 where a zone alone holds the bodies.
    pub contact_radius: f64,
    /// The outer edge of the zone in which adhesion with a range acts; otherwise omitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zone_radius: Option<f64>,
    /// The crest of the outermost edge; none for a gap without waves.
    pub wave: Option<u64>,
    /// Every contact as [inner, outer], from the axis outward; a disc is [0, s].
    pub contacts: Vec<[f64; 2]>,
    /// Whether the device can hold it: not at a limit point, from which edges run.
    pub stable: bool,
    /// dP/dδ while all edges are held, a force per length.
    pub held_stiffness: f64,
    /// The area in contact.
    pub area: f64,
    /// U: the elastic energy minus γ times the contact area; on the way up, minus what that area gained in closing.
    pub energy: f64,
}

/// A state of a path, and where it lies on the path.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PathStateReport {
    /// The stable stretch between two jumps, counted from 0.
    pub piece: usize,
    /// `loading` or `unloading`.
    pub direction: &'static str,
    /// δ, P, or Δ = δ + P/k.
    pub control: f64,
    /// The state.
    #[serde(flatten)]
    pub state: StateReport,
}

/// One event of a path.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct EventReport {
    /// Its number on the path, from 1.
    pub number: usize,
    /// `jump-in`, `first-touch`, `touch`, `merge`, `snap-in`, `snap`, `last-contact`, `snap-off`, `split`, `vanish`, `turn` or `depin`.
    pub kind: &'static str,
    /// `loading` or `unloading`.
    pub direction: &'static str,
    /// δ, P, or Δ = δ + P/k at which it happens.
    pub control: f64,
    /// Where a crest touched, contacts merged or split, one vanished, or an edge that was held began to move.
    pub radius: Option<f64>,
    /// The state before; null while the bodies are apart.
    pub before: Option<StateReport>,
    /// The state after; null once they are apart.
    pub after: Option<StateReport>,
    /// Energy lost, by the drop of the potential of bodies and device; null where a dead load leaves no bound.
    pub dissipated: Option<f64>,
    /// The same from the work left over at the edges on their way; null where it was not asked for.
    pub dissipated_by_area: Option<f64>,
    /// What the jump passed; its order means nothing.
    pub passed: Vec<PassedReport>,
    /// For a path of one disc, whether the states before and after are admissible; null where that is not known.
    pub admissible: Option<bool>,
}

/// What a jump passed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PassedReport {
    /// `touch`, `merge` or `vanish`.
    pub kind: &'static str,
    /// Where.
    pub radius: f64,
}

/// The sums of a path. Null where a dead load leaves no bound, where the sum was not asked for, and where the way was
/// not followed to its end.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TotalsReport {
    /// The state of the smallest force: its force is negative where the bodies stick, and 0 at the last contact where
    /// nothing pulls. Null where the path ends pressed together, before anything pulls.
    pub largest_pull: Option<StateReport>,
    /// The state of the smallest approach.
    pub farthest: Option<StateReport>,
    /// The last state in contact; null where the path does not end apart.
    pub last_contact: Option<StateReport>,
    /// All losses.
    pub dissipated: Option<f64>,
    /// The same by area.
    pub dissipated_by_area: Option<f64>,
    /// The losses before the last contact.
    pub dissipated_before_last_contact: f64,
    /// The work done on bodies and device up to the turn.
    pub work_of_loading: Option<f64>,
    /// The same on the way down.
    pub work_of_unloading: Option<f64>,
    /// The loss because closing gains less than opening costs, for a loop with `material.closing_work_of_adhesion`;
    /// otherwise omitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dead_band: Option<DeadBandReport>,
}

impl TotalsReport {
    /// The largest pull, if anything pulls.
    pub fn pull(&self) -> Option<&StateReport> {
        self.largest_pull.as_ref().filter(|at| at.force < 0.0)
    }
}

/// What a loop loses besides its jumps: together with `dissipated`, the work of the loop, loading and unloading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DeadBandReport {
    /// The area that closed, all of which opened again.
    pub area: f64,
    /// The work of adhesion minus what closing gained of it, times the area.
    pub dissipated: f64,
}

/// An event as a row of CSV.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct EventRow<'a> {
    #[serde(flatten)]
    event: &'a EventReport,
    before_rings: Option<usize>,
    after_rings: Option<usize>,
}

/// One contact of one state, as a row of CSV.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct ContactRow<'a> {
    state: usize,
    #[serde(flatten)]
    at: &'a PathStateReport,
    contact: usize,
    inner_radius: Option<f64>,
    outer_radius: Option<f64>,
}

/// The columns of the events as CSV; they never change, new ones come after them.
pub const COLUMNS: &[&str] = columns!(
    number kind direction control radius before_contact_radius before_approach before_force before_wave
    before_rings before_area before_energy after_contact_radius after_approach after_force after_wave
    after_rings after_area after_energy dissipated dissipated_by_area admissible
);

/// The columns of the states as CSV, a row for each contact; they never change, new ones come after them.
pub const STATE_COLUMNS: &[&str] = columns!(
    state piece direction control approach force energy area held_stiffness contact inner_radius outer_radius
);

/// The column after [`STATE_COLUMNS`] where the adhesion has a range; a state without contact then has one row,
/// without radii.
pub const STATE_ZONE_COLUMNS: &[&str] = columns!(zone_radius);

/// The columns after [`COLUMNS`] where the adhesion has a range.
pub const ZONE_COLUMNS: &[&str] = columns!(before_zone_radius after_zone_radius);

/// How much of a path is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    /// Whether losses are computed twice.
    pub losses: Losses,
    /// Whether to find where a path of one disc is not admissible, which takes longer than all the rest.
    pub admissibility: bool,
}

impl Default for Extent {
    fn default() -> Self {
        Self { losses: Losses::Twice, admissibility: true }
    }
}

/// The two losses agree when they differ by at most this share of the loss.
pub const LOSS_AGREEMENT: f64 = 1e-6;

/// The note on a loop of a preset with ring elements.
pub const LOOP_IS_EXACT: &str =
    "a loop is computed with exact states, without ring elements, whatever the basis";

impl PathReport {
    /// Unloads `preset` from its start.
    ///
    /// ```
    /// use pulloff_engine::{Extent, PathReport, Unwatched, preset};
    ///
    /// let wavy = preset::read_shipped("fig-9").ok_or("no such preset")?;
    /// let unloading = PathReport::unload(&wavy, Extent::default(), &Unwatched)?;
    /// assert_eq!(unloading.events.len(), 8, "seven jumps from wave to wave, and the last contact");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CaseError`] when it cannot be computed, and when `progress` said stop.
    pub fn unload(preset: &Preset, extent: Extent, progress: &dyn Progress) -> Result<Self, CaseError> {
        let case = Case::with_range(preset, &ProgressPart::new(progress, [0.0, 0.5]))?;
        let setting = PathSetting { losses: extent.losses, ..case.setting_of_unloading() };
        if let Some(path) = case.unload_in_zone(&setting, &ProgressPart::new(progress, [0.5, 1.0]))? {
            return Ok(Self::new(preset, &case, &path));
        }
        let curve = case.curve_in(Detail::Drawn, &ProgressPart::new(progress, [0.5, 0.7]))?;
        let path = case.unload(&curve, &setting, &ProgressPart::new(progress, [0.7, 0.8]))?;
        let mut report = Self::new(preset, &case, &path);
        if extent.admissibility {
            report = report.checked(&case, &curve, &path, &ProgressPart::new(progress, [0.8, 1.0]))?;
        }
        report.warnings.extend(case.unsettled(&path, progress));
        // A check that was given up may lack its warning.
        progress.go_on()?;
        Ok(report)
    }

    /// The loop of `preset`, turned round at `turn`, in the units of the preset, instead of where the preset says.
    ///
    /// ```
    /// use pulloff_engine::{Extent, PathReport, Unwatched, preset};
    ///
    /// let wavy = preset::read_shipped("fig-9-cycle").ok_or("no such preset")?;
    /// let whole = PathReport::cycle(&wavy, None, Extent::default(), &Unwatched)?;
    /// assert!(whole.totals.dissipated.is_some_and(|lost| lost > 0.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`unload`](Self::unload).
    pub fn cycle(
        preset: &Preset,
        turn: Option<Turn>,
        extent: Extent,
        progress: &dyn Progress,
    ) -> Result<Self, CaseError> {
        let case = Case::with_range(preset, &ProgressPart::new(progress, [0.0, 0.1]))?;
        let units = case.units();
        let turn = turn.map(|turn| turn.in_units(1.0 / units.length, 1.0 / units.force, case.control));
        let setting = PathSetting { losses: extent.losses, ..case.setting() };
        let path = case.cycle(turn, &setting, &ProgressPart::new(progress, [0.1, 0.9]))?;
        let report = Self::new(preset, &case, &path);
        if !extent.admissibility || setting.contact == ContactKind::Rings || case.cohesion.is_some() {
            return Ok(report);
        }
        let largest = path.states.iter().map(|state| state.contact_radius).fold(case.start, f64::max);
        let curve = case.curve_from(largest, &ProgressPart::new(progress, [0.9, 0.95]))?;
        report.checked(&case, &curve, &path, &ProgressPart::new(progress, [0.95, 1.0]))
    }

    /// The document of a path of `case`; whether a path of one disc is admissible is not known yet.
    #[must_use]
    pub fn new(preset: &Preset, case: &Case, path: &Path) -> Self {
        let (units, problem) = (case.units(), &case.reduced);
        let printer = case.printer().under(path.control);
        let is_loop = path.turn.is_some();
        let begins = path.start().map_or(0.0, |start| start.contact_radius).max(case.start);
        let in_zone = case.cohesion.is_some();
        let radii = path.states.iter().map(|state| state.contact_radius);
        let largest = radii.fold(if is_loop { 0.0 } else { begins }, f64::max);
        let mut warnings =
            if is_loop || in_zone { case.warnings_of_problem(largest) } else { case.warnings(largest) };
        warnings.extend(case.warning_of_start(path));
        warnings.extend(case.warning_of_end(path));
        warnings.extend(path.warnings.iter().map(|w| w.words(&printer)));
        let mut notes = if is_loop || in_zone { problem_notes(case) } else { case.notes(begins) };
        notes.extend(note_of_range(preset, case));
        if preset.edge.exponent.is_some() {
            notes.push(
                "the law of the edge's speed (edge.exponent) plays no part here: a path is infinitely slow; a pull follows \
                 the law"
                    .to_owned(),
            );
        }
        if is_loop && matches!(preset.basis, BasisSpec::Rings { .. }) {
            notes.push(LOOP_IS_EXACT.to_owned());
        }
        let states = path.states.iter().map(|state| PathStateReport {
            piece: state.piece,
            direction: state.direction.name(),
            control: state.control_value * of_control(path.control, units),
            state: StateReport::new(problem, state),
        });
        Self {
            head: Head::new("path", preset, case),
            warnings,
            notes,
            control: case.shown_control(path.control),
            contact: path.contact.name(),
            start_note: path.asked.map(|asked| start_note(case, path, &asked)),
            turn: path.turn.map(|turn| TurnReport::new(turn, path.control, units)),
            stop: path.stop.words(&printer),
            has_reached_its_end: matches!(path.stop, PathStop::Apart | PathStop::End),
            events: (1..)
                .zip(&path.events)
                .map(|(number, event)| EventReport::new(problem, path.control, number, event))
                .collect(),
            totals: TotalsReport::new(problem, path),
            inadmissible: None,
            states: states.collect(),
        }
    }

    /// The same document with the inadmissible states that a path of one disc passes on `curve`, which reaches as far out.
    ///
    /// # Errors
    /// [`CaseError::Stopped`] when `progress` said stop.
    pub fn checked(
        self,
        case: &Case,
        curve: &Curve,
        path: &Path,
        progress: &dyn Progress,
    ) -> Result<Self, CaseError> {
        if path.contact == ContactKind::Rings {
            return Ok(self);
        }
        let on = |curve: &Curve, pieces: &[[f64; 2]]| passed(curve, pieces, progress);
        let Some(closing) = case.closing else {
            let found = on(curve, &path.pieces())?;
            return Ok(self.with_overlaps(case, path, [&[], &found]));
        };
        // Contact that has closed is on the equilibria of a closing edge, and so is the start of an unloading.
        let growing = curve.under(closing, progress)?;
        let start = path.start().map_or(0.0, |start| start.contact_radius);
        let up = if path.turn.is_some() { path.pieces_on(&[Direction::Loading]) } else { vec![[start; 2]] };
        let grown = growing.map_or_else(|| Ok(Vec::new()), |growing| on(&growing, &up))?;
        let found = on(curve, &path.pieces_on(&[Direction::Unloading]))?;
        Ok(self.with_overlaps(case, path, [&grown, &found]))
    }

    /// With the inadmissible states of edges that closed, and of the others.
    fn with_overlaps(mut self, case: &Case, path: &Path, [grown, passed]: [&[Overlap]; 2]) -> Self {
        let holds = |state: &PathState| {
            let of =
                if case.closing.is_some() && state.direction == Direction::Loading { grown } else { passed };
            !of.iter().any(|overlap| overlap.contains(state.contact_radius))
        };
        for (report, event) in self.events.iter_mut().zip(&path.events) {
            report.admissible = Some(event.before.iter().chain(&event.after).all(holds));
        }
        let inadmissible = OverlapReport::all(&[grown, passed].concat(), case.units());
        self.warnings.extend(overlap::warning("the path", &inadmissible, &case.shown));
        self.inadmissible = Some(inadmissible);
        self
    }

    /// The events under the names of their columns.
    ///
    /// # Errors
    /// As [`ReportTable::of`].
    pub fn table(&self) -> Result<ReportTable, RowsError> {
        events_table(&self.events)
    }

    /// The states under the names of their columns, a row for each contact.
    ///
    /// # Errors
    /// As [`ReportTable::of`].
    pub fn states_table(&self) -> Result<ReportTable, RowsError> {
        let rows = self.states.iter().enumerate().flat_map(|(state, at)| {
            // A zone without contact has a row, too.
            let contacts = &at.state.contacts;
            let rows = contacts.len().max(usize::from(at.state.zone_radius.is_some()));
            (0..rows).map(move |contact| ContactRow {
                state,
                at,
                contact,
                inner_radius: contacts.get(contact).map(|edges| edges[0]),
                outer_radius: contacts.get(contact).map(|edges| edges[1]),
            })
        });
        if self.states.iter().all(|at| at.state.zone_radius.is_none()) {
            return ReportTable::picking(STATE_COLUMNS, rows);
        }
        ReportTable::picking(&[STATE_COLUMNS, STATE_ZONE_COLUMNS].concat(), rows)
    }
}

/// Events under the names of their columns.
///
/// # Errors
/// As [`ReportTable::of`].
pub fn events_table(events: &[EventReport]) -> Result<ReportTable, RowsError> {
    let rings = |state: &Option<StateReport>| {
        state.as_ref().map(|state| state.contacts.iter().filter(|[inner, _]| *inner > 0.0).count())
    };
    let rows = events.iter().map(|event| EventRow {
        event,
        before_rings: rings(&event.before),
        after_rings: rings(&event.after),
    });
    let mut states = events.iter().flat_map(|event| event.before.iter().chain(&event.after));
    if states.all(|state| state.zone_radius.is_none()) {
        return ReportTable::picking(COLUMNS, rows);
    }
    ReportTable::picking(&[COLUMNS, ZONE_COLUMNS].concat(), rows)
}

fn problem_notes(case: &Case) -> Vec<String> {
    case.problem.shape.remarks(&case.shown)
}

/// What the range of the adhesion is, where it has one.
pub(super) fn note_of_range(preset: &Preset, case: &Case) -> Option<String> {
    let law = preset.cohesion()?;
    let said = |quantity, x| with_unit(&case.shown, quantity, x, true, |x| significant(x, 6));
    let groups = case.problem.shape.radius_of_curvature().map(|radius| {
        let maugis = law.maugis(radius, case.problem.effective_modulus);
        let tabor = TABOR_OVER_MAUGIS * maugis;
        format!("; Maugis' lambda_M = {}, Tabor's mu = {}", significant(maugis, 4), significant(tabor, 4))
    });
    Some(format!(
        "the adhesion has a range: a tension of {} where the bodies are closer than {}{}; every state is one disc of \
         contact in one zone of tension",
        said(Quantity::Stress, law.strength),
        said(Quantity::Length, law.range),
        groups.unwrap_or_default()
    ))
}

/// Why a path does not start from the state asked for.
fn start_note(case: &Case, path: &Path, asked: &AskedState) -> String {
    let units = case.units();
    let length =
        |s: f64| with_unit(&case.shown, Quantity::Length, s * units.length, true, |s| significant(s, 6));
    let State { contact_radius, .. } = asked.state;
    let reached = length(path.start().map_or(f64::NAN, |start| start.contact_radius));
    let asked_for = format!("the requested state (contact radius {})", length(contact_radius));
    let control = control_name(path.control);
    match asked.why {
        WhyNot::Unstable { falls: true } => {
            format!(
                "{asked_for} is unstable under {control} control: the edge first ran outward to {reached}"
            )
        }
        WhyNot::Unstable { falls: false } => format!(
            "{asked_for} is unstable under {control} control: the path starts at the next stable state outward, \
             {reached}, which the edge would not reach by itself (the potential rises on the way)"
        ),
        WhyNot::Overlaps(radius) => format!(
            "{asked_for} cannot exist alone: outside it the bodies would overlap at r = {}; the path starts from the \
             contact at the same control in which they do not, out to {reached}",
            length(radius)
        ),
        WhyNot::Pulls(radius) => format!(
            "{asked_for} cannot exist without adhesion: the bodies would pull on each other at r = {}; the path \
             starts from the contact at the same control in which they do not, out to {reached}",
            length(radius)
        ),
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
            Turn::Control(_) => ("control", of_control(control, units)),
        };
        Self { of, asked: turn.asked.value() * unit, reached: turn.reached * unit }
    }
}

impl StateReport {
    /// A state of `problem` in the user's units.
    pub fn new(problem: &Reduced, state: &PathState) -> Self {
        let Units { length, force, energy, stiffness, .. } = problem.units;
        Self {
            approach: state.approach * length,
            force: state.force * force,
            contact_radius: state.contact_radius * length,
            zone_radius: state.zone.map(|edge| edge * length),
            wave: wave_index(state.contact_radius, problem.gap.wavelength()),
            contacts: state.contacts.iter().map(|edges| edges.map(|r| r * length)).collect(),
            stable: state.stable,
            held_stiffness: state.held_stiffness * stiffness,
            area: state.contact_area * length * length,
            energy: state.energy * energy,
        }
    }
}

impl EventReport {
    /// An event of `problem` under `control` in the user's units, with its number on the path.
    pub fn new(problem: &Reduced, control: Control, number: usize, event: &Event) -> Self {
        let units = problem.units;
        let state = |state: &Option<PathState>| state.as_ref().map(|state| StateReport::new(problem, state));
        let passed =
            |passed: &Passed| PassedReport { kind: passed.kind.name(), radius: passed.radius * units.length };
        Self {
            number,
            kind: event.kind.name(),
            direction: event.direction.name(),
            control: event.control_value * of_control(control, &units),
            radius: event.radius.map(|r| r * units.length),
            before: state(&event.before),
            after: state(&event.after),
            dissipated: event.dissipated.map(|x| x * units.energy),
            dissipated_by_area: event.dissipated_by_area.map(|x| x * units.energy),
            passed: event.passed.iter().map(passed).collect(),
            admissible: None,
        }
    }

    /// Whether the loss by area confirms the one by energy; `None` where there are not both.
    pub fn losses_agree(&self) -> Option<bool> {
        let (energy, area) = self.dissipated.zip(self.dissipated_by_area)?;
        Some((energy - area).abs() <= LOSS_AGREEMENT * energy.abs())
    }
}

impl TotalsReport {
    fn new(problem: &Reduced, path: &Path) -> Self {
        let Totals {
            dissipated,
            dissipated_by_area,
            dissipated_before_last_contact,
            work_of_loading,
            work_of_unloading,
            dead_band,
            ..
        } = path.totals;
        let length = problem.units.length;
        let energy = |x: f64| x * problem.units.energy;
        let state = |state: &PathState| StateReport::new(problem, state);
        Self {
            // A path that was not followed to its end may pull more, or go farther.
            largest_pull: path.largest_pull().filter(|_| path.is_whole()).map(state),
            farthest: path.farthest().filter(|_| path.is_whole()).map(state),
            last_contact: path.last_contact().and_then(|event| event.before.as_ref()).map(state),
            dissipated: dissipated.map(energy),
            dissipated_by_area: dissipated_by_area.map(energy),
            dissipated_before_last_contact: energy(dissipated_before_last_contact),
            work_of_loading: work_of_loading.map(energy),
            work_of_unloading: work_of_unloading.map(energy),
            dead_band: dead_band
                .map(|of| DeadBandReport { area: of.area * length * length, dissipated: energy(of.lost) }),
        }
    }
}
