//! Adhesion with a range: one disc of contact in one zone, on which a constant tension acts (Dugdale).
//!
//! The tension σ₀ acts wherever the bodies are closer to each other than `h_c` = γ/σ₀. One number runs along the
//! equilibria, the outer edge c of the zone: from the far field (c = 0) through zones without contact to contact of
//! radius s < c.
//!
//! | file | what lives there |
//! |---|---|
//! | [`state`] | the equilibrium of a given zone |
//! | [`around`] | gap and pressure of a state, and whether one disc in one zone is all of it |
//! | [`equilibria`] | all equilibria, in panels over c that are grown outward on demand |
//!
//! Everything is in reduced units (E* = 1).

pub mod around;
pub mod equilibria;
pub mod state;

pub use around::{Ends, FaultKind, ZoneAt, ZoneFault};
pub use equilibria::Equilibria;
pub use state::{Zone, ZoneState};
