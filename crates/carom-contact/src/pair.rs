//! What contact is to the rest of Carom: positions in, gaps and their derivatives out.
//!
//! A pair is one secondary node against one facet. Its gap g(y) is a frame-indifferent scalar, g < 0 penetrates; its multiplier λ ≤ 0 presses and
//! enters the residual as λ ∇g (eq. 10). Balance of contact force and moment follows from that alone. Contact knows no time step and no matrix.

use carom_algebra::{Mat, Vector};
use serde::{Deserialize, Serialize};

/// Nodes a gap can depend on: the secondary node and up to four of a cubic facet.
pub const STENCIL: usize = 5;

/// One secondary node against one facet of the primary side.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Place of the secondary node in [`ContactMethod::secondary`].
    pub node: usize,
    /// Facet of the primary side; 0 for a rigid plane.
    pub facet: usize,
    /// Contact point on the facet, −1 … 1; 0 where a facet is a point or a plane.
    pub xi: f64,
    /// Whether the gap is held at zero.
    pub active: bool,
    /// Multiplier; zero unless active.
    pub lambda: f64,
    /// Gap at the step's start as an energy-conserving penalty counts it: carried, since Δg = ∇g·Δy at the middle holds to second order only.
    pub start: Option<f64>,
    /// Facet it was handed over from in the present step; it does not go back within the step.
    pub left: Option<usize>,
}

/// Gap, its gradient and its λ-contracted second derivative over the nodes it depends on.
#[derive(Clone, Debug)]
pub struct Linearised<const D: usize> {
    /// Gap g.
    pub gap: f64,
    /// Global numbers of the nodes it depends on; the secondary node comes first.
    pub nodes: [usize; STENCIL],
    /// How many of them.
    pub count: usize,
    /// ∂g/∂y of each node.
    pub gradient: [Vector<D>; STENCIL],
    /// λ ∂²g/∂y∂y of each two nodes.
    pub hessian: [[Mat<D>; STENCIL]; STENCIL],
}

impl<const D: usize> Default for Linearised<D> {
    fn default() -> Self {
        Self {
            gap: 0.0,
            nodes: [0; STENCIL],
            count: 0,
            gradient: [Vector::ZERO; STENCIL],
            hessian: [[Mat::ZERO; STENCIL]; STENCIL],
        }
    }
}

/// Something that happened to a pair, for the log.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "event")]
pub enum PairEvent {
    /// The node slid from one facet to its neighbour.
    HandOver {
        /// Global number of the secondary node.
        node: usize,
        /// Old facet.
        from: usize,
        /// New facet.
        to: usize,
    },
    /// The node slid off the end of the side.
    SlidOff {
        /// Global number of the secondary node.
        node: usize,
        /// Facet it left.
        facet: usize,
    },
}

/// Why a gap has no usable value.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// The node is as far behind the facet as the facet's radius of curvature: no unique closest point.
    #[error(
        "secondary node {node} has no unique closest point on primary facet {facet}: a = J² − gκ = {a:.3e} ≤ 0 at ξ = {xi:.3}"
    )]
    Focal {
        /// Global number of the secondary node.
        node: usize,
        /// Facet.
        facet: usize,
        /// Contact point.
        xi: f64,
        /// J² − gκ.
        a: f64,
    },
    /// The closest point lies far outside the facet or was not found.
    #[error("secondary node {node} lost primary facet {facet}: closest point at ξ = {xi:.3}")]
    Lost {
        /// Global number of the secondary node.
        node: usize,
        /// Facet.
        facet: usize,
        /// Last contact point.
        xi: f64,
    },
}

/// A way to measure gaps between two sides.
pub trait ContactMethod<const D: usize>: Send + Sync {
    /// Global numbers of the secondary nodes, each once.
    fn secondary(&self) -> &[usize];

    /// Global numbers of the nodes of a primary facet; empty for a rigid primary.
    fn facet_nodes(&self, facet: usize) -> &[usize];

    /// Signed distance of a secondary node (its place) to the nearest point of the primary side; `None` where no facet faces it.
    fn signed_distance(&self, node: usize, y: &[[f64; D]]) -> Option<f64>;

    /// Brings the pairs worth watching between positions `before` (no penetration) and `now` up to date: adds those that came near, hands over
    /// those that slid off their facet, drops those that left. Ascending by node. Whether anything but an inactive pair changed is returned.
    fn detect(
        &self,
        before: &[[f64; D]],
        now: &[[f64; D]],
        pairs: &mut Vec<Pair>,
        events: &mut Vec<PairEvent>,
    ) -> Result<bool, ContactError>;

    /// Hands over active pairs that have slid well past the end of their facet while the iteration goes on: what a facet extrapolates to there is no
    /// surface. Unlike [`detect`](Self::detect), it lets a pair come back. Whether there was one is returned.
    fn follow(&self, now: &[[f64; D]], pairs: &mut [Pair], events: &mut Vec<PairEvent>) -> bool {
        let _ = (now, pairs, events);
        false
    }

    /// Gap of a pair at positions `y`, its gradient, and `lambda` times its second derivative. Moves `pair.xi` to the closest point.
    fn linearise(
        &self,
        pair: &mut Pair,
        y: &[[f64; D]],
        lambda: f64,
        out: &mut Linearised<D>,
    ) -> Result<(), ContactError>;
}
