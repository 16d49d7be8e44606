//! Secondary nodes against the primary side, and nodes of the primary side against the secondary
//! one, in one set of constraints:
//!
//! ```text
//! secondary nodes, corners of the primary    g ≥ 0
//! other nodes of the primary                 g ≥ −d,   d a fiftieth of a secondary facet
//! ```
//!
//! No secondary node enters the primary, and no corner of the primary cuts into an edge of the
//! secondary between two of its nodes. The other nodes follow the secondary side's edges to within
//! d: with d = 0 the sides would be constrained twice, and meshes that do not match would lock.
//!
//! In contact of a side with itself, each of two places that meet is secondary and primary. The one
//! that comes later along the boundary is the secondary (`folds.rs`): all nodes are in either
//! direction, in the first with the facets before them, in the second with those after them. The
//! nodes of a zone of contact are then secondary on one of its flanks and follow on the other one,
//! as between two bodies. Constraining both flanks would lock them; neither, or the mean of both
//! gaps, would let nodes through. Either choice of the flank gives the same answer where nodes
//! meet nodes.
//!
//! The nodes of the primary follow those of the secondary side. Where a corner meets a secondary
//! node and a facet at the corner is parallel to the secondary one, either row would prevent
//! penetration, and both would be nearly dependent: the corner is then left to the node. It is not
//! left to one in a concave corner, whose row may be that with another facet.

use std::sync::Arc;

use carom_algebra::{Threads, Vector};

use super::Kinematics;
use super::facets::OnFacet;
use super::folds::{Folds, Side};
use super::node_to_facet::{Detection, NodeToFacet};
use super::one_way::OneWay;
use super::passed::Passed;
use super::space::cross;
use super::surface::Surface;
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// Sine of the angle, 30°, above which a facet rises in front of another one.
const RISES: f64 = 0.5;
/// Cosine of the angle, 10°, up to which two facets count as parallel.
pub(super) const PARALLEL: f64 = 0.985;

/// Nodes of a side with the depth that each may have without contact.
#[derive(Clone, Debug, PartialEq)]
pub struct NodesWithDepth {
    /// Global numbers of the nodes.
    pub nodes: Vec<usize>,
    /// Allowed depth ≥ 0 of each node.
    pub depths: Vec<f64>,
}

impl NodesWithDepth {
    /// The nodes that may have no depth.
    #[must_use]
    pub fn without_depth(self) -> Self {
        let all = self.nodes.into_iter().zip(self.depths);
        let (nodes, depths) = all.filter(|(_, depth)| *depth == 0.0).unzip();
        Self { nodes, depths }
    }
}

/// Contact in both directions: secondary nodes against the primary side, and nodes of the primary
/// side against the secondary one.
#[derive(Debug)]
pub struct BothSides<K> {
    forward: K,
    reverse: K,
    /// Facets of the primary side at each of its corners, with the coordinates of the corner on
    /// them; none at its other nodes.
    corners: Vec<Vec<OnFacet<[f64; 2]>>>,
    all: Vec<usize>,
    threads: Threads,
}

impl BothSides<NodeToFacet> {
    /// A side against itself: its nodes in the role of the later place, and those in the role of
    /// the earlier one, whose depth is zero at corners; `piece`: the connected piece of its body to
    /// which each node belongs, from `first_node` on; `reference`: the reference positions, flat
    /// over all nodes; `single`: whether a node over a joint has a pair with one facet.
    pub fn of_itself(
        side: &Surface,
        nodes: Vec<usize>,
        earlier: NodesWithDepth,
        piece: &[usize],
        first_node: usize,
        reference: &[f64],
        single: bool,
    ) -> Self {
        let folds = Arc::new(Folds::new(side, piece, first_node, reference));
        let of = |nodes: Vec<usize>, which: Side| {
            let nodes = NodeToFacet::new(nodes, side.clone(), Detection::ClosestPoint);
            nodes.with_single_facets(single).of_body(side.clone()).folding(folds.clone(), which)
        };
        Self::new(of(nodes, Side::Later), of(earlier.nodes, Side::Earlier).with_allowed(earlier.depths))
    }
}

impl<K: OneWay> BothSides<K> {
    /// Contact in both directions; `forward`: secondary nodes against the primary side; `reverse`:
    /// nodes of the primary side, of which corners have no allowed depth, against the secondary
    /// side.
    pub fn new(forward: K, reverse: K) -> Self {
        let all = [forward.secondary(), reverse.secondary()].concat();
        let corner = |(k, &node): (usize, &usize)| match reverse.allowed(k) {
            0.0 => forward.facets_at(node),
            _ => Vec::new(),
        };
        let corners = reverse.secondary().iter().enumerate().map(corner).collect();
        Self { forward, reverse, corners, all, threads: Threads::one() }
    }

    /// The direction of contact to which a node belongs, and the index of the node in it.
    fn direction(&self, node: usize) -> (&K, usize) {
        let count = self.forward.secondary().len();
        if node < count { (&self.forward, node) } else { (&self.reverse, node - count) }
    }

    /// Whether a corner of the primary meets a node of the secondary facet that it faces and has a
    /// facet parallel to that one, so that the node alone prevents penetration.
    fn is_left_to_node(&self, corner: &Pair, y: &[f64]) -> bool {
        let node = self.reverse.secondary()[corner.node];
        let normal = Vector(self.reverse.normal(corner.facet, [corner.xi, corner.eta], y));
        let faced = self.reverse.nodes_of(corner.facet);
        self.corners[corner.node].iter().any(|&OnFacet { facet, xi }| {
            let own = Vector(self.forward.normal(facet, xi, y));
            // Where an overlap is kept, they meet at that distance.
            let near = K::NEAR_END * self.forward.length(facet, y) + self.reverse.kept(corner.node);
            // Without regard to their depth, which may be large before convergence.
            let meets = |other: usize| cross(self.reverse.offset(other, node, y), normal).norm() < near;
            own.dot(&normal) < -PARALLEL
                && faced.iter().any(|&other| meets(other) && !self.is_in_notch(other, normal, y))
        })
    }

    /// Whether a node of the secondary lies in a concave corner: another facet there rises in front
    /// of the one with this normal.
    fn is_in_notch(&self, node: usize, normal: Vector<3>, y: &[f64]) -> bool {
        self.reverse.facets_at(node).iter().any(|&OnFacet { facet, .. }| {
            let height = |&other: &usize| self.reverse.offset(node, other, y).dot(&normal);
            let highest = self.reverse.nodes_of(facet).iter().map(height).fold(0.0, f64::max);
            highest > RISES * self.reverse.length(facet, y)
        })
    }

    /// Applies a function to the pairs of each direction of contact, numbered within that
    /// direction, and collects their events.
    fn each(
        &self,
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
        of: impl Fn(&K, &mut Pairing, &mut Vec<PairEvent>) -> bool + Sync,
    ) -> bool {
        let count = self.forward.secondary().len();
        let mut reverse = pairing.split_off(count);
        let mut of_reverse = Vec::new();
        let (forth, back) = self
            .threads
            .join(|| of(&self.forward, pairing, events), || of(&self.reverse, &mut reverse, &mut of_reverse));
        events.append(&mut of_reverse);
        pairing.append(reverse, count);
        forth | back
    }
}

impl<K: OneWay> Kinematics for BothSides<K> {
    fn secondary(&self) -> &[usize] {
        &self.all
    }

    fn allowed(&self, node: usize) -> f64 {
        let (direction, node) = self.direction(node);
        direction.allowed(node)
    }

    fn on(&mut self, threads: &Threads) {
        self.threads = threads.clone();
    }

    fn keep(&mut self, depths: &[f64]) {
        let (forward, reverse) = depths.split_at(self.forward.secondary().len().min(depths.len()));
        self.forward.keep(forward);
        self.reverse.keep(reverse);
    }

    fn kept(&self, node: usize) -> f64 {
        let (direction, node) = self.direction(node);
        direction.kept(node)
    }

    fn roundings(&self, y: &[f64]) -> Vec<f64> {
        [self.forward.roundings(y), self.reverse.roundings(y)].concat()
    }

    fn facet_nodes(&self, pair: &Pair) -> &[usize] {
        self.direction(pair.node).0.nodes_of(pair.facet)
    }

    fn is_on_facet(&self, pair: &Pair) -> bool {
        let (direction, node) = self.direction(pair.node);
        direction.is_on_facet(&Pair { node, ..*pair })
    }

    fn facets(&self, node: usize) -> usize {
        let (direction, node) = self.direction(node);
        direction.facets(node)
    }

    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        let (direction, node) = self.direction(node);
        direction.signed_distance(node, y)
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        self.each(pairing, events, |direction, pairing, events| {
            direction.search(before, now, pairing, events)
        })
    }

    fn met(&self, nodes: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>> {
        let count = self.forward.secondary().len();
        let of = |direction: &K, range: std::ops::Range<usize>| {
            let own: Vec<usize> =
                nodes.iter().filter(|n| range.contains(*n)).map(|n| n - range.start).collect();
            if own.is_empty() { Vec::new() } else { direction.met(&own, before, now) }
        };
        let mut forward = of(&self.forward, 0..count).into_iter();
        let mut reverse = of(&self.reverse, count..self.all.len()).into_iter();
        let next = |&node: &usize| if node < count { forward.next() } else { reverse.next() };
        nodes.iter().map(next).map(Option::flatten).collect()
    }

    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        let (forth, back) = self
            .threads
            .join(|| self.forward.passed(before, now, bounce), || self.reverse.passed(before, now, bounce));
        forth.or(back)
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        self.each(pairing, events, |direction, pairing, events| direction.update_facets(now, pairing, events))
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let (direction, node) = self.direction(pair.node);
        let mut local = Pair { node, ..*pair };
        let is_reverse = node != pair.node;
        if is_reverse && !pair.active && self.is_left_to_node(&local, y) {
            rows.push_open();
            return Ok(());
        }
        direction.measure(&mut local, y, rows)?;
        pair.xi = local.xi;
        pair.eta = local.eta;
        if is_reverse {
            rows.reverse_from(rows.len() - 1);
        }
        Ok(())
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        let (direction, node) = self.direction(pair.node);
        direction.curvature_into(&Pair { node, ..*pair }, y, curvature);
    }

    fn slip(&self, pair: &Pair, y: &[f64], moved: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let (direction, node) = self.direction(pair.node);
        let first = rows.len();
        direction.slip(&Pair { node, ..*pair }, y, moved, rows)?;
        if node != pair.node {
            rows.reverse_from(first);
        }
        Ok(())
    }

    fn slip_derivative_into(
        &self,
        pair: &Pair,
        y: &[f64],
        moved: &[f64],
        tangent: usize,
        matrix: &mut [f64],
    ) {
        let (direction, node) = self.direction(pair.node);
        direction.slip_derivative_into(&Pair { node, ..*pair }, y, moved, tangent, matrix);
    }
}
