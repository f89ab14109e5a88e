//! One connected disc, exactly: the transform of its gap, tabulated.
//!
//! | file | what lives there |
//! |---|---|
//! | [`table`] | the table of g: panels with their series, grown outward when asked |
//! | [`panels`] | its panels, and what is read from them |
//! | `spans` | the panels of a gap before there is a table on them |
//! | [`blend`] | tables of mixtures of gaps |
//! | [`sources`] | g of any gap, from samples of its slope |
//! | [`clusters`] | sums over many panels, seen from far away |
//! | [`waves`] | g of a paraboloid with waves |
//! | [`cubic`] | g of a gap that is cubic between knots |
//! | [`law`] | g of a power of r, in closed form |
//! | [`basis`] | what the program needs from a way to compute a disc |
//! | [`exact`] | the basis that reads the table |
//! | [`solution`] | the equilibria over all radii, from the table |
//! | [`sampled`] | the same, computed radius by radius |
//! | [`outside`] | the gap around a disc and the pressure under it |
//! | [`span`] | places on a panel |
//! | [`chebyshev`] | series, their integrals and their roots |
//!
//! Everything is in reduced units (E* = 1).

pub mod basis;
pub mod blend;
pub mod chebyshev;
pub mod clusters;
pub mod cubic;
pub mod exact;
pub mod law;
pub mod outside;
pub mod panels;
pub mod sampled;
pub mod solution;
pub mod sources;
pub mod span;
mod spans;
pub mod table;
pub mod waves;

pub use basis::{Basis, Evaluation, Order};
pub use exact::ExactBasis;
pub use panels::{Panel, Panels, TransformValues};
pub use solution::{Edges, ExactSolution, Local, Solution};
pub use span::Place;
pub use spans::TableError;
pub use table::Table;
