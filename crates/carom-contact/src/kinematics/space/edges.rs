//! The sharp convex edges of a side, each with the two facets that meet there, and what continues
//! them at their ends.

use std::collections::{BTreeSet, HashMap};

use carom_algebra::Vector;
use carom_solid::{Bounds, Hull, line_shape};

use super::boundary::{Boundary, EdgeOfFacet};
use super::patch::{cross, place};
use crate::constants::KINK;
use crate::kinematics::Facets;

/// The sharp convex edges of a side.
#[derive(Debug)]
pub(super) struct Edges {
    boundary: Boundary,
    /// Every sharp edge as an edge of the first facet that contains it.
    places: Vec<EdgeOfFacet>,
    /// Nodes of every edge, ends first.
    nodes: Vec<Vec<usize>>,
    /// The edges that continue every edge at its start and at its end, and whether they do so with
    /// their own end.
    next: Vec<[Option<(usize, bool)>; 2]>,
    hull: Hull,
}

/// A point of a sharp edge.
pub(super) struct OnEdge {
    pub(super) edge: usize,
    /// Coordinate along the edge, −1 … 1 between its ends.
    pub(super) xi: f64,
}

impl Edges {
    /// The sharp edges of a side at its reference positions, without those between nodes of other
    /// sides, whose contacts constrain them.
    pub(super) fn new(boundary: Boundary, others: &BTreeSet<usize>, reference: &[f64]) -> Self {
        let shape = boundary.shape();
        let nodes_of = |&EdgeOfFacet { facet, edge }: &EdgeOfFacet| {
            let (local, count) = shape.edge(edge);
            local[..count].iter().map(|&k| boundary.nodes_of(facet)[k]).collect::<Vec<usize>>()
        };
        let mut places = boundary.sharp_edges(reference);
        places.retain(|place| !nodes_of(place).iter().all(|node| others.contains(node)));
        let nodes: Vec<Vec<usize>> = places.iter().map(nodes_of).collect();
        let mut at: HashMap<usize, Vec<(usize, bool)>> = HashMap::new();
        for (k, nodes) in nodes.iter().enumerate() {
            for is_end in [false, true] {
                at.entry(nodes[usize::from(is_end)]).or_default().push((k, is_end));
            }
        }
        // Out of the edge at that end.
        let leaving = |k: usize, is_end: bool| {
            let [from, to] = [!is_end, is_end].map(|end| place(reference, nodes[k][usize::from(end)]));
            let along = to - from;
            along * along.norm().recip()
        };
        let next = |k: usize, is_end: bool| {
            let out = leaving(k, is_end);
            let others = at[&nodes[k][usize::from(is_end)]].iter().filter(|(other, _)| *other != k);
            let straight = others.map(|&(other, end)| (-leaving(other, end).dot(&out), other, end));
            let best = straight.fold((KINK.cosine, None), |best, (cosine, other, end)| {
                if cosine > best.0 { (cosine, Some((other, end))) } else { best }
            });
            best.1
        };
        let next = (0..nodes.len()).map(|k| [next(k, false), next(k, true)]).collect();
        let hull = Hull::line(shape.degree() + 1, 1.0);
        Self { boundary, places, nodes, next, hull }
    }

    /// Number of sharp edges.
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Number of facets of the side.
    pub(super) fn facets(&self) -> usize {
        self.boundary.facets()
    }

    /// Nodes of an edge, ends first.
    pub(super) fn nodes(&self, edge: usize) -> &[usize] {
        &self.nodes[edge]
    }

    /// The first of the facets that meet at an edge.
    pub(super) fn facet(&self, edge: usize) -> usize {
        self.places[edge].facet
    }

    /// Nodes of the facets that meet at an edge.
    pub(super) fn around(&self, edge: usize) -> impl Iterator<Item = usize> {
        let place = self.places[edge];
        let facets = std::iter::once(place.facet).chain(self.boundary.across(place.facet, place.edge));
        facets.flat_map(|facet| self.boundary.nodes_of(facet).iter().copied())
    }

    /// Bound of the sum of the weights of an edge's nodes in the points of its bounding box.
    pub(super) fn weight(&self) -> f64 {
        self.hull.weight()
    }

    /// Bounding box of an edge.
    pub(super) fn bounds(&self, edge: usize, y: &[f64]) -> Bounds {
        let nodes = &self.nodes[edge];
        self.hull.bounds(|a| &y[3 * nodes[a]..3 * nodes[a] + 3])
    }

    /// Distance between the ends of an edge.
    pub(super) fn length(&self, edge: usize, y: &[f64]) -> f64 {
        (place(y, self.nodes[edge][1]) - place(y, self.nodes[edge][0])).norm()
    }

    /// The point of the next edge that lies as far from the common joint as ξ lies past the end of
    /// an edge, if another edge continues it.
    pub(super) fn beyond(&self, edge: usize, xi: f64) -> Option<OnEdge> {
        let (next, is_end) = self.next[edge][usize::from(xi > 0.0)]?;
        let excess = xi.abs() - 1.0;
        Some(OnEdge { edge: next, xi: if is_end { 1.0 - excess } else { excess - 1.0 } })
    }

    /// The node of the joint with the edge that continues an edge at the end next to ξ, if one
    /// does, and a direction along both edges there, not normalised.
    pub(super) fn joint(&self, edge: usize, xi: f64, y: &[f64]) -> Option<(usize, Vector<3>)> {
        let is_end = xi > 0.0;
        let (next, next_is_end) = self.next[edge][usize::from(is_end)]?;
        let leaving = |edge: usize, is_end: bool| {
            let nodes = &self.nodes[edge];
            let end = if is_end { 1.0 } else { -1.0 };
            let from = place(y, nodes[usize::from(is_end)]);
            let slopes = line_shape(nodes.len(), end).first;
            let tangent: Vector<3> = nodes
                .iter()
                .zip(slopes)
                .fold(Vector::ZERO, |sum, (&node, slope)| sum + (place(y, node) - from) * slope);
            tangent * (end / tangent.norm())
        };
        let node = self.nodes[edge][usize::from(is_end)];
        Some((node, leaving(edge, is_end) - leaving(next, next_is_end)))
    }

    /// Whether two edges are equal or one continues the other.
    pub(super) fn is_near(&self, edge: usize, other: usize) -> bool {
        edge == other || self.next[edge].iter().flatten().any(|&(next, _)| next == other)
    }

    /// Outward normals of the two facets that meet at an edge, at ξ.
    pub(super) fn normals(&self, edge: usize, xi: f64, y: &[f64]) -> [Vector<3>; 2] {
        let place = self.places[edge];
        self.boundary.normals_at_edge(place.facet, place.edge, 0.5 * (1.0 + xi.clamp(-1.0, 1.0)), y)
    }

    /// Sine of the angle by which a direction points out of the body at ξ of an edge with this
    /// tangent: the smaller one of its angles to the planes perpendicular to the two facets;
    /// positive between the normals of the facets.
    pub(super) fn outwards(
        &self,
        edge: usize,
        xi: f64,
        tangent: Vector<3>,
        direction: Vector<3>,
        y: &[f64],
    ) -> f64 {
        let [here, there] = self.normals(edge, xi, y);
        // Into the facets: counter-clockwise seen from outside.
        let first = cross(here, tangent);
        let second = cross(tangent, there);
        -first.dot(&direction).max(second.dot(&direction))
    }
}
