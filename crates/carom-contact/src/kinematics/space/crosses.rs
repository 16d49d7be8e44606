//! A boundary in space that crosses itself, and where its nodes lie relative to those parts of it
//! that they may meet (`folds.rs`).
//!
//! The solid angle under which a node sees the oriented boundary, without the facets that contain
//! it, is that of the body at the node, in (0, 4π), and 4π more where another part of the body
//! covers it. Facets are cut into triangles between their nodes.

use std::f64::consts::PI;

use carom_algebra::Vector;
use carom_solid::Bounds;

use super::closed_surface::ClosedSurface;
use super::folds::PatchFolds;
use super::patch::{Feature, cross, place};
use crate::constants::SHARPEST_SOLID;
use crate::inside_itself::InsideItself;
use crate::kinematics::{Depth, Facets, Side};
use crate::solid_angle::solid_angle;

type Triangle = [Vector<3>; 3];

impl ClosedSurface {
    /// Allows nodes of the boundary itself to be measured; `piece`: the connected piece of the body
    /// to which each node belongs, from `first_node` on; `reference`: the reference positions, flat
    /// over all nodes.
    #[must_use]
    pub fn with_pieces(self, piece: &[usize], first_node: usize, reference: &[f64]) -> Self {
        let folds = PatchFolds::new(&self.boundary, piece, first_node, reference);
        Self { folds: Some((folds, Vec::new())), ..self }
    }

    /// Position of a node of the boundary relative to those parts of the boundary that it may meet
    /// and that lie on the given side of it in the order of places, if one is nearer than `reach`.
    /// Where the nearest part lies on the other side, or ends there, the node counts as outside.
    pub fn depth_of(&self, node: usize, side: Side, reach: f64, y: &[f64]) -> Option<Depth> {
        let (folds, normals) = self.folds.as_ref()?;
        let point = place(y, node);
        let meets = |facet: usize| folds.met(node, facet, |facet| normals[facet]).is_some();
        let mut nearest: Option<(usize, f64)> = None;
        for facet in self.tree.meeting(&Bounds::of(&point.0).grown(reach)).filter(|&facet| meets(facet)) {
            let distance = self.boundary.patch(facet).nearest(y, point).distance;
            let least = nearest.map_or(reach, |(_, least)| least);
            // The first of equals, in whatever order the tree finds them.
            if distance < least || distance == least && nearest.is_some_and(|(first, _)| facet < first) {
                nearest = Some((facet, distance));
            }
        }
        let (facet, _) = nearest?;
        // An end next to what the node cannot meet, such as its own facet, is no place to enter.
        let is_open = match self.boundary.patch(facet).nearest(y, point).at {
            Feature::Inside => true,
            Feature::Edge(edge) => self.boundary.across(facet, edge).is_some_and(meets),
            Feature::Corner(corner) => self.boundary.around(facet, corner).iter().all(|&f| meets(f)),
        };
        let found = self.boundary.depth(facet, point, y);
        let counts = is_open && folds.met(node, facet, |facet| normals[facet]) == Some(side);
        Some(Depth { distance: if counts { found.distance } else { found.distance.abs() }, ..found })
    }

    /// Whether two facets without a common node cross each other at the positions of the last
    /// update. Pairs that are `known` do not count.
    pub fn crosses_itself(&self, y: &[f64], known: impl Fn(usize, usize) -> bool) -> bool {
        self.crossings(y, known).next().is_some()
    }

    /// The node that lies deepest inside its own body, of the nodes of facets that cross others, if
    /// one does.
    pub fn deepest_in_itself(&self, y: &[f64]) -> Option<InsideItself> {
        let facets = self.crossings(y, |_, _| false).flat_map(|(a, b)| [a, b]);
        let mut nodes: Vec<usize> = facets.flat_map(|facet| self.facet_nodes(facet)).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut deepest: Option<InsideItself> = None;
        for node in nodes.into_iter().filter(|&node| self.seen_from(node, y) >= 4.0 * PI + SHARPEST_SOLID) {
            let point = place(y, node);
            let distance = |facet: usize| {
                let is_other = !self.facet_nodes(facet).contains(&node);
                is_other.then(|| self.boundary.patch(facet).nearest(y, point).distance)
            };
            if let Some((facet, depth)) = self.tree.nearest(&point.0, None, distance)
                && deepest.is_none_or(|most| depth > most.depth)
            {
                deepest = Some(InsideItself { node, facet, depth });
            }
        }
        deepest
    }

    /// Change of a coordinate of a node, apart from a motion of all nodes together, before two
    /// facets without a common node can cross; 0 where two are near at the positions of the last
    /// update.
    pub fn clearance_to_itself(&self, y: &[f64]) -> f64 {
        self.boundary.clearance(&self.hull, &self.tree, y)
    }

    /// The pairs of facets that cross each other, the first of each ascending.
    fn crossings(
        &self,
        y: &[f64],
        known: impl Fn(usize, usize) -> bool,
    ) -> impl Iterator<Item = (usize, usize)> {
        let of_facet = move |a: usize| {
            let bounds = self.boundary.bounds(&self.hull, a, y);
            let mut others: Vec<usize> =
                self.boundary.apart_from(a, &bounds, &self.tree).filter(|&b| b > a && !known(a, b)).collect();
            others.sort_unstable();
            let own = if others.is_empty() { Triangles::default() } else { self.triangles(a, y) };
            others.retain(|&b| {
                let other = self.triangles(b, y);
                own.iter().any(|one| other.iter().any(|two| crosses(one, two)))
            });
            others.into_iter().map(move |b| (a, b))
        };
        (0..self.boundary.all()).flat_map(of_facet)
    }

    /// Solid angle under which a node sees the facets of its own boundary that do not contain it.
    fn seen_from(&self, node: usize, y: &[f64]) -> f64 {
        let from = place(y, node);
        let others = (0..self.boundary.all()).filter(|&facet| !self.facet_nodes(facet).contains(&node));
        let of_facet = |facet: usize| -> f64 {
            let triangles = self.triangles(facet, y);
            triangles.iter().map(|corners| solid_angle(corners.map(|corner| corner - from))).sum()
        };
        others.map(of_facet).sum()
    }

    /// Divides a facet into triangles between its nodes.
    fn triangles(&self, facet: usize, y: &[f64]) -> Triangles {
        let patch = self.boundary.patch(facet);
        let count = patch.shape.degree();
        let is_square = patch.corners() == 4;
        let at = |i: usize, j: usize| {
            let [s, t] = [i, j].map(|k| k as f64 / count as f64);
            patch.at(y, if is_square { [2.0 * s - 1.0, 2.0 * t - 1.0] } else { [s, t] }).position
        };
        let mut triangles = Triangles::default();
        for i in 0..count {
            for j in 0..if is_square { count } else { count - i } {
                triangles.add([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if is_square || i + j + 1 < count {
                    triangles.add([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
        triangles
    }
}

/// The triangles into which a facet is divided, at most nine for a cubic triangle.
#[derive(Clone, Copy, Default)]
struct Triangles {
    all: [Option<Triangle>; 9],
    count: usize,
}

impl Triangles {
    fn add(&mut self, triangle: Triangle) {
        self.all[self.count] = Some(triangle);
        self.count += 1;
    }

    fn iter(&self) -> impl Iterator<Item = &Triangle> {
        self.all.iter().flatten()
    }
}

/// Whether an edge of one triangle crosses the inside of the other one, ends and edges not
/// included.
fn crosses(one: &Triangle, other: &Triangle) -> bool {
    let bounds = |triangle: &Triangle| triangle.iter().map(|corner| corner.0).collect::<Bounds>();
    bounds(one).meets(&bounds(other)) && (pierces(one, other) || pierces(other, one))
}

fn pierces(edges: &Triangle, [a, b, c]: &Triangle) -> bool {
    let normal = cross(*b - *a, *c - *a);
    (0..3).any(|k| {
        let p = edges[k];
        let q = edges[(k + 1) % 3];
        let [from, to] = [p, q].map(|x| (x - *a).dot(&normal));
        if from * to >= 0.0 {
            return false;
        }
        let along = q - p;
        let volume = |u: &Vector<3>, v: &Vector<3>| cross(*u - p, *v - p).dot(&along);
        let volumes = [volume(a, b), volume(b, c), volume(c, a)];
        volumes.iter().all(|v| *v > 0.0) || volumes.iter().all(|v| *v < 0.0)
    })
}
