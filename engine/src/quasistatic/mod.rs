//! The quasi-static path of a loading device along the equilibrium curve.
//!
//! | file | what lives there |
//! |---|---|
//! | [`equilibrium`] | the contact as a system of two equations in (δ, P, s); states, stability, controls |
//! | [`places`] | the places of the states with which a curve is drawn |
//! | [`curve`] | the equilibrium curve between two radii, its limit points, the arc-length tracer |
//! | [`monotone`] | the stretches on which a control is monotone, the limit points between them |
//! | [`start`] | the state a path starts from: a contact radius, an approach or a preload |
//! | [`jump`] | where the edge lands when it runs at constant control |
//! | [`descent`] | the way down at a falling control, jump by jump |
//! | [`ascent`] | the way up at a rising control, one disc alone |
//! | [`beyond`] | whether larger contacts than that at the start pull more |
//! | [`energy`] | what a jump dissipates, computed twice |
//! | [`landscape`] | the potential over the contact radius at a held control: minima, maxima, barriers |
//! | [`path`] | what happens on the way of a device: an unloading, a whole loop, with rings of contact |
//! | [`profile`] | one state across the radius: pressure inside, deformed gap outside |
//! | [`admissible`] | whether the bodies stay apart outside the contact |
//! | [`overlap`] | where a curve or a path passes states that are not admissible |
//! | [`walk`] | steps, runs and jumps along the curve, one request at a time |
//!
//! All numbers are in reduced units.

pub mod admissible;
pub mod ascent;
pub mod beyond;
pub mod curve;
pub mod descent;
pub mod energy;
pub mod equilibrium;
pub mod jump;
pub mod landscape;
pub mod monotone;
pub mod overlap;
pub mod path;
pub mod places;
pub mod profile;
pub mod start;
pub mod walk;

pub use admissible::Admissibility;
pub use curve::{Curve, CurveStop, Sample};
pub use equilibrium::{Equilibrium, Scales, Stability, State, StatePoint, Stiffness};
pub use landscape::Landscape;
pub use monotone::{Extremum, Limit, Monotone};
pub use overlap::Overlap;
pub use path::{Event, EventKind, Losses, Path, PathState, PathStop};
pub use places::Detail;
pub use profile::Profile;
pub use start::StartError;
