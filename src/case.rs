//! A preset made ready for the engine: its problem reduced, its basis built, its start found.
//!
//! Everything that computes for a person (the commands, the explorer's worker, the benches) begins here, so
//! they all see the same numbers.

use crate::contact::groups::LARGE_TABOR;
use crate::contact::{Control, Groups, Problem, Reduced, Start, Units};
use crate::preset::{BasisSpec, Functions, Preset};
use crate::quasistatic::admissible::falls;
use crate::quasistatic::start::{StartError, contact_radius};
use crate::quasistatic::unload::{UnloadError, unload_while};
use crate::quasistatic::{Curve, Losses, Unloading};
use crate::ritz::parallel::Progress;
use crate::ritz::{Basis, BasisError, Rings, RingsError, Spectral};
use crate::theory::jkr::Jkr;
use std::sync::Arc;

/// Points of an arc-length trace before it stops.
pub const TRACE_POINTS: usize = 20_000;

/// A preset made ready for the engine.
#[derive(Debug, Clone)]
pub struct Case {
    /// The problem in the user's units.
    pub problem: Problem,
    /// The problem in reduced units.
    pub reduced: Reduced,
    /// The discretization.
    pub basis: Arc<dyn Basis>,
    /// What is controlled, in reduced units.
    pub control: Control,
    /// The contact radius at the start, reduced.
    pub start: f64,
    /// The contact radius at the end, reduced.
    pub end: f64,
    /// Tabor's μ, where it is known.
    pub tabor: Option<f64>,
}

/// Why a preset could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CaseError {
    /// The basis could not be made.
    #[error(transparent)]
    Basis(#[from] BasisError),
    /// The start state does not exist.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The end lies outside the start.
    #[error(
        "path.end_contact_radius = {end:e} must be smaller than the contact radius at the start, which is {start:e}"
    )]
    EndOutsideStart {
        /// The end, in the user's units.
        end: f64,
        /// The start, in the user's units.
        start: f64,
    },
    /// The unloading could not start.
    #[error(transparent)]
    Unload(#[from] UnloadError),
    /// It was no longer wanted.
    #[error("cancelled")]
    Cancelled,
}

impl Case {
    /// Makes `preset` ready: builds or reuses its basis and finds its start state.
    ///
    /// # Errors
    /// [`CaseError`] when the basis or the start state cannot be had.
    pub fn new(preset: &Preset) -> Result<Self, CaseError> {
        Self::prepare(preset, &mut |_| true)
    }

    /// The same for a basis that takes long: `progress` is told the share of it that is built, and stops it by
    /// answering no.
    ///
    /// # Errors
    /// As [`Case::new`], and [`CaseError::Cancelled`] when `progress` said no.
    pub fn prepare(preset: &Preset, progress: Progress<'_>) -> Result<Self, CaseError> {
        let problem = preset.problem();
        let reduced = preset.reduced();
        let units = reduced.units;
        let wanted = match preset.path.start {
            Start::ContactRadius(s) => Start::ContactRadius(s / units.length),
            Start::Approach(delta) => Start::Approach(delta / units.length),
            Start::Force(p) => Start::Force(p / units.force),
        };
        let (basis, start) = start(&reduced, preset.basis, wanted, progress)?;
        let end = preset.end_contact_radius(start * units.length) / units.length;
        if end >= start {
            return Err(CaseError::EndOutsideStart { end: end * units.length, start: start * units.length });
        }
        let control = preset.path.control.in_units(units.stiffness);
        let tabor = Groups::of(&problem, preset.range_of_action()).tabor;
        Ok(Self { problem, reduced, basis, control, start, end, tabor })
    }

    /// The factors to the user's units.
    pub fn units(&self) -> &Units {
        &self.reduced.units
    }

    /// A control in the user's units.
    pub fn shown_control(&self, control: Control) -> Control {
        control.in_units(1.0 / self.units().stiffness)
    }

    /// The controls whose limit points are reported: displacement, force, and the device where it is a spring.
    pub fn controls(&self) -> Vec<Control> {
        let mut controls = vec![Control::Displacement, Control::Force];
        if !controls.contains(&self.control) {
            controls.push(self.control);
        }
        controls
    }

    /// The curve from start to end by arc-length continuation.
    ///
    /// # Errors
    /// [`CaseError::Start`] when there is no equilibrium at the start.
    pub fn trace(&self) -> Result<Curve, CaseError> {
        Curve::traced(
            self.reduced.clone(),
            Arc::clone(&self.basis),
            self.start,
            self.end,
            |settings| settings.points = TRACE_POINTS,
            || true,
        )
        .ok_or_else(|| self.no_start())
    }

    /// The curve from start to end through the explicit root; `go_on` is asked between points.
    ///
    /// # Errors
    /// [`CaseError::Start`] when there is no equilibrium at the start, [`CaseError::Cancelled`] when `go_on` said no.
    pub fn sweep(&self, mut go_on: impl FnMut() -> bool) -> Result<Curve, CaseError> {
        let mut wanted = true;
        let curve = Curve::swept(self.reduced.clone(), Arc::clone(&self.basis), self.start, self.end, || {
            wanted = wanted && go_on();
            wanted
        });
        if !wanted {
            return Err(CaseError::Cancelled);
        }
        curve.ok_or_else(|| self.no_start())
    }

    /// The quasi-static unloading along `curve`, which is extended where a landing needs it.
    ///
    /// # Errors
    /// [`CaseError::Unload`] when the start is unstable and nothing outward is stable.
    pub fn unload(&self, curve: &mut Curve, control: Control) -> Result<Unloading, CaseError> {
        self.unload_while(curve, control, Losses::Twice, || true)
    }

    /// The same as [`Case::unload`], with these losses; `go_on` is asked before each event.
    ///
    /// # Errors
    /// As [`Case::unload`], and [`CaseError::Cancelled`] when `go_on` said no.
    pub fn unload_while(
        &self,
        curve: &mut Curve,
        control: Control,
        losses: Losses,
        go_on: impl FnMut() -> bool,
    ) -> Result<Unloading, CaseError> {
        unload_while(curve, control, losses, go_on).map_err(|e| match e {
            UnloadError::Cancelled => CaseError::Cancelled,
            other @ UnloadError::UnstableStart { .. } => CaseError::Unload(other.in_units(self.units())),
        })
    }

    /// The smooth sphere of the same curvature and adhesion; `None` for a gap without a radius of curvature.
    pub fn smooth(&self) -> Option<Jkr> {
        Some(Jkr {
            effective_modulus: self.problem.effective_modulus,
            work_of_adhesion: self.problem.work_of_adhesion,
            radius_of_curvature: self.problem.shape.radius_of_curvature()?,
        })
    }

    /// Its pull-off force `P_c`, where there is one and it adheres.
    pub fn critical_force(&self) -> Option<f64> {
        self.smooth().map(|jkr| jkr.pull_off_force()).filter(|force| *force > 0.0)
    }

    /// What to be careful about, for a largest contact of radius `largest` (reduced).
    pub fn warnings(&self, largest: f64) -> Vec<String> {
        let mut warnings = self.problem.shape.notes();
        warnings.extend(self.basis.cautions(&self.reduced, largest).iter().map(ToString::to_string));
        if let Some(tabor) = self.tabor.filter(|tabor| *tabor < LARGE_TABOR) {
            warnings.push(format!(
                "Tabor's mu = {tabor:.2} is below {LARGE_TABOR}: the adhesion reaches beyond the edge, and the JKR limit \
                 of this method does not hold"
            ));
        }
        warnings
    }

    /// What else is worth knowing, for a largest contact of radius `largest` (reduced).
    pub fn notes(&self, largest: f64) -> Vec<String> {
        let text = "the gap falls within the contact: without adhesion it would not be one connected disc, and each state \
                    shown is checked";
        falls(&self.reduced.gap, largest).then(|| text.to_owned()).into_iter().collect()
    }

    fn no_start(&self) -> CaseError {
        StartError::NoEquilibrium(self.start).in_units(self.units()).into()
    }
}

/// The basis and the contact radius at the start, reduced.
///
/// An automatic number of functions follows from the largest contact, the start; where the start is an approach or
/// a force, the two are found in turn.
fn start(
    reduced: &Reduced,
    spec: BasisSpec,
    wanted: Start,
    progress: Progress<'_>,
) -> Result<(Arc<dyn Basis>, f64), CaseError> {
    let radius = |basis: &Arc<dyn Basis>| {
        contact_radius(reduced, basis, wanted).map_err(|e| e.in_units(&reduced.units))
    };
    let basis: Arc<dyn Basis> = match spec {
        BasisSpec::Rings { rings, grading } => {
            Rings::shared_with(rings, grading, progress).map_err(|error| match error {
                RingsError::Cancelled => CaseError::Cancelled,
                error => BasisError::from(error).into(),
            })?
        }
        BasisSpec::Spectral { functions: Functions::Count(n) } => {
            Arc::new(Spectral::new(n).map_err(BasisError::from)?)
        }
        BasisSpec::Spectral { functions: Functions::Auto } => {
            let resolving = |s| Spectral::resolving(reduced, s).map_err(BasisError::from);
            // Twice the paraboloid of R = 1 with its adhesion: as far as the search for a start looks first.
            let unit = |elastic: f64| 2.0 * elastic.max(reduced.work_of_adhesion.cbrt());
            let mut largest = match wanted {
                Start::ContactRadius(s) => s,
                Start::Approach(delta) => unit(delta.abs().sqrt()),
                Start::Force(p) => unit(p.abs().cbrt()),
            };
            let most = reduced.largest_contact();
            loop {
                largest = largest.min(most.max(match wanted {
                    Start::ContactRadius(s) => s,
                    Start::Approach(_) | Start::Force(_) => 0.0,
                }));
                let found = radius(&(Arc::new(resolving(largest)?) as Arc<dyn Basis>))?;
                if found <= largest {
                    return Ok((Arc::new(resolving(found)?), found));
                }
                // A little more, so that rounding cannot ask for another round.
                largest = 1.01 * found;
            }
        }
    };
    let found = radius(&basis)?;
    Ok((basis, found))
}
