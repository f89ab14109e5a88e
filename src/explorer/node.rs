//! One state of the walk.

use super::setting::Setting;
use pulloff_engine::annuli::Contacts;
use pulloff_engine::problem::Control;
use pulloff_engine::quasistatic::walk::{Ahead, At, edges};
use pulloff_engine::quasistatic::{Admissibility, Event, Stability, State, StatePoint, Stiffness};
use std::sync::Arc;

/// How a node came about.
#[derive(Debug, Clone, PartialEq)]
pub enum NodeKind {
    Start,
    Step,
    /// A limit point of the control, located exactly.
    Limit,
    /// Where the crest at this radius (reduced) touches, located exactly: from here on the real path has a ring.
    Touch(f64),
    /// The landing of a jump, or `None` inside for a pull-off, with what it cost.
    Jump(Box<Event>),
    /// Moved to by hand: an event selected, the start again.
    Moved,
    /// Solved again after a parameter or the control had changed.
    Solved,
    /// Not solved after a change: the state before, with the reason.
    Stale(String),
}

/// One state of the walk.
#[derive(Debug, Clone)]
pub struct Node {
    /// The node before.
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
    /// At a limit point of the control: where the jump leads, if that is known.
    pub ahead: Option<Ahead>,
    /// Whether the state is admissible, and the nearest crest.
    pub admissibility: Admissibility,
    /// Decimal digits the basis can be trusted for here.
    pub digits: f64,
    /// The relative difference of P from the exact solution of one disc at the same contact radius; not a number with rings.
    pub from_exact: f64,
    /// The number of the state on the path along which the walker goes, from 0; `None` where it goes along the curve.
    pub on_path: Option<usize>,
    /// Whether a walk of its own begins here: at the start, at a restart, at a selected event.
    pub begins: bool,
    /// The number of the walk request that made it: what one command made has one number.
    pub request: u64,
}

impl Node {
    /// Whether there is more than a disc.
    pub fn has_rings(&self) -> bool {
        edges::has_rings(&self.point)
    }

    /// Where the bodies touch, reduced lengths.
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
        matches!(&self.kind, NodeKind::Jump(event) if event.after.is_none())
    }

    /// Of an inadmissible state, the reduced r at fault, with the crest that would touch there (and its number), or
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
