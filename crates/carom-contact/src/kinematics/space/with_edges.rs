//! Nodes against facets in both directions, and sharp edges against sharp edges: the edges of the
//! secondary side are numbered after the nodes, those of the primary after its facets.

use super::edge_to_edge::EdgeToEdge;
use super::node_to_patch::NodeToPatch;
use crate::kinematics::{BothSides, Kinematics, Passed};
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// Contact of nodes with facets in both directions, and of sharp edges with each other.
#[derive(Debug)]
pub struct WithEdges {
    nodes: BothSides<NodeToPatch>,
    edges: EdgeToEdge,
    facets: usize,
    all: Vec<usize>,
}

impl WithEdges {
    /// Combines contact of nodes in both directions with that of the sharp edges of the same sides;
    /// `facets`: number of facets of the primary side.
    pub fn new(nodes: BothSides<NodeToPatch>, edges: EdgeToEdge, facets: usize) -> Self {
        let all = nodes.secondary().iter().copied().chain(edges.names()).collect();
        Self { nodes, edges, facets, all }
    }

    /// A pair of two edges, with the first edge numbered among the edges; none for a pair of a
    /// node.
    fn of_edges(&self, pair: &Pair) -> Option<Pair> {
        let node = pair.node.checked_sub(self.nodes())?;
        Some(Pair { node, ..*pair })
    }
}

impl Kinematics for WithEdges {
    fn secondary(&self) -> &[usize] {
        &self.all
    }

    fn nodes(&self) -> usize {
        self.nodes.secondary().len()
    }

    fn allowed(&self, node: usize) -> f64 {
        if node < self.nodes() { self.nodes.allowed(node) } else { 0.0 }
    }

    fn keep(&mut self, depths: &[f64]) {
        let count = self.nodes().min(depths.len());
        self.nodes.keep(&depths[..count]);
    }

    fn kept(&self, node: usize) -> f64 {
        if node < self.nodes() { self.nodes.kept(node) } else { 0.0 }
    }

    fn roundings(&self, y: &[f64]) -> Vec<f64> {
        self.nodes.roundings(y)
    }

    fn facet_nodes(&self, pair: &Pair) -> &[usize] {
        match self.of_edges(pair) {
            Some(pair) => self.edges.nodes_of(&pair),
            None => self.nodes.facet_nodes(pair),
        }
    }

    fn is_on_facet(&self, pair: &Pair) -> bool {
        pair.node < self.nodes() && self.nodes.is_on_facet(pair)
    }

    fn facets(&self, node: usize) -> usize {
        if node < self.nodes() { self.nodes.facets(node) } else { self.facets + self.edges.count() }
    }

    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        // An edge has no gap without the other one.
        if node < self.nodes() { self.nodes.signed_distance(node, y) } else { Some(f64::INFINITY) }
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let mut edges = pairing.split_off(self.nodes());
        let changed = self.nodes.search(before, now, pairing, events)
            | self.edges.search(before, now, &mut edges, events);
        pairing.append(edges, self.nodes());
        changed
    }

    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        self.nodes.passed(before, now, bounce).or_else(|| self.edges.passed(before, now, bounce))
    }

    fn met(&self, nodes: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>> {
        let own: Vec<usize> = nodes.iter().copied().filter(|node| *node < self.nodes()).collect();
        let mut of_nodes = self.nodes.met(&own, before, now).into_iter();
        let met = |node: &usize| match node.checked_sub(self.nodes()) {
            None => of_nodes.next().flatten(),
            Some(edge) => self.edges.met(edge, before, now),
        };
        nodes.iter().map(met).collect()
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        let edges = pairing.split_off(self.nodes());
        let changed = self.nodes.update_facets(now, pairing, events);
        pairing.append(edges, self.nodes());
        changed
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let Some(mut local) = self.of_edges(pair) else { return self.nodes.measure(pair, y, rows) };
        self.edges.measure(&mut local, y, rows)?;
        pair.xi = local.xi;
        pair.eta = local.eta;
        Ok(())
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        match self.of_edges(pair) {
            Some(pair) => self.edges.curvature_into(&pair, y, curvature),
            None => self.nodes.curvature_into(pair, y, curvature),
        }
    }

    fn slip(&self, pair: &Pair, y: &[f64], moved: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        match self.of_edges(pair) {
            Some(pair) => self.edges.slip(&pair, y, rows),
            None => self.nodes.slip(pair, y, moved, rows),
        }
    }

    fn slip_derivative_into(
        &self,
        pair: &Pair,
        y: &[f64],
        moved: &[f64],
        tangent: usize,
        matrix: &mut [f64],
    ) {
        // Edges have no friction, whose force would need it.
        match self.of_edges(pair) {
            Some(_) => matrix.fill(0.0),
            None => self.nodes.slip_derivative_into(pair, y, moved, tangent, matrix),
        }
    }
}
