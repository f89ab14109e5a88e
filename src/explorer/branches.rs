//! The branches of the walk: every end that was reached, and the way to it from the current walk.

use super::history::History;
use super::node::Node;
use super::prune::{children, is_repeated};

/// At most this many branches are drawn and listed: the newest ones.
pub const MOST: usize = 40;

/// A branch.
#[derive(Debug, Clone)]
pub struct WalkBranch<'a> {
    pub end: usize,
    pub is_here: bool,
    /// Its states from the fork to its end; for the current branch, all states.
    pub nodes: Vec<&'a Node>,
}

impl<'a> WalkBranch<'a> {
    /// Its last node.
    pub fn last(&self) -> Option<&'a Node> {
        self.nodes.last().copied()
    }
}

/// The branches of a walk, the newest first.
pub fn branches(history: &History) -> Vec<WalkBranch<'_>> {
    let nodes: Vec<&Node> = history.nodes().collect();
    let children = children(&nodes);
    let mut is_ours = vec![false; nodes.len()];
    let mut at = history.cursor();
    while let Some(number) = at {
        is_ours[number] = true;
        at = nodes[number].parent;
    }
    let is_end = |at: &usize| children[*at].is_empty() && !is_repeated(&nodes, &children, *at);
    let ends = (0..nodes.len()).rev().filter(|at| is_end(at) || history.cursor() == Some(*at));
    ends.take(MOST)
        .map(|end| {
            let mut way = Vec::new();
            let mut at = Some(end);
            while let Some(number) = at {
                way.push(nodes[number]);
                let parted = is_ours[number] && !is_ours[end];
                at = nodes[number].parent.filter(|_| !parted && !nodes[number].begins);
            }
            way.reverse();
            WalkBranch { end, is_here: history.cursor() == Some(end), nodes: way }
        })
        .collect()
}

/// Whether there is more than one.
pub fn are_several(history: &History) -> bool {
    branches(history).len() > 1
}
