//! The edge has a speed: one disc pulled at a rate.
//!
//! An edge that is offered more than the work of adhesion moves at a speed that grows with the excess, and dissipates
//! that excess. The limit of a slow pull is the quasi-static path, whatever the law: the losses of its jumps are what
//! is dissipated in the snaps.
//!
//! | file | what lives there |
//! |---|---|
//! | [`law`] | the speed of an edge as a function of the energy it is offered |
//! | [`equation`] | the equation of motion of a disc under a device |
//! | [`radau`] | the weights of the integrator |
//! | [`step`] | one implicit step |
//! | [`caps`] | how far a step may go: limit points |
//! | [`variation`] | how a pull changes with its values |
//! | [`stretch`] | a stretch on which the edge goes one way |
//! | [`record`] | moments, sums, least forces |
//! | [`snaps`] | the snaps among them |
//! | [`pull`] | a programme of ramps and holds |
//! | [`failure`] | how long a dead load holds |
//! | [`settings`] | the settings of the integrator |
//! | [`error`] | why there is no pull |
//!
//! In reduced units: E* = 1, and v₀ = 1, so that times are in units of the length over v₀.

pub mod caps;
pub mod equation;
pub mod error;
pub mod failure;
pub mod law;
pub mod pull;
pub mod radau;
pub mod record;
pub mod settings;
pub mod snaps;
pub mod step;
pub mod stretch;
#[cfg(test)]
mod tests;
pub mod variation;

pub use equation::MovingEdge;
pub use error::RateError;
pub use law::EdgeLaw;
pub use pull::{Pull, Puller};
pub use record::Moment;
pub use settings::PullSettings;
pub use snaps::Snap;
