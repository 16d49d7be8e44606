//! Where two surfaces are to each other: pairs worth watching, their gaps and the gaps'
//! derivatives, at given positions. Knows no time step, no law and no matrix.
//!
//! Positions are flat over all nodes, `dimension` components each.

mod node_to_facet;
mod node_to_plane;
mod projection;
mod surface;
mod trajectory;

pub use node_to_facet::{Detection, NodeToFacet};
pub use node_to_plane::NodeToPlane;
pub use surface::Surface;

use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// A way to measure gaps between two sides.
pub trait Kinematics: Send + Sync {
    /// Global numbers of the secondary nodes, each once.
    fn secondary(&self) -> &[usize];

    /// Global numbers of the nodes of a primary facet; empty for a rigid primary.
    fn facet_nodes(&self, facet: usize) -> &[usize];

    /// Most nodes that one gap depends on.
    fn stencil(&self) -> usize;

    /// Signed distance of a secondary node (its place) to the nearest point of the primary side;
    /// `None` where no facet faces it.
    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64>;

    /// Brings the pairs worth watching between positions `before` (no penetration) and `now` up to
    /// date: adds those that came near, hands over those that slid off their facet, drops those
    /// that left. Whether anything but an open pair changed is returned.
    fn search(&self, before: &[f64], now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>)
    -> bool;

    /// Hands over active pairs that have slid well past the end of their facet while the iteration
    /// goes on: what a facet extrapolates to there is no surface. Unlike [`search`](Self::search),
    /// it lets a pair come back. Whether there was one is returned.
    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        let _ = (now, pairing, events);
        false
    }

    /// Adds the row of a pair at positions `y` to `rows`. Moves `pair.xi` to the closest point.
    ///
    /// # Errors
    /// There is no unique closest point; nothing was added.
    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError>;

    /// ∂²g/∂y∂y of a pair that was measured at `y`, over the nodes of its row: overwrites the first
    /// `(n·D)²` of `curvature`, row-major.
    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]);
}

/// Where a gap costs nothing, every node is watched in every step.
fn watch_every_node(nodes: usize, pairs: &mut Vec<Pair>) {
    if pairs.len() == nodes {
        return;
    }
    let mut known = std::mem::take(pairs).into_iter().peekable();
    for node in 0..nodes {
        pairs.push(known.next_if(|p| p.node == node).unwrap_or(Pair::open(node, 0, 0.0)));
    }
}
