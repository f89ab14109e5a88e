//! One state of the walk.

use super::setting::Setting;
use pulloff_engine::annuli::Contacts;
use pulloff_engine::exact;
use pulloff_engine::problem::Control;
use pulloff_engine::quasistatic::path::EventKind;
use pulloff_engine::quasistatic::walk::{Ahead, At, edges};
use pulloff_engine::quasistatic::{Admissibility, Event, Stability, State, StatePoint, Stiffness};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// How a node came about.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NodeKind {
    Start,
    Step,
    /// A limit point of the control, located exactly.
    Limit,
    /// Where the crest at this radius (reduced) touches, located exactly: from here on, the real path has a ring.
    Touch(#[serde(with = "exact")] f64),
    /// The landing of a jump, or `None` inside for a pull-off, with the energy lost.
    Jump(Box<Event>),
    /// Moved to by hand: a selected event, or the start again.
    Moved,
    /// Solved again after a parameter or the control had changed.
    Solved,
    /// Not solved after a change: the previous state, with the reason.
    Stale(String),
}

/// The place of a state in the [journal](super::journal).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trace {
    /// The number of its origin, and how many states that had made with it.
    pub origin: usize,
    pub made: usize,
    /// The direction in which the walker leaves it, where the request does not determine that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inward: Option<bool>,
}

/// One state of the walk.
#[derive(Debug, Clone)]
pub struct Node {
    /// The previous node.
    pub parent: Option<usize>,
    pub kind: NodeKind,
    pub setting: Arc<Setting>,
    /// The control it was reached under (reduced).
    pub control: Control,
    /// The point of the curve, in the scales of its setting.
    pub point: StatePoint,
    /// The state, reduced; its contact radius is the outermost edge.
    pub state: State,
    /// The slopes that decide the stability, reduced.
    pub stability: Stability,
    pub step: usize,
    /// dP/dδ and dA/dδ here, reduced.
    pub stiffness: Stiffness,
    /// At a limit point of the control: where the jump leads, if known.
    pub ahead: Option<Ahead>,
    /// Whether the state is admissible, and the nearest crest.
    pub admissibility: Admissibility,
    /// Decimal digits to which the basis can be trusted here.
    pub digits: f64,
    /// The relative difference of P from the exact solution of one disc at the same contact radius; not a number with rings.
    pub from_exact: f64,
    /// The number, from 0, of the state on the path that the walker follows; `None` if it follows the curve.
    pub on_path: Option<usize>,
    /// Whether a new walk begins here: at the start, at a restart, at a selected event.
    pub begins: bool,
    /// The number of the walk request that made it: all states made by one command share a number.
    pub request: u64,
    /// Its place in the journal, which is known once it is in the tree.
    pub trace: Trace,
}

impl Node {
    /// The state as it is shown, in the user's units: what rounding leaves of a force or an approach of zero is zero.
    pub fn seen(&self) -> State {
        /// In units of the scales of the curve.
        const NOISE: f64 = 1e-13;
        let scales = &self.setting.scales;
        let clean = |x: f64, scale: f64| if x.abs() < NOISE * scale { 0.0 } else { x };
        let (approach, force) = (self.state.approach, self.state.force);
        let (approach, force) = (clean(approach, scales.approach), clean(force, scales.force));
        State { approach, force, ..self.state }.in_units(self.setting.units())
    }

    /// Whether there is more than a disc.
    pub fn has_rings(&self) -> bool {
        edges::has_rings(&self.point)
    }

    /// Where the bodies touch, in reduced lengths.
    pub fn contacts(&self) -> Contacts {
        edges::contacts(&self.setting.scales, &self.point)
    }

    /// What the walker stands on under `control`.
    pub fn at(&self, control: Control) -> At {
        match self.kind {
            NodeKind::Touch(radius) => At::Touch(radius),
            _ if self.is_limit(control) => At::Limit,
            _ => At::Nothing,
        }
    }

    /// The bodies are apart: the walk ends here.
    pub fn is_apart(&self) -> bool {
        self.parted_by().is_some()
    }

    /// The event by which the bodies came apart, in words.
    pub fn parted_by(&self) -> Option<&'static str> {
        match &self.kind {
            NodeKind::Jump(event) if event.after.is_none() && event.kind == EventKind::SnapOff => {
                Some("snap-off")
            }
            NodeKind::Jump(event) if event.after.is_none() => Some("last contact"),
            _ => None,
        }
    }

    /// For an inadmissible state, the reduced r at fault, with the crest that would touch there (and its number), or
    /// `None` where the disc would have to pull.
    pub fn fault_radius(&self) -> Option<(f64, Option<Option<u64>>)> {
        let found = self.admissibility;
        if found.holds || self.is_apart() {
            return None;
        }
        match found.overlapping() {
            Some(crest) => Some((crest.radius, Some(crest.wave))),
            None => found.least_pressure.map(|(radius, _)| (radius, None)),
        }
    }

    /// A limit point under `control`.
    pub fn is_limit(&self, control: Control) -> bool {
        self.kind == NodeKind::Limit && self.control == control
    }
}
