//! Effects: the work that the model asks for. Replies: what came of it.

use super::curve::{CurveData, ProblemCurve};
use super::fitting::{Distances, FitWish};
use super::job::{Done, Job};
use super::loops::{LoopData, LoopWish};
use super::maps::{MapData, MapWish};
use super::onset::SnapsFrom;
use super::profile::{Ask, Inside};
use super::progress::Stage;
use super::studies::{StudyData, StudyWish};
use super::walk::{Made, Outcome, Request};
use crate::mend::Reason;
use pulloff_engine::fit::Fit;
use pulloff_engine::preset::Preset;
use std::sync::Arc;

/// Work that the model asks for.
#[derive(Debug, Clone)]
pub enum Effect {
    /// Compute the curve of a preset; an older one still waiting is forgotten.
    Curve(Box<Wish>),
    /// Give up the curves and checks up to this number.
    StopCurve(u64),
    /// Check which states of a curve are admissible; dropped when another curve is wanted.
    Check(Check),
    /// Compute a loop of loading and unloading; an older one still waiting is forgotten.
    Loop(Box<LoopWish>),
    /// Compute a map of two numbers; an older one still waiting is forgotten.
    Map(Box<MapWish>),
    /// Fit the free keys of a preset to its measured curve.
    Fit(Box<FitWish>),
    /// End the fit of this number with the best so far.
    StopFit(u64),
    /// Find the distances of measured points; an older wish still waiting is forgotten.
    Distances(Box<FitWish>),
    /// Compute a study; an older one is given up.
    Study(Box<StudyWish>),
    /// End the study of this number; what is done of it stays.
    StopStudy(u64),
    /// Compute the inside of a state; an older one still waiting is forgotten.
    Profile(Box<Ask>),
    Walk(Box<Request>),
    /// The run goes on at so many states a second.
    Pace(f64),
    /// End the walk of this number; its states so far stay.
    StopWalk(u64),
    /// Compute the curve of a pin of a resumed session, by its number.
    Pin(usize, Box<Preset>),
    /// Cancel the curves of pins that are still to be computed.
    StopPins,
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

/// A curve whose admissibility is wanted.
#[derive(Debug, Clone)]
pub struct Check {
    pub id: u64,
    pub curve: Arc<CurveData>,
    /// Whether it is to be found from which amplitude on the problem snaps.
    pub with_onset: bool,
}

/// What came of it.
#[derive(Debug, Clone)]
pub enum Reply {
    Curve {
        id: u64,
        result: Result<Arc<CurveData>, Reason>,
    },
    Stage {
        id: u64,
        stage: Stage,
    },
    /// The same curve with what is not admissible on it, and where snaps begin if that was asked.
    Checked {
        id: u64,
        curve: Arc<CurveData>,
        snaps_from: Option<Arc<SnapsFrom>>,
    },
    Loop(Arc<LoopData>),
    Map(Arc<MapData>),
    /// A fit has come so far, in per cent.
    Fitting {
        id: u64,
        percent: u8,
    },
    Fitted {
        id: u64,
        result: Result<Arc<Fit>, Reason>,
    },
    Distances(Arc<Distances>),
    /// A study, or as much of it as is done.
    Study(Arc<StudyData>),
    Profile(Arc<Inside>),
    Walked {
        id: u64,
        made: Vec<Made>,
        /// How it ended; `None` while it goes on.
        outcome: Option<Outcome>,
    },
    /// The curve of a pin, by its number, or `None` where there is none any more.
    Pinned(usize, Option<Arc<CurveData>>),
    /// A message about the session for the person.
    Notice(String),
    File(Box<Done>),
}
