//! The smooth surface that straight facets stand for. Facets of the length h whose nodes lie on a
//! curve of the radius R are chords of it, and up to h²/8R away from it: meshes of two bodies that
//! touch along an arc overlap by that much between their nodes, or gape.
//!
//! The curvature S of the surface at a facet follows from the normals of its neighbours, as the
//! least-squares solution of n_g − n_f = S (x_g − x_f). With the shape functions φᵃ and the corners
//! xᵃ of the facet, the surface then lies over it by
//!
//! ```text
//! w = ½ Σ_{a<b} φᵃ φᵇ (xᵇ − xᵃ)·S (xᵇ − xᵃ)        in the plane h²/8R (1 − ξ²)
//! ```
//!
//! which is exact where S is constant. Of the curvatures of a facet and of its neighbours the
//! smallest counts, and none where their signs differ: a blunt kink between flat facets, which has
//! no counterpart further on, is no arc.

use carom_algebra::Vector;

use super::cross;
use super::facets::Facets;
use crate::constants::KINK;

/// Square of the extent of the neighbours in one direction, relative to that in the other one, from
/// which on the curvature in it is known.
const KNOWN: f64 = 1e-8;

/// Curvature of a surface at a facet in the principal directions of the positions of its
/// neighbours.
struct Curvature {
    normal: Vector<3>,
    axes: [Vector<3>; 2],
    /// S₁₁, S₁₂ and S₂₂.
    entries: [f64; 3],
}

impl Curvature {
    /// The quadratic form x·S x of a tangent x at another facet, turned with its `normal`.
    fn along(&self, x: Vector<3>, normal: Vector<3>) -> f64 {
        let both = normal + self.normal;
        let x = x - both * (self.normal.dot(&x) / (1.0 + normal.dot(&self.normal)));
        let [u, v] = self.axes.map(|axis| axis.dot(&x));
        self.entries[0] * u * u + 2.0 * self.entries[1] * u * v + self.entries[2] * v * v
    }
}

/// Height of the smooth surface over the point ξ of a straight facet; negative behind it.
pub fn rounding<const D: usize>(side: &impl Facets<D>, facet: usize, xi: [f64; 2], y: &[f64]) -> f64 {
    let curvatures: Vec<Curvature> = std::iter::once(facet)
        .chain(smooth_neighbours(side, facet, y))
        .map(|facet| curvature(side, facet, y))
        .collect();
    let normal = side.normal(facet, [0.0; 2], y);
    let nodes = side.nodes_of(facet);
    let values = side.shape().functions(xi).values;
    let mut height = 0.0;
    for b in 0..nodes.len() {
        for a in 0..b {
            let chord = position::<D>(y, nodes[b]) - position::<D>(y, nodes[a]);
            let bends = curvatures.iter().map(|curvature| curvature.along(chord, normal));
            height += 0.5 * values[a] * values[b] * least(bends);
        }
    }
    height
}

/// The value of least magnitude; zero if their signs differ.
fn least(values: impl Iterator<Item = f64>) -> f64 {
    let both = |a: f64, b: f64| if a * b <= 0.0 { 0.0 } else { a.signum() * a.abs().min(b.abs()) };
    values.reduce(both).unwrap_or(0.0)
}

fn smooth_neighbours<const D: usize>(
    side: &impl Facets<D>,
    facet: usize,
    y: &[f64],
) -> impl Iterator<Item = usize> {
    let normal = side.normal(facet, [0.0; 2], y);
    side.beside(facet).filter(move |&other| side.normal(other, [0.0; 2], y).dot(&normal) > KINK.cosine)
}

fn curvature<const D: usize>(side: &impl Facets<D>, facet: usize, y: &[f64]) -> Curvature {
    let at = |facet: usize| (middle(side, facet, y), side.normal(facet, [0.0; 2], y));
    let (place, normal) = at(facet);
    // Offsets of the middles of the neighbours, and differences of their normals.
    let around: Vec<[Vector<3>; 2]> = smooth_neighbours(side, facet, y)
        .map(|other| {
            let (other, turned) = at(other);
            [other - place, turned - normal]
        })
        .collect();
    let nodes = side.nodes_of(facet);
    let edge = position::<D>(y, nodes[1]) - position::<D>(y, nodes[0]);
    let first = edge * edge.norm().recip();
    let second = cross(normal, first);
    let sum = |i: usize, [a, b]: [Vector<3>; 2]| -> f64 {
        around.iter().map(|pair| pair[0].dot(&a) * pair[i].dot(&b)).sum()
    };
    let spread = [sum(0, [first; 2]), sum(0, [first, second]), sum(0, [second; 2])];
    let angle = 0.5 * (2.0 * spread[1]).atan2(spread[0] - spread[2]);
    let sine = angle.sin();
    let cosine = angle.cos();
    let axes = [first * cosine + second * sine, second * cosine - first * sine];
    let extents = axes.map(|axis| sum(0, [axis; 2]));
    let over = |turn: f64, extent: f64| {
        if extent > KNOWN * (extents[0] + extents[1]) { turn / extent } else { 0.0 }
    };
    let mixed = sum(1, axes) + sum(1, [axes[1], axes[0]]);
    let entries = [
        over(sum(1, [axes[0]; 2]), extents[0]),
        over(mixed, extents[0] + extents[1]),
        over(sum(1, [axes[1]; 2]), extents[1]),
    ];
    Curvature { normal, axes, entries }
}

/// The mean of the corners of a facet.
fn middle<const D: usize>(side: &impl Facets<D>, facet: usize, y: &[f64]) -> Vector<3> {
    let nodes = side.nodes_of(facet);
    let sum = nodes.iter().fold(Vector::ZERO, |sum, &node| sum + position::<D>(y, node));
    sum * (nodes.len() as f64).recip()
}

/// Position of a node, padded with zeros to space.
fn position<const D: usize>(y: &[f64], node: usize) -> Vector<3> {
    Vector(std::array::from_fn(|i| if i < D { y[D * node + i] } else { 0.0 }))
}
