//! The relative position of two surfaces: candidate pairs, their gaps and the gaps' derivatives, at
//! given positions. Independent of time steps, laws and matrices.
//!
//! Positions are flat over all nodes, `dimension` components each.

#[doc(hidden)]
pub mod apart;
mod candidate;
mod carrier;
mod combined;
mod drift;
mod facet_rows;
#[doc(hidden)]
pub mod facets;
mod facing;
#[doc(hidden)]
pub mod folds;
mod gap;
mod hand_over;
mod itself;
mod joint;
#[doc(hidden)]
pub mod mirror;
mod mortar;
mod node_to_facet;
mod node_to_obstacle;
mod obstacle;
mod opposed;
mod outward;
mod passed;
#[doc(hidden)]
pub mod projection;
#[doc(hidden)]
pub mod recent;
mod reversed;
#[doc(hidden)]
pub mod rounding;
#[doc(hidden)]
pub mod space;
mod surface;
mod swept;
mod tangents;
mod tip_to_facet;
#[doc(hidden)]
pub mod trajectory;
#[doc(hidden)]
pub mod way;

pub use carrier::Carrier;
pub use combined::Combined;
pub(crate) use facets::Facets;
pub use facets::{Depth, OnFacet};
pub use folds::Side;
pub(crate) use folds::{Folds, Turns};
pub use joint::AtJoints;
pub use mortar::{Mortar, Quadrature};
pub use node_to_facet::{ContactPoint, Detection, NodeToFacet};
pub use node_to_obstacle::NodeToObstacle;
pub use obstacle::{Faceted, Obstacle, Polyline, PolylineError, Tip};
pub use outward::Outward;
pub use passed::Passed;
pub use reversed::NodesWithDepth;
pub(crate) use space::cross;
pub use space::{Boundary, ClosedSurface, EdgePoints, EdgeToEdge, NodeToPatch};
pub use surface::Surface;
pub use swept::{Crossings, SpaceHit, Swept, SweptEdges, SweptPatch, SweptTest};
pub use tip_to_facet::TipToFacet;
pub(crate) use way::amplification;

use carom_algebra::{Mat, Threads};
use carom_solid::shape::line_shape;

use crate::constants::ON_FACET;
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// Contact pressure of a field at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodalPressure {
    /// Global number of the node.
    pub node: usize,
    /// Force per area of the deformed surface, ≥ 0.
    pub actual: f64,
    /// Force per area of the reference surface, ≥ 0.
    pub nominal: f64,
}

/// Where both sides of a contact in the plane meet a plane of symmetry.
#[derive(Clone, Debug, PartialEq)]
pub struct InPlane {
    /// Global numbers of the nodes of both sides there.
    pub nodes: Vec<usize>,
    /// Unit normal of the plane of symmetry.
    pub normal: [f64; 2],
}

/// A point of a facet or an edge, between its nodes.
#[derive(Clone, Copy, Debug)]
pub struct BetweenNodes<'a> {
    /// Global numbers of the nodes.
    pub nodes: &'a [usize],
    /// Their shape functions at the point.
    pub values: [f64; 4],
}

impl<'a> BetweenNodes<'a> {
    /// A point ξ of a line.
    pub(crate) fn on_line(nodes: &'a [usize], xi: f64) -> Self {
        Self { nodes, values: line_shape(nodes.len(), xi.clamp(-1.0, 1.0)).values }
    }

    /// A positive quantity of the nodes at the point, Σ N² q / Σ N²: it lies between those of the
    /// nodes, and is that of a node there.
    pub fn mean(&self, of: impl Fn(usize) -> f64) -> f64 {
        let mut sum = 0.0;
        let mut weight = 0.0;
        for (&node, value) in self.nodes.iter().zip(self.values) {
            sum += value * value * of(node);
            weight += value * value;
        }
        sum / weight
    }

    /// The point in a configuration of the nodes; `y`: flat over all nodes.
    pub fn place(&self, y: &[f64], dimension: usize) -> Vec<f64> {
        let at = |i: usize| {
            let nodes = self.nodes.iter().zip(self.values);
            nodes.map(|(&node, value)| value * y[node * dimension + i]).sum()
        };
        (0..dimension).map(at).collect()
    }
}

/// A method to find pairs of two sides and to measure their gaps.
pub trait Kinematics: std::fmt::Debug + Send + Sync {
    /// Global numbers of the secondary nodes. In contact of a side with itself all nodes occur
    /// twice: as nodes of the later place, then as nodes of the earlier one.
    fn secondary(&self) -> &[usize];

    /// Number of secondary nodes. Sharp edges and points of them follow the nodes in
    /// [`secondary`](Self::secondary), each represented by a node of the edge, and so do convex
    /// parts of an obstacle, each represented by the node that is nearest to it in the reference
    /// configuration.
    fn nodes(&self) -> usize {
        self.secondary().len()
    }

    /// Depth to which a secondary node, given by index, may penetrate without contact; its gap is
    /// larger by that depth.
    fn allowed(&self, _node: usize) -> f64 {
        0.0
    }

    /// Shares work among threads, on whose number no result depends.
    fn on(&mut self, _threads: &Threads) {}

    /// Adds to the gap of every secondary node, by index, an initial depth: an overlap that is
    /// kept, or not yet closed, or the deviation of straight facets from a curved side.
    fn keep(&mut self, depths: &[f64]);

    /// Initial depth that is kept as an overlap of a secondary node, given by index.
    fn kept(&self, node: usize) -> f64;

    /// Initial depths that nodes keep, with their global numbers.
    fn kept_at_nodes(&self) -> Vec<(usize, f64)> {
        (0..self.nodes()).map(|node| (self.secondary()[node], self.kept(node))).collect()
    }

    /// Global numbers of the nodes of a pair's facet; empty for a rigid primary.
    fn facet_nodes(&self, pair: &Pair) -> &[usize];

    /// The point of the secondary side at which a row acts that is of none of its nodes: of a
    /// convex part of an obstacle, and of an edge; none of other rows.
    fn between_nodes(&self, _pair: &Pair) -> Option<BetweenNodes<'_>> {
        None
    }

    /// Rotation of a rigid primary between two positions; none of a deformable one, or of one that
    /// does not turn.
    fn rotation_of_primary(&self, _pair: &Pair, _ends: [&[f64]; 2]) -> Option<Mat<3>> {
        None
    }

    /// Whether the contact point of a pair lies on its facet, not on its extension.
    fn is_on_facet(&self, pair: &Pair) -> bool {
        pair.xi.abs() <= 1.0 + ON_FACET
    }

    /// Whether a pair keeps the depth at which it began.
    fn keeps_depth(&self, _pair: &Pair) -> bool {
        true
    }

    /// For every secondary node, by index, the height over the facet that it faces of the smooth
    /// surface that straight facets stand for, at positions `y`; empty if facets are no such
    /// chords.
    fn roundings(&self, _y: &[f64]) -> Vec<f64> {
        Vec::new()
    }

    /// Number of facets with which a secondary node, given by index, can form pairs.
    fn facets(&self, node: usize) -> usize;

    /// Signed distance of a secondary node, given by index, to the nearest point of the primary
    /// side, plus the depth that it keeps; `None` if no facet faces it.
    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64>;

    /// Whether contact of a secondary node, given by index, with the facet that it faces is left to
    /// a sharp edge of that facet, which the other direction of contact keeps out.
    fn is_left(&self, _node: usize, _y: &[f64]) -> bool {
        false
    }

    /// Signed distance of any node, given by its global number, to a rigid obstacle; none of other
    /// primary sides.
    fn distance_to_obstacle(&self, _node: usize, _y: &[f64]) -> Option<f64> {
        None
    }

    /// Convex round parts of a rigid obstacle and points of its sharp edges, which can lie between
    /// nodes; none of other primary sides.
    fn tips(&self, _y: &[f64]) -> Vec<Tip> {
        Vec::new()
    }

    /// Updates the pairs between positions `before` (no penetration) and `now`: adds candidates,
    /// hands over those that slid off their facet, drops those that left. Returns whether anything
    /// but an inactive pair changed.
    fn search(&self, before: &[f64], now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>)
    -> bool;

    /// The node, or edge, that was deepest inside the primary's body between `before` and `now`,
    /// and outside it at both: its motion is that of a step without contact. `bounce`: allowed
    /// depth, over the length of a facet, of a node that leaves on the side on which it entered.
    fn passed(&self, _before: &[f64], _now: &[f64], _bounce: f64) -> Option<Passed> {
        None
    }

    /// First instant θ, from 0 at `before` to 1 at `now`, at which each of the secondary nodes,
    /// given by index, meets the primary side while all nodes move on straight lines; none for a
    /// node that does not meet it, or has a depth without contact.
    fn met(&self, nodes: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>>;

    /// Hands over active pairs that have slid well past the end of their facet during the
    /// iteration: the extrapolation of a facet is not the surface. Unlike [`search`](Self::search),
    /// a pair may return. Returns whether a pair was handed over.
    fn update_facets(&self, _now: &[f64], _pairing: &mut Pairing, _events: &mut Vec<PairEvent>) -> bool {
        false
    }

    /// Prepares a pair for a step from positions `y`: moves its contact point to the closest point,
    /// where [`measure`](Self::measure) does not.
    fn start_step(&self, _pair: &mut Pair, _y: &[f64]) {}

    /// Adds the row of a pair at positions `y` to `rows`. Sets `pair.xi` to the closest point,
    /// unless contact points are frozen. A pair whose part of the surface faces nothing any more is
    /// opened.
    ///
    /// # Errors
    /// If there is no unique closest point; no row is added.
    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError>;

    /// Second derivative ∂²g/∂y∂y of the gap of a pair measured at `y`, over the nodes of its row:
    /// overwrites the first `(n·D)²` entries of `curvature`, row-major.
    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]);

    /// Smallest gap at positions `y` on the part of the surface for which a pair with this gap
    /// stands: of a node its own.
    fn nearest(&self, _pair: &Pair, gap: f64, _y: &[f64]) -> f64 {
        gap
    }

    /// Whether a secondary node, given by index, stands for a coefficient of a pressure field.
    fn is_of_field(&self, _node: usize) -> bool {
        false
    }

    /// Area of the reference surface, of thickness one, for which a secondary node, given by index,
    /// stands as a coefficient of a pressure field; none of a node or an edge.
    fn area(&self, _node: usize) -> Option<f64> {
        None
    }

    /// Where both sides meet a plane of symmetry, if a secondary node, given by index, stands for
    /// the coefficient of a pressure field there: no tangential traction acts in such a plane as
    /// long as neither side moves across it.
    fn in_plane_of_symmetry(&self, _node: usize) -> Option<InPlane> {
        None
    }

    /// Pressures at the nodes of the secondary side, where the pairs are coefficients of a pressure
    /// field; none where they are forces on nodes. `y`: positions;
    /// `thickness`: thickness of the bodies.
    fn pressure_field(&self, _pairs: &[Pair], _y: &[f64], _thickness: f64) -> Vec<NodalPressure> {
        Vec::new()
    }

    /// Adds the rows H_α of the slip of a pair measured at `y`, over the nodes of its gap, one per
    /// tangent: H_α·Δy is the tangential motion of the first node relative to the other side, which
    /// turns with it. A slip from y₀ to y₁ is H·(y₁ − y₀) at their midpoint, where every finite
    /// rigid motion of the pair is an infinitesimal one: the slip is exactly zero. `moved` is
    /// y₁ − y₀ if `y` is their midpoint, and empty for the rate of slip at `y`. The first node's
    /// part of a row is the tangent; the plane has one, space two (`tangents.rs`).
    ///
    /// # Errors
    /// If there is no unique closest point; no row is added.
    fn slip(&self, pair: &Pair, y: &[f64], moved: &[f64], rows: &mut Rows) -> Result<(), ContactError>;

    /// Derivative ∂H_α/∂y of a slip row of a pair measured at `y`, with tangents that turn with the
    /// normal only and y₀ (see [`slip`](Self::slip)) fixed: overwrites the first `(n·D)²` entries
    /// of `matrix`, row-major, not symmetric. In space `pair` has the tangents of these positions.
    fn slip_derivative_into(&self, pair: &Pair, y: &[f64], moved: &[f64], tangent: usize, matrix: &mut [f64]);
}

/// Instant θ at which a gap that varies linearly from `before` to `now` becomes negative; none if
/// it does not.
fn zero(before: f64, now: f64) -> Option<f64> {
    (now < 0.0).then(|| if before > 0.0 { before / (before - now) } else { 0.0 })
}

/// Gives every node without one a pair, for primary sides whose gaps are cheap enough to track all
/// nodes in every step.
fn watch_every_node(nodes: usize, pairs: &mut Vec<Pair>) {
    let mut known = std::mem::take(pairs).into_iter().peekable();
    for node in 0..nodes {
        let first = pairs.len();
        while let Some(pair) = known.next_if(|pair| pair.node == node) {
            pairs.push(pair);
        }
        if pairs.len() == first {
            pairs.push(Pair::open(node, 0, 0.0));
        }
    }
}
