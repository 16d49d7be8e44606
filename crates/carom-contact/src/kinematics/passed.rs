//! Nodes that enter a body and leave it again within one step; through rigid obstacles in
//! `obstacle/path.rs`.
//!
//! At the end of such a step nothing penetrates, and no facet is faced where the node entered: it
//! has moved past the end of the side. Its straight path relative to the body shows it (`way.rs`).
//! A node that only cuts off a corner does so by less the shorter the step is.

use carom_algebra::Vector;
use carom_solid::FacetShape;

use super::surface::{Search, Surface};
use super::swept::SweptTest;
use super::trajectory::crossing;
use super::way::{Allowed, Between, Met, SHARE, Seen, Way, amplification, through};
use crate::places::Places;

/// A node, or an edge, that was inside a body between the start and the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passed {
    /// What it is, in words that the number follows.
    pub what: &'static str,
    /// Its global number, or that of a node of the edge.
    pub node: usize,
    /// Its largest depth on its way, within an eighth.
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
    /// Allowed depth of a node that leaves where it entered, over the length of a facet.
    pub bounce: f64,
}

impl Paths<'_> {
    /// The node that was deepest beyond its limit, if any.
    pub(super) fn deepest(
        &self,
        search: &mut Search,
        swept: &mut SweptTest,
        [before, now]: [&[f64]; 2],
    ) -> Option<Passed> {
        let Self { surface, nodes, enters, bounds, .. } = *self;
        let first = *nodes.first()?;
        if surface.shape() == FacetShape::Point || !surface.is_whole() {
            return None;
        }
        let [start, end] = [before, now].map(|y| Places::new(y, 2));
        if search.is_apart(0.0, start, end) {
            return None;
        }
        let path = |node: usize| end.at(node) - start.at(node);
        // Squares, relative to one node, so that bodies that fly together do not count as moving.
        let moved = |node: &usize| square(path(*node) - path(first));
        let (mut of_body, mut shortest) = (0.0_f64, f64::INFINITY);
        for facet in 0..surface.all() {
            let nodes = surface.facet(facet).nodes;
            of_body = nodes.iter().map(moved).fold(of_body, f64::max);
            shortest = shortest.min(square(start.at(nodes[1]) - start.at(nodes[0])));
        }
        let of_nodes = nodes.iter().map(moved).fold(0.0, f64::max);
        let of_body = of_body.sqrt();
        // Entry, depth and exit need a path of twice the depth.
        if of_body + of_nodes.sqrt() <= 2.0 * SHARE * shortest.sqrt()
            || !search.update(surface, nodes, 0.0, start, end)
        {
            return None;
        }
        let mut between = None;
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
                    met.filter_map(|&f| Some((f, crossing(swept, surface.facet(f), from, to, node)?)));
                let (facet, met) = crossings.min_by(|a, b| a.1.theta.total_cmp(&b.1.theta))?;
                Some(Met { theta: met.theta, facet, xi: [met.xi, 0.0] })
            };
            // The last exit is the first entry of the reversed motion.
            let entry = earliest(start, end, &|facet| enters(node, facet));
            let exit = earliest(end, start, &|_| true).map(|back| Met { theta: 1.0 - back.theta, ..back });
            let between = between.get_or_insert_with(|| Between::new([before, now]));
            let from = entry.or(exit).map(|met| met.facet);
            let allowed = Allowed::default();
            let mut way = OnWay { paths: self, search, between, start, place, node, allowed, from };
            let fastest = amplification(surface.shape()) * (of_body + moved(&node).sqrt());
            let Some(found) = through(&mut way, [entry, exit], self.bounce, fastest) else { continue };
            let (depth, limit) = (found.depth, found.limit);
            if worst.is_none_or(|worst| depth - limit > worst.depth - worst.limit) {
                worst = Some(Passed { what: "node", node, depth, limit });
            }
        }
        worst
    }
}

fn square(v: Vector<2>) -> f64 {
    v.dot(&v)
}

/// A node between entry and exit.
struct OnWay<'a, 'b> {
    paths: &'a Paths<'a>,
    search: &'a Search,
    between: &'a mut Between<'b, 2>,
    start: Places<'a>,
    place: usize,
    node: usize,
    allowed: Allowed,
    /// A facet near the node.
    from: Option<usize>,
}

impl Way for OnWay<'_, '_> {
    fn seen(&mut self, theta: f64) -> Option<Seen> {
        let (surface, node) = (self.paths.surface, self.node);
        let point = self.between.at(theta, node).0;
        let distance = |facet: usize| {
            (self.paths.bounds)(node, facet).then(|| {
                let y = self.between.with(theta, surface.facet(facet).nodes);
                surface.nearest(facet, point, Places::new(y, 2)).1
            })
        };
        let (facet, _) = self.search.nearest(point, self.from, distance)?;
        let near = [false, true].into_iter().filter_map(|forward| surface.neighbour(facet, forward));
        for facet in near.chain([facet]) {
            self.between.with(theta, surface.facet(facet).nodes);
        }
        let found = surface.depth(facet, point, Places::new(self.between.flat(), 2));
        self.from = Some(found.facet);
        Some(self.on(theta, found.facet, found.xi, -found.distance))
    }

    fn on(&self, theta: f64, facet: usize, xi: [f64; 2], depth: f64) -> Seen {
        let surface = self.paths.surface;
        let speed = self.between.speed(self.node, surface.shape(), surface.facet(facet).nodes, xi);
        let of_facet =
            (self.paths.allowed)(self.place) + self.allowed.share * surface.length(facet, self.start);
        let limit = of_facet.max(self.allowed.at_end);
        Seen { theta, facet, xi, depth, speed, limit }
    }

    fn normal(&mut self, at: &Seen) -> Vector<3> {
        let facet = self.paths.surface.facet(at.facet);
        let y = self.between.with(at.theta, facet.nodes);
        let normal = facet.at(Places::new(y, 2), at.xi[0]).normal;
        Vector([normal[0], normal[1], 0.0])
    }

    fn between(&self, from: &Seen, to: &Seen) -> f64 {
        let surface = self.paths.surface;
        self.between.most(self.node, surface.shape(), surface.facet(from.facet).nodes, from, to)
    }

    fn allow(&mut self, allowed: Allowed) {
        self.allowed = allowed;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::{Detection, Kinematics, NodeToFacet};

    /// A plate −1 ≤ x ≤ 1, −0.1 ≤ y ≤ 0 of two facets along its length, of which those at the top
    /// are the side; node 6 moves from `start` to `end`, all of it with another motion as well.
    fn passed_by(start: [f64; 2], end: [f64; 2], with: [f64; 2]) -> Option<Passed> {
        bounced(start, end, with, 0.01)
    }

    fn bounced(start: [f64; 2], end: [f64; 2], with: [f64; 2], bounce: f64) -> Option<Passed> {
        let plate = [[-1.0, -0.1], [0.0, -0.1], [1.0, -0.1], [1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]];
        let facet = |k: usize| vec![k, (k + 1) % 6];
        let surface = Surface::new(FacetShape::L2, &[facet(3), facet(4)], &[1.0; 2]);
        let surface = surface.bounded_by(&[facet(0), facet(1), facet(2), facet(5)], 0);
        let contact = NodeToFacet::new(vec![6], surface, Detection::ClosestPoint);
        let before: Vec<f64> = plate.iter().chain([&start]).flatten().copied().collect();
        let moved = plate.iter().chain([&end]).map(|p| [p[0] + with[0], p[1] + with[1]]);
        contact.passed(&before, &moved.flatten().collect::<Vec<_>>(), bounce)
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

    #[test]
    fn a_node_that_leaves_where_it_entered_may_be_as_deep_as_a_contact_allows() {
        // Through a low ridge of the top, 0.04 deep; its facets are 1 long.
        let bounce = |share: f64| {
            let plate = [[-1.0, -0.1], [0.0, -0.1], [1.0, -0.1], [1.0, 0.0], [0.0, 0.08], [-1.0, 0.0]];
            let facet = |k: usize| vec![k, (k + 1) % 6];
            let surface = Surface::new(FacetShape::L2, &[facet(3), facet(4)], &[1.0; 2]);
            let surface = surface.bounded_by(&[facet(0), facet(1), facet(2), facet(5)], 0);
            let contact = NodeToFacet::new(vec![6], surface, Detection::ClosestPoint);
            let at = |x: f64| plate.into_iter().chain([[x, 0.04]]).flatten().collect::<Vec<_>>();
            contact.passed(&at(-0.9), &at(0.9), share)
        };
        let found = bounce(0.01).unwrap();
        assert!((found.depth - 0.04 / f64::hypot(1.0, 0.08)).abs() < 1e-6, "{found:?}");
        assert_eq!(bounce(0.25), None);
        // Through the plate, however much a bounce may have.
        assert!(bounced([0.1, 0.2], [2.5, -1.0], [0.0; 2], 0.25).is_some());
    }

    #[test]
    fn thin_walls_of_a_hollow_body_are_not_missed() {
        // Of the way from the first entry, x = 0, to the last exit, x = 2.06, 94 % are outside.
        let channel = [
            [0.0, 0.0],
            [2.06, 0.0],
            [2.06, 1.0],
            [2.0, 1.0],
            [2.0, 0.06],
            [0.06, 0.06],
            [0.06, 1.0],
            [0.0, 1.0],
        ];
        let facet = |k: usize| vec![k, (k + 1) % 8];
        let rest: Vec<_> = (0..7).map(facet).collect();
        let surface = Surface::new(FacetShape::L2, &[facet(7)], &[1.0]).bounded_by(&rest, 0);
        let contact = NodeToFacet::new(vec![8], surface, Detection::ClosestPoint);
        let at = |x: f64, y: f64| [channel.as_flattened(), &[x, y]].concat();
        let found = contact.passed(&at(-1.0, 0.5), &at(3.0, 0.5), 0.01).unwrap();
        assert!((0.026..0.0301).contains(&found.depth), "{found:?}");
        assert_eq!(contact.passed(&at(-1.0, 1.01), &at(3.0, 1.01), 0.01), None);
    }

    #[test]
    fn a_node_with_a_pair_that_enters_elsewhere_has_another_one() {
        use crate::{Pair, Pairing};
        // Between the inner walls of a channel, with an open pair with the left one.
        let channel =
            [[0.0, 0.0], [2.5, 0.0], [2.5, 1.0], [2.0, 1.0], [2.0, 0.5], [0.5, 0.5], [0.5, 1.0], [0.0, 1.0]];
        let facet = |k: usize| vec![k, (k + 1) % 8];
        let rest: Vec<_> = [0, 1, 2, 6, 7].map(facet).into();
        let side = [facet(3), facet(4), facet(5)];
        let surface = Surface::new(FacetShape::L2, &side, &[1.0; 3]).bounded_by(&rest, 0);
        let contact = NodeToFacet::new(vec![8], surface, Detection::ClosestPoint);
        let at = |x: f64, y: f64| [channel.as_flattened(), &[x, y]].concat();
        let found = |to: Vec<f64>| {
            let mut pairing = Pairing::new(vec![Pair::open(0, 2, 0.0)]);
            let changed = contact.search(&at(0.6, 0.75), &to, &mut pairing, &mut Vec::new());
            (changed, pairing.pairs.iter().map(|pair| pair.facet).collect::<Vec<_>>())
        };
        assert_eq!(found(at(2.1, 0.75)), (true, vec![2, 0]));
        assert_eq!(found(at(1.9, 0.75)), (false, vec![2]));
        assert_eq!(found(at(0.45, 0.75)), (false, vec![2]));
    }

    #[test]
    fn a_node_that_starts_or_ends_at_a_depth_that_it_may_have_is_not_forgotten() {
        // It may be 0.02 deep, is 0.015 deep at one end of its way, and 0.05 deep on it.
        let plate = [[-1.0, -0.1], [0.0, -0.1], [1.0, -0.1], [1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]];
        let facet = |k: usize| vec![k, (k + 1) % 6];
        let surface = Surface::new(FacetShape::L2, &[facet(3), facet(4)], &[1.0; 2]);
        let surface = surface.bounded_by(&[facet(0), facet(1), facet(2), facet(5)], 0);
        let contact = NodeToFacet::new(vec![6], surface, Detection::ClosestPoint).with_allowed(vec![0.02]);
        let at = |x: f64, y: f64| [plate.as_flattened(), &[x, y]].concat();
        let [inside, below] = [at(0.2, -0.015), at(0.4, -0.5)];
        for [from, to] in [[&inside, &below], [&below, &inside]] {
            let found = contact.passed(from, to, 0.01).unwrap();
            assert!((0.044..0.0501).contains(&found.depth), "{found:?}");
        }
        assert_eq!(contact.passed(&inside, &at(0.4, 0.5), 0.01), None);
        assert_eq!(contact.passed(&inside, &at(0.4, -0.01), 0.01), None);
    }
}
