//! Nodes that enter a body and leave it again within one step, in the plane and in space; through
//! rigid obstacles in `obstacle/path.rs`.
//!
//! At the end of such a step nothing penetrates, and no facet is faced where the node entered: it
//! has moved past the end of the side. Its straight path relative to the body shows it (`way.rs`).
//! A node that only cuts off a corner does so by less the shorter the step is.

use carom_algebra::Vector;
use carom_solid::{Bounds, Tree};

use super::drift::Drift;
use super::facets::Facets;
use super::way::{Allowed, Between, Met, Seen, Way, amplification, through};
use crate::constants::SHALLOW;

/// A node, or an edge, that was inside a body between the start and the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passed {
    /// Kind of the object, in words that its number follows: a node or an edge.
    pub what: &'static str,
    /// Global number of the node, or of a node of the edge.
    pub node: usize,
    /// Largest depth on the path, known to within an eighth.
    pub depth: f64,
    /// Depth that is allowed on the path.
    pub limit: f64,
}

/// Search for nodes that pass through a body within a step.
pub(super) struct Paths<'a, B> {
    /// The whole boundary of the body.
    pub boundary: &'a B,
    pub nodes: &'a [usize],
    /// Depth that each node may have without contact.
    pub allowed: &'a dyn Fn(usize) -> f64,
    /// Whether a node can enter the body through a facet.
    pub enters: &'a dyn Fn(usize, usize) -> bool,
    /// Whether a facet bounds a body that a node can enter.
    pub bounds: &'a dyn Fn(usize, usize) -> bool,
    /// Allowed depth of a node that leaves where it entered, over the shortest edge of a facet.
    pub bounce: f64,
}

/// Boxes of the paths of facets and nodes in a step.
#[derive(Clone, Copy)]
pub(super) struct Boxes<'a> {
    /// Hierarchy of the boxes of the facets' paths.
    pub tree: &'a Tree,
    /// Frame in which all boxes are seen.
    pub drift: Drift,
    /// Box of the path of a node.
    pub of_node: &'a dyn Fn(usize) -> Bounds,
}

/// Largest motion of the nodes of a body in a step, and the shortest edge of its facets.
pub(super) struct Motion {
    of_body: f64,
    shortest: f64,
}

impl<B> Paths<'_, B> {
    /// Largest motion of the nodes in a step; none if it is too short to enter and leave the body,
    /// which needs a path of twice the depth.
    pub(super) fn motion<const D: usize>(&self, ends: [&[f64]; 2]) -> Option<Motion>
    where
        B: Facets<D>,
    {
        let Self { boundary, nodes, .. } = *self;
        let first = *nodes.first()?;
        let most = |nodes: &[usize]| nodes.iter().map(|&n| relative::<D>(ends, n, first)).fold(0.0, f64::max);
        let of_body = most(boundary.nodes()).sqrt();
        let of_nodes = most(nodes).sqrt();
        let lengths = (0..boundary.all()).map(|facet| boundary.shortest_edge(facet, ends[0]));
        let shortest = lengths.fold(f64::INFINITY, f64::min);
        (of_body + of_nodes > 2.0 * SHALLOW * shortest).then_some(Motion { of_body, shortest })
    }

    /// Whether a node moves far enough relative to a facet to enter and leave the body there.
    fn moves_far<const D: usize>(&self, node: usize, facet: usize, ends: [&[f64]; 2]) -> bool
    where
        B: Facets<D>,
    {
        let moved = |&other: &usize| relative::<D>(ends, node, other).sqrt();
        let most = self.boundary.nodes_of(facet).iter().map(moved).fold(0.0, f64::max);
        most > 2.0 * SHALLOW * self.boundary.shortest_edge(facet, ends[0])
    }

    /// The node that was deepest beyond its limit, if any. `crossing`: where a node first crosses a
    /// facet, up to a given instant.
    pub(super) fn deepest<const D: usize>(
        &self,
        Motion { of_body, shortest }: Motion,
        [before, now]: [&[f64]; 2],
        boxes: Boxes,
        mut crossing: impl FnMut(usize, [&[f64]; 2], f64, usize) -> Option<Met>,
    ) -> Option<Passed>
    where
        B: Facets<D>,
    {
        let Self { boundary, nodes, bounds, .. } = *self;
        let mut between = None;
        let mut near = Vec::new();
        let mut worst: Option<Passed> = None;
        for (place, &node) in nodes.iter().enumerate() {
            boxes.tree.find_into(&(boxes.of_node)(node), &mut near);
            near.retain(|&facet| bounds(node, facet));
            if !near.iter().any(|&facet| self.moves_far(node, facet, [before, now])) {
                continue;
            }
            let moved = relative::<D>([before, now], node, nodes[0]).sqrt();
            let fastest = amplification(boundary.shape()) * (of_body + moved);
            let slack = (self.allowed)(place);
            // What enters later, or leaves earlier, is not inside for long enough.
            let until = 1.0 - (SHALLOW * shortest + slack) / fastest;
            if until <= 0.0 {
                continue;
            }
            let mut earliest = |ends: [&[f64]; 2], through: &dyn Fn(usize) -> bool| {
                let met = near.iter().filter(|&&facet| through(facet));
                let crossings = met.filter_map(|&facet| crossing(facet, ends, until, node));
                crossings.min_by(|a, b| a.theta.total_cmp(&b.theta))
            };
            // The last exit is the first entry of the reversed motion.
            let exit = earliest([now, before], &|_| true).map(|back| Met { theta: 1.0 - back.theta, ..back });
            let entry = earliest([before, now], &|facet| (self.enters)(node, facet));
            let mut way = OnWay {
                boundary,
                bounds,
                boxes,
                between: between.get_or_insert_with(|| Between::new([before, now])),
                before,
                node,
                slack,
                allowed: Allowed::default(),
                from: entry.or(exit).map(|met| met.facet),
            };
            let Some(found) = through(&mut way, [entry, exit], self.bounce, fastest) else { continue };
            let depth = found.depth;
            let limit = found.limit;
            if worst.is_none_or(|worst| depth - limit > worst.depth - worst.limit) {
                worst = Some(Passed { what: "node", node, depth, limit });
            }
        }
        worst
    }
}

/// Squared motion of a node relative to another one: bodies that fly together do not move relative
/// to each other.
fn relative<const D: usize>([before, now]: [&[f64]; 2], node: usize, other: usize) -> f64 {
    let [before, now] = [before, now].map(|y| y.as_chunks::<D>().0);
    let path = |node: usize| Vector(now[node]) - Vector(before[node]);
    let apart = path(node) - path(other);
    apart.dot(&apart)
}

/// Path of a node through a body between entry and exit.
struct OnWay<'a, 'b, const D: usize, B> {
    boundary: &'a B,
    bounds: &'a dyn Fn(usize, usize) -> bool,
    boxes: Boxes<'a>,
    between: &'a mut Between<'b, D>,
    before: &'a [f64],
    node: usize,
    slack: f64,
    allowed: Allowed,
    /// A facet near the node, where the search for the nearest one begins.
    from: Option<usize>,
}

impl<const D: usize, B: Facets<D>> Way for OnWay<'_, '_, D, B> {
    fn seen(&mut self, theta: f64) -> Option<Seen> {
        let boundary = self.boundary;
        let point = self.between.at(theta, self.node);
        let distance = |facet: usize| {
            (self.bounds)(self.node, facet)
                .then(|| boundary.distance(facet, point, self.between.with(theta, boundary.nodes_of(facet))))
        };
        let seen = self.boxes.drift.seen(theta, &point.0);
        let (facet, _) = self.boxes.tree.nearest(&seen, self.from, distance)?;
        for beside in boundary.beside(facet) {
            self.between.with(theta, boundary.nodes_of(beside));
        }
        let found = boundary.depth(facet, point, self.between.with(theta, boundary.nodes_of(facet)));
        self.from = Some(found.facet);
        Some(self.on(theta, found.facet, found.xi, -found.distance))
    }

    fn on(&self, theta: f64, facet: usize, xi: [f64; 2], depth: f64) -> Seen {
        let boundary = self.boundary;
        let speed = self.between.speed(self.node, boundary.shape(), boundary.nodes_of(facet), xi);
        let of_facet = self.slack + self.allowed.share * boundary.shortest_edge(facet, self.before);
        let limit = of_facet.max(self.allowed.at_end);
        Seen { theta, facet, xi, depth, speed, limit }
    }

    fn normal(&mut self, at: &Seen) -> Vector<3> {
        let boundary = self.boundary;
        boundary.normal(at.facet, at.xi, self.between.with(at.theta, boundary.nodes_of(at.facet)))
    }

    fn between(&self, from: &Seen, to: &Seen) -> f64 {
        let boundary = self.boundary;
        self.between.most(self.node, boundary.shape(), boundary.nodes_of(from.facet), from, to)
    }

    fn allow(&mut self, allowed: Allowed) {
        self.allowed = allowed;
    }
}
