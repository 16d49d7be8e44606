//! Which facets of another body a node can press on. With the outward normals nᵢ of the facets at a
//! node of one body, a plane with the outward normal n keeps the node's body in front of it only if
//! (Farkas' lemma)
//!
//! ```text
//! {x : nᵢ·x ≤ 0} ⊂ {x : n·x ≥ 0}    ⇔    −n = Σ λᵢ nᵢ,  λᵢ ≥ 0,    so that min nᵢ·n < 0
//! ```
//!
//! Where two bodies are flush, the nodes of their common outline lie on the faces beside the edges
//! that they meet, as near as on the faces that they press on, and only the normals tell which.
//! Both turn as bodies deform. A facet is left to one across a sharp edge of its body if no normal
//! of the node opposes the first, one opposes the second, and the node is not clearly in front of
//! the first.

use carom_algebra::Vector;

use crate::constants::{FLUSH, OPPOSED, PARALLEL};

/// Most sweeps over the λᵢ.
const SWEEPS: usize = 500;
/// Share of the distance by which a sweep must shorten it to go on.
const SHORTER: f64 = 1e-3;

/// Whether a node with these normals presses on a facet with the normal n: the distance of −n from
/// their cone is at most `within`. Sweeps over the λᵢ approach the closest point of the cone.
pub(super) fn presses<const D: usize>(normals: &[Vector<D>], n: Vector<D>, within: f64) -> bool {
    let mut multipliers = vec![0.0; normals.len()];
    let mut rest = n * -1.0;
    for _ in 0..SWEEPS {
        let before = rest.norm();
        for (multiplier, normal) in multipliers.iter_mut().zip(normals) {
            let step = rest.dot(normal).max(-*multiplier);
            *multiplier += step;
            rest -= *normal * step;
        }
        if rest.norm() <= within {
            return true;
        }
        if rest.norm() > (1.0 - SHORTER) * before {
            return false;
        }
    }
    false
}

/// Whether contact of a node at a height over a facet with the normal n is left to a facet across a
/// sharp edge. `normals` are the nᵢ at the node; `beside` gives those facets, each with its normal
/// and its length.
pub(super) fn is_left<const D: usize, I: Iterator<Item = (Vector<D>, f64)>>(
    normals: &(impl Iterator<Item = Vector<D>> + Clone),
    n: Vector<D>,
    height: f64,
    beside: impl Fn() -> I,
) -> bool {
    let most_opposed = |n: Vector<D>| normals.clone().map(|own| own.dot(&n)).fold(f64::INFINITY, f64::min);
    // An nᵢ that opposes the facet presses on it by itself.
    most_opposed(n) > -PARALLEL.sine
        && beside().any(|(other, length)| height <= FLUSH * length && most_opposed(other) < -OPPOSED.cosine)
        && !presses(&normals.clone().collect::<Vec<_>>(), n, PARALLEL.cosine)
}
