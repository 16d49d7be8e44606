//! From linear cells to every order: nodes on edges and inside cells.
//!
//! Edge nodes are equally spaced along the chord, or in angle along the true circle. The inner node
//! of a T10 with corners c and edge nodes e is Σe/4 − Σc/6, which reproduces quadratic maps, so
//! that the third derivatives of a curved cell's reference map are O(h³), as optimal order requires
//! (P. G. Ciarlet, P.-A. Raviart, CMAME 1 (1972) 217–249; M. Lenoir, SIAM J. Numer. Anal. 23 (1986)
//! 562–580). Only edges on the boundary are curved.

use std::collections::{BTreeMap, HashMap};
use std::f64::consts::{PI, TAU};

use super::lerp;
use crate::mesh::{Element, Facet, Mesh};

/// Corners, cells and sides.
#[derive(Default)]
pub(super) struct Skeleton {
    pub(super) points: Vec<[f64; 2]>,
    /// Corners, counter-clockwise.
    pub(super) triangles: Vec<[usize; 3]>,
    pub(super) sides: Vec<Side>,
}

/// Edges of a side in order of traversal, on a circle or straight.
pub(super) struct Side {
    pub(super) name: String,
    pub(super) edges: Vec<[usize; 2]>,
    pub(super) circle: Option<Circle>,
}

/// A circle.
#[derive(Clone, Copy)]
pub(super) struct Circle {
    pub(super) center: [f64; 2],
    pub(super) radius: f64,
}

impl Circle {
    /// The point at fraction `t` of the shorter arc from `a` to `b`.
    fn between(&self, a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
        let angle = |p: [f64; 2]| (p[1] - self.center[1]).atan2(p[0] - self.center[0]);
        let start = angle(a);
        let turn = angle(b) - angle(a);
        let turn = if turn > PI {
            turn - TAU
        } else if turn < -PI {
            turn + TAU
        } else {
            turn
        };
        let (sin, cos) = (start + t * turn).sin_cos();
        [self.center[0] + self.radius * cos, self.center[1] + self.radius * sin]
    }
}

/// The mesh of an element type on a skeleton.
pub(super) fn elevate(skeleton: Skeleton, element: Element) -> Mesh {
    let Skeleton { points: mut nodes, triangles, sides } = skeleton;
    let k = element.degree();
    // Nodes between two corners, and the circle they lie on; the key of an edge is its corners in
    // ascending order.
    let key = |[i, j]: [usize; 2]| [i.min(j), i.max(j)];
    let mut circles = HashMap::new();
    for side in &sides {
        circles.extend(
            side.circle.iter().flat_map(|circle| side.edges.iter().map(|&edge| (key(edge), *circle))),
        );
    }
    let mut between: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
    let mut owner = HashMap::new();
    let mut cells = Vec::with_capacity(triangles.len() * element.nodes());
    for (cell, triangle) in triangles.iter().enumerate() {
        let first = cells.len();
        cells.extend(triangle);
        for edge in [[triangle[0], triangle[1]], [triangle[1], triangle[2]], [triangle[2], triangle[0]]] {
            owner.insert(edge, cell);
            let [i, j] = key(edge);
            let inner = between.entry([i, j]).or_insert_with(|| {
                let a = nodes[i];
                let b = nodes[j];
                let added = (1..k).map(|m| {
                    let t = m as f64 / k as f64;
                    match circles.get(&[i, j]) {
                        Some(circle) => circle.between(a, b, t),
                        None => [lerp(a[0], b[0], t), lerp(a[1], b[1], t)],
                    }
                });
                nodes.extend(added);
                (nodes.len() + 1 - k..nodes.len()).collect()
            });
            cells.extend(directed(inner, edge));
        }
        if element == Element::T10 {
            let (corners, edges) = cells[first..].split_at(3);
            let sum = |set: &[usize], i: usize| set.iter().map(|&n: &usize| nodes[n][i]).sum::<f64>();
            let center = [0, 1].map(|i| sum(edges, i) / 4.0 - sum(corners, i) / 6.0);
            cells.push(nodes.len());
            nodes.push(center);
        }
    }
    let facets = |side: Side| {
        let facet = |&edge: &[usize; 2]| {
            let inner = directed(&between[&key(edge)], edge);
            Facet { cell: owner[&edge], nodes: edge.into_iter().chain(inner).collect() }
        };
        (side.name, side.edges.iter().map(facet).collect())
    };
    let sides: BTreeMap<_, _> = sides.into_iter().map(facets).collect();
    Mesh { element, nodes: nodes.into(), cells, regions: Vec::new(), sides, repairs: Vec::new() }
}

/// The nodes between an edge's corners, in its direction.
fn directed(inner: &[usize], [i, j]: [usize; 2]) -> Vec<usize> {
    if i < j { inner.to_vec() } else { inner.iter().rev().copied().collect() }
}
