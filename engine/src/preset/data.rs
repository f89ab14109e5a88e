//! The table `[data]`: a measured curve that belongs to a preset, and what lies between the instrument and the model.
//!
//! The stiffness of the instrument is given by `path.control.stiffness` alone. A file that states one supplies it to a
//! preset whose `path.control` is not given. If both give one, they must agree, and so must the tip radii, unless only
//! the preset counts.

use crate::measured::points::Turned;
use crate::measured::{Branches, FreePart, Instrument, PointsFile, Segment};
use std::sync::Arc;

/// The key of the file.
pub const FILE: &str = "data.file";
/// The key of δ₀, the x at which the approach is zero.
pub const OFFSET: &str = "data.offset";
/// The key of P₀, the force reading that means zero force.
pub const BASELINE: &str = "data.baseline";
/// The key of P₀ as far as a fit has found it where no rows show it: it is only where the next fit starts.
pub const TARE: &str = "data.tare";
/// The key of the slope of P₀.
pub const TILT: &str = "data.tilt";
/// The key of what the columns are.
pub const COLUMNS: &str = "data.columns";
/// The key of the branch to which the points are restricted.
pub const SEGMENT: &str = "data.segment";
/// The key of which rows are apart.
pub const FREE_PART: &str = "data.free_part";
/// The key of the direction of the columns.
pub const SIGNS: &str = "data.signs";
/// The key of how many rows at the beginning are left out.
pub const SKIP: &str = "data.skip";
/// The key of the keys that a fit may change.
pub const FREE: &str = "data.free";
/// The key of the values that are given with an error.
pub const UNCERTAIN: &str = "data.uncertain";
/// The key that says whether the file or the preset counts for the instrument.
pub const SETTINGS: &str = "data.settings";
/// The keys of what holds for one file only: how it is read, and where its zeros are.
pub const OF_FILE: [&str; 9] = [COLUMNS, SEGMENT, FREE_PART, SIGNS, SKIP, OFFSET, BASELINE, TARE, TILT];
/// The words of [`SETTINGS`].
pub const SETTINGS_OF: [&str; 2] = ["file", "preset"];
/// The words of [`SEGMENT`].
pub const SEGMENTS: [&str; 2] = ["approach", "retraction"];

/// A measured curve and how it is laid over the model's curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DataSpec {
    /// The file, if there is one.
    pub source: Option<Arc<PointsFile>>,
    /// What its columns are, as the user specifies; empty leaves it to its header.
    pub columns: String,
    /// Whether the stiffness and the tip radius that the file states are ignored.
    pub is_alone: bool,
    /// δ₀, in the numbers of the file whatever the signs of its columns, as the next three; `None` is 0.
    pub offset: Option<f64>,
    /// P₀; `None` leaves it to the free part.
    pub baseline: Option<f64>,
    /// P₀ where neither that nor a free part says it, as a fit has found it; `None` is 0.
    pub tare: Option<f64>,
    /// The slope of P₀ over x; `None` is 0.
    pub tilt: Option<f64>,
    /// The branch to which the points are restricted.
    pub segment: Option<Segment>,
    /// Which rows are apart, as the user specifies; empty leaves them to be found.
    pub free_part: String,
    /// The same in base units.
    pub apart: FreePart,
    /// Whether the signs of x and P are reversed; `None` leaves it to the points.
    pub turned: Option<Turned>,
    /// How many rows at the beginning are left out.
    pub skip: usize,
    /// The keys that a fit may change, dotted or by their letters, separated by commas.
    pub free: String,
    /// The values that are given with an error: `path.control.stiffness=10%`, separated by commas.
    pub uncertain: String,
}

impl DataSpec {
    /// The same without the file, and without what holds for it alone.
    #[must_use]
    pub fn without_file(&self) -> Self {
        let Self { is_alone, free, uncertain, .. } = self.clone();
        Self { is_alone, free, uncertain, ..Self::default() }
    }

    /// What lies between model and instrument, in the signs of `branches`: what is not given is 0, and the baseline that
    /// of the free part, or the tare.
    pub fn instrument(&self, branches: &Branches) -> Instrument {
        let or_zero = |value: Option<f64>| value.unwrap_or(0.0);
        let [offset, baseline, tilt] = [self.offset, self.baseline.or(self.tare), self.tilt].map(or_zero);
        let given = Instrument { offset, baseline, tilt }.turned(branches.turned);
        let found = branches.baseline.filter(|_| self.baseline.is_none());
        Instrument { baseline: found.unwrap_or(given.baseline), ..given }
    }

    /// The keys that a fit may change.
    pub fn free(&self) -> impl Iterator<Item = &str> {
        self.free.split(',').map(str::trim).filter(|key| !key.is_empty())
    }
}
