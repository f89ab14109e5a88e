//! What a walk arrives at, and how its requests end.

use crate::continuation::StepFailure;
use crate::quasistatic::path::Event;
use crate::quasistatic::{Admissibility, Stability, State, StatePoint, Stiffness};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Where the edge would land from a limit point, and what it would cost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ahead {
    /// The landing; `None` where the bodies come apart.
    pub after: Option<State>,
    /// The energy lost; `None` for a pull-off under a dead load.
    #[serde(with = "crate::exact")]
    pub dissipated: Option<f64>,
}

/// How the walker came to a state.
#[derive(Debug, Clone, PartialEq)]
pub enum Arrival {
    /// By a step.
    Step,
    /// At a limit point of the control, with where the jump from there leads, if that is known.
    Limit(Option<Ahead>),
    /// Where the next crest touches, at this radius, a length: from here on the real path has a ring.
    Touch(f64),
    /// By a jump.
    Jump(Box<Event>),
    /// Moved to a contact radius.
    Moved,
    /// Solved again for a changed problem.
    Solved,
}

/// How a request ended.
#[derive(Debug, Clone, PartialEq)]
pub enum WalkEnd {
    /// Done as asked.
    Done,
    /// At a limit point of the control.
    AtLimit,
    /// Where a crest touches.
    AtTouch,
    /// The receiver of the states did not want more.
    Paused,
    /// At the end contact radius.
    AtEnd,
    /// At the end of the path along which it goes.
    PathEnds,
    /// The branch ends: two edges meet at this radius, a length.
    EdgesMeet(f64),
    /// The branch ends: the width of the contact at this radius, a length, goes to nothing.
    Vanishes(f64),
    /// At three times the start radius.
    OutOfRange,
}

/// Why a walk cannot go on.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum WalkFailure {
    /// There is no state to begin with.
    #[error("there is no state to {0} from")]
    NoState(&'static str),
    /// The curve has no such state.
    #[error("there is no equilibrium {0}")]
    NoEquilibrium(&'static str),
    /// No step by arc length.
    #[error(transparent)]
    Step(#[from] StepFailure),
    /// The basis has no equilibrium where the walker stands.
    #[error("the basis has no equilibrium here")]
    NoBasis,
    /// The potential would have to rise on the way.
    #[error("the edge cannot run to the next stable state: on the way the potential rises")]
    Rises,
    /// The edge runs outward and finds no stable state.
    #[error("no stable state further out at this control value")]
    NothingOutward,
    /// The edge runs inward beyond what the basis can tell.
    #[error("the basis has no equilibrium further in: the landing is not known")]
    NothingInward,
    /// There is no first touch.
    #[error("the gap has no minimum: the bodies never touch")]
    NeverTouches,
    /// Nothing runs from here.
    #[error("this state is stable: its edges do not run")]
    Stable,
    /// A state with rings could not be found.
    #[error("the edges could not be followed: {0}")]
    Edges(String),
    /// The changed problem has no state near the old one.
    #[error("no equilibrium at this control value near the old contact radius")]
    NotSolved,
}

/// How a request ended, or why it could not go on.
pub type Walked = Result<WalkEnd, WalkFailure>;

/// A state that a walk arrived at, with what is known about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reached {
    /// How it was reached.
    pub arrival: Arrival,
    /// The state with the frame of the curve there: δ, P and the edges from the axis outward, in the scales of the curve. With rings its
    /// tangent is that of a walk inward.
    pub point: StatePoint,
    /// δ, P, U and the outermost edge.
    pub state: State,
    /// The slopes that decide its stability.
    pub stability: Stability,
    /// dP/dδ and dA/dδ.
    pub stiffness: Stiffness,
    /// Whether the bodies stay apart where they are not in contact.
    pub admissibility: Admissibility,
    /// Decimal digits of the edges.
    pub digits: f64,
    /// For a walk along a path, the number of the state on it, from 0.
    pub on_path: Option<usize>,
}

/// Takes the states of a walk, and says whether it is to go on.
pub type Emit<'a> = dyn FnMut(Reached) -> bool + 'a;
