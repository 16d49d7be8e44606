//! The place on a secondary facet over a joint of two facets of the primary. The integral of a gap
//! is that over one facet up to ξ and over the other from there on, and both are equal at ξ: its
//! gradient does not depend on the motion of ξ, but its second derivative does. With the jump [∇g]
//! of the gradient from the first facet to the second,
//!
//! ```text
//! [∇g] + [g'] ∂ξ = 0,    ∇²∫g = ∫∇²g + [∇g] ⊗ ∂ξ = ∫∇²g − [∇g] ⊗ [∇g]/[g'],    [g'] = [∇_x g]·x'.
//! ```
//!
//! Where surfaces touch, [∇g] is the jump of the normal, by the point and by the node of the joint.
//! In the row H of the slip, which jumps as the tangent does, ∂H has the term [H] ⊗ ∂ξ.

use carom_algebra::Vector;

/// A joint of two facets of the primary over a secondary facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    /// Coordinate on the secondary facet.
    pub(super) xi: f64,
    /// Facets of the primary before and after it, along the secondary facet.
    pub(super) facets: [usize; 2],
    /// Global number of their common node.
    pub(super) node: usize,
    /// Unit normal of the first facet less that of the second.
    pub(super) normal: Vector<2>,
    /// Unit tangent of the first facet less that of the second.
    pub(super) tangent: Vector<2>,
    /// Weight over [g'].
    pub(super) weight: f64,
}

impl Joint {
    /// Adds the term of the jump of a row, which is `jump` times the weights of the nodes in
    /// `places`, to the derivative of that row, a matrix of `size` rows; `share`: that of the
    /// multiplier.
    pub(super) fn add_to(
        &self,
        share: f64,
        jump: Vector<2>,
        places: &[(usize, f64)],
        size: usize,
        matrix: &mut [f64],
    ) {
        for &(row, of_row) in places {
            for &(column, of_column) in places {
                let factor = -share * self.weight * of_row * of_column;
                for i in 0..2 {
                    for j in 0..2 {
                        matrix[(2 * row + i) * size + 2 * column + j] +=
                            factor * jump.0[i] * self.normal.0[j];
                    }
                }
            }
        }
    }
}
