//! Certified swept tests of a node against a curved facet in the plane (`path.rs`) and in space
//! (`patch_path.rs`), and of two curved edges in space (`edge_path.rs`), all of whose nodes move on
//! straight lines in 0 ≤ θ ≤ 1:
//!
//! ```text
//! f(ξ, θ) = y_N(θ) − y_S(ξ, θ) = Σᵢ Σⱼ cᵢⱼ Bᵢ³(ξ) Bⱼ¹(θ),    f = 0 where they meet
//! ```
//!
//! The Bernstein polynomials B are ≥ 0 and sum to 1. f therefore lies in the convex hull of its
//! coefficients c over every box of parameters (Farouki, Rajan, Comput. Aided Geom. Design 4
//! (1987)), and a direction in which they all have one sign proves that a box contains no contact.
//! Other boxes are halved, the earliest first; the first that is small enough is reported
//! (inclusion test: Snyder, SIGGRAPH 1992; Wang et al., ACM Trans. Graph. 40 (2021), for linear
//! paths of triangles). Round-off is bounded in `path.rs`: [`Swept::Clear`] is a proof.
//!
//! A hit may be false. Its distance |f| is then below 4δ + 2·separation, δ the tolerance times the
//! extent of f along ξ or θ, whichever is larger. θ is early by at most the tolerance +
//! (4δ + 2·separation)/v, v the normal velocity, where v does not vanish. Only a query that
//! exhausts its budget may be coarser.

mod edge_path;
mod patch_path;
mod path;

use carom_algebra::Vector;
use carom_solid::{Earliest, FacetShape, Net, Piece};

use edge_path::EdgePath;
use patch_path::PatchPath;
use path::CurvePath;

use crate::constants::{MEETS, ON_FACET};

/// Result of a swept test of a node against a facet in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Swept {
    /// The node certainly does not meet the facet.
    Clear,
    /// The node meets the facet, or comes closer than the tolerance.
    Hit {
        /// Lower bound of the instant θ of the first contact.
        theta: f64,
        /// Coordinate of the first contact on the facet, −1..1, within the tolerance.
        xi: f64,
    },
}

/// The contacts that a swept test reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossings {
    /// All contacts, except that at θ = 0 of a node that starts on the facet, or within the
    /// separation, and moves to the outer side.
    All,
    /// Contacts where the node does not move to the outer side: crossings inwards, and motion along
    /// the facet. The outer side is on the right in the direction of traversal.
    Inward,
}

/// Largest number of boxes examined before a query answers with the earliest θ that remains.
const BUDGET: usize = 4096;

/// Certified swept tests with facets of one shape in the plane. Owns the memory of its queries;
/// results do not depend on earlier queries.
#[derive(Clone, Debug)]
pub struct SweptTest {
    shape: FacetShape,
    tolerance: f64,
    queue: Earliest<CurvePath>,
}

impl SweptTest {
    /// Swept tests for facets of a shape, with a tolerance of 1e-6.
    pub fn new(shape: FacetShape) -> Self {
        Self { shape, tolerance: MEETS, queue: Earliest::new(BUDGET) }
    }

    /// Swept tests with another tolerance in θ, which is also that of the distance relative to the
    /// extents of f; values below 1e-12 count as 1e-12.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance: tolerance.max(1e-12), ..self }
    }

    /// First contact of a node that moves from `node[0]` to `node[1]` with a facet whose nodes
    /// (start, end, interior) move from `facet[0]` to `facet[1]`. A distance of at most
    /// `separation` is contact. Positions that are not finite give a hit at θ = 0.
    ///
    /// # Panics
    /// If the number of positions is not that of the shape's nodes.
    #[inline]
    pub fn first(
        &mut self,
        node: [Vector<2>; 2],
        facet: [&[Vector<2>]; 2],
        crossings: Crossings,
        separation: f64,
    ) -> Swept {
        let path = CurvePath::new(self.shape, node, facet, separation);
        if path.is_clear() {
            return Swept::Clear;
        }
        let separating = |piece: &CurvePath| match crossings {
            Crossings::Inward => piece.only_separates(),
            Crossings::All => piece.only_separates() && piece.starts_in_contact(),
        };
        let end = path.stop(self.tolerance);
        match self.queue.first(path, separating, |piece| piece.split(&end)) {
            None => Swept::Clear,
            Some(piece) => Swept::Hit { theta: piece.theta(), xi: piece.xi() },
        }
    }
}

/// First contact of a node and a facet, or of two edges, in space, or a distance below the
/// tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceHit {
    /// Lower bound of the instant θ of the first contact.
    pub theta: f64,
    /// Coordinates of the first contact on the facet, or on both edges, −1..1, within the
    /// tolerance.
    pub xi: [f64; 2],
}

/// Certified swept tests with facets of one shape in space.
#[derive(Clone, Debug)]
pub struct SweptPatch {
    net: Net,
    tolerance: f64,
    queue: Earliest<PatchPath>,
}

impl SweptPatch {
    /// Swept tests for facets of a shape, with a tolerance of 1e-5.
    ///
    /// # Panics
    /// For a point or a line.
    pub fn new(shape: FacetShape) -> Self {
        Self { net: Net::facet(shape), tolerance: ON_FACET, queue: Earliest::new(BUDGET) }
    }

    /// First contact, where the node does not move to the outer side, of a node that moves from
    /// `node[0]` to `node[1]` with a facet whose nodes move from `facet[0]` to `facet[1]`; none is
    /// a proof. A distance of at most `separation` is contact. The outer side sees the facet's
    /// nodes counter-clockwise. Positions that are not finite give a hit at θ = 0.
    pub fn first(
        &mut self,
        node: [Vector<3>; 2],
        facet: [&[Vector<3>]; 2],
        separation: f64,
    ) -> Option<SpaceHit> {
        let path = PatchPath::new(&self.net, node, facet, separation);
        if path.is_clear() {
            return None;
        }
        let net = &self.net;
        let end = path.stop(&self.net, self.tolerance);
        let found = self.queue.first(path, |piece| piece.only_separates(net), |piece| piece.split(net, &end));
        found.map(|piece| SpaceHit { theta: piece.theta(), xi: piece.xi() })
    }
}

/// Certified swept tests of edges of 2 to 4 nodes in space.
#[derive(Clone, Debug)]
pub struct SweptEdges {
    tolerance: f64,
    queue: Earliest<EdgePath>,
}

impl Default for SweptEdges {
    /// Swept tests of edges with a tolerance of 1e-5.
    fn default() -> Self {
        Self { tolerance: ON_FACET, queue: Earliest::new(BUDGET) }
    }
}

impl SweptEdges {
    /// First contact of two edges whose nodes, ends first, move from those of `start` to those of
    /// `end`, A and B in turn, where A does not move out of the body of B; none is a proof. The
    /// normal of both edges points to the side of `outwards`. A distance of at most `separation` is
    /// contact. Positions that are not finite give a hit at θ = 0.
    ///
    /// # Panics
    /// For an edge of one node or of more than four.
    pub fn first(
        &mut self,
        [start, end]: [[&[Vector<3>]; 2]; 2],
        outwards: Vector<3>,
        separation: f64,
    ) -> Option<SpaceHit> {
        assert!(start.iter().all(|edge| (2..=4).contains(&edge.len())), "edges of 2 to 4 nodes");
        let path = EdgePath::new([start, end], separation);
        if path.is_clear() {
            return None;
        }
        let end = path.stop(self.tolerance);
        let separates = |piece: &EdgePath| piece.only_separates(&outwards);
        let found = self.queue.first(path, separates, |piece| piece.split(&end));
        found.map(|piece| SpaceHit { theta: piece.theta(), xi: piece.xi() })
    }
}
