//! The place on a secondary facet at which the primary side ends, and its motion. Over a facet of
//! the primary that ends at v with the unit tangent t, the integral of a weighted gap ends at ξ,
//!
//! ```text
//! (x(ξ) − v)·t = 0,    ∂ξ = −((∂x − ∂v)·t + (x − v)·∂T/|T|) / (x'·t),    T = |T| t = Σ_l N_l' y_l
//! ```
//!
//! where ∂x is that at a fixed ξ. With the gap there, its motion adds g ∂ξ to the gradient of the
//! integral, with a negative sign where the primary begins. Without it, forces would have no
//! potential where bodies overhang, and with springs they would create energy. Newton's method
//! leaves out the second derivative: where bodies touch, g is zero.

use carom_algebra::Vector;
use carom_solid::LineShape;

use crate::kinematics::projection::FacetPoint;

/// Most vectors on which the place depends: the point and the nodes of a facet.
const MOST: usize = 5;

/// The gap that enters the integral at a border, with the derivatives of the border's place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Border {
    /// Gradient ∂ξ by the point and the nodes of the facet.
    slopes: [Vector<2>; MOST],
    pub(super) count: usize,
    /// Jump of the weighted gap over the border, and of the weight.
    jumps: [f64; 2],
}

/// The end of a facet of the primary.
pub(super) struct End<'a> {
    pub(super) at: FacetPoint,
    pub(super) shape: &'a LineShape,
    pub(super) nodes: usize,
}

impl Border {
    /// The border at a point of the secondary side over an end of the primary; none where the
    /// secondary side runs along the line on which it lies. `jumps`: that of the weighted gap, and
    /// that of the weight.
    pub(super) fn new(point: &FacetPoint, end: &End, jumps: [f64; 2]) -> Option<Self> {
        let along = end.at.tangent * end.at.measure.recip();
        let rate = point.tangent.dot(&along);
        if rate == 0.0 {
            return None;
        }
        let across = (point.position - end.at.position) * end.at.measure.recip();
        let mut slopes = [Vector::ZERO; MOST];
        slopes[0] = along * -rate.recip();
        for node in 0..end.nodes {
            let of_node = along * end.shape.values[node] - across * end.shape.first[node];
            slopes[1 + node] = of_node * rate.recip();
        }
        Some(Self { slopes, count: 1 + end.nodes, jumps })
    }

    /// Calls a function with the gradients of the integral by the point and the nodes of the
    /// facet; `kept`: an initial depth by which gaps are larger.
    pub(super) fn gradient(&self, kept: f64, mut of: impl FnMut(usize, Vector<2>)) {
        let jump = self.jumps[0] + kept * self.jumps[1];
        (0..self.count).for_each(|p| of(p, self.slopes[p] * jump));
    }
}
