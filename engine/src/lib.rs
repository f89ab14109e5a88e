//! Adhesive contact of two elastic bodies, from the text of a problem to a report: equilibrium curves of the force P,
//! the approach δ and the contact radius s, their limit points, the jumps at these, and what each jump dissipates.
//!
//! Two elastic half-spaces with the effective modulus E* have a gap h(r) between them before they touch. Pressed to the
//! approach δ they stick on a disc of radius s, and the state is in equilibrium where the potential is stationary in s:
//!
//! ```text
//! U(δ, s) = E* ∫₀ˢ (δ − g(a))² da − π s² γ,     g(a) = a ∫₀^{π/2} h'(a sin θ) dθ,     ∂U/∂s = 0
//! ```
//!
//! with γ the work of adhesion. On a wavy gap the curve of such states has folds, and a pulled contact jumps across
//! them. The method is either the variational principle of J. J. Kalker (1977) with the ring elements of its source
//! paper, or, exact for any gap, the transform g of I. N. Sneddon (1965), doi:10.1016/0020-7225(65)90019-4.
//!
//! # A first computation
//!
//! A wavy sphere pulled off at a given approach: its edge jumps seven times from wave to wave before it lets go.
//!
//! ```
//! use pulloff_engine::{Adhesion, Extent, Material, PathReport, Preset, Shape, Start, Unwatched};
//!
//! let gap = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 };
//! let (work_of_adhesion, adhesion) = (0.025 / std::f64::consts::TAU, Adhesion::ShortRange);
//! let material = Material { effective_modulus: 1.0, work_of_adhesion, range_of_action: None, adhesion };
//! let preset = Preset::new(material, gap, Start::ContactRadius(0.5));
//!
//! let unloading = PathReport::unload(&preset, Extent::default(), &Unwatched)?;
//! assert_eq!(unloading.events.len(), 8);
//! let smooth = 1.5 * std::f64::consts::PI * material.work_of_adhesion;
//! let pull = unloading.totals.largest_pull.map_or(0.0, |state| state.force);
//! assert!((pull / smooth + 1.48).abs() < 0.01);
//! # Ok::<(), pulloff_engine::CaseError>(())
//! ```
//!
//! # What is here
//!
//! | to | take |
//! |---|---|
//! | state a problem in code | [`Preset`], [`Shape`], [`Material`], [`Control`], [`Start`] |
//! | read one from its text | [`read`](fn@read), with files [`read_in`] |
//! | prepare it | [`Case`]: reduced, its basis built, its start found |
//! | follow the curve | [`Case::curve`], [`Curve`], [`Case::trace`] |
//! | unload, or press and unload | [`Case::unload`], [`Case::cycle`], [`Path`], [`Event`] |
//! | look inside one state | [`Profile`], [`Landscape`], [`Admissibility`] |
//! | know where snaps begin | [`StabilityReport`], [`MapReport`] |
//! | pull at a rate | [`PullReport`] |
//! | fit a measured curve | [`FitReport`] |
//! | compute many problems | [`sweep::Spec`] |
//! | get the result as JSON, CSV or a table | [`TraceReport`], [`PathReport`], [`VerifyReport`] and the others, [`json`] |
//!
//! Nothing here reads a disk, a clock or the environment: the caller supplies texts of presets and rows of measured
//! profiles ([`Files`]).
//!
//! # How it is built
//!
//! The modules below build on each other from first to last: none uses a later one. The names at the root of the crate
//! are the stable ones, as `public-items.txt` lists them; whatever is only in a module may change with any version.
//!
//! | module | what lives there |
//! |---|---|
//! | [`elementary`], [`root`] | sin, exp, ln and such, the same on every machine; roots of functions of one number |
//! | [`text`], [`units`], [`expression`] | quoting foreign text, dimensions and units, the common grammar of formulas and values |
//! | [`cells`] | tables of text from instruments |
//! | [`gap`] | r → (h, h', h'', …), its breaks, the panels that resolve it; one file per shape |
//! | [`problem`] | E*, γ, the gap, the loading device, the start; reduced units, dimensionless groups |
//! | [`continuation`] | arc-length continuation and the location of limit points for any system |
//! | [`disc`] | one disc of contact, exactly: the table of g and what is read from it |
//! | [`ritz`] | the paper's method: ring elements, Kalker's functional, Newton-Raphson |
//! | [`annuli`] | the state of a disc and any number of rings of contact |
//! | [`zone`] | adhesion with a range: one disc of contact in one zone |
//! | [`rate`] | one disc whose edge has a speed: pulls, times to failure |
//! | [`theory`] | references in closed form that share only functions and roots with the above: Hertz, JKR, Guduru, Kesari-Lew |
//! | [`quasistatic`] | the curve, devices, stability, jumps, losses, unloading, admissibility |
//! | [`preset`], [`case`] | the table of keys, reading and writing presets; a preset prepared for the engine |
//! | [`stability`] | the law of stability, limit points in two parameters, counts of snaps |
//! | [`measured`], [`fit`] | measured curves, and the values of a preset that they give |
//! | [`report`], [`verify`] | the one serializable form of results; our numbers against theory |
//! | [`sweep`] | one preset over many values of its keys, row by row |
//! | [`progress`] | watching a long computation, and ending it |

#![cfg_attr(
    test,
    allow(
        clippy::disallowed_methods,
        reason = "tests judge by functions that share nothing with what they judge"
    )
)]

/// The page of the package, whose code is run as part of the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;

pub mod annuli;
pub mod case;
pub mod cells;
pub mod continuation;
pub mod disc;
pub mod elementary;
pub mod exact;
pub mod expression;
pub mod fit;
#[cfg(test)]
mod fixtures;
pub mod gap;
pub mod measured;
pub mod preset;
pub mod problem;
pub mod progress;
pub mod quasistatic;
pub mod rate;
pub mod report;
pub mod ritz;
pub mod root;
pub mod stability;
pub mod sweep;
pub mod text;
pub mod theory;
pub mod units;
pub mod verify;
pub mod zone;

pub use case::{Case, CaseError};
pub use gap::formula::{Formula, FormulaParameter, TypedGap};
pub use gap::shapes::{
    ExactSphere, Harmonic, Harmonics, MeasuredGap, PowerLaw, ProfileRows, RandomWaves, Smoothing,
};
pub use gap::{Gap, Jet, Shape};
pub use preset::{
    BasisSpec, Files, Invalid, Material, Mistake, PathSpec, Preset, ReadError, read, read_in, read_with,
};
pub use problem::{Adhesion, Cohesion, Control, Groups, Problem, Start, StatedCohesion, Units};
pub use progress::{Progress, Unwatched};
pub use quasistatic::{
    Admissibility, Curve, CurveStop, Detail, Event, EventKind, Extremum, Landscape, Limit, Losses, Path,
    PathState, PathStop, Profile, Stability, State,
};
pub use report::path::Extent;
pub use report::{
    FitReport, MapReport, OverlapReport, PathReport, PullReport, SCHEMA, StabilityReport, TraceReport,
    VerifyReport, json,
};
pub use ritz::Grading;
pub use units::UnitSystem;
