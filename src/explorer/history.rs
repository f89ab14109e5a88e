//! The walk as an append-only tree: undo moves a cursor, a step after undo makes a branch, nothing is erased.

use crate::case::Case;
use crate::contact::Control;
use crate::preset::Preset;
use crate::quasistatic::{Admissibility, Equilibrium, Event, Point, Stability, State, Stiffness};
use std::sync::Arc;

/// The problem a node was solved in: the parameters may change from node to node.
#[derive(Debug, Clone)]
pub struct Setting {
    /// The preset.
    pub preset: Preset,
    /// The preset made ready.
    pub case: Case,
    /// The equations with the scales of their curve.
    pub equilibrium: Equilibrium,
}

/// How a node came about.
#[derive(Debug, Clone, PartialEq)]
pub enum NodeKind {
    /// The start state.
    Start,
    /// A step.
    Step,
    /// A limit point of the control, located exactly.
    Limit,
    /// The landing of a jump, or `None` inside for a pull-off, with what it cost.
    Jump(Box<Event>),
    /// Moved to by hand: an event selected, the start again.
    Moved,
    /// Solved again after a parameter or the control had changed.
    Solved,
    /// Not solved after a change: the state before, with the reason.
    Stale(String),
}

/// Where the edge would land from a limit point, and what it would cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ahead {
    /// The landing, reduced; `None` where the bodies come apart.
    pub after: Option<State>,
    /// Energy lost, reduced; `None` for a pull-off under a dead load.
    pub dissipated: Option<f64>,
}

/// One state of the walk.
#[derive(Debug, Clone)]
pub struct Node {
    /// The node before.
    pub parent: Option<usize>,
    /// How it came about.
    pub kind: NodeKind,
    /// The problem it solves.
    pub setting: Arc<Setting>,
    /// The control it was reached under (reduced).
    pub control: Control,
    /// The point of the curve, in the scales of its setting.
    pub point: Point,
    /// The state, reduced.
    pub state: State,
    /// Steps since the start.
    pub step: usize,
    /// How force and area answer to the approach here, reduced.
    pub stiffness: Stiffness,
    /// At a limit point of the control: where the jump leads, if that is known.
    pub ahead: Option<Ahead>,
    /// Whether the state is admissible, and the nearest crest.
    pub admissibility: Admissibility,
    /// Decimal digits the basis can be trusted for here.
    pub digits: f64,
    /// The relative difference of P from the exact solution at the same contact radius.
    pub from_exact: f64,
    /// Whether a walk of its own begins here: at the start, at a restart, at a selected event.
    pub begins: bool,
    /// The number of the walk request that made it: what one command made has one number.
    pub request: u64,
}

impl Node {
    /// The slopes that tell the stability.
    pub fn stability(&self) -> Stability {
        self.setting.equilibrium.stability(&self.point)
    }

    /// The bodies are apart: the walk ends here.
    pub fn is_apart(&self) -> bool {
        matches!(&self.kind, NodeKind::Jump(event) if event.after.is_none())
    }

    /// A limit point under `control`.
    pub fn is_limit(&self, control: Control) -> bool {
        self.kind == NodeKind::Limit && self.control == control
    }
}

/// A place to come back to: a node, and the child last gone to from there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mark {
    cursor: Option<usize>,
    forward: Option<usize>,
}

/// The tree.
#[derive(Debug, Clone, Default)]
pub struct History {
    nodes: Vec<Node>,
    cursor: Option<usize>,
    /// For each node the child last gone to.
    forward: Vec<Option<usize>>,
}

impl History {
    /// The node the walker stands on.
    pub fn current(&self) -> Option<&Node> {
        self.nodes.get(self.cursor?)
    }

    /// Its number.
    pub fn cursor(&self) -> Option<usize> {
        self.cursor
    }

    /// The node before it.
    pub fn parent(&self) -> Option<usize> {
        self.current()?.parent
    }

    /// Where redo would go.
    pub fn redo_target(&self) -> Option<usize> {
        *self.forward.get(self.cursor?)?
    }

    /// All nodes ever made.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Appends a node behind the current one and stands on it.
    pub fn push(&mut self, mut node: Node) {
        node.parent = self.cursor;
        self.append(node);
    }

    /// Appends a node beside the current one: the same change made further is one undo.
    pub fn push_beside(&mut self, mut node: Node) {
        node.parent = self.parent();
        self.append(node);
    }

    fn append(&mut self, node: Node) {
        let at = self.nodes.len();
        if let Some(parent) = node.parent {
            self.forward[parent] = Some(at);
        }
        self.nodes.push(node);
        self.forward.push(None);
        self.cursor = Some(at);
    }

    /// Where the walker stands.
    pub fn mark(&self) -> Mark {
        Mark { cursor: self.cursor, forward: self.redo_target() }
    }

    /// Stands where it stood, as if nothing had been walked since; the nodes made since are kept.
    pub fn return_to(&mut self, mark: Mark) {
        self.cursor = mark.cursor;
        if let Some(at) = mark.cursor {
            self.forward[at] = mark.forward;
            if let Some(parent) = self.parent() {
                self.forward[parent] = Some(at);
            }
        }
    }

    /// Stands on the node before; false when there is none.
    pub fn undo(&mut self) -> bool {
        let Some(parent) = self.parent() else { return false };
        self.forward[parent] = self.cursor;
        self.cursor = Some(parent);
        true
    }

    /// Stands on the child last gone to; false when there is none.
    pub fn redo(&mut self) -> bool {
        let target = self.redo_target();
        if target.is_some() {
            self.cursor = target;
        }
        target.is_some()
    }

    /// The walk that led to the current node: from where it began, each node with its number.
    pub fn path(&self) -> Vec<(usize, &Node)> {
        let mut path = Vec::new();
        let mut at = self.cursor;
        while let Some((number, node)) = at.and_then(|i| Some((i, self.nodes.get(i)?))) {
            path.push((number, node));
            at = node.parent.filter(|_| !node.begins);
        }
        path.reverse();
        path
    }
}
