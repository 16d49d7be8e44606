//! Positions of all nodes as contact reads them: padded with zeros to the plane, so that the end of
//! a bar and a curved side share their code.

use carom_algebra::Vector;

/// Positions of the nodes of one configuration.
#[derive(Clone, Copy)]
pub struct Places<'a> {
    y: &'a [f64],
    dimension: usize,
}

impl<'a> Places<'a> {
    /// Positions from components flat over all nodes, in one dimension or in the plane.
    pub fn new(y: &'a [f64], dimension: usize) -> Self {
        debug_assert!(dimension <= 2, "positions in space are those of `space/`");
        Self { y, dimension }
    }

    /// The positions as given, flat over all nodes.
    pub(crate) fn flat(&self) -> &'a [f64] {
        self.y
    }

    /// Coordinates of a node, one per dimension.
    #[inline]
    pub(crate) fn coordinates(&self, node: usize) -> &'a [f64] {
        &self.y[node * self.dimension..(node + 1) * self.dimension]
    }

    /// Position of a node, padded with zeros to the plane.
    #[inline]
    pub fn at(&self, node: usize) -> Vector<2> {
        match self.dimension {
            1 => Vector([self.y[node], 0.0]),
            _ => Vector([self.y[2 * node], self.y[2 * node + 1]]),
        }
    }
}
