//! The state of a possible contact between steps, and its events.

use std::collections::BTreeMap;

use educe::Educe;
use serde::{Deserialize, Serialize};

use crate::constants::{WATCHED, WITHIN_STEP};
use crate::friction::Tangential;
use crate::kinematics::OnFacet;

/// A secondary node and a facet of the primary side, or two sharp edges, that may be in contact:
/// contact point and history.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Index of the secondary node in [`Kinematics::secondary`](crate::Kinematics::secondary), or
    /// of the edge: edges follow the nodes. A node in a concave corner of the primary has several
    /// pairs, and so has an edge that crosses several ones.
    pub node: usize,
    /// Facet of the primary side, or piece of a polyline; 0 for a plane or a circle. Edges are
    /// numbered after the facets.
    pub facet: usize,
    /// Number of facets along the primary, on either side of `facet`, over whose nodes the gap
    /// extends (mortar); 0 for a node.
    pub reach: usize,
    /// Contact point on the facet, −1 … 1; 0 if the facet is a point or a plane.
    pub xi: f64,
    /// Second coordinate of the contact point on a facet in space; 0 in the plane. For two edges, ξ
    /// is the coordinate on the edge of the secondary side and η that on the other one.
    pub eta: f64,
    /// End, corner or edge of the facet at which the node meets other facets as well (`joint.rs`);
    /// none inside a facet.
    pub joint: Option<u8>,
    /// Number of the secondary edge at the start of the step less the present one: a crossing of
    /// edges goes on along both. Other pairs keep their node.
    pub handed: isize,
    /// Whether the pair is active: for a constraint, whether its gap is constrained to zero.
    pub active: bool,
    /// Whether the pair has been active since the start of the run.
    pub rests: bool,
    /// Multiplier λ ≤ 0; zero unless active.
    pub lambda: f64,
    /// λ̂ of an augmented Lagrangian: λ of the last round, at first that of the step's start.
    pub multiplier: f64,
    /// Gap at the step's start for an energy-conserving penalty. It is stored, since Δg = ∇g·Δy at
    /// the midpoint holds to second order only.
    pub start: Option<f64>,
    /// Diagonal of the bodies' tangent at its place, of which penalty springs are multiples: that
    /// of this step, or of a conserving spring as long as the pair is closed.
    pub diagonal: Option<f64>,
    /// Depth that the pair keeps, ≥ 0, by which its gap is larger: that at which it began.
    pub depth: f64,
    /// Whether the pair has just been found or handed over, so that its depth is not known yet.
    pub begins: bool,
    /// Tangential state and history, for friction.
    pub tangential: Tangential,
}

impl Pair {
    /// An inactive pair at a point of a facet.
    pub fn open(node: usize, facet: usize, xi: f64) -> Self {
        Self {
            node,
            facet,
            reach: 0,
            xi,
            eta: 0.0,
            joint: None,
            handed: 0,
            active: false,
            rests: false,
            lambda: 0.0,
            multiplier: 0.0,
            start: None,
            diagonal: None,
            depth: 0.0,
            begins: true,
            tangential: Tangential::default(),
        }
    }

    /// An inactive pair at a point of a facet in space, or of one in the plane with η = 0.
    pub(crate) fn opened(node: usize, OnFacet { facet, xi: [xi, eta] }: OnFacet<[f64; 2]>) -> Self {
        Self { eta, ..Self::open(node, facet, xi) }
    }
}

/// Orders pairs by their nodes; those of one node remain in their order.
pub(crate) fn in_order(pairs: &mut [Pair]) {
    pairs.sort_by_key(|pair| pair.node);
}

/// The pairs of one contact during one solve, ascending by node.
#[derive(Debug, Educe, PartialEq)]
#[educe(Clone)]
pub struct Pairing {
    /// The pairs, ascending by node.
    pub pairs: Vec<Pair>,
    /// Margin around facets within which nodes are tracked.
    pub(crate) margin: f64,
    /// Facet from which each node was handed over in this step: a node that would return to it lies
    /// in a concave corner.
    pub(crate) left: BTreeMap<usize, usize>,
    /// Whether no search has been made yet in this solve.
    pub fresh: bool,
}

impl Pairing {
    /// Pairs at the start of a solve, in which each may change facets again.
    pub fn new(mut pairs: Vec<Pair>) -> Self {
        pairs.iter_mut().for_each(|pair| pair.handed = 0);
        Self { pairs, margin: WATCHED, left: BTreeMap::new(), fresh: true }
    }

    /// Pairs at the start of an explicit step, which moves no further than predicted: only nodes
    /// that may come into contact within it are tracked.
    pub fn near(pairs: Vec<Pair>) -> Self {
        Self { margin: WITHIN_STEP, ..Self::new(pairs) }
    }

    /// Drops the inactive pairs and the hand-overs, so that a new search depends on positions
    /// alone.
    pub fn restart(&mut self) {
        self.pairs.retain(|pair| pair.active);
        self.left.clear();
        self.fresh = true;
    }

    /// Takes out the pairs of nodes from `node` on, and numbers these nodes from 0.
    pub(crate) fn split_off(&mut self, node: usize) -> Self {
        let mut pairs = self.pairs.split_off(self.pairs.partition_point(|pair| pair.node < node));
        pairs.iter_mut().for_each(|pair| pair.node -= node);
        let left = self.left.split_off(&node).into_iter().map(|(k, facet)| (k - node, facet)).collect();
        Self { pairs, margin: self.margin, left, fresh: self.fresh }
    }

    /// Adds pairs whose nodes are numbered from `node` on, the inverse of
    /// [`split_off`](Self::split_off).
    pub(crate) fn append(&mut self, other: Self, node: usize) {
        self.pairs.extend(other.pairs.into_iter().map(|pair| Pair { node: pair.node + node, ..pair }));
        self.left.extend(other.left.into_iter().map(|(k, facet)| (k + node, facet)));
    }
}

impl Default for Pairing {
    fn default() -> Self {
        Self::new(Vec::new())
    }
}

/// An event of a pair, for the log.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "event")]
pub enum PairEvent {
    /// The node slid from one facet to its neighbour.
    HandOver {
        /// Global number of the secondary node.
        node: usize,
        /// Facet from which the node slid.
        from: usize,
        /// Facet to which the node slid.
        to: usize,
    },
    /// The node slid off the end of the side.
    SlidOff {
        /// Global number of the secondary node.
        node: usize,
        /// Facet that the node left.
        facet: usize,
    },
}

/// Why the gap of a pair cannot be measured.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// The node is as far behind the facet as the facet's radius of curvature: no unique closest
    /// point.
    #[error(
        "secondary node {node} has no unique closest point on primary facet {facet}: a = J² − gκ = {a:.3e} ≤ 0 at ξ = {xi:.3}"
    )]
    Focal {
        /// Global number of the secondary node.
        node: usize,
        /// Facet of the pair.
        facet: usize,
        /// Coordinate ξ of the contact point on the facet.
        xi: f64,
        /// Second derivative a = J² − gκ of half the squared distance by ξ, which is not positive.
        a: f64,
    },
    /// The node is inside a rigid obstacle, at the centre of a circle.
    #[error(
        "secondary node {node} is at the centre of a rigid circle or rounded corner: the normal is not unique"
    )]
    Center {
        /// Global number of the secondary node.
        node: usize,
    },
    /// A convex part of a rigid obstacle has no unique closest point on a facet, or is far past its
    /// end.
    #[error(
        "the convex part of the rigid obstacle near node {node} has no unique closest point on facet {facet}, which it touched at ξ = {xi:.3}"
    )]
    Tip {
        /// Global number of the node that represents the part.
        node: usize,
        /// Facet of the pair.
        facet: usize,
        /// Coordinate ξ of the last contact point on the facet.
        xi: f64,
    },
    /// Two edges run along each other, or have left each other, so that there are no closest
    /// points.
    #[error(
        "the sharp edge at secondary node {node} does not cross edge {facet} of the primary: they run along each other, or are far past their ends"
    )]
    Edges {
        /// Global number of the first node of the edge.
        node: usize,
        /// Number of the edge, after the facets of the primary.
        facet: usize,
    },
    /// The closest point lies far outside the facet or was not found.
    #[error("secondary node {node} is beyond primary facet {facet}: its closest point is at ξ = {xi:.3}")]
    Lost {
        /// Global number of the secondary node.
        node: usize,
        /// Facet of the pair.
        facet: usize,
        /// Coordinate ξ of the last contact point on the facet.
        xi: f64,
    },
}

impl ContactError {
    /// The error of a pair whose secondary node has another number.
    pub(crate) fn at_node(mut self, number: usize) -> Self {
        match &mut self {
            Self::Focal { node, .. }
            | Self::Center { node }
            | Self::Tip { node, .. }
            | Self::Edges { node, .. }
            | Self::Lost { node, .. } => *node = number,
        }
        self
    }

    /// Reports an error for a pair without a unique closest point, a ≤ 0; `node`: global number of
    /// the secondary node.
    pub(crate) fn unless_regular(node: usize, pair: &Pair, a: f64) -> Result<(), Self> {
        if a > 0.0 && a.is_finite() {
            return Ok(());
        }
        Err(Self::Focal { node, facet: pair.facet, xi: pair.xi, a })
    }
}
