//! The boundary of a body in space as curved facets in global node numbers: neighbours across edges
//! and around corners, and on which side of it a point lies.
//!
//! The sign of the distance to a closed surface is that of d·n at its nearest point; on an edge n
//! is the sum of both facets' normals, at a corner the sum of all facets' normals there, each
//! weighted with the facet's angle (Bærentzen and Aanæs, IEEE Trans. Vis. Comput. Graph. 11
//! (2005)).

use std::collections::{BTreeMap, HashMap, HashSet};

use carom_algebra::Vector;
use carom_solid::{Bounds, FacetShape};

use super::patch::{Feature, Nearest, Patch, PatchPoint, cross, place};
use crate::constants::{CANCELS, EDGES_CROSS, KINK};
use crate::kinematics::mirror::{Continuation, Continuations, contains, is_mirror, reflected};
use crate::kinematics::{Depth, Facets, OnFacet};

/// Number of pieces into which points between its ends divide a sharp edge.
const PIECES: usize = 8;
/// Contact holds every second of these points.
const HELD: usize = 2;

/// The facets of a side in space, all of one shape, which may be followed by the rest of the
/// boundary of its body.
#[derive(Clone, Debug)]
pub struct Boundary {
    shape: FacetShape,
    nodes: Vec<usize>,
    /// Across each edge of each facet: the same edge as one of the neighbouring facet.
    neighbours: Vec<[Option<EdgeOfFacet>; 4]>,
    /// Facets that meet at each node.
    around: HashMap<usize, Vec<usize>>,
    /// Facets that share a corner with each facet, without itself, ascending.
    rings: Vec<Vec<usize>>,
    side: usize,
    siblings: usize,
    is_whole: bool,
    /// Continuations of the surface where facets begin that are no surface.
    continuations: Continuations,
}

/// An edge of a facet; edge k runs from corner k to the next one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeOfFacet {
    pub(crate) facet: usize,
    pub(crate) edge: usize,
}

/// A point of a sharp edge, between its nodes.
pub(super) struct EdgePoint {
    /// The facets that meet at the edge.
    pub(super) facets: Vec<usize>,
    /// Nodes of the edge with their weights in the point.
    pub(super) nodes: Vec<(usize, f64)>,
}

/// A point relative to the nearest point of a facet.
pub struct Height {
    /// Distance of the point from the nearest point of the facet.
    pub distance: f64,
    /// Component of the offset along the normal of the boundary; zero at the tip of a slit.
    pub height: f64,
}

/// A point as seen from the nearest point of a facet.
struct Offset {
    /// Vector from the nearest point to the given one.
    vector: Vector<3>,
    /// Normal of the boundary at the nearest point, not of length one.
    normal: Vector<3>,
}

impl Boundary {
    /// Facets as lists of global nodes, corners first, counter-clockwise seen from outside: those
    /// of the side, then the `rest` of the body's boundary, of which the first `siblings` belong to
    /// sides that other contacts keep the same nodes away from.
    pub fn new(shape: FacetShape, side: &[Vec<usize>], rest: &[Vec<usize>], siblings: usize) -> Self {
        let facets: Vec<&Vec<usize>> = side.iter().chain(rest).collect();
        let count = shape.corners();
        let mut edges: HashMap<[usize; 2], EdgeOfFacet> = HashMap::new();
        let mut around: HashMap<usize, Vec<usize>> = HashMap::new();
        for (facet, nodes) in facets.iter().enumerate() {
            for edge in 0..count {
                edges.insert([nodes[edge], nodes[(edge + 1) % count]], EdgeOfFacet { facet, edge });
            }
            for &node in *nodes {
                around.entry(node).or_default().push(facet);
            }
        }
        let neighbours = |nodes: &&Vec<usize>| {
            std::array::from_fn(|e| {
                if e < count { edges.get(&[nodes[(e + 1) % count], nodes[e]]).copied() } else { None }
            })
        };
        let neighbours: Vec<[Option<EdgeOfFacet>; 4]> = facets.iter().map(neighbours).collect();
        let ring = |(facet, nodes): (usize, &&Vec<usize>)| {
            let around = nodes[..count].iter().flat_map(|corner| &around[corner]);
            let mut ring: Vec<usize> = around.copied().filter(|&other| other != facet).collect();
            ring.sort_unstable();
            ring.dedup();
            ring
        };
        let rings = facets.iter().enumerate().map(ring).collect();
        Self {
            shape,
            is_whole: neighbours.iter().all(|across| across[..count].iter().all(Option::is_some)),
            neighbours,
            nodes: facets.iter().flat_map(|nodes| nodes.iter().copied()).collect(),
            around,
            rings,
            side: side.len(),
            siblings: side.len() + siblings,
            continuations: Continuations::default(),
        }
    }

    /// Marks the facets that lie in a plane of symmetry at the positions `y`; `bodies`: a box
    /// around all bodies; `is_fixed`: whether a node is fixed along an axis.
    #[must_use]
    pub fn with_mirrors(
        mut self,
        y: &[f64],
        bodies: &Bounds,
        is_fixed: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let is_mirror = |facet: &[usize]| is_mirror(facet, y, 3, bodies, &is_fixed);
        self.continuations.mark(Continuation::Mirror, self.nodes.chunks_exact(self.shape.nodes()), is_mirror);
        self
    }

    /// Marks the facets that a tie has closed, given by their nodes in ascending order: where one
    /// begins the surface goes on along the other body.
    #[must_use]
    pub fn with_closed(mut self, closed: &HashSet<Vec<usize>>) -> Self {
        if !closed.is_empty() {
            let facets = self.nodes.chunks_exact(self.shape.nodes());
            self.continuations.mark(Continuation::Tied, facets, |facet| contains(closed, facet));
        }
        self
    }

    /// Continuation of the surface where a facet begins.
    pub(crate) fn continuation(&self, facet: usize) -> Continuation {
        self.continuations.of(facet)
    }

    /// Number of facets of the side.
    pub fn facets(&self) -> usize {
        self.side
    }

    /// Whether the facets form a closed surface: the whole boundary of the body is known.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    pub(crate) fn is_of_side(&self, facet: usize) -> bool {
        facet < self.side
    }

    pub(crate) fn is_of_sibling(&self, facet: usize) -> bool {
        (self.side..self.siblings).contains(&facet)
    }

    /// A facet of the boundary.
    pub fn patch(&self, facet: usize) -> Patch<'_> {
        Patch { shape: self.shape, nodes: self.nodes_of(facet) }
    }

    /// Smallest length of the facets.
    pub(super) fn shortest(&self, y: &[f64]) -> f64 {
        (0..self.all()).map(|facet| self.length(facet, y)).fold(f64::INFINITY, f64::min)
    }

    /// Position and normal in the middle of a facet.
    pub(crate) fn middle(&self, facet: usize, y: &[f64]) -> PatchPoint {
        let patch = self.patch(facet);
        patch.at(y, if patch.corners() == 3 { [1.0 / 3.0; 2] } else { [0.0; 2] })
    }

    /// The facet across an edge of a facet, if there is one.
    pub(crate) fn across(&self, facet: usize, edge: usize) -> Option<usize> {
        self.neighbours[facet][edge].map(|neighbour| neighbour.facet)
    }

    /// The facets that meet at a node.
    pub(crate) fn facets_around(&self, node: usize) -> &[usize] {
        self.around.get(&node).map_or(&[], Vec::as_slice)
    }

    /// The facets that meet at a corner of a facet, with itself.
    pub(super) fn around(&self, facet: usize, corner: usize) -> &[usize] {
        self.facets_around(self.patch(facet).nodes[corner])
    }

    /// The facets that meet at a corner of a facet, or across an edge, with itself, without those
    /// in planes of symmetry; corners are numbered before edges.
    pub(super) fn joined(&self, facet: usize, joint: u8) -> Vec<usize> {
        let corners = self.shape.corners();
        let mut joined = match usize::from(joint).checked_sub(corners) {
            None => self.around(facet, usize::from(joint)).to_vec(),
            Some(edge) => std::iter::once(facet).chain(self.across(facet, edge)).collect(),
        };
        joined.retain(|&facet| !self.is_mirror(facet));
        joined
    }

    /// Distance of a point, along the surface, from the joint at a corner or an edge of a facet;
    /// corners are numbered before edges.
    pub(super) fn past_joint(&self, facet: usize, joint: u8, point: Vector<3>, y: &[f64]) -> f64 {
        let patch = self.patch(facet);
        let corners = self.shape.corners();
        let Some(edge) = usize::from(joint).checked_sub(corners) else {
            let node = patch.nodes[usize::from(joint)];
            let normal = self.normal_at_corner(node, y);
            return cross(point - place(y, node), normal).norm() / normal.norm();
        };
        let [start, end] = [0.0, 1.0].map(|s| patch.at(y, patch.along(edge, s)).position);
        let along = end - start;
        let share = (point - start).dot(&along) / along.dot(&along);
        let s = share.clamp(0.0, 1.0);
        let [here, there] = self.normals_at_edge(facet, edge, s, y);
        let across = cross(along, here + there);
        let foot = patch.at(y, patch.along(edge, s)).position;
        let aside = (point - foot).dot(&across).abs() / across.norm();
        let is_past = share != s && !self.ends_at_rim(facet, edge, s, y);
        aside.hypot(if is_past { (share - s) * along.norm() } else { 0.0 })
    }

    /// Whether another side follows across an edge of a facet, with which another contact keeps the
    /// same nodes out.
    pub(super) fn meets_sibling(&self, facet: usize, edge: usize) -> bool {
        self.across(facet, edge).is_some_and(|next| self.is_of_sibling(next))
    }

    /// Whether no blunt joint with another facet of the side follows across an edge of a facet.
    pub(super) fn is_end(&self, facet: usize, edge: usize, y: &[f64]) -> bool {
        self.across(facet, edge).is_none_or(|next| {
            !self.is_mirror(next) && (!self.is_of_side(next) || self.is_sharp(facet, edge, y))
        })
    }

    /// Whether a point past the edges of a facet lies past the end of the smooth surface around it,
    /// by more than a tolerance relative to the length of a facet. Where that surface ends at a
    /// corner of the facet, and at none of its edges, the facet alone does not show it.
    pub(super) fn is_past_rim(&self, facet: usize, point: Vector<3>, tolerance: f64, y: &[f64]) -> bool {
        let is_of_surface = |other: usize| {
            self.is_of_side(other) && !self.is_mirror(other) && self.is_smooth(facet, other, y)
        };
        let around = self.ring(facet).iter().copied().filter(|&other| is_of_surface(other));
        let found = |facet: usize| (facet, self.patch(facet).nearest(y, point));
        let closer = |best: (usize, Nearest), next: (usize, Nearest)| {
            if next.1.distance < best.1.distance { next } else { best }
        };
        let (closest, nearest) = around.map(found).fold(found(facet), closer);
        let is_beyond = |of_facet: usize, edge: usize| {
            let within = if self.meets_sibling(of_facet, edge) { 0.0 } else { tolerance };
            self.is_end(of_facet, edge, y) && nearest.distance > within * self.length(of_facet, y)
        };
        match nearest.at {
            Feature::Inside => false,
            Feature::Edge(edge) => is_beyond(closest, edge),
            Feature::Corner(corner) => {
                let node = self.patch(closest).nodes[corner];
                let count = self.shape.corners();
                let meets = |of_facet: usize, edge: usize| {
                    let nodes = self.patch(of_facet).nodes;
                    [nodes[edge], nodes[(edge + 1) % count]].contains(&node)
                };
                let ends = |of_facet: usize| {
                    (0..count).any(|edge| meets(of_facet, edge) && is_beyond(of_facet, edge))
                };
                self.around(closest, corner).iter().any(|&other| is_of_surface(other) && ends(other))
            }
        }
    }

    /// Whether the joint at an edge of a facet ends at its corner, s = 0 or 1, where no other facet
    /// continues the smooth surface.
    fn ends_at_rim(&self, facet: usize, edge: usize, s: f64, y: &[f64]) -> bool {
        let corner = if s > 0.0 { (edge + 1) % self.shape.corners() } else { edge };
        let beside = self.across(facet, edge);
        let continues = |&other: &usize| {
            let is_surface = self.is_of_side(other) && !self.is_mirror(other);
            other != facet && Some(other) != beside && is_surface && self.is_smooth(facet, other, y)
        };
        !self.around(facet, corner).iter().any(continues)
    }

    /// Whether two facets with a common corner form a smooth surface, but for a small kink where
    /// they meet.
    pub(super) fn is_smooth(&self, facet: usize, other: usize, y: &[f64]) -> bool {
        let [here, there] = self.normals_where_met(facet, other, y);
        here.dot(&there) > KINK.cosine
    }

    /// Whether a facet turns away from the mean of all those at a corner, as at the tip of a cone.
    pub(super) fn is_tip(&self, corner: usize, y: &[f64]) -> bool {
        let mean = self.normal_at_corner(corner, y);
        let corners = self.shape.corners();
        let turns = |&facet: &usize| {
            let patch = self.patch(facet);
            let Some(place) = patch.nodes[..corners].iter().position(|&node| node == corner) else {
                return false;
            };
            let normal = patch.at(y, patch.along(place, 0.0)).normal;
            normal.dot(&mean) < KINK.cosine * mean.norm()
        };
        self.facets_around(corner).iter().filter(|facet| !self.is_mirror(**facet)).any(turns)
    }

    /// Normals of two facets where they meet: in the middle of their common edge, or at the corner.
    fn normals_where_met(&self, facet: usize, other: usize, y: &[f64]) -> [Vector<3>; 2] {
        let corners = self.shape.corners();
        if let Some(edge) = (0..corners).find(|&edge| self.across(facet, edge) == Some(other)) {
            return self.normals_at_edge(facet, edge, 0.5, y);
        }
        let [own, met] = [facet, other].map(|facet| self.patch(facet));
        let at = |patch: &Patch, corner: usize| patch.at(y, patch.along(corner, 0.0)).normal;
        for corner in 0..corners {
            let node = own.nodes[corner];
            let Some(same) = met.nodes[..corners].iter().position(|&other| other == node) else { continue };
            let normals = [at(&own, corner), at(&met, same)];
            // The edges of a degenerate facet may run along each other at a corner.
            if normals.iter().all(|normal| normal.norm().is_finite()) {
                return normals;
            }
        }
        [facet, other].map(|facet| self.middle(facet, y).normal)
    }

    /// The facets that share a corner with a facet, without itself, ascending.
    pub(crate) fn ring(&self, facet: usize) -> &[usize] {
        &self.rings[facet]
    }

    /// Outward normals on both sides of an edge of a facet, at the share s of its length from its
    /// first corner. Behind a plane of symmetry the mirror image of the facet follows, and behind a
    /// convex edge with a facet that a tie has closed the other body, taken for the mirror image.
    pub(crate) fn normals_at_edge(&self, facet: usize, edge: usize, s: f64, y: &[f64]) -> [Vector<3>; 2] {
        let own = self.patch(facet);
        let here = own.at(y, own.along(edge, s)).normal;
        let Some(neighbour) = self.neighbours[facet][edge] else { return [here, here] };
        let patch = self.patch(neighbour.facet);
        let there = patch.at(y, patch.along(neighbour.edge, 1.0 - s)).normal;
        let is_convex = || {
            let [start, end] = [0.0, 1.0].map(|s| own.at(y, own.along(edge, s)).position);
            here.dot(&there) < KINK.cosine && cross(here, there).dot(&(end - start)) > 0.0
        };
        let is_continued = |facet: usize| match self.continuation(facet) {
            Continuation::None => false,
            Continuation::Mirror => true,
            Continuation::Tied => is_convex(),
        };
        match [facet, neighbour.facet].map(is_continued) {
            [false, false] => [here, there],
            [false, true] => [here, reflected(here, there)],
            [true, false] => [reflected(there, here), there],
            [true, true] => [here, here],
        }
    }

    /// Whether the smooth surface ends at an edge of a facet, or is continued by its mirror image.
    pub(super) fn is_rim(&self, facet: usize, edge: usize, y: &[f64]) -> bool {
        self.is_end(facet, edge, y) || self.across(facet, edge).is_some_and(|next| self.is_mirror(next))
    }

    /// Whether an edge of a facet is sharp: convex, with a kink of more than 30°.
    pub(crate) fn is_sharp(&self, facet: usize, edge: usize, y: &[f64]) -> bool {
        let [here, there] = self.normals_at_edge(facet, edge, 0.5, y);
        let nodes = self.patch(facet).nodes;
        let along = place(y, nodes[(edge + 1) % self.shape.corners()]) - place(y, nodes[edge]);
        // Counter-clockwise seen from outside: at a convex edge the normals turn about it.
        here.dot(&there) < KINK.cosine && cross(here, there).dot(&along) > 0.0
    }

    /// Whether a sharp edge at a node crosses a direction.
    pub(super) fn has_edge_across(&self, node: usize, direction: Vector<3>, y: &[f64]) -> bool {
        let crosses = |facet: usize, edge: usize| {
            let (nodes, count) = self.shape.edge(edge);
            let of_edge = nodes[..count].iter().map(|&k| self.patch(facet).nodes[k]);
            let along =
                place(y, self.patch(facet).nodes[nodes[1]]) - place(y, self.patch(facet).nodes[nodes[0]]);
            let sine = cross(along, direction).norm();
            of_edge.into_iter().any(|other| other == node)
                && sine >= EDGES_CROSS * along.norm() * direction.norm()
                && self.is_sharp(facet, edge, y)
        };
        let facets = self.facets_around(node).iter().filter(|&&facet| !self.is_mirror(facet));
        facets.into_iter().any(|&facet| (0..self.shape.corners()).any(|edge| crosses(facet, edge)))
    }

    /// The facets that share a corner with a facet and bend away from it there by more than 30°.
    pub(super) fn bent_away(&self, facet: usize, y: &[f64]) -> impl Iterator<Item = usize> {
        let here = self.middle(facet, y);
        self.ring(facet).iter().copied().filter(|&other| !self.is_mirror(other)).filter(move |&other| {
            let there = self.middle(other, y);
            let way = there.position - here.position;
            !self.is_smooth(facet, other, y) && way.dot(&here.normal) < 0.0 && way.dot(&there.normal) > 0.0
        })
    }

    /// Nodes of the side where sharp convex edges of different directions meet, ascending.
    pub fn corners(&self, y: &[f64]) -> Vec<usize> {
        let count = self.shape.corners();
        let mut directions: BTreeMap<usize, Vec<Vector<3>>> = BTreeMap::new();
        for facet in 0..self.side {
            let patch = self.patch(facet);
            for edge in (0..count).filter(|&edge| self.is_sharp(facet, edge, y)) {
                let ends = [edge, (edge + 1) % count].map(|corner| patch.nodes[corner]);
                let along = place(y, ends[1]) - place(y, ends[0]);
                let along = along * along.norm().recip();
                ends.iter().for_each(|&node| directions.entry(node).or_default().push(along));
            }
        }
        let turns = |at: &Vec<Vector<3>>| at.iter().any(|along| along.dot(&at[0]).abs() < KINK.cosine);
        directions.into_iter().filter(|(_, at)| turns(at)).map(|(node, _)| node).collect()
    }

    /// Nodes of the side at corners and on sharp convex edges, ascending.
    pub fn nodes_of_sharp_edges(&self, y: &[f64]) -> Vec<usize> {
        let of_edge = |EdgeOfFacet { facet, edge }: EdgeOfFacet| {
            let (nodes, count) = self.shape.edge(edge);
            nodes.into_iter().take(count).map(move |node| self.patch(facet).nodes[node])
        };
        let mut nodes: Vec<usize> = self.sharp_edges(y).into_iter().flat_map(of_edge).collect();
        nodes.extend(self.corners(y));
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The sharp convex edges of the side, each once, as an edge of the first facet that contains
    /// it.
    pub(crate) fn sharp_edges(&self, y: &[f64]) -> Vec<EdgeOfFacet> {
        let count = self.shape.corners();
        let all = (0..self.side).flat_map(|facet| (0..count).map(move |edge| EdgeOfFacet { facet, edge }));
        let is_first = |facet: usize, edge: usize| self.across(facet, edge).is_none_or(|other| facet < other);
        let is_sharp = |&EdgeOfFacet { facet, edge }: &EdgeOfFacet| {
            is_first(facet, edge) && self.is_sharp(facet, edge, y)
        };
        all.filter(is_sharp).collect()
    }

    /// Points of the side's sharp convex edges, between their nodes, at which contact holds them.
    pub(super) fn edge_points(&self, y: &[f64]) -> Vec<EdgePoint> {
        let mut points = Vec::new();
        for EdgeOfFacet { facet, edge } in self.sharp_edges(y) {
            let facets: Vec<usize> = std::iter::once(facet).chain(self.across(facet, edge)).collect();
            let nodes = (1..PIECES).filter(|k| k % HELD == 0).map(|k| self.on_edge(facet, edge, k));
            let between = nodes.filter(|nodes| nodes.len() > 1);
            points.extend(between.map(|nodes| EdgePoint { facets: facets.clone(), nodes }));
        }
        points
    }

    /// The k-th of the points between the ends of an edge, as nodes with weights.
    fn on_edge(&self, facet: usize, edge: usize, k: usize) -> Vec<(usize, f64)> {
        let patch = self.patch(facet);
        let values = self.shape.functions(patch.along(edge, k as f64 / PIECES as f64)).values.into_iter();
        let weights = patch.nodes.iter().copied().zip(values);
        weights.filter(|(_, weight)| weight.abs() > f64::EPSILON).collect()
    }

    /// The boundary with points of edges, numbered from `first` on.
    pub(super) fn with_points(mut self, first: usize, points: &[EdgePoint]) -> Self {
        self.around.extend(points.iter().enumerate().map(|(k, point)| (first + k, point.facets.clone())));
        self
    }

    /// Points between the ends of the side's sharp convex edges, each as nodes with weights.
    pub fn points_of_sharp_edges(&self, y: &[f64]) -> Vec<Vec<(usize, f64)>> {
        let edges = self.sharp_edges(y).into_iter();
        edges
            .flat_map(|EdgeOfFacet { facet, edge }| (1..PIECES).map(move |k| self.on_edge(facet, edge, k)))
            .collect()
    }

    /// Position relative to the boundary of a point whose nearest facet, and the nearest point of
    /// that facet, are known.
    pub(super) fn depth_from(&self, facet: usize, nearest: Nearest, point: Vector<3>, y: &[f64]) -> Depth {
        let Offset { vector, normal } = self.offset(facet, nearest, point, y);
        let distance = if vector.dot(&normal) >= 0.0 { nearest.distance } else { -nearest.distance };
        Depth { distance, facet, xi: nearest.xi }
    }

    /// Height of a point over the boundary at the nearest point of a facet.
    pub fn height(&self, facet: usize, point: Vector<3>, y: &[f64]) -> Height {
        let nearest = self.patch(facet).nearest(y, point);
        let Offset { vector, normal } = self.offset(facet, nearest, point, y);
        let size = normal.norm();
        // Where two normals are opposite, none points outwards.
        let height = if size > CANCELS { vector.dot(&normal) / size } else { 0.0 };
        Height { distance: nearest.distance, height }
    }

    /// The offset of a point from the nearest point of a facet.
    fn offset(&self, facet: usize, nearest: Nearest, point: Vector<3>, y: &[f64]) -> Offset {
        let patch = self.patch(facet);
        let at = patch.at(y, nearest.xi);
        let normal = match nearest.at {
            Feature::Inside => at.normal,
            Feature::Edge(edge) => {
                let s = {
                    let [a, b] = [0.0, 1.0].map(|s| patch.along(edge, s));
                    let i = usize::from((b[1] - a[1]).abs() > (b[0] - a[0]).abs());
                    (nearest.xi[i] - a[i]) / (b[i] - a[i])
                };
                let [here, there] = self.normals_at_edge(facet, edge, s, y);
                here + there
            }
            Feature::Corner(corner) => self.normal_at_corner(patch.nodes[corner], y),
        };
        Offset { vector: point - at.position, normal }
    }

    /// Where a node lies on the outline of a facet; none of inner nodes.
    fn on_outline(&self, facet: usize, node: usize) -> Option<[f64; 2]> {
        let patch = self.patch(facet);
        let count = patch.corners();
        let degree = self.shape.degree();
        let place = patch.nodes[..count * degree].iter().position(|&n| n == node)?;
        // Behind the corners come the inner nodes of edge after edge.
        let Some(inner) = place.checked_sub(count) else { return Some(patch.corner(place)) };
        let edge = inner / (degree - 1);
        let k = inner % (degree - 1);
        Some(patch.along(edge, (k + 1) as f64 / degree as f64))
    }

    /// Normals at a node of the facets that meet there. Points of edges and inner nodes of facets
    /// take those in the middles of the facets, and so do corners without a normal.
    pub(super) fn normals_at(&self, node: usize, y: &[f64]) -> Vec<Vector<3>> {
        let normal = |&facet: &usize| {
            let at_node = self.on_outline(facet, node).map(|xi| self.patch(facet).at(y, xi).normal);
            let known = at_node.filter(|normal| normal.norm().is_finite());
            known.unwrap_or_else(|| self.middle(facet, y).normal)
        };
        self.facets_around(node).iter().map(normal).collect()
    }

    /// Sum of the normals at a corner, weighted with the facets' angles, with those of mirror
    /// images.
    fn normal_at_corner(&self, node: usize, y: &[f64]) -> Vector<3> {
        let mut sum = Vector::ZERO;
        let count = self.shape.corners();
        for &facet in self.around.get(&node).into_iter().flatten() {
            if self.is_mirror(facet) {
                continue;
            }
            let patch = self.patch(facet);
            let Some(corner) = patch.nodes[..count].iter().position(|&n| n == node) else { continue };
            let at = patch.at(y, patch.corner(corner));
            // Directions of both edges at the corner.
            let [out, back] =
                [patch.along(corner, 1.0), patch.corner((corner + count - 1) % count)].map(|to| {
                    let here = patch.corner(corner);
                    at.tangents[0] * (to[0] - here[0]) + at.tangents[1] * (to[1] - here[1])
                });
            let angle = cross(out, back).norm().atan2(out.dot(&back));
            sum += at.normal * angle;
        }
        for &facet in self.facets_around(node).iter().filter(|&&facet| self.is_mirror(facet)) {
            let across = self.middle(facet, y).normal;
            sum -= across * sum.dot(&across);
        }
        sum
    }
}

impl Facets<3> for Boundary {
    fn facets_at(&self, node: usize) -> Vec<OnFacet<[f64; 2]>> {
        let around = self.facets_around(node).iter().filter(|&&facet| self.is_of_side(facet));
        around.filter_map(|&facet| Some(OnFacet { facet, xi: self.on_outline(facet, node)? })).collect()
    }

    fn shape(&self) -> FacetShape {
        self.shape
    }

    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn is_mirror(&self, facet: usize) -> bool {
        self.continuation(facet) == Continuation::Mirror
    }

    fn beside(&self, facet: usize) -> impl Iterator<Item = usize> {
        self.ring(facet).iter().copied()
    }

    fn distance(&self, facet: usize, point: Vector<3>, y: &[f64]) -> f64 {
        self.patch(facet).nearest(y, point).distance
    }

    fn depth(&self, facet: usize, point: Vector<3>, y: &[f64]) -> Depth {
        self.depth_from(facet, self.patch(facet).nearest(y, point), point, y)
    }

    fn normal(&self, facet: usize, xi: [f64; 2], y: &[f64]) -> Vector<3> {
        self.patch(facet).at(y, xi).normal
    }
}
