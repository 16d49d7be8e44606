//! Whether some point is deeper in a body than it may be, without a search where none can be. With
//! s the signed distance of a point, positive outside, and a and b the largest motions of the
//! points and of the body's surface since s was measured,
//!
//! ```text
//! s − a − b > −d    ⇒    no point is deeper than d
//! ```
//!
//! s is measured again where that does not tell, so that the answer depends on positions alone. A
//! point that moves by d or more within a step is not left out: it may have passed through a part.

use carom_algebra::Vector;

use super::boundary::Boundary;
use super::closed_surface::ClosedSurface;
use super::patch::place;
use crate::constants::SURE;
use crate::kinematics::Facets;

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
    /// For points with these nodes and weights, which may enter the body with this surface by
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

    /// Whether no point moves by the depth in a step: one that does may pass through a part of the
    /// body.
    pub(super) fn is_slow(&self, [before, now]: [&[f64]; 2]) -> bool {
        let start = |side: usize, k: usize| place(before, self.nodes[side][k]);
        self.relative(now, start) < self.depth
    }

    /// Whether no point can be too deep, as far as motion tells.
    pub(super) fn holds(&self, y: &[f64]) -> bool {
        let measured = |side: usize, k: usize| {
            let places = self.measured[side].as_chunks::<3>().0;
            places.get(k).map_or(Vector([f64::NAN; 3]), |place| Vector(*place))
        };
        self.least - self.relative(y, measured) > -SURE * self.depth
    }

    /// Measures whether none of the points is too deep; `points`: their positions, at those of all
    /// nodes.
    pub(super) fn measure<'a>(&mut self, points: impl Iterator<Item = &'a [f64; 3]>, y: &[f64]) -> bool {
        self.surface.update(y);
        self.least = f64::INFINITY;
        for (point, near) in points.zip(&mut self.near) {
            let Some(found) = self.surface.depth(*point, *near, y) else { continue };
            let is_known = found.distance.is_finite();
            self.least = if is_known { self.least.min(found.distance) } else { f64::NEG_INFINITY };
            *near = Some(found.facet);
        }
        for (places, nodes) in self.measured.iter_mut().zip(&self.nodes) {
            places.clear();
            places.extend(nodes.iter().flat_map(|node| place(y, *node).0));
        }
        self.least > -self.depth
    }

    /// Bound of the relative motion of points and surface to positions `y` from others of the
    /// nodes, by side and number; infinite where one is not known.
    fn relative(&self, y: &[f64], from: impl Fn(usize, usize) -> Vector<3>) -> f64 {
        let Some(first) = self.nodes[1].first() else { return f64::INFINITY };
        // In the frame of a node of the surface: what all of them move has no part in it.
        let drift = place(y, *first) - from(1, 0);
        let largest = |side: usize| {
            let moved = |(k, node): (usize, &usize)| (place(y, *node) - from(side, k) - drift).norm();
            let nodes = self.nodes[side].iter().enumerate();
            nodes.map(moved).fold(0.0, |most: f64, x| if x.is_finite() { most.max(x) } else { f64::INFINITY })
        };
        self.factors[0] * largest(0) + self.factors[1] * largest(1)
    }
}
