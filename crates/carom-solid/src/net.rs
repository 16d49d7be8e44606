//! The control net of a surface in space: its points as weights of the facet's nodes (`Hull`), and
//! the lines of points along which de Casteljau's algorithm halves it.

use crate::bernstein::{Direction, directions_of_box, directions_of_simplex};
use crate::facet::FacetShape;
use crate::shape::Hull;

/// The control net of facets of one shape, of which all points are means.
#[derive(Clone, Debug, PartialEq)]
pub struct Net {
    hull: Hull,
    points: usize,
    degree: usize,
    corners: Vec<[f64; 2]>,
    directions: Vec<Direction>,
}

impl Net {
    /// Most points of a net.
    pub const POINTS: usize = 10;

    /// The net of a surface.
    ///
    /// # Panics
    /// For a point or a line.
    ///
    /// ```
    /// use carom_solid::{FacetShape, Net};
    /// let net = Net::facet(FacetShape::T6);
    /// assert_eq!((net.points(), net.directions().len()), (6, 3));
    /// ```
    #[must_use]
    pub fn facet(shape: FacetShape) -> Self {
        assert_eq!(shape.dimension(), 3, "a net of {shape:?}");
        let (corners, directions) = if shape.corners() == 3 {
            (vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], directions_of_simplex::<2>(shape.degree()))
        } else {
            let corners = vec![[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
            (corners, directions_of_box::<2>(shape.degree()))
        };
        Self { hull: Hull::facet(shape), points: shape.nodes(), degree: shape.degree(), corners, directions }
    }

    /// Number of points, which is that of the facet's nodes.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points
    }

    /// Polynomial degree along a line of points; the second corner of a triangle and of a square is
    /// the point of this number.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Weights of the nodes in a point.
    #[must_use]
    pub fn weights(&self, point: usize) -> &[f64] {
        self.hull.weights(point)
    }

    /// ξ of its corners; those of a square in the order of its axes.
    #[must_use]
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    /// The directions in which it can be halved.
    #[must_use]
    pub fn directions(&self) -> &[Direction] {
        &self.directions
    }
}
