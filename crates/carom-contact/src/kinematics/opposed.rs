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

/// Sine of the angle, 30°, by which −n may leave the cone of the nᵢ: joints are blunt up to it.
pub(super) const BLUNT: f64 = 0.5;
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

/// Distance of −n from the cone of the nᵢ above which no nᵢ opposes the facet: within 11° of
/// perpendicular.
const ASIDE: f64 = 0.98;
/// Cosine of the same angle.
const ALONG: f64 = 0.2;
/// Cosine of the angle between two normals below which they oppose each other: within 45° of
/// opposite.
const OPPOSED: f64 = -0.7;
/// Height of a node over a facet, relative to the length of the facet across the sharp edge, up to
/// which the node is left to that other facet; and height of a corner over a facet of the node's
/// body, relative to its length, up to which it lies at the facet.
pub(super) const FLUSH: f64 = 0.02;

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
    most_opposed(n) > -ALONG
        && beside().any(|(other, length)| height <= FLUSH * length && most_opposed(other) < OPPOSED)
        && !presses(&normals.clone().collect::<Vec<_>>(), n, ASIDE)
}
