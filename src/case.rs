//! A preset made ready for the engine: its problem reduced, its basis built, its start found.
//!
//! Everything that computes for a person (the commands, the explorer's worker, the benches) begins here, so
//! they all see the same numbers.

use crate::contact::groups::LARGE_TABOR;
use crate::contact::{Control, Gap, Groups, Problem, Reduced, Shape, Start, Units};
use crate::preset::{BasisSpec, Functions, Material, Preset};
use crate::quasistatic::admissible::falls;
use crate::quasistatic::curve::{SWEEP_STEPS_PER_WAVE, radii};
use crate::quasistatic::start::{StartError, contact_radius};
use crate::quasistatic::unload::{UnloadError, unload_while};
use crate::quasistatic::{Curve, Losses, Unloading};
use crate::ritz::parallel::Progress;
use crate::ritz::{Basis, BasisError, Rings, RingsError, Spectral};
use crate::theory::jkr::Jkr;
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
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
    /// Whether the number of functions follows from the contact.
    pub automatic: bool,
    /// What is controlled, in reduced units.
    pub control: Control,
    /// The contact radius at the start, reduced.
    pub start: f64,
    /// The contact radius at the end, reduced.
    pub end: f64,
    /// Tabor's μ, where it is known.
    pub tabor: Option<f64>,
    /// How numbers are shown to the user.
    pub shown: UnitSystem,
}

/// Why a preset could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CaseError {
    /// The basis could not be made.
    #[error(transparent)]
    Basis(#[from] BasisError),
    /// The start state does not exist.
    #[error("{}", error.words(shown))]
    Start {
        /// Why, in the user's units.
        error: StartError,
        /// How numbers are shown.
        shown: Box<UnitSystem>,
    },
    /// The end lies outside the start.
    #[error(
        "path.end_contact_radius = {} must be smaller than the contact radius at the start, which is {}",
        said(shown, Quantity::Length, *.end), said(shown, Quantity::Length, *.start)
    )]
    EndOutsideStart {
        /// The end, in the user's units.
        end: f64,
        /// The start, in the user's units.
        start: f64,
        /// How numbers are shown.
        shown: Box<UnitSystem>,
    },
    /// The unloading could not start.
    #[error("{}", error.words(shown))]
    Unload {
        /// Why, in the user's units.
        error: UnloadError,
        /// How numbers are shown.
        shown: Box<UnitSystem>,
    },
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
        let shown = preset.units.clone();
        let (basis, start) = start(&reduced, preset.basis, wanted, progress, &shown)?;
        let end = preset.end_contact_radius(start * units.length) / units.length;
        if end >= start {
            let (end, start) = (end * units.length, start * units.length);
            return Err(CaseError::EndOutsideStart { end, start, shown: Box::new(shown) });
        }
        let control = preset.path.control.in_units(units.stiffness);
        let tabor = Groups::of(&problem, preset.range_of_action()).tabor;
        let automatic = matches!(preset.basis, BasisSpec::Spectral { functions: Functions::Auto });
        Ok(Self { problem, reduced, basis, automatic, control, start, end, tabor, shown })
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

    /// The points of [`Case::sweep`], where there is an equilibrium at each.
    pub fn sweep_points(&self) -> usize {
        radii(self.start, self.end, self.reduced.gap.feature_length(), SWEEP_STEPS_PER_WAVE).len()
    }

    /// The quasi-static unloading along `curve`, which is extended where a landing needs it, and made anew where an
    /// automatic number of functions does not resolve how far an unstable start runs outward.
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
        mut go_on: impl FnMut() -> bool,
    ) -> Result<Unloading, CaseError> {
        loop {
            let unloading = unload_while(curve, control, losses, &mut go_on).map_err(|e| match e {
                UnloadError::Cancelled => CaseError::Cancelled,
                other @ UnloadError::UnstableStart { .. } => CaseError::Unload {
                    error: other.in_units(self.units()),
                    shown: Box::new(self.shown.clone()),
                },
            })?;
            let Some(finer) = self.finer(curve, &unloading)? else { return Ok(unloading) };
            *curve = Self { basis: finer, ..self.clone() }.sweep(&mut go_on)?;
        }
    }

    /// The basis for a path whose start ran outward beyond the wave more that an automatic number of functions allows for;
    /// none where that of `curve` will do.
    fn finer(&self, curve: &Curve, unloading: &Unloading) -> Result<Option<Arc<dyn Basis>>, CaseError> {
        let largest = unloading.start.contact_radius;
        let allowed = self.start + self.reduced.gap.feature_length().unwrap_or(0.0);
        if !self.automatic || largest <= allowed {
            return Ok(None);
        }
        let finer = Spectral::resolving(&self.reduced, largest).map_err(BasisError::from)?;
        // The second time its size is the same: where the path starts has moved by rounding at most.
        Ok((finer.size() > curve.equilibrium.basis.size()).then(|| Arc::new(finer) as Arc<dyn Basis>))
    }

    /// The smooth sphere of the same curvature and adhesion; `None` for a gap without a radius of curvature.
    pub fn smooth(&self) -> Option<Jkr> {
        let Problem { effective_modulus, work_of_adhesion, shape } = &self.problem;
        smooth(*effective_modulus, *work_of_adhesion, shape)
    }

    /// Its pull-off force `P_c`, where there is one and it adheres.
    pub fn critical_force(&self) -> Option<f64> {
        pull_off_force(self.smooth())
    }

    /// What to be careful about, for a largest contact of radius `largest` (reduced).
    pub fn warnings(&self, largest: f64) -> Vec<String> {
        let mut warnings = self.problem.shape.notes(&self.shown);
        // An automatic number of functions follows the contact.
        if !self.automatic {
            warnings.extend(self.basis.cautions(&self.reduced, largest).iter().map(ToString::to_string));
        }
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
        let text = if self.reduced.work_of_adhesion > 0.0 {
            "the gap falls within the contact: without adhesion it would not be one connected disc. Whether the bodies stay \
             apart outside the disc is checked; tension inside it is not, for in the JKR limit any adhesion, however weak, \
             bears it"
        } else {
            "the gap falls within the contact, and there is no adhesion: of a connected disc it is checked that the bodies \
             stay apart outside it and that nothing pulls inside it"
        };
        falls(&self.reduced.gap, largest).then(|| text.to_owned()).into_iter().collect()
    }

    fn no_start(&self) -> CaseError {
        let error = StartError::NoEquilibrium(self.start).in_units(self.units());
        CaseError::Start { error, shown: Box::new(self.shown.clone()) }
    }
}

/// The smooth sphere of the curvature of `shape`, which may have none.
fn smooth(effective_modulus: f64, work_of_adhesion: f64, shape: &Shape) -> Option<Jkr> {
    Some(Jkr { effective_modulus, work_of_adhesion, radius_of_curvature: shape.radius_of_curvature()? })
}

fn pull_off_force(smooth: Option<Jkr>) -> Option<f64> {
    smooth.map(|jkr| jkr.pull_off_force()).filter(|force| *force > 0.0)
}

/// [`Case::critical_force`] of a preset that is not made ready.
pub fn critical_force(preset: &Preset) -> Option<f64> {
    let Material { effective_modulus, work_of_adhesion, .. } = preset.material;
    pull_off_force(smooth(effective_modulus, work_of_adhesion, &preset.gap))
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
    shown: &UnitSystem,
) -> Result<(Arc<dyn Basis>, f64), CaseError> {
    let radius = |basis: &Arc<dyn Basis>| {
        contact_radius(reduced, basis, wanted).map_err(|e| CaseError::Start {
            error: e.in_units(&reduced.units),
            shown: Box::new(shown.clone()),
        })
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
