//! Shapes of facets, the cells of a body's boundary: a point at the end of a bar, a curve in the
//! plane.
//!
//! A facet of dimension D has D − 1 coordinates ξ, and D − 1 tangents. Its normal, as long as its
//! measure, is ±1 for a point, and for a curve traversed with the body on its left the tangent
//! rotated to the right.

use crate::quadrature;
use crate::shape::{LineShape, line_shape};

/// Shape of a facet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum FacetShape {
    Point,
    L2,
    L3,
    L4,
}

impl FacetShape {
    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Self::Point => 1,
            Self::L2 => 2,
            Self::L3 => 3,
            Self::L4 => 4,
        }
    }

    /// Dimension of the space whose bodies have such facets.
    pub fn dimension(self) -> usize {
        match self {
            Self::Point => 1,
            Self::L2 | Self::L3 | Self::L4 => 2,
        }
    }

    /// Polynomial degree; 0 for a point.
    pub fn degree(self) -> usize {
        self.nodes() - 1
    }

    /// Shape functions and their derivatives; for a point all derivatives are zero.
    #[inline]
    pub fn at(self, xi: f64) -> LineShape {
        line_shape(self.nodes(), xi)
    }

    /// Quadrature points and weights exact for polynomials of a degree; a point has weight one.
    pub fn rule(self, degree: usize) -> Vec<(f64, f64)> {
        match self {
            Self::Point => vec![(0.0, 1.0)],
            Self::L2 | Self::L3 | Self::L4 => {
                quadrature::line(degree).iter().map(|(xi, w)| (xi[0], w)).collect()
            }
        }
    }

    /// Outward normal with the length of the facet's measure per ξ, from the derivative y′ of its
    /// positions. `orientation`: see [`Mesh::orientation`](crate::Mesh::orientation). Components
    /// beyond the dimension are zero.
    #[inline]
    pub fn normal(self, tangent: [f64; 2], orientation: f64) -> [f64; 2] {
        match self {
            Self::Point => [orientation, 0.0],
            Self::L2 | Self::L3 | Self::L4 => [orientation * tangent[1], -orientation * tangent[0]],
        }
    }
}
