//! Nodes that enter a body and leave it again within one step; through rigid obstacles in
//! `obstacle/path.rs`.
//!
//! At the end of such a step nothing penetrates, and no facet is faced where the node entered: it has
//! moved past the end of the side. Its straight path relative to the body shows it. A node that only
//! cuts off a corner does so by less the shorter the step is.

use carom_solid::FacetShape;

use super::surface::{Search, Surface};
use super::swept::SweptTest;
use super::trajectory::crossing;
use crate::places::Places;

/// Depth, relative to the facet, that a path may have.
pub(super) const SHARE: f64 = 0.01;
/// Instants between entry and exit at which the depth is measured.
const INSTANTS: usize = 7;

/// A node that was inside a body between the start and the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passed {
    /// Its global number.
    pub node: usize,
    /// Its largest depth of those measured on its way.
    pub depth: f64,
    /// The depth that is allowed.
    pub limit: f64,
}

/// Nodes that may pass through a body.
pub(super) struct Paths<'a> {
    /// The whole boundary of the body.
    pub surface: &'a Surface,
    pub nodes: &'a [usize],
    /// Depth that each node may have in any case.
    pub allowed: &'a dyn Fn(usize) -> f64,
    /// Whether a node enters through a facet, and whether the facet bounds what it enters.
    pub enters: &'a dyn Fn(usize, usize) -> bool,
    pub bounds: &'a dyn Fn(usize, usize) -> bool,
}

impl Paths<'_> {
    /// The node that was deepest beyond its limit, if any.
    pub(super) fn deepest(
        &self,
        search: &mut Search,
        swept: &mut SweptTest,
        [before, now]: [&[f64]; 2],
    ) -> Option<Passed> {
        let Self { surface, nodes, allowed, enters, bounds } = self;
        let first = *nodes.first()?;
        if surface.shape() == FacetShape::Point || !surface.is_whole() {
            return None;
        }
        let [start, end] = [before, now].map(|y| Places::new(y, 2));
        let path = |node: usize| end.at(node) - start.at(node);
        // Relative to one node, so that bodies that fly together do not count as moving.
        let moved = |node: &usize| (path(*node) - path(first)).norm();
        let facets = || 0..surface.all();
        let of_body = facets().flat_map(|f| surface.facet(f).nodes).map(moved).fold(0.0, f64::max);
        let of_nodes = nodes.iter().map(moved).fold(0.0, f64::max);
        let shortest = facets().map(|f| surface.length(f, start)).fold(f64::INFINITY, f64::min);
        // Entry, depth and exit need a path of twice the depth.
        if of_body + of_nodes <= 2.0 * SHARE * shortest || !search.update(surface, nodes, 0.0, start, end) {
            return None;
        }
        let mut between = Between { before, now, y: vec![0.0; now.len()] };
        let mut worst: Option<Passed> = None;
        for (place, &node) in nodes.iter().enumerate() {
            search.find(node, start, end);
            search.retain(|facet| bounds(node, facet));
            let near = search.found();
            let relative = |&other: &usize| (path(node) - path(other)).norm();
            let far = near.iter().any(|&f| {
                let most = surface.facet(f).nodes.iter().map(relative).fold(0.0, f64::max);
                most > 2.0 * SHARE * surface.length(f, start)
            });
            if !far {
                continue;
            }
            let mut earliest = |from: Places, to: Places, through: &dyn Fn(usize) -> bool| {
                let met = near.iter().filter(|&&facet| through(facet));
                let crossings =
                    met.filter_map(|&f| Some((f, crossing(swept, surface.facet(f), from, to, node)?.theta)));
                crossings.min_by(|a, b| a.1.total_cmp(&b.1))
            };
            // The last exit is the first entry of the reversed motion.
            let Some((entered, entry)) = earliest(start, end, &|facet| enters(node, facet)) else { continue };
            let Some((_, back)) = earliest(end, start, &|_| true) else { continue };
            let exit = 1.0 - back;
            if exit <= entry {
                continue;
            }
            for k in 0..INSTANTS {
                let theta = entry + (exit - entry) * (k + 1) as f64 / (INSTANTS + 1) as f64;
                let point = between.at(theta, node);
                let nearest = search.nearest(point, entered, |facet| {
                    bounds(node, facet).then(|| {
                        between.place(theta, surface.facet(facet).nodes);
                        surface.nearest(facet, point, Places::new(&between.y, 2)).1
                    })
                });
                let Some((facet, _)) = nearest else { continue };
                for near in [Some(facet), surface.neighbour(facet, false), surface.neighbour(facet, true)] {
                    near.iter().for_each(|&f| between.place(theta, surface.facet(f).nodes));
                }
                let found = surface.depth(facet, point, Places::new(&between.y, 2));
                let (depth, limit) =
                    (-found.distance, allowed(place) + SHARE * surface.length(found.facet, start));
                if depth > limit && worst.is_none_or(|worst| depth - limit > worst.depth - worst.limit) {
                    worst = Some(Passed { node, depth, limit });
                }
            }
        }
        worst
    }
}

/// Positions at an instant of the motion, those of some nodes alone.
struct Between<'a> {
    before: &'a [f64],
    now: &'a [f64],
    y: Vec<f64>,
}

impl Between<'_> {
    fn at(&self, theta: f64, node: usize) -> [f64; 2] {
        [2 * node, 2 * node + 1].map(|i| self.before[i] + theta * (self.now[i] - self.before[i]))
    }

    fn place(&mut self, theta: f64, nodes: &[usize]) {
        for &node in nodes {
            [self.y[2 * node], self.y[2 * node + 1]] = self.at(theta, node);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::{Detection, Kinematics, NodeToFacet};

    /// A plate −1 ≤ x ≤ 1, −0.1 ≤ y ≤ 0 of two facets along its length, of which those at the top are the
    /// side; node 6 moves from `start` to `end`, all of it with another motion as well.
    fn passed_by(start: [f64; 2], end: [f64; 2], with: [f64; 2]) -> Option<Passed> {
        let plate = [[-1.0, -0.1], [0.0, -0.1], [1.0, -0.1], [1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]];
        let facet = |k: usize| vec![k, (k + 1) % 6];
        let surface = Surface::new(FacetShape::L2, &[facet(3), facet(4)], &[1.0; 2]);
        let surface = surface.bounded_by(&[facet(0), facet(1), facet(2), facet(5)], 0);
        let contact = NodeToFacet::new(vec![6], surface, Detection::ClosestPoint);
        let before: Vec<f64> = plate.iter().chain([&start]).flatten().copied().collect();
        let moved = plate.iter().chain([&end]).map(|p| [p[0] + with[0], p[1] + with[1]]);
        contact.passed(&before, &moved.flatten().collect::<Vec<_>>())
    }

    #[test]
    fn a_node_that_leaves_past_the_end_of_the_side_is_found() {
        for with in [[0.0, 0.0], [3.0, -7.0]] {
            // Through the plate from x = 0.5 to x = 0.7, and on to x = 2.5.
            let found = passed_by([0.1, 0.2], [2.5, -1.0], with).unwrap();
            assert_eq!(found.node, 6);
            assert!((found.depth - 0.05).abs() < 1e-6, "{found:?}");
            assert!((found.limit - 0.01).abs() < 1e-12);
        }
    }

    #[test]
    fn a_node_that_stays_outside_or_inside_or_cuts_off_a_corner_is_not() {
        // Beside the end, above, and inside at the end.
        assert_eq!(passed_by([1.01, 0.2], [1.01, -1.0], [0.0; 2]), None);
        assert_eq!(passed_by([-3.0, 0.01], [3.0, 0.01], [0.0; 2]), None);
        assert_eq!(passed_by([0.1, 0.2], [0.1, -0.05], [0.0; 2]), None);
        // 0.001 of the top and of the end, which is 0.1 long: 0.0005 deep at most.
        assert_eq!(passed_by([0.899, 0.1], [1.1, -0.101], [0.0; 2]), None);
        assert!(passed_by([0.8, 0.1], [1.1, -0.2], [0.0; 2]).is_some());
    }
}
