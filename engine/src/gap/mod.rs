//! The gap between the undeformed bodies: r → h(r), its derivatives, and what is known about it as a function.
//!
//! | file | what lives there |
//! |---|---|
//! | [`function`] | what the numerics need from a gap: r → (h, h', h'', h''') |
//! | [`breaks`] | where a gap is not smooth, and Gauss's rule split at those radii |
//! | `lanes` | functions of many radii, four at a time |
//! | [`shape`] | the gap shapes a user can choose |
//! | [`shapes`] | one file per gap: its formula, its derivatives, its lengths |
//! | [`formula`] | gaps typed as formulas in r |
//! | [`panels`] | panels on which the slope of a gap is provably resolved |

pub mod breaks;
#[cfg(test)]
mod fixtures;
pub mod formula;
pub mod function;
pub(crate) mod lanes;
pub mod panels;
pub mod shape;
pub mod shapes;

pub use breaks::{Breaks, Parity};
pub use function::{ComplexDisc, Form, Gap, Jet, Piece, Wave, wave_index};
pub use shape::Shape;
