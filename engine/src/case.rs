//! A preset prepared for the engine: its problem reduced, its basis built, its start found.
//!
//! Everything that computes for a user (the commands, the explorer's worker, the benches) begins here, so that all of
//! them see the same numbers.

mod warnings;

use crate::continuation::Branch;
use crate::disc::table::KeptTables;
use crate::disc::{Basis, ExactBasis, Panels, Table, TableError};
use crate::elementary::cbrt;
use crate::gap::function::Scaled;
use crate::gap::{Gap, Shape};
use crate::preset::{BasisSpec, Material, Preset};
use crate::problem::{
    Adhesion, Cohesion, ContactKind, Control, Groups, Printer, Problem, Reduced, Start, Turn, Units,
};
use crate::progress::{Progress, Stopped, Unwatched};
use crate::quasistatic::path::{
    Losses, Path, PathError, PathSetting, ZoneStartError, Zones, cycle, cycle_in_zone, start_in_zone, unload,
    unload_in_zone,
};
use crate::quasistatic::start::{StartError, contact_radius, end_contact_radius};
use crate::quasistatic::{Curve, CurveStop, Detail};
use crate::ritz::{Rings, RingsError};
use crate::theory::jkr::Jkr;
use crate::units::UnitSystem;
use std::sync::{Arc, Mutex};

/// Points of an arc-length trace before it stops.
pub const TRACE_POINTS: usize = 20_000;

/// A preset prepared for the engine.
#[derive(Debug, Clone)]
pub struct Case {
    /// The problem in the user's units.
    pub problem: Problem,
    /// The problem in reduced units.
    pub reduced: Reduced,
    /// The discretization.
    pub basis: Arc<dyn Basis>,
    /// The table of the gap.
    pub table: Arc<Table>,
    /// What is controlled, in reduced units.
    pub control: Control,
    /// Which contacts a path follows.
    pub contact: ContactKind,
    /// Whether states are those of ring elements.
    pub has_elements: bool,
    /// The contact radius at the start, reduced.
    pub start: f64,
    /// The contact radius at the end, reduced.
    pub end: f64,
    /// Whether the preset says so.
    pub end_is_given: bool,
    /// Where a loop turns round, reduced; `None` means at the start.
    pub turn: Option<Turn>,
    /// What a closing edge gains if that is less than the work of adhesion, reduced; the edge at the start is one that
    /// has closed.
    pub closing: Option<f64>,
    /// Tabor's μ, if it is known.
    pub tabor: Option<f64>,
    /// The tension and the range of an adhesion that has a range, reduced; paths and the curves of its zones take it
    /// into account.
    pub cohesion: Option<Cohesion>,
    /// How the adhesion is stated.
    pub adhesion: Adhesion,
    /// How numbers are shown to the user.
    pub shown: UnitSystem,
}

/// Why a preset could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CaseError {
    /// The rings could not be made.
    #[error(transparent)]
    Basis(RingsError),
    /// The gap cannot be tabulated.
    #[error("{}", error.words(printer))]
    Table {
        /// Why.
        error: TableError,
        /// Prints its numbers.
        printer: Box<Printer>,
    },
    /// The start state does not exist.
    #[error("{}", error.words(printer))]
    Start {
        /// Why.
        error: StartError,
        /// Prints its numbers.
        printer: Box<Printer>,
    },
    /// The end lies outside the start.
    #[error(
        "path.end_contact_radius = {} must be smaller than the contact radius at the start, which is {}",
        printer.length(*.end), printer.length(*.start)
    )]
    EndOutsideStart {
        /// The end, reduced.
        end: f64,
        /// The start, reduced.
        start: f64,
        /// Prints both.
        printer: Box<Printer>,
    },
    /// Adhesion with a range, in a computation that does not support it.
    #[error(
        "material.adhesion = \"{word}\": the explorer, trace, unload, cycle, fit and sweeps support adhesion with a \
         range, this does not; \"short-range\" works everywhere"
    )]
    HasRange {
        /// The word for that adhesion.
        word: &'static str,
    },
    /// There is no path.
    #[error("{}", error.words(printer))]
    Path {
        /// Why.
        error: Box<PathError>,
        /// Prints its numbers.
        printer: Box<Printer>,
    },
    /// The result was no longer wanted.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl Case {
    /// Prepares `preset`: builds or reuses its basis and finds its start state.
    ///
    /// # Errors
    /// [`CaseError`] if the basis or the start state cannot be made.
    pub fn new(preset: &Preset) -> Result<Self, CaseError> {
        Self::prepare(preset, &Unwatched)
    }

    /// The same for a basis that takes long: `progress` is told the share of the basis that is built, and may stop it.
    ///
    /// # Errors
    /// As [`Case::new`], and [`CaseError::Stopped`] if `progress` said stop. [`CaseError::HasRange`] if the adhesion
    /// has a range: callers of this function expect the states of short-range adhesion.
    pub fn prepare(preset: &Preset, progress: &dyn Progress) -> Result<Self, CaseError> {
        if preset.cohesion().is_some() {
            return Err(CaseError::HasRange { word: preset.material.adhesion.name() });
        }
        Self::with_range(preset, progress)
    }

    /// The same for callers that support adhesion with a range and do not overlook [`Case::cohesion`].
    ///
    /// # Errors
    /// As [`Case::prepare`].
    pub fn with_range(preset: &Preset, progress: &dyn Progress) -> Result<Self, CaseError> {
        let problem = preset.problem();
        let reduced = preset.reduced();
        let units = reduced.units;
        let wanted = match preset.path.start {
            Start::ContactRadius(s) => Start::ContactRadius(s / units.length),
            Start::Approach(delta) => Start::Approach(delta / units.length),
            Start::Force(p) => Start::Force(p / units.force),
        };
        let shown = preset.units.clone();
        let control = preset.path.control.in_units(units.stiffness);
        let printer = Printer::new(&units, &shown).under(control);
        let reach = reach(&reduced, wanted);
        let table = table(&preset.gap, &reduced, reach, &printer, progress)?;
        let mut basis: Arc<dyn Basis> = match preset.basis {
            BasisSpec::Rings { rings, grading } => {
                Rings::shared_with(rings, grading, progress).map_err(|error| match error {
                    RingsError::Stopped(Stopped) => CaseError::Stopped(Stopped),
                    error => CaseError::Basis(error),
                })?
            }
            BasisSpec::Exact => Arc::new(ExactBasis::new(Arc::clone(&table), reach)),
        };
        let cohesion = preset.cohesion().map(|law| law.reduced_by(units.length, units.pressure));
        let closing = preset.edge.closing_work_of_adhesion.map(|gamma| gamma / units.work_of_adhesion);
        let closing = closing.filter(|closing| *closing < reduced.work_of_adhesion);
        let started = if let Some(law) = cohesion {
            start_in_zone(&table, law, wanted, progress)
        } else {
            let work_of_adhesion = closing.unwrap_or(reduced.work_of_adhesion);
            let grown = Reduced { work_of_adhesion, ..reduced.clone() };
            contact_radius(&grown, &*basis, wanted, progress).map_err(ZoneStartError::Start)
        };
        let start = started.map_err(|error| refused_start(error, &printer))?;
        if preset.basis == BasisSpec::Exact {
            // However the start was given, from here on it decides how far the basis reaches.
            basis = Arc::new(ExactBasis::new(Arc::clone(&table), start));
        }
        let given = preset.path.end_contact_radius.map(|end| end / units.length);
        let end = end_contact_radius(&reduced, &table, start, given, progress)?;
        if end >= start {
            return Err(CaseError::EndOutsideStart { end, start, printer: Box::new(printer) });
        }
        let tabor = Groups::of(&problem, preset.range_of_action(), preset.cohesion()).tabor;
        let turn = preset.path.turn.map(|turn| turn.in_units(1.0 / units.length, 1.0 / units.force, control));
        let (contact, has_elements) = (preset.path.contact, preset.basis != BasisSpec::Exact);
        Ok(Self {
            problem,
            reduced,
            basis,
            table,
            control,
            contact,
            has_elements,
            start,
            end,
            end_is_given: given.is_some(),
            turn,
            closing,
            tabor,
            cohesion,
            adhesion: preset.material.adhesion,
            shown,
        })
    }

    /// The table of g from the axis to the start.
    ///
    /// # Errors
    /// [`CaseError::Table`], and [`CaseError::Stopped`] if `progress` said stop.
    pub fn panels(&self, progress: &dyn Progress) -> Result<Arc<Panels>, CaseError> {
        self.panels_to(self.start, progress)
    }

    /// The table of g from the axis to the radius `r`, a reduced length.
    ///
    /// # Errors
    /// As [`Case::panels`].
    pub fn panels_to(&self, r: f64, progress: &dyn Progress) -> Result<Arc<Panels>, CaseError> {
        let made = self.table.up_to_while(r, 0, progress);
        made.map_err(|error| refusal(error, &self.printer()))
    }

    /// Prints reduced numbers in the user's units.
    pub fn printer(&self) -> Printer {
        Printer::new(self.units(), &self.shown).under(self.control)
    }

    /// The factors to the user's units.
    pub fn units(&self) -> &Units {
        &self.reduced.units
    }

    /// A control in the user's units.
    pub fn shown_control(&self, control: Control) -> Control {
        control.as_given(self.units().stiffness)
    }

    /// The controls whose limit points are reported: displacement, force, and the device if it is a spring.
    pub fn controls(&self) -> Vec<Control> {
        let mut controls = vec![Control::Displacement, Control::Force];
        if !controls.contains(&self.control) {
            controls.push(self.control);
        }
        controls
    }

    /// The curve from start to end.
    ///
    /// # Errors
    /// [`CaseError::Start`] if there is no equilibrium at the start, [`CaseError::Stopped`] if `progress` said stop.
    pub fn curve(&self, progress: &dyn Progress) -> Result<Curve, CaseError> {
        self.curve_in(Detail::Drawn, progress)
    }

    /// The same with as many states as `detail` asks for.
    ///
    /// # Errors
    /// As [`Case::curve`].
    pub fn curve_in(&self, detail: Detail, progress: &dyn Progress) -> Result<Curve, CaseError> {
        self.curve_between([self.start, self.end], detail, progress)
    }

    /// The curve from a radius further out than the start, a reduced length, to the end.
    ///
    /// # Errors
    /// As [`Case::curve`].
    pub fn curve_from(&self, radius: f64, progress: &dyn Progress) -> Result<Curve, CaseError> {
        self.curve_between([radius, self.end], Detail::Drawn, progress)
    }

    fn curve_between(
        &self,
        ends: [f64; 2],
        detail: Detail,
        progress: &dyn Progress,
    ) -> Result<Curve, CaseError> {
        let (basis, table) = (Arc::clone(&self.basis), Arc::clone(&self.table));
        if self.cohesion.is_some() {
            let zones = self.zones(progress)?;
            return Curve::of_zones(self.reduced.clone(), basis, table, &zones, progress)
                .map_err(|error| self.no_path(error, self.control));
        }
        let curve = Curve::new(self.reduced.clone(), basis, table, ends, detail, progress)?;
        progress.go_on()?;
        curve.ok_or_else(|| self.no_start())
    }

    /// The same stretch of `curve` by arc-length continuation, with the reason why it ends.
    ///
    /// # Errors
    /// [`CaseError::Start`] if there is no equilibrium at the start, [`CaseError::Stopped`] if `progress`, which is asked
    /// before each point, said stop.
    pub fn trace(&self, curve: &Curve, progress: &dyn Progress) -> Result<(Branch, CurveStop), CaseError> {
        let traced = curve.traced(|settings| settings.points = TRACE_POINTS, progress);
        progress.go_on()?;
        traced.ok_or_else(|| self.no_start())
    }

    /// The setting of a path: the device and the contacts of the preset, losses computed in both ways, states to draw.
    pub fn setting(&self) -> PathSetting<'static> {
        PathSetting { contact: self.contact, closing: self.closing, ..PathSetting::new(self.control) }
    }

    /// The same for an unloading, in which ring elements follow a single disc.
    pub fn setting_of_unloading(&self) -> PathSetting<'static> {
        let contact = if self.has_elements { ContactKind::OneDisc } else { self.contact };
        PathSetting { contact, ..self.setting() }
    }

    /// The quasi-static unloading along `curve`, reduced; `progress` is asked often.
    ///
    /// # Errors
    /// [`CaseError::Path`] if there is none, [`CaseError::Stopped`] if `progress` said stop.
    pub fn unload(
        &self,
        curve: &Curve,
        setting: &PathSetting<'_>,
        progress: &dyn Progress,
    ) -> Result<Path, CaseError> {
        // For adhesion with a range, the equations of the curve are not those of its states.
        if let Some(path) = self.unload_in_zone(setting, progress)? {
            return Ok(path);
        }
        unload(curve, setting, progress).map_err(|error| self.no_path(error, setting.control))
    }

    /// The whole loop, reduced: from apart to the first touch, up to `turn` and down until the bodies are apart. `turn`
    /// is reduced; if it is not given, it is that of the preset or the start of its unloading. `progress` is asked
    /// before each step, with the rough share of the way that is done.
    ///
    /// # Errors
    /// As [`Case::unload`].
    pub fn cycle(
        &self,
        turn: Option<Turn>,
        setting: &PathSetting<'_>,
        progress: &dyn Progress,
    ) -> Result<Path, CaseError> {
        let turn = turn.or(self.turn).unwrap_or(Turn::Radius(self.start));
        if let Some(law) = self.cohesion {
            return cycle_in_zone(&self.table, law, turn, setting, progress)
                .map_err(|error| self.no_path(error, setting.control));
        }
        cycle(&self.table, self.reduced.work_of_adhesion, turn, setting, progress)
            .map_err(|error| self.no_path(error, setting.control))
    }

    /// The unloading from the start for adhesion with a range, reduced; `None` for short-range adhesion, which has a
    /// curve to [`unload`](Self::unload) along.
    ///
    /// # Errors
    /// As [`Case::unload`].
    pub fn unload_in_zone(
        &self,
        setting: &PathSetting<'_>,
        progress: &dyn Progress,
    ) -> Result<Option<Path>, CaseError> {
        let Some(law) = self.cohesion else { return Ok(None) };
        // Zones persist below the smallest contact, so the way down ends with the bodies apart.
        unload_in_zone(&self.table, law, self.start, setting, progress)
            .map(Some)
            .map_err(|error| self.no_path(error, setting.control))
    }

    /// The equilibria of adhesion with a range, as far out as the start.
    ///
    /// # Errors
    /// [`CaseError::Path`] if the start has none, [`CaseError::Stopped`] if `progress` said stop.
    pub fn zones(&self, progress: &dyn Progress) -> Result<Zones, CaseError> {
        let law = self.cohesion.unwrap_or(Cohesion { strength: f64::NAN, range: f64::NAN });
        Zones::up_to(&self.table, law, self.start, progress)
            .map_err(|error| self.no_path(error, self.control))
    }

    /// The refusal of a path under `control`, reduced.
    pub fn no_path(&self, error: PathError, control: Control) -> CaseError {
        refused_path(error, self.printer().under(control))
    }

    /// A warning if the events of an unloading on averaged rows depend on how finely the rows are averaged, because
    /// other events are found with cells twice as wide. `None` if they are the same, or if the gap is not a profile of
    /// averaged rows.
    pub fn unsettled(&self, path: &Path, progress: &dyn Progress) -> Option<String> {
        let Shape::Profile(measured) = &self.problem.shape else { return None };
        let profile = measured.coarser()?;
        let gap: Arc<dyn Gap> = Arc::new(Scaled::new(profile, self.units().length));
        let problem = Reduced { gap, ..self.reduced.clone() };
        let table = Arc::new(Table::new(Arc::clone(&problem.gap), self.start, progress).ok()?);
        let basis = Arc::new(ExactBasis::new(Arc::clone(&table), self.start));
        let ends = [self.start, self.end];
        let curve = Curve::new(problem, basis, table, ends, Detail::Drawn, progress).ok()??;
        let setting = PathSetting { losses: Losses::Once, ..self.setting() };
        let coarser = unload(&curve, &PathSetting { control: path.control, ..setting }, progress).ok();
        if progress.stop() {
            return None;
        }
        let count = coarser.map_or(0, |found| found.events.len());
        (count != path.events.len()).then(|| {
            format!(
                "the events depend on how finely the rows are averaged: {} here, {count} with cells twice as wide; a longer \
                 gap.smoothing leaves less of the noise in the gap",
                path.events.len()
            )
        })
    }

    /// The smooth sphere of the same curvature and adhesion; `None` for a gap without a radius of curvature.
    pub fn smooth(&self) -> Option<Jkr> {
        let Problem { effective_modulus, work_of_adhesion, shape } = &self.problem;
        smooth(*effective_modulus, *work_of_adhesion, shape)
    }

    /// The pull-off force `P_c` of that sphere, if there is one and it adheres.
    pub fn critical_force(&self) -> Option<f64> {
        pull_off_force(self.smooth())
    }

    fn no_start(&self) -> CaseError {
        CaseError::Start { error: StartError::NoEquilibrium(self.start), printer: Box::new(self.printer()) }
    }
}

/// The smooth sphere with the curvature of `shape`; `None` if the shape has no curvature.
fn smooth(effective_modulus: f64, work_of_adhesion: f64, shape: &Shape) -> Option<Jkr> {
    Some(Jkr { effective_modulus, work_of_adhesion, radius_of_curvature: shape.radius_of_curvature()? })
}

fn pull_off_force(smooth: Option<Jkr>) -> Option<f64> {
    smooth.map(|jkr| jkr.pull_off_force()).filter(|force| *force > 0.0)
}

/// [`Case::critical_force`] of a preset that is not prepared.
pub fn critical_force(preset: &Preset) -> Option<f64> {
    let Material { effective_modulus, work_of_adhesion, .. } = preset.material;
    pull_off_force(smooth(effective_modulus, work_of_adhesion, &preset.gap))
}

/// The tables of the last gaps used, by shape and unit of length.
static TABLES: KeptTables<(Shape, u64)> = Mutex::new(Vec::new());

/// How far the table of a gap reaches at first.
fn reach(reduced: &Reduced, wanted: Start) -> f64 {
    // Twice the contact on a paraboloid of R = 1 with its adhesion: the first distance to which a start is looked for.
    let unit = |elastic: f64| 2.0 * elastic.max(cbrt(reduced.work_of_adhesion));
    match wanted {
        Start::ContactRadius(s) => s,
        Start::Approach(delta) => unit(delta.abs().sqrt()),
        Start::Force(p) => unit(cbrt(p.abs())),
    }
}

/// The table of the gap, shared by all problems with the same gap: adhesion, modulus, device and start do not affect
/// it.
pub(crate) fn table(
    shape: &Shape,
    reduced: &Reduced,
    reach: f64,
    printer: &Printer,
    progress: &dyn Progress,
) -> Result<Arc<Table>, CaseError> {
    let key = (shape.clone(), reduced.units.length.to_bits());
    Table::shared(&TABLES, &key, &reduced.gap, reach, progress).map_err(|error| refusal(error, printer))
}

/// Why there is no table of the gap.
fn refusal(error: TableError, printer: &Printer) -> CaseError {
    match error {
        TableError::Stopped(Stopped) => CaseError::Stopped(Stopped),
        error @ TableError::TooFine(_) => CaseError::Table { error, printer: Box::new(printer.clone()) },
    }
}

/// Why there is no start.
fn refused_start(error: ZoneStartError, printer: &Printer) -> CaseError {
    match error {
        ZoneStartError::Path(error) => refused_path(error, printer.clone()),
        ZoneStartError::Start(StartError::Stopped(stopped)) => CaseError::Stopped(stopped),
        ZoneStartError::Start(error) => CaseError::Start { error, printer: Box::new(printer.clone()) },
    }
}

fn refused_path(error: PathError, printer: Printer) -> CaseError {
    match error {
        PathError::Stopped(Stopped) => CaseError::Stopped(Stopped),
        error => CaseError::Path { error: Box::new(error), printer: Box::new(printer) },
    }
}
