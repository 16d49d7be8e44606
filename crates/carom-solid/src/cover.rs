//! Which points a body covers, for many points at one position of its nodes: O(log cells) each,
//! after O(cells log cells).

use crate::body::Body;
use crate::bounds::Bounds;
use crate::tree::Tree;

/// A body at a position of its nodes, with a hierarchy of its cells' boxes.
pub struct Cover<'a> {
    body: &'a dyn Body,
    y: &'a [f64],
    tree: Tree,
}

impl<'a> Cover<'a> {
    /// Of a body whose nodes are at `y`.
    pub fn new(body: &'a dyn Body, y: &'a [f64]) -> Self {
        Self { body, y, tree: Tree::new(body.mesh().cell_count(), |cell| body.cell_bounds(cell, y)) }
    }

    /// Whether a point lies in the body, its boundary included.
    pub fn contains(&self, point: &[f64]) -> bool {
        self.tree.meeting(&Bounds::of(point)).any(|cell| self.body.invert(cell, self.y, point).is_some())
    }
}
