//! Following a curve of solutions, and what is special on it. Knows no contact.
//!
//! N − 1 equations g(y) = 0 in N unknowns define a curve. The caller scales its unknowns so that a unit
//! change of any of them matters equally: every length, angle and step here is Euclidean in y.
//!
//! | file | what lives there |
//! |---|---|
//! | [`system`] | the equations with exact first and second derivatives |
//! | [`closed`] | the equations closed by one more: a square system, factored |
//! | [`settings`] | every number of this module, with its reason |
//! | [`tangent`] | tangent, curvature and the orientation sign |
//! | [`corrector`] | Newton-Raphson on the sphere, on a plane, or at a control value |
//! | [`step_size`] | the turning of a step and the length of the next |
//! | [`step`] | one step: predict, correct, judge, retry |
//! | [`trace`] | steps until the end value, and why it stopped |
//! | [`branch`] | points with tangents |
//! | [`events`] | where a control turns: sign changes and grazing pairs |
//! | [`locate`] | guarded Newton on a limit point, or on a control value |
//!
//! A control is a row c: the controlled quantity is c·y, and its limit points are where c·t = 0 for the
//! unit tangent t. All controls share one branch.

pub mod branch;
pub mod closed;
pub mod corrector;
pub mod events;
pub mod locate;
pub mod settings;
pub mod step;
pub mod step_size;
pub mod system;
pub mod tangent;
pub mod trace;

pub use branch::{Branch, Point, Work};
pub use corrector::{Constraint, CorrectorFailure};
pub use events::Bracket;
pub use locate::LimitPoint;
pub use settings::Settings;
pub use step::{StepFailure, Stepper};
pub use system::{Linearization, System, Vector};
pub use trace::{End, Stop};

#[cfg(test)]
pub(crate) mod examples;
