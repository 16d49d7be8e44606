//! Tests whether points lie in a body in one configuration: O(log cells) per point, after O(cells
//! log cells).

use crate::body::Body;
use crate::bounds::Bounds;
use crate::tree::Tree;

/// A body in one configuration, with a hierarchy of its cells' boxes.
pub struct PointLocator<'a> {
    body: &'a dyn Body,
    y: &'a [f64],
    tree: Tree,
}

impl<'a> PointLocator<'a> {
    /// For a body whose nodes are at `y`.
    pub fn new(body: &'a dyn Body, y: &'a [f64]) -> Self {
        Self { body, y, tree: Tree::new(body.mesh().cell_count(), |cell| body.cell_bounds(cell, y)) }
    }

    /// Whether a point lies in the body, including its boundary.
    pub fn contains(&self, point: &[f64]) -> bool {
        self.tree.meeting(&Bounds::of(point)).any(|cell| self.body.invert(cell, self.y, point).is_some())
    }
}
