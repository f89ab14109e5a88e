//! Effects: the work that the model requests. Replies: the outcome of that work.

use super::curve::{CurveData, ProblemCurve};
use super::job::{Done, Job};
use super::node::Node;
use super::progress::CurveStage;
use super::results::{Found, Task};
use super::walk::{Request, WalkOutcome};
use crate::mend::WordedFault;
use pulloff_engine::preset::Preset;
use std::sync::Arc;

/// Work that the model requests.
#[derive(Debug, Clone)]
pub enum Effect {
    /// Compute the curve of a preset; an older request still waiting is dropped.
    Curve(Box<Wish>),
    /// Give up the curves up to this number.
    StopCurve(u64),
    /// Compute a result; an older request of its kind still waiting is dropped.
    Compute(Task),
    /// Stop the results of this kind up to this number; what is done of them may still arrive.
    Stop {
        name: &'static str,
        id: u64,
    },
    Walk(Box<Request>),
    /// The run continues at this many states per second.
    Pace(f64),
    /// End the walk with this number; its states so far stay.
    StopWalk(u64),
    File(Box<Job>),
}

/// A curve that is wanted.
#[derive(Debug, Clone)]
pub struct Wish {
    pub id: u64,
    pub preset: Preset,
    /// The curve of the same problem, if known: then only what belongs to the control is computed.
    pub base: Option<Arc<ProblemCurve>>,
}

/// The outcome of an effect.
#[derive(Debug, Clone)]
pub enum Reply {
    Curve {
        id: u64,
        result: Result<Arc<CurveData>, WordedFault>,
    },
    Stage {
        id: u64,
        stage: CurveStage,
    },
    /// A result, or the part of it that is done.
    Found(Found),
    Walked {
        id: u64,
        made: Vec<Node>,
        /// How it ended; `None` while it continues.
        outcome: Option<WalkOutcome>,
    },
    /// A message about the session for the person.
    SessionSaved(Result<(), String>),
    File(Box<Done>),
}
