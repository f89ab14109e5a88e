//! What a fit makes of the rows of a file, counted by branch and part.

use super::problem::{Datum, FitProblem};
use crate::measured::{Branches, Segment};
use serde::Serialize;

/// How many rows of one branch there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct BranchRows {
    /// Those in contact, which are fitted.
    pub contact: usize,
    /// Those apart, which are fitted.
    pub free: usize,
    /// Those within the jump between the two, which belong to neither.
    pub jump: usize,
    /// Those left out: on request, as repeated, or with the whole branch.
    pub dropped: usize,
}

/// How many rows there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Rows {
    /// Of the approach.
    pub approach: BranchRows,
    /// Of the retraction.
    pub retraction: BranchRows,
    /// Of pauses, which are left out.
    pub pause: usize,
}

impl Rows {
    /// The rows of `branches`, of which those of `problem` are fitted.
    pub(super) fn of(problem: &FitProblem, branches: &Branches) -> Self {
        let of = |segment: Segment, all: usize| {
            let count = |free: bool| {
                let is_of = |datum: &&Datum| datum.segment == segment && datum.free == free;
                problem.data.iter().filter(is_of).count()
            };
            let [contact, free] = [false, true].map(count);
            let list = branches.list.iter().filter(|branch| branch.segment == segment);
            // The rows of a branch that is left out as a whole play no part.
            let jump = if contact + free > 0 { list.map(|branch| branch.jump).sum() } else { 0 };
            BranchRows { contact, free, jump, dropped: all.saturating_sub(contact + free + jump) }
        };
        let [approach, retraction] = branches.rows;
        Self {
            approach: of(Segment::Approach, approach),
            retraction: of(Segment::Retraction, retraction),
            pause: branches.pauses,
        }
    }

    /// The branches with their names.
    pub fn branches(&self) -> [(&'static str, BranchRows); 2] {
        [(Segment::Approach.name(), self.approach), (Segment::Retraction.name(), self.retraction)]
    }

    /// How many rows in contact are fitted.
    pub fn contact(&self) -> usize {
        self.approach.contact + self.retraction.contact
    }

    /// How many rows are fitted.
    pub fn fitted(&self) -> usize {
        self.contact() + self.approach.free + self.retraction.free
    }

    /// How many rows there are.
    pub fn all(&self) -> usize {
        let of = |(_, rows): (_, BranchRows)| rows.contact + rows.free + rows.jump + rows.dropped;
        self.branches().map(of).iter().sum::<usize>() + self.pause
    }
}
