//! Boxes of the facets' paths in a step: which facets are near a node, and which it may cross.

use carom_solid::{Bounds, Hull, Tree};

use super::boundary::Boundary;
use super::patch::place;

/// Depth relative to the length of a facet that round-off feigns.
pub(super) const NOISE: f64 = 1e-9;
/// Growth of a box, relative to its size, beyond the distance at which a node meets a facet
/// (`crossing.rs`).
const MEETS: f64 = 1e-5;

/// Boxes of the facets' paths; reused memory.
#[derive(Debug, Default)]
pub(super) struct Paths {
    /// With a margin.
    tree: Tree,
    /// Without one.
    tight: Vec<Bounds>,
}

impl Paths {
    /// Updates the boxes; those of the tree are grown by `margin` of their sizes.
    pub(super) fn update(
        &mut self,
        primary: &Boundary,
        hull: &Hull,
        margin: f64,
        [before, now]: [&[f64]; 2],
    ) {
        let swept = |facet: usize| {
            let [old, new] = [before, now].map(|y| primary.bounds(hull, facet, y));
            old.union(&new)
        };
        self.tight.clear();
        self.tight.extend((0..primary.all()).map(swept));
        let grown = |facet: usize| self.tight[facet].grown(margin * self.tight[facet].size());
        if self.tree.is_empty() {
            self.tree = Tree::new(self.tight.len(), grown);
        } else {
            self.tree.update(grown);
        }
    }

    /// The boxes with the margin.
    pub(super) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Finds the facets near a node's path, ascending.
    pub(super) fn find_into(&self, node: usize, ends: [&[f64]; 2], near: &mut Vec<usize>) {
        self.tree.find_into(&path(node, ends), near);
    }

    /// Whether a node may meet a facet on its path, rather than only be near it.
    pub(super) fn may_cross(&self, path: &Bounds, facet: usize) -> bool {
        let tight = &self.tight[facet];
        tight.grown(MEETS * tight.size()).meets(path)
    }
}

/// The box of a node's path.
pub(super) fn path(node: usize, ends: [&[f64]; 2]) -> Bounds {
    let path: Bounds = ends.iter().map(|y| place(y, node).0).collect();
    path.grown(NOISE * path.size())
}
