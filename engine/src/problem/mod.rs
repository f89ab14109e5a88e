//! The problem: two elastic bodies, the gap between them, their adhesion, and the device that loads them.
//!
//! | file | what lives there |
//! |---|---|
//! | [`reduced`] | E*, γ and a gap; reduced units: E* = 1, lengths in units of the gap's own length |
//! | [`groups`] | the dimensionless groups in common use |
//! | [`cohesion`] | adhesion with a range |
//! | [`control`] | what the loading device prescribes |
//! | [`printer`] | reduced numbers in sentences |
//! | [`programme`] | what a test does with the control, part by part |
//! | [`start`] | how the start of a path is given |
//! | [`turn`] | where a path turns round, and which contacts it follows |

pub mod cohesion;
pub mod control;
pub mod groups;
pub mod printer;
pub mod programme;
pub mod reduced;
pub mod start;
pub mod turn;

pub use cohesion::{Adhesion, Cohesion, StatedCohesion};
pub use control::Control;
pub use groups::Groups;
pub use printer::Printer;
pub use programme::Part;
pub use reduced::{Problem, Reduced, Units};
pub use start::{Begin, Start};
pub use turn::{ContactKind, Turn};
