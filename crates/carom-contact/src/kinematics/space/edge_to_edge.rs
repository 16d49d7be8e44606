//! Sharp edges of the secondary side against sharp edges of the primary, in one set of pairs: where
//! two edges cross between their nodes, no node enters a body.
//!
//! Two edges are in contact where the normal along the product of their tangents points out of the
//! body of the one and into that of the other, between the normals of the facets that meet at
//! either edge: elsewhere a body rests on a facet, and nodes constrain it. A pair is created once
//! they cross in a step; it follows the contact point along edges that continue each other, and is
//! removed at a corner, or where the normal leaves the facets' normals.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use carom_algebra::Vector;
use carom_solid::{Bounds, Tree};

use super::boundary::Boundary;
use super::edge_gap::EdgeGap;
use super::edges::Edges;
use super::folds::PatchFolds;
use crate::constants::{
    DEEPEST, EDGES_BEHIND, EDGES_BETWEEN, EDGES_CORNER, EDGES_CROSS, EDGES_NEAR_CORNER, EDGES_OUTSIDE,
    EDGES_TOGETHER, EXTENDED, PARALLEL, PAST_END, ROUND_OFF,
};
use crate::kinematics::apart::Apart;
use crate::kinematics::drift::Drift;
use crate::kinematics::tangents::tangents;
use crate::kinematics::{BetweenNodes, Kinematics, ON_FACET, Passed, SweptEdges};
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// Numbers of the two edges of a known pair, and its gap if it has one.
type Held = ([usize; 2], Option<EdgeGap>);

/// A point of an edge of the secondary side and one of an edge of the primary.
#[derive(Clone, Copy)]
pub(super) struct OnEdges {
    pub(super) edges: [usize; 2],
    pub(super) xi: [f64; 2],
}

/// Sharp edges of the secondary side against sharp edges of the primary side.
#[derive(Debug)]
pub struct EdgeToEdge {
    /// Sharp edges of the secondary side and of the primary side.
    pub(super) sides: [Edges; 2],
    /// A node of every edge of the secondary side, which represents the edge.
    names: Vec<usize>,
    /// For contact of a side with itself: the order of its places.
    folds: Option<Arc<PatchFolds>>,
    tools: Mutex<Tools>,
    swept: Mutex<SweptEdges>,
}

/// Memory that searches for edges reuse; results do not depend on its content.
#[derive(Debug)]
struct Tools {
    /// Bounding boxes of the paths of the edges of the primary side.
    tree: Tree,
    apart: Apart,
}

impl EdgeToEdge {
    /// Contact of the sharp edges of two sides, the secondary one first, at reference positions;
    /// `others`: the nodes of sides whose own contacts constrain the edges that they share with
    /// these.
    pub fn new(sides: [Boundary; 2], others: &[BTreeSet<usize>; 2], reference: &[f64]) -> Self {
        let [one, other] = sides;
        let sides = [Edges::new(one, &others[0], reference), Edges::new(other, &others[1], reference)];
        let nodes = sides.iter().flat_map(|side| (0..side.len()).flat_map(|k| side.nodes(k)));
        // The boxes of both sides grow.
        let weight = sides[0].weight() + sides[1].weight();
        let apart = Apart::new(nodes.copied(), 3, weight);
        let tools = Mutex::new(Tools { tree: Tree::default(), apart });
        let names = (0..sides[0].len()).map(|edge| sides[0].nodes(edge)[0]).collect();
        Self { sides, names, folds: None, tools, swept: Mutex::default() }
    }

    /// Contact of the edges of a side with each other; both sides are equal.
    pub(super) fn folding(self, folds: Arc<PatchFolds>) -> Self {
        Self { folds: Some(folds), ..self }
    }

    /// Whether two edges may form a pair in this order: always if they belong to different bodies;
    /// in one body if the first is the later one in the order of places, and no facet has nodes of
    /// both.
    pub(super) fn may_meet(&self, [own, other]: [usize; 2]) -> bool {
        let Some(folds) = &self.folds else { return true };
        let [here, there] = [own, other].map(|edge| self.sides[0].facet(edge));
        let is_later = folds.is_later(here, there) || here == there && own > other;
        is_later && !self.sides[0].around(own).any(|node| self.sides[0].nodes(other).contains(&node))
    }

    /// Whether a path of one edge across another one can be examined: two edges of one piece may
    /// begin and end on either side of its boundary.
    pub(super) fn may_pass(&self, [own, other]: [usize; 2]) -> bool {
        self.folds.as_ref().is_none_or(|folds| {
            let [here, there] = [own, other].map(|edge| self.sides[0].facet(edge));
            folds.are_of_different_pieces(here, there)
        })
    }

    /// Numbers of the two edges of a pair, each on its side.
    pub(super) fn of(&self, pair: &Pair) -> [usize; 2] {
        [pair.node, pair.facet - self.sides[1].facets()]
    }

    fn pair(&self, edges: [usize; 2], xi: [f64; 2]) -> Pair {
        Pair { eta: xi[1], ..Pair::open(edges[0], self.sides[1].facets() + edges[1], xi[0]) }
    }

    /// The certified test for crossings of edges.
    pub(super) fn swept(&self) -> MutexGuard<'_, SweptEdges> {
        self.swept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Nodes of one of two edges, ends first: that of the secondary side (`of` = 0) or of the
    /// primary (1).
    pub(super) fn nodes(&self, edges: [usize; 2], of: usize) -> &[usize] {
        self.sides[of].nodes(edges[of])
    }

    /// Nodes of the facets that meet at one of two edges: that of the secondary side (`of` = 0) or
    /// of the primary (1).
    pub(super) fn around(&self, edges: [usize; 2], of: usize) -> impl Iterator<Item = usize> {
        self.sides[of].around(edges[of])
    }

    /// A direction out of the body of the edge of the primary side and into that of the other edge.
    pub(super) fn outwards(&self, edges: [usize; 2], xi: [f64; 2], y: &[f64]) -> Vector<3> {
        let sum = |i: usize| {
            let [here, there] = self.sides[i].normals(edges[i], xi[i], y);
            here + there
        };
        sum(1) - sum(0)
    }

    pub(super) fn closest(&self, edges: [usize; 2], start: [f64; 2], y: &[f64]) -> Option<EdgeGap> {
        let nodes = [0, 1].map(|i| self.nodes(edges, i));
        EdgeGap::closest(nodes, start, y, self.outwards(edges, start, y))
    }

    fn gap_of(&self, pair: &Pair, y: &[f64]) -> Option<EdgeGap> {
        self.closest(self.of(pair), [pair.xi, pair.eta], y)
    }

    /// Whether two edges cross: their normal lies between those of the facets at either edge, with
    /// a margin, and the edges do not run along each other.
    pub(super) fn cross(&self, edges: [usize; 2], gap: &EdgeGap, margin: f64, y: &[f64]) -> bool {
        let out = |i: usize| {
            let direction = if i == 1 { gap.normal } else { -gap.normal };
            self.sides[i].outwards(edges[i], gap.xi[i], gap.tangent(i), direction, y)
        };
        gap.sine() >= EDGES_CROSS && out(0) >= margin && out(1) >= margin
    }

    pub(super) fn shorter(&self, edges: [usize; 2], y: &[f64]) -> f64 {
        let [a, b] = [0, 1].map(|i| self.sides[i].length(edges[i], y));
        a.min(b)
    }

    /// Whether the closest points lie on both edges, with the tolerance `past` at an end that
    /// another edge continues and `corner` at one where none does.
    fn is_on(&self, edges: [usize; 2], xi: [f64; 2], past: f64, corner: f64) -> bool {
        [0, 1].into_iter().all(|i| {
            let continues = self.sides[i].beyond(edges[i], xi[i]).is_some();
            xi[i].abs() <= 1.0 + if continues { past } else { corner }
        })
    }

    /// Whether both closest points are near corners. Each corner is then past an edge of the other
    /// body's facet, and neither faces that facet, however nearly the normal is the facet's.
    fn at_corners(&self, edges: [usize; 2], xi: [f64; 2]) -> bool {
        let ends = |i: usize| self.sides[i].beyond(edges[i], xi[i].signum() * (1.0 + PAST_END)).is_none();
        [0, 1].into_iter().all(|i| xi[i].abs() > 1.0 - EDGES_NEAR_CORNER && ends(i))
    }

    /// Gap of two edges without a pair that have met between two positions, if they have.
    fn candidate(&self, edges: [usize; 2], before: &[f64], now: &[f64]) -> Option<EdgeGap> {
        let gap = self.closest(edges, [0.0; 2], now)?;
        let length = self.shorter(edges, now);
        // Edges that touch may carry a body at the start. Where they touch at nodes, those carry
        // it, and round-off would choose between mirror images.
        let is_between = self.is_on(edges, gap.xi, -EDGES_CORNER, -EDGES_CORNER);
        let least = if is_between { ROUND_OFF } else { -ROUND_OFF };
        let met = gap.distance < least * length && gap.distance > -DEEPEST * length;
        let between = if self.at_corners(edges, gap.xi) { EDGES_OUTSIDE } else { EDGES_BETWEEN };
        if !met
            || !self.is_on(edges, gap.xi, PAST_END, -EDGES_CORNER)
            || !self.cross(edges, &gap, between, now)
        {
            return None;
        }
        // A pair that takes edges out of each other faster than they approach would throw them.
        let came = self.closest(edges, gap.xi, before).is_some_and(|start| {
            let approach = start.distance - gap.distance;
            start.distance >= -approach.max(ROUND_OFF * length).min(EDGES_BEHIND * length)
        });
        // Where they are past each other's ends at the start, that gap says nothing.
        (came || self.crossing(&mut self.swept(), edges, before, now).is_some()).then_some(gap)
    }

    /// The point on the next edge for each of two edges past whose end its coordinate ξ lies, by
    /// more than a tolerance, if another edge continues one of them.
    pub(super) fn beyond(&self, edges: [usize; 2], xi: [f64; 2], tolerance: f64) -> Option<OnEdges> {
        let mut to = OnEdges { edges, xi };
        for i in (0..2).filter(|&i| xi[i].abs() > 1.0 + tolerance) {
            if let Some(next) = self.sides[i].beyond(edges[i], xi[i]) {
                to.edges[i] = next.edge;
                to.xi[i] = next.xi;
            }
        }
        (to.edges != edges).then_some(to)
    }

    /// The edges to which a pair whose contact point is past an end, by more than a tolerance, is
    /// handed over, with their gap, if an edge continues there past whose end it lies less. Where
    /// the gap of both is the same, as over the joint, it does not jump.
    fn next(
        &self,
        edges: [usize; 2],
        xi: [f64; 2],
        tolerance: f64,
        y: &[f64],
    ) -> Option<([usize; 2], EdgeGap)> {
        let OnEdges { edges, xi: start } = self.beyond(edges, xi, tolerance)?;
        let gap = self.closest(edges, start, y)?;
        let is_nearer = past_ends(gap.xi) < past_ends(xi);
        let goes_on = is_nearer && self.may_meet(edges) && self.is_on(edges, gap.xi, PAST_END, PAST_END);
        (goes_on && self.cross(edges, &gap, EDGES_OUTSIDE, y)).then_some((edges, gap))
    }

    /// Hands pairs over to the next edges, or removes them: at the start of a step from where they
    /// are, not from where they would be without contact. Returns whether anything but an inactive
    /// pair changed, and the remaining pairs with their gaps at the positions `now`.
    fn follow(
        &self,
        [before, now]: [&[f64]; 2],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> (bool, Vec<Held>) {
        let starts = std::mem::replace(&mut pairing.fresh, false);
        let y = if starts { before } else { now };
        // Within a solve pairs would go there and back.
        let tolerance = if starts { ROUND_OFF } else { PAST_END };
        let mut known: BTreeSet<[usize; 2]> = pairing.pairs.iter().map(|pair| self.of(pair)).collect();
        let mut changed = false;
        pairing.pairs.retain_mut(|pair| {
            if starts {
                self.start_joint(pair, y, &mut known);
            }
            let edges = self.of(pair);
            let gap = self.gap_of(pair, y);
            let node = self.sides[0].nodes(edges[0])[0];
            // Over a joint all edges there count, whichever the pair has.
            if pair.joint.is_none()
                && let Some((to, gap)) = gap.and_then(|gap| self.next(edges, gap.xi, tolerance, y))
                && known.insert(to)
            {
                let facet = self.sides[1].facets() + to[1];
                let handed = pair.handed + edges[0] as isize - to[0] as isize;
                let joint = self.joints(to, &gap, y);
                *pair = Pair { node: to[0], facet, handed, begins: true, joint, ..*pair };
                [pair.xi, pair.eta] = gap.xi;
                let from = self.sides[1].facets() + edges[1];
                if pair.active && from != pair.facet {
                    events.push(PairEvent::HandOver { node, from, to: pair.facet });
                }
                changed |= pair.active || gap.distance < 0.0;
                return true;
            }
            let stays = |gap: &EdgeGap| {
                self.is_on(edges, gap.xi, EXTENDED, PAST_END) && self.cross(edges, gap, EDGES_OUTSIDE, y)
            };
            if gap.as_ref().is_some_and(stays) || pair.active && !starts {
                return true;
            }
            if pair.active {
                events.push(PairEvent::SlidOff { node, facet: pair.facet });
                changed = true;
            }
            false
        });
        let held = |pair: &Pair| (self.of(pair), self.gap_of(pair, now));
        (changed, pairing.pairs.iter().map(held).collect())
    }

    /// Calls `visit` for the edges whose paths come near each other, in order.
    pub(super) fn each_near(&self, before: &[f64], now: &[f64], mut visit: impl FnMut([usize; 2])) {
        if self.sides.iter().any(|side| side.len() == 0) {
            return;
        }
        let of_primary = (0..self.sides[1].len()).flat_map(|edge| self.sides[1].nodes(edge).iter().copied());
        let drift = Drift::of(of_primary, 3, [before, now]);
        let swept = |i: usize, edge: usize| {
            let [old, new] = [before, now].map(|y| self.sides[i].bounds(edge, y));
            let bounds = drift.path(old, new);
            bounds.grown(ROUND_OFF * bounds.size())
        };
        let mut tools = self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        let Tools { tree, apart } = &mut *tools;
        if apart.holds(ROUND_OFF, [before, now]) {
            return;
        }
        tree.place(self.sides[1].len(), |edge| swept(1, edge));
        let own: Vec<Bounds> = (0..self.sides[0].len()).map(|edge| swept(0, edge)).collect();
        let all = own.iter().skip(1).fold(own[0], carom_solid::Bounds::union);
        apart.searched([&tree.bounds(), &all], [ROUND_OFF, ROUND_OFF], now);
        let mut near = Vec::new();
        for (a, bounds) in own.iter().enumerate() {
            tree.find_into(bounds, &mut near);
            near.sort_unstable();
            near.iter().map(|&b| [a, b]).filter(|edges| self.may_meet(*edges)).for_each(&mut visit);
        }
    }

    /// First instant θ at which an edge of the secondary side meets one of the primary: that of the
    /// certified crossing or, for edges that were in contact before, that at which a linear gap
    /// vanishes.
    fn first_met(&self, edge: usize, before: &[f64], now: &[f64]) -> Option<f64> {
        let mut first: Option<f64> = None;
        self.each_near(before, now, |edges| {
            if edges[0] == edge
                && let Some(gap) = self.candidate(edges, before, now)
                && let Some(theta) = self.theta(edges, &gap, before, now)
            {
                first = Some(first.map_or(theta, |first| first.min(theta)));
            }
        });
        first
    }

    fn theta(&self, edges: [usize; 2], gap: &EdgeGap, before: &[f64], now: &[f64]) -> Option<f64> {
        if let Some(hit) = self.crossing(&mut self.swept(), edges, before, now) {
            return Some(hit.theta);
        }
        let start = self.closest(edges, gap.xi, before)?;
        crate::kinematics::zero(start.distance, gap.distance)
    }

    pub(super) fn lost(&self, pair: &Pair) -> ContactError {
        ContactError::Edges { node: self.sides[0].nodes(pair.node)[0], facet: pair.facet }
    }

    /// Adds a row over the nodes of both edges.
    fn push(&self, edges: [usize; 2], gap: f64, slopes: impl Iterator<Item = Vector<3>>, rows: &mut Rows) {
        let nodes = [0, 1].map(|i| self.nodes(edges, i));
        rows.push_both(gap, nodes, slopes);
        rows.begin_with_edge(nodes[0].len());
    }
}

/// How far two coordinates lie past the ends of their edges.
pub(super) fn past_ends(xi: [f64; 2]) -> f64 {
    xi.map(|xi| (xi.abs() - 1.0).max(0.0)).iter().sum()
}

impl Kinematics for EdgeToEdge {
    fn secondary(&self) -> &[usize] {
        &self.names
    }

    fn nodes(&self) -> usize {
        0
    }

    fn keep(&mut self, _: &[f64]) {}

    fn kept(&self, _: usize) -> f64 {
        0.0
    }

    fn facet_nodes(&self, pair: &Pair) -> &[usize] {
        self.sides[1].nodes(self.of(pair)[1])
    }

    fn between_nodes(&self, pair: &Pair) -> Option<BetweenNodes<'_>> {
        Some(BetweenNodes::on_line(self.sides[0].nodes(pair.node), pair.xi))
    }

    fn is_on_facet(&self, pair: &Pair) -> bool {
        [pair.xi, pair.eta].into_iter().all(|xi| xi.abs() <= 1.0 + ON_FACET)
    }

    fn facets(&self, _: usize) -> usize {
        self.sides[1].facets() + self.sides[1].len()
    }

    /// Infinite: an edge has no gap without the other one.
    fn signed_distance(&self, _: usize, _: &[f64]) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let (mut changed, mut all) = self.follow([before, now], pairing, events);
        let mut found = Vec::new();
        self.each_near(before, now, |edges| {
            if !all.iter().any(|(known, _)| *known == edges) {
                found.extend(self.candidate(edges, before, now).map(|gap| (edges, gap)));
            }
        });
        // Edges on which the contact point lies come before edges that continue them.
        found.sort_by(|a, b| past_ends(a.1.xi).total_cmp(&past_ends(b.1.xi)));
        for (edges, gap) in found {
            let near = EDGES_TOGETHER * self.shorter(edges, now);
            let joint = self.joints(edges, &gap, now);
            let is_held = all.iter().any(|(known, other)| {
                let joins = (0..2).all(|i| self.sides[i].is_near(edges[i], known[i]));
                let same = |other: &EdgeGap| {
                    let is_parallel = || other.normal.dot(&gap.normal) > PARALLEL.cosine;
                    let is_mean = || joint.is_some() && self.joints(*known, other, now) == joint;
                    (other.point(0) - gap.point(0)).norm() < near && (is_parallel() || is_mean())
                };
                joins && other.as_ref().is_some_and(same)
            });
            if !is_held {
                changed |= gap.distance < 0.0;
                pairing.pairs.push(Pair { joint, ..self.pair(edges, gap.xi) });
                all.push((edges, Some(gap)));
            }
        }
        pairing.pairs.sort_by_key(|pair| (pair.node, pair.facet));
        changed
    }

    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        self.passed_edge(before, now, bounce)
    }

    fn met(&self, edges: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>> {
        edges.iter().map(|&edge| self.first_met(edge, before, now)).collect()
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let edges = self.of(pair);
        let gap = self.gap_of(pair, y).ok_or_else(|| self.lost(pair))?;
        [pair.xi, pair.eta] = gap.xi;
        let crosses =
            self.is_on(edges, gap.xi, EXTENDED, PAST_END) && self.cross(edges, &gap, EDGES_OUTSIDE, y);
        if !pair.active && !crosses {
            rows.push_open();
            return Ok(());
        }
        self.push_means((pair, 1), y, rows, |edges, gap, rows| {
            self.push(edges, gap.distance + pair.depth, gap.gradient(), rows);
        })
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        self.mean_into(pair, y, curvature, EdgeGap::curvature_into);
    }

    fn slip(&self, pair: &Pair, y: &[f64], _: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        self.push_means((pair, 2), y, rows, |edges, gap, rows| {
            for along in tangents(gap.normal, pair.tangential.tangents) {
                self.push(edges, 0.0, gap.slip(along), rows);
            }
        })
    }

    fn slip_derivative_into(&self, pair: &Pair, y: &[f64], _: &[f64], tangent: usize, matrix: &mut [f64]) {
        self.mean_into(pair, y, matrix, |gap, matrix| {
            let along = tangents(gap.normal, pair.tangential.tangents)[tangent];
            gap.slip_derivative_into(along, matrix);
        });
    }
}
