//! The walk of a session: every node, in the order in which they were made.
//!
//! A node holds what cannot be recovered without its curve: its unknowns, the frame of the curve there, its energy and
//! what the basis said of it. The state follows from the unknowns and their scales, which are powers of two.

use crate::explorer::history::History;
use crate::explorer::node::{Node, NodeKind, Trace};
use crate::explorer::setting::Setting;
use pulloff_engine::annuli::MOST_CONTACTS;
use pulloff_engine::continuation::Columns;
use pulloff_engine::exact;
use pulloff_engine::quasistatic::walk::{Ahead, edges};
use pulloff_engine::quasistatic::{Admissibility, Stability, State, StatePoint, Stiffness};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The number of unknowns of a disc, and of the most contacts.
const FEWEST: usize = 3;
const MOST: usize = 2 + 2 * MOST_CONTACTS;

/// A node.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct SavedNode {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    parent: Option<usize>,
    kind: NodeKind,
    setting: usize,
    step: usize,
    /// δ, P and every edge, scaled; then the tangent and the curvature, as many numbers each.
    #[serde(with = "exact")]
    columns: Vec<f64>,
    positive: bool,
    #[serde(with = "exact")]
    length: f64,
    #[serde(with = "exact")]
    turning: f64,
    rounds: usize,
    #[serde(with = "exact")]
    energy: f64,
    stability: Stability,
    stiffness: Stiffness,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    ahead: Option<Ahead>,
    admissibility: Admissibility,
    #[serde(with = "exact")]
    digits: f64,
    #[serde(with = "exact")]
    from_exact: f64,
    /// The number of the state on the path along which it was walked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    on_path: Option<usize>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    begins: bool,
    request: u64,
    trace: Trace,
}

impl SavedNode {
    fn of(node: &Node, setting: usize) -> Self {
        let Node { point, .. } = node;
        Self {
            parent: node.parent,
            kind: node.kind.clone(),
            setting,
            step: node.step,
            columns: [point.y(), point.tangent(), point.curvature()].iter().flatten().copied().collect(),
            positive: point.positive,
            length: point.length,
            turning: point.turning,
            rounds: point.rounds,
            energy: node.state.energy,
            stability: node.stability,
            stiffness: node.stiffness,
            ahead: node.ahead,
            admissibility: node.admissibility,
            digits: node.digits,
            from_exact: node.from_exact,
            on_path: node.on_path,
            begins: node.begins,
            request: node.request,
            trace: node.trace,
        }
    }

    fn back(self, settings: &[Arc<Setting>]) -> Option<Node> {
        let setting = Arc::clone(settings.get(self.setting)?);
        let is_whole =
            self.columns.len().is_multiple_of(3) && (FEWEST..=MOST).contains(&(self.columns.len() / 3));
        let columns = is_whole.then(|| Columns::from_vec(self.columns))?;
        let mut point = StatePoint::of(columns, self.positive);
        (point.length, point.rounds, point.turning) = (self.length, self.rounds, self.turning);
        let [approach, force] = edges::device(&setting.scales, &point);
        let contacts = edges::contacts(&setting.scales, &point);
        let contact_radius = contacts.outermost();
        // If there is only a zone, there is no contact.
        if self.on_path.is_none() || contact_radius > 0.0 {
            contacts.check().ok()?;
        }
        Some(Node {
            parent: self.parent,
            kind: self.kind,
            control: setting.control,
            state: State { contact_radius, approach, force, energy: self.energy },
            setting,
            stability: self.stability,
            point,
            step: self.step,
            stiffness: self.stiffness,
            ahead: self.ahead,
            admissibility: self.admissibility,
            digits: self.digits,
            from_exact: self.from_exact,
            on_path: self.on_path,
            begins: self.begins,
            request: self.request,
            trace: self.trace,
        })
    }
}

/// The nodes of a tree; `setting` numbers their settings.
pub(super) fn nodes(history: &History, mut setting: impl FnMut(&Arc<Setting>) -> usize) -> Vec<SavedNode> {
    history.nodes().map(|node| SavedNode::of(node, setting(&node.setting))).collect()
}

/// The tree of these nodes; `None` if they do not form one.
pub(super) fn history(
    nodes: Vec<SavedNode>,
    cursor: Option<usize>,
    settings: &[Arc<Setting>],
) -> Option<History> {
    let nodes = nodes.into_iter().map(|node| node.back(settings)).collect::<Option<Vec<_>>>()?;
    History::of(nodes, cursor)
}
