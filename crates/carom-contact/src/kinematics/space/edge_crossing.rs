//! Edges that cross each other within a step: x_A(ξ, θ) = x_B(η, θ), all nodes moving on straight
//! lines from θ = 0 to θ = 1.
//!
//! The certified test of `swept` isolates the first crossing into the body of the other edge;
//! Newton's method polishes it. Edges that have crossed and form no pair at the end of the step,
//! because they are past each other's ends, or one has gone through a thin body, overlap on their
//! way by the depth −g of their closest points, examined as that of nodes is (`way.rs`).

use carom_algebra::{Mat, Vector};
use carom_solid::shape::line_shape;

use super::edge_to_edge::EdgeToEdge;
use super::patch::{cross, place};
use crate::constants::{ASTRAY, DEEP, EDGES_CROSS, MEETS, PAST_END};
use crate::kinematics::way::{Allowed, Between, Seen, Way, deepest};
use crate::kinematics::{Passed, SpaceHit, SweptEdges};

/// Largest ratio of the motion of a point of an edge to that of its nodes.
const AMPLIFIED: f64 = 1.6312;

/// Largest number of edges along which closest points are followed.
const MOST: usize = 100;

/// Places of the nodes of an edge at the start and at the end of a step.
type Path = [Vec<Vector<3>>; 2];

impl EdgeToEdge {
    /// First crossing of two edges in a step by which each enters the body of the other.
    pub(super) fn crossing(
        &self,
        swept: &mut SweptEdges,
        edges: [usize; 2],
        before: &[f64],
        now: &[f64],
    ) -> Option<SpaceHit> {
        let paths: [Path; 2] = [0, 1].map(|of| {
            [before, now].map(|y| self.nodes(edges, of).iter().map(|&node| place(y, node)).collect())
        });
        let chord = |of: usize, end: usize| paths[of][end][1] - paths[of][end][0];
        let crosses = |end: usize| {
            let a = chord(0, end);
            let b = chord(1, end);
            cross(a, b).norm() >= EDGES_CROSS * a.norm() * b.norm()
        };
        if !crosses(0) && !crosses(1) {
            return None;
        }
        let outwards = self.outwards(edges, [0.0; 2], before);
        let at = |end: usize| [0, 1].map(|of| paths[of][end].as_slice());
        let separation = MEETS * self.shorter(edges, before);
        let hit = swept.first([at(0), at(1)], outwards, separation)?;
        Some(polished(&paths, hit).unwrap_or(hit))
    }

    /// The edge that was deepest beyond its limit in the body of another edge within a step;
    /// `bounce`: allowed depth of a node, relative to the length of a facet.
    pub(super) fn passed_edge(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        let mut swept = self.swept();
        let mut between: Option<Between<3>> = None;
        let mut worst: Option<Passed> = None;
        self.each_near(before, now, |edges| {
            if !self.may_pass(edges) {
                return;
            }
            let limit = bounce.max(DEEP) * self.shorter(edges, before);
            let moved = |node: usize| place(now, node) - place(before, node);
            let [own, other] = [0, 1].map(|of| self.nodes(edges, of));
            let first = moved(own[0]);
            let most = own.iter().chain(other).map(|&node| (moved(node) - first).norm()).fold(0.0, f64::max);
            let fastest = 2.0 * AMPLIFIED * most;
            if fastest <= limit {
                return;
            }
            let Some(SpaceHit { theta, xi }) = self.crossing(&mut swept, edges, before, now) else { return };
            if fastest * (1.0 - theta) <= limit {
                return;
            }
            let between = between.get_or_insert_with(|| Between::new([before, now]));
            let mut way = OnWay { contact: self, edges, between, xi, fastest, limit };
            let entry = way.on(theta, 0, xi, 0.0);
            let Some(end) = way.seen(1.0) else { return };
            let found = if end.depth > limit { Some(end) } else { deepest(&mut way, [entry, end], fastest) };
            let Some(Seen { depth, limit, .. }) = found else { return };
            if worst.is_none_or(|worst| depth - limit > worst.depth - worst.limit) {
                worst = Some(Passed { what: "the edge at node", node: own[0], depth, limit });
            }
        });
        worst
    }
}

/// Crossing of two edges refined by Newton's method from an isolated one; none if that does not
/// lead to a crossing near it.
fn polished(paths: &[Path; 2], hit: SpaceHit) -> Option<SpaceHit> {
    let SpaceHit { mut theta, mut xi } = hit;
    for _ in 0..20 {
        // Relative to a node of B: exact differences, however far from the origin.
        let mut miss = Vector::ZERO;
        let mut moved = Vector::ZERO;
        let mut tangents = [Vector::ZERO; 2];
        for of in 0..2 {
            let [before, now] = &paths[of];
            let sign = [1.0, -1.0][of];
            let shape = line_shape(before.len(), xi[of]);
            for (k, (before, now)) in before.iter().zip(now).enumerate() {
                let start = *before - paths[1][0][0];
                let end = *now - paths[1][1][0];
                let x = start * (1.0 - theta) + end * theta;
                miss += x * (sign * shape.values[k]);
                moved += (end - start) * (sign * shape.values[k]);
                tangents[of] += x * (sign * shape.first[k]);
            }
        }
        let matrix = Mat([moved.0, tangents[0].0, tangents[1].0]).transposed();
        let step = matrix.inverse().apply(&-miss);
        theta += step[0];
        xi = [xi[0] + step[1], xi[1] + step[2]];
        let size = step.0.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let astray = [theta - hit.theta, xi[0] - hit.xi[0], xi[1] - hit.xi[1]];
        let near = astray.iter().all(|x| x.abs() < ASTRAY);
        // A NaN is not near.
        if !size.is_finite() || !near {
            return None;
        }
        if size <= 1e-12 {
            let inside = (0.0..=1.0).contains(&theta) && xi.iter().all(|x| x.abs() <= 1.0 + MEETS);
            return inside.then_some(SpaceHit { theta, xi });
        }
    }
    None
}

/// Path of two edges after they have crossed each other.
struct OnWay<'a, 'b> {
    contact: &'a EdgeToEdge,
    edges: [usize; 2],
    between: &'a mut Between<'b, 3>,
    /// Coordinates on both edges where the search for their closest points begins.
    xi: [f64; 2],
    fastest: f64,
    limit: f64,
}

impl Way for OnWay<'_, '_> {
    /// Depth of the edges at an instant; zero where the bodies do not meet with these edges or
    /// those that continue them.
    fn seen(&mut self, theta: f64) -> Option<Seen> {
        let mut edges = self.edges;
        let mut xi = self.xi;
        for _ in 0..MOST {
            for of in 0..2 {
                for node in self.contact.around(edges, of) {
                    self.between.with(theta, &[node]);
                }
            }
            let y = self.between.flat();
            let Some(gap) = self.contact.closest(edges, xi, y) else { break };
            if let Some(next) = self.contact.beyond(edges, gap.xi, PAST_END) {
                edges = next.edges;
                xi = next.xi;
                continue;
            }
            if gap.xi.iter().any(|xi| xi.abs() > 1.0 + PAST_END) || !self.contact.cross(edges, &gap, 0.0, y) {
                break;
            }
            self.edges = edges;
            self.xi = gap.xi;
            return Some(self.on(theta, 0, gap.xi, -gap.distance));
        }
        Some(self.on(theta, 0, self.xi, 0.0))
    }

    fn on(&self, theta: f64, facet: usize, xi: [f64; 2], depth: f64) -> Seen {
        Seen { theta, facet, xi, depth, speed: self.fastest, limit: self.limit }
    }

    fn between(&self, _: &Seen, _: &Seen) -> f64 {
        f64::INFINITY
    }

    fn normal(&mut self, _: &Seen) -> Vector<3> {
        Vector::ZERO
    }

    fn allow(&mut self, _: Allowed) {}
}
