//! Whether some point is deeper in a body than it may be, without a search where none can be. With
//! s the signed distance of a point, positive outside, and a and b the largest motions of the
//! points and of the body's surface since s was measured,
//!
//! ```text
//! s − a − b > −d    ⇒    no point is deeper than d
//! ```
//!
//! A cache: s is measured again where that does not tell, and the answer is the same.

use carom_algebra::Vector;

use super::boundary::Boundary;
use super::closed_surface::ClosedSurface;
use super::patch::place;
use crate::kinematics::Facets;

/// Share of the depth up to which motion decides; round-off is far below the rest.
const SURE: f64 = 0.99;

/// Points, each a combination of nodes, and the surface of a body that they may enter by a depth.
#[derive(Debug)]
pub(super) struct Clear {
    surface: ClosedSurface,
    depth: f64,
    /// Nodes of the points, and of the surface.
    nodes: [Vec<usize>; 2],
    /// Largest motion of a point, and of the surface, over that of their nodes.
    factors: [f64; 2],
    /// Coordinates of the nodes when distances were measured.
    measured: [Vec<f64>; 2],
    /// The least signed distance of a point then.
    least: f64,
    /// The facet nearest to each point then.
    near: Vec<Option<usize>>,
}

impl Clear {
    /// Of points with these nodes and weights, which may enter the body with this surface by
    /// `depth`.
    pub(super) fn new(points: &[Vec<(usize, f64)>], surface: Boundary, depth: f64) -> Self {
        let mut own: Vec<usize> = points.iter().flatten().map(|(node, _)| *node).collect();
        let mut others = surface.nodes().to_vec();
        for nodes in [&mut own, &mut others] {
            nodes.sort_unstable();
            nodes.dedup();
        }
        let sums = points.iter().map(|nodes| nodes.iter().map(|(_, weight)| weight.abs()).sum());
        let surface = ClosedSurface::new(surface);
        Self {
            depth,
            factors: [sums.fold(1.0, f64::max), surface.amplification()],
            surface,
            nodes: [own, others],
            measured: [Vec::new(), Vec::new()],
            least: f64::NEG_INFINITY,
            near: vec![None; points.len()],
        }
    }

    /// Whether no point can be too deep, as far as motion tells.
    pub(super) fn holds(&self, y: &[f64]) -> bool {
        self.least - self.motion(y) > -SURE * self.depth
    }

    /// Measures whether none of the points is too deep; `points`: their positions, at those of all
    /// nodes.
    pub(super) fn measure<'a>(&mut self, points: impl Iterator<Item = &'a [f64; 3]>, y: &[f64]) -> bool {
        self.surface.update(y);
        self.least = f64::INFINITY;
        for (point, near) in points.zip(&mut self.near) {
            let Some(found) = self.surface.depth(*point, *near, y) else { continue };
            self.least = self.least.min(found.distance);
            *near = Some(found.facet);
        }
        for (places, nodes) in self.measured.iter_mut().zip(&self.nodes) {
            places.clear();
            places.extend(nodes.iter().flat_map(|node| place(y, *node).0));
        }
        self.least > -self.depth
    }

    /// Bound of the relative motion of points and surface since distances were measured.
    fn motion(&self, y: &[f64]) -> f64 {
        let [own, others] = &self.measured;
        let Some(first) = others.first_chunk::<3>() else { return f64::INFINITY };
        // In the frame of a node of the surface: what all of them move has no part in it.
        let drift = place(y, self.nodes[1][0]) - Vector(*first);
        let largest = |nodes: &[usize], known: &[f64]| {
            let moved =
                |(node, known): (&usize, &[f64; 3])| (place(y, *node) - Vector(*known) - drift).norm();
            nodes.iter().zip(known.as_chunks::<3>().0).map(moved).fold(0.0, f64::max)
        };
        self.factors[0] * largest(&self.nodes[0], own) + self.factors[1] * largest(&self.nodes[1], others)
    }
}
