//! Which states of a long walk may be forgotten.
//!
//! A walk of a million steps must not fill the memory. The states that tell the story stay: starts, limit points,
//! jumps, changed problems, the states next to them, the places where branches part and their ends, and the newest
//! states. Of the plain steps in between, every second one is removed, oldest first, so the walk becomes sparser
//! further back.

use super::node::{Node, NodeKind};

/// Walks with more states than this are pruned.
pub const MOST: usize = 5_000;
/// Pruning leaves this many.
const LEFT: usize = 3_750;
/// This many of the newest are never pruned.
const NEWEST: usize = 2_000;

/// Which of `nodes` stay; those that are held always do.
pub(super) fn staying(nodes: &[&Node], is_held: impl Fn(usize) -> bool) -> Vec<bool> {
    let count = nodes.len();
    let old = count.saturating_sub(NEWEST);
    let mut stays = vec![true; count];
    let mut surplus = count.saturating_sub(LEFT);
    let children = children(nodes);
    let is_plain = |at: usize| {
        // Its only child is a step like itself, so it is neither an end, nor a fork, nor the state before an event.
        let single = matches!(children[at][..], [child] if nodes[child].kind == NodeKind::Step);
        nodes[at].kind == NodeKind::Step && single && !is_held(at) && nodes[at].parent.is_some()
    };
    loop {
        let plain: Vec<usize> = (0..old).filter(|at| stays[*at] && is_plain(*at)).collect();
        if surplus == 0 || plain.is_empty() {
            break;
        }
        // Every second one goes, so that what stays is spread evenly.
        for at in plain.into_iter().step_by(2).take(surplus) {
            stays[at] = false;
            surplus -= 1;
        }
    }
    let repeated: Vec<usize> = (0..old)
        .filter(|at| !is_held(*at) && children[*at].is_empty() && is_repeated(nodes, &children, *at))
        .take(surplus)
        .collect();
    for at in repeated {
        stays[at] = false;
    }
    stays
}

pub(super) fn children(nodes: &[&Node]) -> Vec<Vec<usize>> {
    let mut children = vec![Vec::new(); nodes.len()];
    for (at, node) in nodes.iter().enumerate() {
        if let Some(of) = node.parent.and_then(|parent| children.get_mut(parent)) {
            of.push(at);
        }
    }
    children
}

/// Whether a later sibling replaces this end: the same change continued, or the same state made again after undo.
pub(super) fn is_repeated(nodes: &[&Node], children: &[Vec<usize>], at: usize) -> bool {
    let is_change = |kind: &NodeKind| matches!(kind, NodeKind::Solved | NodeKind::Stale(_));
    let Some(siblings) = nodes[at].parent.map(|parent| &children[parent]) else { return false };
    siblings.iter().rev().take_while(|sibling| **sibling > at).any(|sibling| {
        let (ours, theirs) = (nodes[at], nodes[*sibling]);
        let same = ours.kind == theirs.kind && (ours.state, ours.control) == (theirs.state, theirs.control);
        same || is_change(&ours.kind) && is_change(&theirs.kind)
    })
}
