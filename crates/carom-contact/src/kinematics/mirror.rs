//! Facets in a plane of symmetry: they are no surface, since the mirror image of the body continues
//! it there. Their nodes are fixed across the plane and not all of them along it, and no body lies
//! on both sides of it: a face on rollers beyond which another body reaches is a surface.
//!
//! A node on the axis of a half model lies on such a facet to within round-off, and would be
//! nearest to it.

use std::collections::HashSet;

use carom_algebra::Vector;
use carom_solid::Bounds;

use crate::constants::ROUND_OFF;

/// Continuation of the surface of a body where a facet begins that is no surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Continuation {
    /// The facet is a surface.
    #[default]
    None,
    /// The mirror image of the body: the facet lies in a plane of symmetry.
    Mirror,
    /// Another body: a tie has closed the facet.
    Tied,
}

/// The continuations of all facets of a boundary; none are listed if all are surfaces.
#[derive(Clone, Debug, Default)]
pub(super) struct Continuations(Vec<Continuation>);

impl Continuations {
    /// The continuation where a facet begins.
    pub(super) fn of(&self, facet: usize) -> Continuation {
        self.0.get(facet).copied().unwrap_or_default()
    }

    /// Marks those of the facets, given by their nodes, for which `has` holds.
    pub(super) fn mark<'a>(
        &mut self,
        continuation: Continuation,
        facets: impl ExactSizeIterator<Item = &'a [usize]>,
        has: impl Fn(&[usize]) -> bool,
    ) {
        self.0.resize(facets.len(), Continuation::None);
        for (of_facet, nodes) in self.0.iter_mut().zip(facets) {
            if has(nodes) {
                *of_facet = continuation;
            }
        }
    }
}

/// Whether a facet lies in a plane of symmetry at the positions `y`, flat over all nodes with
/// `dimension` components each; `bodies`: a box around all bodies; `is_fixed`: whether a node is
/// fixed along an axis.
pub fn is_mirror(
    nodes: &[usize],
    y: &[f64],
    dimension: usize,
    bodies: &Bounds,
    is_fixed: &impl Fn(usize, usize) -> bool,
) -> bool {
    if nodes.len() < 2 {
        return false;
    }
    let extent = |axis: usize| {
        let along = nodes.iter().map(|node| y[dimension * node + axis]);
        let least = along.clone().fold(f64::INFINITY, f64::min);
        along.fold(f64::NEG_INFINITY, f64::max) - least
    };
    let size = (0..dimension).map(extent).fold(0.0, f64::max);
    let is_at_end = |axis: usize| {
        let at = y[dimension * nodes[0] + axis];
        let [below, above] = [at - bodies.low()[axis], bodies.high()[axis] - at];
        below.min(above) <= ROUND_OFF * size
    };
    let is_across = |axis: usize| {
        let is_flat = extent(axis) <= ROUND_OFF * size;
        is_flat && is_at_end(axis) && nodes.iter().all(|&node| is_fixed(node, axis))
    };
    let is_held = |node: &usize| (0..dimension).all(|axis| is_fixed(*node, axis));
    (0..dimension).any(is_across) && !nodes.iter().all(is_held)
}

/// Whether a set of facets, given by their nodes in ascending order, contains that of these nodes.
pub(super) fn contains(facets: &HashSet<Vec<usize>>, nodes: &[usize]) -> bool {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    facets.contains(&nodes)
}

/// A vector without twice its component along a direction of length one.
pub(super) fn reflected<const D: usize>(vector: Vector<D>, direction: Vector<D>) -> Vector<D> {
    vector - direction * (2.0 * vector.dot(&direction))
}
