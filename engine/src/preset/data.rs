//! The table `[data]`: a measured curve that belongs to a preset, and what lies between the instrument and the model.
//!
//! The stiffness of the instrument is `path.control.stiffness` alone. A file that states one gives it to a preset whose
//! `path.control` says nothing; where both say one they must agree, as must the radii of the tip, unless the preset alone
//! counts.

use crate::measured::points::Turned;
use crate::measured::{FreePart, PointsFile, Segment};
use std::sync::Arc;

/// The key of the file.
pub const FILE: &str = "data.file";
/// The key of δ₀, the x at which the approach is zero.
pub const OFFSET: &str = "data.offset";
/// The key of P₀, the force that is none.
pub const BASELINE: &str = "data.baseline";
/// The key of the slope of P₀.
pub const TILT: &str = "data.tilt";
/// The key of what the columns are.
pub const COLUMNS: &str = "data.columns";
/// The key of the branch that is used alone.
pub const SEGMENT: &str = "data.segment";
/// The key of which rows are apart.
pub const FREE_PART: &str = "data.free_part";
/// The key of which way the columns run.
pub const SIGNS: &str = "data.signs";
/// The key of how many rows at the beginning are left out.
pub const SKIP: &str = "data.skip";
/// The key of the keys that a fit may change.
pub const FREE: &str = "data.free";
/// The key of the values that are given with an error.
pub const UNCERTAIN: &str = "data.uncertain";
/// The key of whose word counts of the instrument.
pub const SETTINGS: &str = "data.settings";
/// The words of [`SETTINGS`].
pub const SETTINGS_OF: [&str; 2] = ["file", "preset"];
/// The words of [`SEGMENT`].
pub const SEGMENTS: [&str; 2] = ["approach", "retraction"];

/// A measured curve and how it is laid over the model's.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DataSpec {
    /// The file, where there is one.
    pub source: Option<Arc<PointsFile>>,
    /// What its columns are, as a person says it; empty leaves it to its header.
    pub columns: String,
    /// Whether the stiffness and the tip radius that the file states are left out.
    pub is_alone: bool,
    /// δ₀; `None` is 0.
    pub offset: Option<f64>,
    /// P₀; `None` leaves it to the free part.
    pub baseline: Option<f64>,
    /// The slope of P₀ over x; `None` is 0.
    pub tilt: Option<f64>,
    /// The branch that is used alone.
    pub segment: Option<Segment>,
    /// Which rows are apart, as a person says it; empty leaves them to be found.
    pub free_part: String,
    /// The same in base units.
    pub apart: FreePart,
    /// Whether the signs of x and P are turned; `None` leaves it to the points.
    pub turned: Option<Turned>,
    /// How many rows at the beginning are left out.
    pub skip: usize,
    /// The keys that a fit may change, dotted or by their letters, with commas between.
    pub free: String,
    /// The values that are given with an error: `path.control.stiffness=10%`, with commas between.
    pub uncertain: String,
}

impl DataSpec {
    /// The keys that a fit may change.
    pub fn free(&self) -> impl Iterator<Item = &str> {
        self.free.split(',').map(str::trim).filter(|key| !key.is_empty())
    }
}
