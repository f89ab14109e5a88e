//! The problem: two elastic bodies, the gap between them, their adhesion, and the device that loads them.
//!
//! | file | what lives there |
//! |---|---|
//! | [`gap`] | what the numerics ask of a gap: r → (h, h', h'', h''') |
//! | [`breaks`] | where a gap is not smooth, and Gauss's rule broken there |
//! | `lanes` | functions of many radii, four at a time |
//! | [`shape`] | the gap shapes a person can choose |
//! | [`shapes`] | one file per gap: its formula, its derivatives, its lengths |
//! | [`formula`] | gaps typed as formulas in r |
//! | [`panels`] | panels on which the slope of a gap is proved to be resolved |
//! | [`problem`] | E*, γ and a gap; reduced units E* = 1, lengths by the gap's own |
//! | [`groups`] | the dimensionless groups people quote |
//! | [`control`] | what the loading device prescribes |
//! | [`start`] | how the start of a path is given |

pub mod breaks;
#[cfg(test)]
mod complex;
pub mod control;
pub mod formula;
pub mod gap;
pub mod groups;
pub(crate) mod lanes;
pub mod panels;
pub mod problem;
pub mod shape;
pub mod shapes;
pub mod start;

pub use breaks::{Axis, Breaks};
pub use control::Control;
pub use gap::{Disc, Form, Gap, Jet, Piece, Wave};
pub use groups::Groups;
pub use problem::{Problem, Reduced, Units};
pub use shape::Shape;
pub use start::Start;
