//! The problem: two elastic bodies, the gap between them, their adhesion, and the device that loads them.
//!
//! | file | what lives there |
//! |---|---|
//! | [`reduced`] | E*, γ and a gap; reduced units E* = 1, lengths by the gap's own |
//! | [`groups`] | the dimensionless groups people quote |
//! | [`control`] | what the loading device prescribes |
//! | [`start`] | how the start of a path is given |
//! | [`turn`] | where a path turns round, which contacts it follows |

pub mod control;
pub mod groups;
pub mod reduced;
pub mod start;
pub mod turn;

pub use control::Control;
pub use groups::Groups;
pub use reduced::{Problem, Reduced, Units};
pub use start::{Begin, Start};
pub use turn::{ContactKind, Turn};
