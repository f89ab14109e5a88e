//! The walk as an append-only tree: undo moves a cursor, a step after undo makes a branch, nothing is erased.

use super::node::{Node, NodeKind};
use super::prune;
use super::setting::Setting;
use pulloff_engine::units::UnitSystem;
use std::sync::Arc;

/// Nodes per chunk. A snapshot of the tree shares all chunks but the last with the tree itself.
const CHUNK: usize = 256;

/// A node with its place in the tree.
#[derive(Debug, Clone)]
struct TreeNode {
    node: Node,
    /// Its permanent number: pruning keeps it, and it grows from node to node.
    id: u64,
}

/// A node to return to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bookmark {
    cursor: Option<usize>,
    numbering: u64,
}

/// The tree. A clone is cheap however long the walk: what does not change afterwards stays shared.
#[derive(Debug, Clone, Default)]
pub struct History {
    chunks: Vec<Arc<Vec<TreeNode>>>,
    cursor: Option<usize>,
    revision: u64,
    /// How often nodes have been forgotten and the others renumbered.
    numbering: u64,
    /// The tree is pruned when it has this many nodes.
    prune_at: usize,
    next_id: u64,
}

impl History {
    /// The tree of these nodes; `None` if they form no tree.
    pub fn of(nodes: Vec<Node>, cursor: Option<usize>) -> Option<Self> {
        let count = nodes.len();
        let grown = nodes.iter().enumerate().all(|(at, node)| node.parent.is_none_or(|parent| parent < at));
        if !grown || cursor.is_some_and(|cursor| cursor >= count) || cursor.is_some() != (count > 0) {
            return None;
        }
        let mut tree = Self::default();
        for node in nodes {
            tree.grow(node);
        }
        tree.cursor = cursor;
        Some(tree)
    }

    /// The node the walker stands on.
    pub fn current(&self) -> Option<&Node> {
        self.node(self.cursor?)
    }

    /// Its number.
    pub fn cursor(&self) -> Option<usize> {
        self.cursor
    }

    /// The node before it.
    pub fn parent(&self) -> Option<usize> {
        self.current()?.parent
    }

    /// The node with this number.
    pub fn node(&self, number: usize) -> Option<&Node> {
        self.entry(number).map(|entry| &entry.node)
    }

    /// The permanent number of the current node.
    pub fn id(&self) -> Option<u64> {
        self.entry(self.cursor?).map(|entry| entry.id)
    }

    /// The number of the node with this permanent number, or of the last one before it that was not pruned.
    pub fn find(&self, id: u64) -> Option<usize> {
        let (mut low, mut high) = (0, self.len());
        while low < high {
            let middle = usize::midpoint(low, high);
            if self.entry(middle).is_some_and(|entry| entry.id <= id) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low.checked_sub(1)
    }

    /// All nodes, by number; a node comes after its parent.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = &Node> {
        (0..self.len()).map(|at| &self.chunks[at / CHUNK][at % CHUNK].node)
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.chunks.last().map_or(0, |last| (self.chunks.len() - 1) * CHUNK + last.len())
    }

    /// Whether nothing has been walked.
    pub fn is_empty(&self) -> bool {
        self.chunks.is_empty()
    }

    /// A tree of the same revision without its nodes: to tell later whether anything has changed, not to hold them.
    #[must_use]
    pub fn stamp(&self) -> Self {
        Self { revision: self.revision, ..Self::default() }
    }

    /// Changes whenever anything in the tree changes.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Changes whenever nodes were pruned and the others renumbered.
    pub fn numbering(&self) -> u64 {
        self.numbering
    }

    fn entry(&self, number: usize) -> Option<&TreeNode> {
        self.chunks.get(number / CHUNK)?.get(number % CHUNK)
    }

    fn add(&mut self, entry: TreeNode) {
        match self.chunks.last_mut().filter(|last| last.len() < CHUNK) {
            Some(last) => Arc::make_mut(last).push(entry),
            None => self.chunks.push(Arc::new(vec![entry])),
        }
    }

    fn grow(&mut self, node: Node) {
        let id = self.next_id;
        self.next_id += 1;
        self.add(TreeNode { node, id });
    }

    /// Shows the numbers of all nodes in `units`, where both are SI: how numbers are shown is no part of a problem.
    pub fn show_in(&mut self, units: &UnitSystem) {
        let is_other = |own: &UnitSystem| own != units && *own != UnitSystem::Reduced;
        if *units == UnitSystem::Reduced {
            return;
        }
        // Nodes share their settings.
        let mut last: Option<[Arc<Setting>; 2]> = None;
        for chunk in &mut self.chunks {
            if !chunk.iter().any(|node| is_other(&node.node.setting.preset.units)) {
                continue;
            }
            for TreeNode { node, .. } in Arc::make_mut(chunk) {
                if !is_other(&node.setting.preset.units) {
                    continue;
                }
                let known = last.as_ref().filter(|[own, _]| Arc::ptr_eq(own, &node.setting));
                let shown = known
                    .map_or_else(|| Arc::new(node.setting.shown_in(units)), |[_, shown]| Arc::clone(shown));
                last = Some([std::mem::replace(&mut node.setting, Arc::clone(&shown)), shown]);
                self.revision += 1;
            }
        }
    }

    /// Appends a node after the current one and moves to it.
    pub fn push(&mut self, mut node: Node) {
        node.parent = self.cursor;
        self.append(node);
    }

    /// Whether the walk stands where it began; other values may have been tried there.
    pub fn has_just_begun(&self) -> bool {
        let tried = |node: &Node| matches!(node.kind, NodeKind::Solved | NodeKind::Stale(_));
        let node = self.current().filter(|node| !tried(node));
        node.or_else(|| self.node(self.parent()?)).is_some_and(|node| node.begins)
    }

    /// Appends a node beside the current one: continuing the same change remains one undo.
    pub fn push_beside(&mut self, mut node: Node) {
        node.parent = self.parent();
        self.append(node);
    }

    fn append(&mut self, node: Node) {
        self.grow(node);
        self.stand(self.len() - 1);
    }

    /// In a walk that has become long, forgets plain states far back and renumbers the others; the nodes whose
    /// permanent numbers are in `held`, ascending, stay.
    pub fn shorten(&mut self, held: &[u64]) {
        if self.len() <= self.prune_at.max(prune::MOST) {
            return;
        }
        let nodes: Vec<&Node> = self.nodes().collect();
        let is_held = |at: usize| {
            self.cursor == Some(at)
                || self.entry(at).is_some_and(|entry| held.binary_search(&entry.id).is_ok())
        };
        let stays = prune::staying(&nodes, is_held);
        let mut tree = Self {
            revision: self.revision + 1,
            numbering: self.numbering + 1,
            next_id: self.next_id,
            ..Self::default()
        };
        // The new number of each node, or of the last node before it that stays.
        let mut place: Vec<usize> = Vec::with_capacity(nodes.len());
        for (at, node) in nodes.iter().enumerate() {
            let parent = node.parent.map(|parent| place[parent]);
            if stays[at] {
                place.push(tree.len());
                let id = self.entry(at).map_or(0, |entry| entry.id);
                tree.add(TreeNode { node: Node { parent, ..(*node).clone() }, id });
            } else {
                // The first node has no parent, and always stays.
                place.push(parent.unwrap_or(0));
            }
        }
        tree.cursor = self.cursor.map(|cursor| place[cursor]);
        // Keeps a tree in which little could be pruned from being pruned at every step.
        tree.prune_at = tree.len() + tree.len() / 4;
        *self = tree;
    }

    fn stand(&mut self, at: usize) {
        self.cursor = Some(at);
        self.revision += 1;
    }

    /// Where the walker stands.
    pub fn mark(&self) -> Bookmark {
        Bookmark { cursor: self.cursor, numbering: self.numbering }
    }

    /// Returns to where it stood, as if nothing had been walked since; the nodes made since are kept.
    ///
    /// If nodes have been renumbered since, it stays where it is.
    pub fn return_to(&mut self, mark: Bookmark) {
        if let Some(at) = mark.cursor.filter(|_| mark.numbering == self.numbering) {
            self.stand(at);
        }
    }

    /// Moves to the node with this number; false if there is none.
    pub fn go(&mut self, number: usize) -> bool {
        let is_there = self.node(number).is_some();
        if is_there {
            self.stand(number);
        }
        is_there
    }

    /// The walk that led to the current node: from its beginning, each node with its number.
    pub fn path(&self) -> Vec<(usize, &Node)> {
        self.cursor.map_or_else(Vec::new, |cursor| self.path_to(cursor))
    }

    /// The walk that led to the node with this number.
    pub fn path_to(&self, number: usize) -> Vec<(usize, &Node)> {
        let mut path = Vec::new();
        let mut at = Some(number);
        while let Some((number, node)) = at.and_then(|i| Some((i, self.node(i)?))) {
            path.push((number, node));
            at = node.parent.filter(|_| !node.begins);
        }
        path.reverse();
        path
    }
}
