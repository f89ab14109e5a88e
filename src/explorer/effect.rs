//! Effects: the work that the model asks for. Replies: what came of it.

use super::curve::{CurveData, ProblemCurve};
use super::job::{Done, Job};
use super::progress::CurveStage;
use super::results::{Found, Task};
use super::walk::{MadeState, Request, WalkOutcome};
use crate::mend::WordedFault;
use pulloff_engine::preset::Preset;
use std::sync::Arc;

/// Work that the model asks for.
#[derive(Debug, Clone)]
pub enum Effect {
    /// Compute the curve of a preset; an older one still waiting is forgotten.
    Curve(Box<Wish>),
    /// Give up the curves up to this number.
    StopCurve(u64),
    /// Compute a result; an older one of its kind still waiting is forgotten.
    Compute(Task),
    /// Stop the result of this kind up to this number; what is done of it may still come.
    Stop {
        name: &'static str,
        id: u64,
    },
    Walk(Box<Request>),
    /// The run goes on at so many states a second.
    Pace(f64),
    /// End the walk of this number; its states so far stay.
    StopWalk(u64),
    File(Box<Job>),
}

/// A curve that is wanted.
#[derive(Debug, Clone)]
pub struct Wish {
    pub id: u64,
    pub preset: Preset,
    /// The curve of the same problem, where it is known: then only what belongs to the control is computed.
    pub base: Option<Arc<ProblemCurve>>,
}

/// What came of it.
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
    /// A result, or as much of it as is done.
    Found(Found),
    Walked {
        id: u64,
        made: Vec<MadeState>,
        /// How it ended; `None` while it goes on.
        outcome: Option<WalkOutcome>,
    },
    /// A message about the session for the person.
    Notice(String),
    File(Box<Done>),
}
