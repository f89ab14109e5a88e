//! Where snaps begin: the law of stability of one disc, and its limit points in two parameters.
//!
//! | file | what lives there |
//! |---|---|
//! | [`weight`] | `W_k`, the weight of a loading device |
//! | [`law`] | `γ_k(s)`, the law itself, and its cusps |
//! | [`axis`] | one number of a preset over a range |
//! | [`family`] | a preset with one or two numbers left open |
//! | [`count`] | the snaps of a path, and where their number changes |
//! | [`explicit`] | lines of cusps that follow from s |
//! | [`equations`] | cusps, landings, starts and folds as systems for the tracer |
//! | [`lines`] | lines followed by the tracer |
//! | [`edges`] | makes sure a line runs between neighbouring cells of a map whose snaps differ |
//! | [`map`] | the lines of two numbers, and the snaps in every cell |
//! | [`folds`] | the limit points as functions of one number |
//! | [`onset`] | the smallest amplitude at which a preset snaps |
//!
//! The law is that of the exact equation of one disc; presets in ring elements are judged by it all the same.

pub mod axis;
pub mod count;
pub mod edges;
pub mod equations;
pub mod explicit;
pub mod family;
pub mod folds;
pub mod law;
pub mod lines;
pub mod map;
pub mod onset;
pub mod weight;

pub use axis::{AxisError, COMPLIANCE, MapAxis, Spacing};
pub use count::{Cause, Change, Passage, even};
pub use equations::{Equations, Sort};
pub use family::{Family, FamilyError};
pub use folds::{FoldLine, Folds};
pub use law::{Cusp, Law};
pub use map::{Counts, Map, MapLine, MapPoint};
pub use onset::Onset;
