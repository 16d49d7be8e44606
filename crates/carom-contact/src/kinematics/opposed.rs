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
/// Sweeps over the λᵢ.
const SWEEPS: usize = 20;

/// Whether a node with these normals presses on a facet with the normal n: the distance of −n from
/// their cone is at most `within`.
pub(super) fn presses<const D: usize>(
    normals: impl Iterator<Item = Vector<D>> + Clone,
    n: Vector<D>,
    within: f64,
) -> bool {
    let mut multipliers = vec![0.0; normals.clone().count()];
    let mut rest = n * -1.0;
    for _ in 0..SWEEPS {
        for (multiplier, normal) in multipliers.iter_mut().zip(normals.clone()) {
            let step = rest.dot(&normal).max(-*multiplier);
            *multiplier += step;
            rest = rest - normal * step;
        }
        if rest.norm() <= within {
            return true;
        }
    }
    false
}

/// Cosine of the angle between two normals above which they do not oppose each other: 11° from
/// perpendicular.
const ASIDE: f64 = -0.2;
/// Cosine of the angle between two normals below which they oppose each other: within 45° of
/// opposite.
const OPPOSED: f64 = -0.7;
/// Height of a node over a facet, relative to the length of the facet across the sharp edge, up to
/// which the node is left to that other facet.
pub(super) const FLUSH: f64 = 0.02;

/// Whether contact of a node at a height over a facet is left to a facet across a sharp edge.
/// `beside` gives those facets, each with its length; `most_opposed` is the least nᵢ·n of the
/// normals nᵢ at the node for the normal n of a facet.
pub(super) fn is_left<F, I: Iterator<Item = (F, f64)>>(
    facet: &F,
    height: f64,
    beside: impl Fn() -> I,
    most_opposed: impl Fn(&F) -> f64,
) -> bool {
    most_opposed(facet) > ASIDE
        && beside().any(|(other, length)| height <= FLUSH * length && most_opposed(&other) < OPPOSED)
}
