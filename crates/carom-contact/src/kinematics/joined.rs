//! Two kinds of contact of the same bodies in one set of pairs: nodes against facets or against a
//! rigid obstacle, and what may lie between the nodes, numbered after them. In space these are
//! sharp edges against sharp edges, the edges of the primary being numbered after its facets; in
//! the plane convex corners and round parts of an obstacle against facets.

use carom_algebra::Threads;

use super::node_to_obstacle::NodeToObstacle;
use super::obstacle::Tip;
use super::space::{EdgeToEdge, NodeToPatch};
use super::tip_to_facet::TipToFacet;
use super::{BothSides, Kinematics, NodalPressure, Passed};
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// Contact of nodes with facets in both directions, and of sharp edges with each other.
pub type WithEdges = Joined<BothSides<NodeToPatch>, EdgeToEdge>;
/// Contact of nodes with a rigid obstacle, and of the obstacle's convex parts with facets.
pub type WithTips = Joined<NodeToObstacle, TipToFacet>;

/// Contact of nodes, and of what lies between them.
#[derive(Debug)]
pub struct Joined<N, B> {
    nodes: N,
    between: B,
    all: Vec<usize>,
}

impl<N: Kinematics, B: Kinematics> Joined<N, B> {
    /// Combines contact of nodes with that of what lies between them.
    pub fn new(nodes: N, between: B) -> Self {
        let all = [nodes.secondary(), between.secondary()].concat();
        Self { nodes, between, all }
    }

    /// Number of pairs' nodes that come first.
    fn count(&self) -> usize {
        self.nodes.secondary().len()
    }

    /// The kind of contact to which a secondary node, given by index, belongs, and its index there.
    fn of(&self, node: usize) -> (&dyn Kinematics, usize) {
        match node.checked_sub(self.count()) {
            None => (&self.nodes, node),
            Some(node) => (&self.between, node),
        }
    }

    /// Applies a function to the pairs of each kind, numbered within it.
    fn each(&self, pairing: &mut Pairing, mut of: impl FnMut(&dyn Kinematics, &mut Pairing) -> bool) -> bool {
        let mut between = pairing.split_off(self.count());
        let changed = of(&self.nodes, pairing) | of(&self.between, &mut between);
        pairing.append(between, self.count());
        changed
    }
}

impl<N: Kinematics, B: Kinematics> Kinematics for Joined<N, B> {
    fn secondary(&self) -> &[usize] {
        &self.all
    }

    fn nodes(&self) -> usize {
        let first = self.nodes.nodes();
        // Multipliers of a mortar are no nodes, and come first.
        if first < self.count() { first } else { first + self.between.nodes() }
    }

    fn rubbing(&self) -> usize {
        self.nodes.rubbing() + self.between.rubbing()
    }

    fn allowed(&self, node: usize) -> f64 {
        let (kind, node) = self.of(node);
        kind.allowed(node)
    }

    fn keep(&mut self, depths: &[f64]) {
        let (nodes, between) = depths.split_at(self.count().min(depths.len()));
        self.nodes.keep(nodes);
        self.between.keep(between);
    }

    fn kept(&self, node: usize) -> f64 {
        let (kind, node) = self.of(node);
        kind.kept(node)
    }

    fn on(&mut self, threads: &Threads) {
        self.nodes.on(threads);
        self.between.on(threads);
    }

    fn kept_at_nodes(&self) -> Vec<(usize, f64)> {
        [self.nodes.kept_at_nodes(), self.between.kept_at_nodes()].concat()
    }

    fn roundings(&self, y: &[f64]) -> Vec<f64> {
        self.nodes.roundings(y)
    }

    fn facet_nodes(&self, pair: &Pair) -> &[usize] {
        let (kind, node) = self.of(pair.node);
        kind.facet_nodes(&Pair { node, ..*pair })
    }

    fn is_on_facet(&self, pair: &Pair) -> bool {
        let (kind, node) = self.of(pair.node);
        kind.is_on_facet(&Pair { node, ..*pair })
    }

    fn facets(&self, node: usize) -> usize {
        let (kind, node) = self.of(node);
        kind.facets(node)
    }

    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        let (kind, node) = self.of(node);
        kind.signed_distance(node, y)
    }

    fn distance_to_obstacle(&self, node: usize, y: &[f64]) -> Option<f64> {
        self.nodes.distance_to_obstacle(node, y)
    }

    fn tips(&self, y: &[f64]) -> Vec<Tip> {
        self.nodes.tips(y)
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        self.each(pairing, |kind, pairing| kind.search(before, now, pairing, events))
    }

    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        self.nodes.passed(before, now, bounce).or_else(|| self.between.passed(before, now, bounce))
    }

    fn met(&self, nodes: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>> {
        let (own, between): (Vec<usize>, Vec<usize>) = nodes.iter().partition(|node| **node < self.count());
        let between: Vec<usize> = between.iter().map(|node| node - self.count()).collect();
        let mut of_nodes = self.nodes.met(&own, before, now).into_iter();
        let mut of_between = self.between.met(&between, before, now).into_iter();
        let met = |node: &usize| if *node < self.count() { of_nodes.next() } else { of_between.next() };
        nodes.iter().map(met).map(Option::flatten).collect()
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        self.each(pairing, |kind, pairing| kind.update_facets(now, pairing, events))
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let (kind, node) = self.of(pair.node);
        let mut local = Pair { node, ..*pair };
        let measured = kind.measure(&mut local, y, rows);
        *pair = Pair { node: pair.node, ..local };
        measured
    }

    fn nearest(&self, pair: &Pair, gap: f64, y: &[f64]) -> f64 {
        let (kind, node) = self.of(pair.node);
        kind.nearest(&Pair { node, ..*pair }, gap, y)
    }

    fn is_of_field(&self, node: usize) -> bool {
        let (kind, node) = self.of(node);
        kind.is_of_field(node)
    }

    fn area(&self, node: usize) -> Option<f64> {
        let (kind, node) = self.of(node);
        kind.area(node)
    }

    fn pressure_field(&self, pairs: &[Pair], y: &[f64], thickness: f64) -> Vec<NodalPressure> {
        let own = &pairs[..pairs.partition_point(|pair| pair.node < self.count())];
        self.nodes.pressure_field(own, y, thickness)
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        let (kind, node) = self.of(pair.node);
        kind.curvature_into(&Pair { node, ..*pair }, y, curvature);
    }

    fn slip(&self, pair: &Pair, y: &[f64], moved: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let (kind, node) = self.of(pair.node);
        kind.slip(&Pair { node, ..*pair }, y, moved, rows)
    }

    fn slip_derivative_into(
        &self,
        pair: &Pair,
        y: &[f64],
        moved: &[f64],
        tangent: usize,
        matrix: &mut [f64],
    ) {
        let (kind, node) = self.of(pair.node);
        kind.slip_derivative_into(&Pair { node, ..*pair }, y, moved, tangent, matrix);
    }
}
