//! Following a curve of solutions, and finding its special points. Knows nothing of contact.
//!
//! n − 1 equations g(y) = 0 in n unknowns define a curve. The caller scales its unknowns so that a unit change of any
//! of them matters equally: every length, angle and step here is Euclidean in y. n is known at run time, 2 to a few
//! hundred: the algebra is dense.
//!
//! | file | what lives there |
//! |---|---|
//! | `system` | the equations with their Jacobian, and second derivatives where they have them |
//! | `second` | second derivatives along a direction, from the system or by differences |
//! | `closed` | the equations closed by one more: a square system, factored |
//! | `tangent` | tangent, curvature and the orientation sign |
//! | `branch` | points with tangent and curvature |
//! | `convergence` | when Newton's method has converged, and when it is given up |
//! | `settings` | every number of this module, with its reason |
//! | `tracer` | what follows a curve: system, settings, work space |
//! | `corrector` | correct: Newton-Raphson to the sphere, a plane, or a control value |
//! | `step_size` | the length of the next step |
//! | `step` | step: predict, correct, judge, retry |
//! | `trace` | trace: steps until the end value, and why it stopped |
//! | `events` | brackets: where a control turns, sign changes and grazing pairs |
//! | `locate` | locate: guarded Newton on a limit point, or on a control value |
//!
//! A control is a row c: the controlled quantity is c·y, and its limit points are where c·t = 0 for the
//! unit tangent t. All controls share one branch.

mod branch;
mod closed;
mod convergence;
mod corrector;
mod events;
mod locate;
mod second;
mod settings;
mod step;
mod step_size;
mod system;
mod tangent;
mod trace;
mod tracer;

pub use branch::{Branch, Point, Work};
pub use convergence::{Convergence, Criteria, NewtonFailure};
pub use events::Bracket;
pub use locate::LimitPoint;
pub use settings::Settings;
pub use step::StepFailure;
pub use system::{ColumnView, Columns, Linearization, Matrix, MatrixMut, SizeError, System, Vector};
pub use trace::{End, Stop};
pub use tracer::Tracer;

#[cfg(test)]
mod fixtures;
#[cfg(test)]
mod tests;
