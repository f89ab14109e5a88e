//! Where a walker stands.

use crate::annuli::Ground;
use crate::problem::{ContactKind, Control};
use crate::progress::Unwatched;
use crate::quasistatic::curve::Curve;
use crate::quasistatic::equilibrium::Equilibrium;
use crate::quasistatic::path::course::on_ground;
use crate::quasistatic::path::{Balance, PathError};
use crate::quasistatic::{StatePoint, walk::arrival::WalkFailure, walk::edges};

/// A walk leaves the range of the curve by at most this factor in the contact radius.
pub const ROOM: f64 = 3.0;

/// The table of the gap goes beyond the outermost edge by this factor.
const BEYOND: f64 = 1.3;

/// What a walker stands on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum At {
    /// Nothing that a step would end at.
    Nothing,
    /// A limit point of the control.
    Limit,
    /// A crest that touches at this radius, a length.
    Touch(f64),
}

/// Where a walker stands, and how it goes.
#[derive(Debug, Clone, Copy)]
pub struct Walk<'a> {
    /// The curve of the problem.
    pub curve: &'a Curve,
    /// The contact radii between which the curve is asked for: its start and its end.
    pub range: [f64; 2],
    /// What is controlled.
    pub control: Control,
    /// Where the walker stands; only moves need no such state.
    pub from: Option<&'a StatePoint>,
    /// What it stands on.
    pub at: At,
    /// Whether the contact is to shrink.
    pub inward: bool,
    /// The longest step, in the scaled unknowns.
    pub length: f64,
}

impl Walk<'_> {
    pub(super) fn equilibrium(&self) -> &Equilibrium {
        &self.curve.equilibrium
    }

    /// The same walk, with the walker standing elsewhere.
    pub(super) fn standing<'b>(&'b self, from: &'b StatePoint, at: At) -> Walk<'b> {
        Walk { from: Some(from), at, ..*self }
    }

    /// The state to begin with; `what` names the request in the error.
    pub(super) fn begun(&self, what: &'static str) -> Result<&StatePoint, WalkFailure> {
        self.from.ok_or(WalkFailure::NoState(what))
    }

    /// Whether it stands in a contact with rings.
    pub(super) fn has_rings(&self) -> bool {
        self.from.is_some_and(edges::has_rings)
    }

    /// The gap out to where, with an outermost edge at `radius` and the approach `delta`, something could touch.
    pub(super) fn ground(&self, radius: f64, delta: f64) -> Result<Ground, WalkFailure> {
        let ground = self.on_ground(radius, delta, &|ground| Ok(ground.clone()), &|_| delta);
        ground.map_err(|error| WalkFailure::Edges(error.to_string()))
    }

    /// What `find` finds on that gap, or on more of it where it needs more; `highest` gives the largest approach of
    /// the result.
    pub(super) fn on_ground<T>(
        &self,
        radius: f64,
        delta: f64,
        find: &dyn Fn(&Ground) -> Result<T, PathError>,
        highest: &dyn Fn(&T) -> f64,
    ) -> Result<T, PathError> {
        let far_enough =
            |ground: &Ground| BEYOND * ground.can_touch_up_to(delta).max(radius) <= ground.reach();
        let reach = BEYOND * radius.max(self.range[0]);
        on_ground(&self.equilibrium().table, reach, &far_enough, &Unwatched, find, highest)
    }

    /// The balance of contacts on `ground` under `control`.
    pub(super) fn balance<'a>(&self, ground: &'a Ground, control: Control) -> Balance<'a> {
        Balance {
            ground,
            work_of_adhesion: self.equilibrium().problem.work_of_adhesion,
            control,
            contact: ContactKind::Rings,
            progress: &Unwatched,
            lane: None,
            pinned: None,
        }
    }
}
