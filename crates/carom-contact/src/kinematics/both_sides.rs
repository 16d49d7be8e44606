//! Secondary nodes against the primary side, and the corners of the primary side against the
//! secondary one: no secondary node enters the primary, and no corner of the primary cuts into an
//! edge of the secondary between two of its nodes.
//!
//! The nodes of the corners follow those of the secondary side. Where a corner meets a secondary
//! node and a facet at the corner is parallel to the secondary one, either row would prevent
//! penetration, and both would be nearly dependent: the corner is then left to the node.

use super::Kinematics;
use super::node_to_facet::{NodeToFacet, PAST_SIDE};
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::places::Places;
use crate::rows::Rows;

/// Distance between a corner and a secondary node, relative to the corner's facet, below which the
/// node's own pair is responsible: just where the node begins to face the primary side.
const NEAR_NODE: f64 = 0.5 * PAST_SIDE;
/// Cosine of the angle up to which two facets are parallel: 10°.
const PARALLEL: f64 = 0.985;

/// Contact in both directions: secondary nodes and the corners of the primary.
#[derive(Debug)]
pub struct BothSides {
    nodes: NodeToFacet,
    corners: NodeToFacet,
    /// Facets of the primary side at each corner, with the corner's ξ.
    facets: Vec<Vec<(usize, f64)>>,
    all: Vec<usize>,
}

impl BothSides {
    /// `nodes`: secondary nodes against the primary side; `corners`: the nodes of the primary's
    /// corners against the secondary side.
    pub fn new(nodes: NodeToFacet, corners: NodeToFacet) -> Self {
        let all = [nodes.secondary(), corners.secondary()].concat();
        let primary = nodes.primary();
        let end = |facet: usize, node: usize| {
            let nodes = primary.facet(facet).nodes;
            (nodes[0] == node).then_some((facet, -1.0)).or((nodes[1] == node).then_some((facet, 1.0)))
        };
        let facets = corners
            .secondary()
            .iter()
            .map(|&node| (0..primary.facets()).filter_map(|f| end(f, node)).collect());
        Self { facets: facets.collect(), nodes, corners, all }
    }

    /// The direction to which a pair belongs, and the pair in its numbering.
    fn direction(&self, pair: &Pair) -> (&NodeToFacet, Pair) {
        let count = self.nodes.secondary().len();
        if pair.node < count {
            (&self.nodes, *pair)
        } else {
            (&self.corners, Pair { node: pair.node - count, ..*pair })
        }
    }

    /// Whether a corner meets a node of the secondary facet that it faces, and has a facet parallel to
    /// that.
    fn is_left_to_node(&self, corner: &Pair, y: &[f64]) -> bool {
        let (primary, secondary) = (self.nodes.primary(), self.corners.primary());
        let y = Places::new(y, primary.shape().dimension());
        let at = y.at(self.corners.secondary()[corner.node]);
        let faced = secondary.facet(corner.facet);
        let normal = faced.at(y, corner.xi).normal;
        self.facets[corner.node].iter().any(|&(facet, xi)| {
            let near = NEAR_NODE * primary.length(facet, y);
            primary.facet(facet).at(y, xi).normal.dot(&normal) < -PARALLEL
                && faced.nodes.iter().any(|&other| (y.at(other) - at).norm() < near)
        })
    }

    /// Applies `of` to the pairs of either direction in its own numbering.
    fn each(&self, pairing: &mut Pairing, mut of: impl FnMut(&NodeToFacet, &mut Pairing) -> bool) -> bool {
        let count = self.nodes.secondary().len();
        let mut corners = pairing.split_off(count);
        let changed = of(&self.nodes, pairing) | of(&self.corners, &mut corners);
        pairing.append(corners, count);
        changed
    }
}

impl Kinematics for BothSides {
    fn secondary(&self) -> &[usize] {
        &self.all
    }

    fn facet_nodes(&self, facet: usize) -> &[usize] {
        self.nodes.facet_nodes(facet)
    }

    fn stencil(&self) -> usize {
        self.nodes.stencil().max(self.corners.stencil())
    }

    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        let (direction, pair) = self.direction(&Pair::open(node, 0, 0.0));
        direction.signed_distance(pair.node, y)
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        self.each(pairing, |direction, pairing| direction.search(before, now, pairing, events))
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        self.each(pairing, |direction, pairing| direction.update_facets(now, pairing, events))
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let (direction, mut local) = self.direction(pair);
        let corner = pair.node >= self.nodes.secondary().len();
        if corner && !pair.active && self.is_left_to_node(&local, y) {
            rows.push_open();
            return Ok(());
        }
        direction.measure(&mut local, y, rows)?;
        pair.xi = local.xi;
        if corner {
            rows.reverse_last();
        }
        Ok(())
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        let (direction, pair) = self.direction(pair);
        direction.curvature_into(&pair, y, curvature);
    }
}
