//! Secondary nodes against a rigid obstacle, fixed or carried by nodes (`carrier.rs`), with gaps
//! and slips as in `obstacle/gap.rs`.
//!
//! At a sharp corner or edge of the obstacle the nearest piece may be one on which the body cannot
//! press. There a node belongs to the piece that is parallel to a facet of its body, also if it
//! lies past the corner by less than the distance up to which the row of the corner is left to it
//! (`tip_to_facet.rs`).
//!
//! At a concave corner of more than 30° a node has a pair with each piece behind which it lies, and
//! with that one to the end of its contact: with one pair it would sink into the others.

use std::collections::BTreeMap;

use carom_algebra::{Mat, Vector};

use super::carrier::{Carrier, Local};
use super::obstacle::{AtCorner, Near, Obstacle, ObstacleGap, Point, Through, Tip, dot};
use super::outward::{Outward, is_opposed};
use super::passed::Passed;
use super::reversed::NodesWithDepth;
use super::tangents::tangents;
use super::way::share;
use super::{Kinematics, watch_every_node};
use crate::constants::{KINK, NEAR_END, SHALLOW};
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// Secondary nodes against a rigid obstacle.
#[derive(Clone, Debug)]
pub struct NodeToObstacle {
    secondary: Vec<usize>,
    dimension: usize,
    pub(super) shape: Obstacle,
    pub(super) carrier: Option<Carrier>,
    /// Convex parts of the obstacle, in the coordinates of the shape.
    pub(super) tips: Vec<Tip>,
    /// Length of the facets at each secondary node; empty if the nodes have no facets.
    lengths: Vec<f64>,
    /// Boundary of the body of the nodes, if it is known.
    own: Option<Outward>,
    /// Depth that each node may have without contact; empty if none may have any.
    allowed: Vec<f64>,
    /// Initial depth that is kept for each node; empty if all are zero.
    kept: Vec<f64>,
}

impl NodeToObstacle {
    /// Contact of secondary nodes with an obstacle that is fixed in space.
    pub fn new(secondary: Vec<usize>, dimension: usize, shape: Obstacle) -> Self {
        let tips = shape.tips(f64::INFINITY);
        Self {
            secondary,
            dimension,
            shape,
            carrier: None,
            tips,
            lengths: Vec::new(),
            own: None,
            allowed: Vec::new(),
            kept: Vec::new(),
        }
    }

    /// Contact with an obstacle that moves with the nodes of a carrier.
    #[must_use]
    pub fn carried_by(self, carrier: Carrier) -> Self {
        Self { carrier: Some(carrier), ..self }
    }

    /// Contact with the length of the facets at each secondary node, relative to which the depth of
    /// a path through the obstacle is judged, and with points of its sharp edges two to a facet.
    #[must_use]
    pub fn with_lengths(self, lengths: Vec<f64>) -> Self {
        let tips = self.shape.tips(0.5 * lengths.iter().copied().fold(f64::INFINITY, f64::min));
        Self { tips, lengths, ..self }
    }

    /// Contact of nodes that belong to a body with the boundary `own`.
    #[must_use]
    pub fn of_body(self, own: Outward) -> Self {
        Self { own: Some(own), ..self }
    }

    /// Contact of those of the nodes that are listed in order, each with the depth that it may have
    /// without contact.
    #[must_use]
    pub fn of_nodes(&self, nodes: &NodesWithDepth) -> Self {
        let of_all = |(place, &node): (usize, &usize)| {
            let listed = nodes.nodes.binary_search(&node).ok()?;
            Some((place, nodes.depths[listed]))
        };
        let found: Vec<(usize, f64)> = self.secondary.iter().enumerate().filter_map(of_all).collect();
        Self {
            secondary: found.iter().map(|&(place, _)| self.secondary[place]).collect(),
            lengths: found.iter().filter_map(|&(place, _)| self.lengths.get(place).copied()).collect(),
            allowed: found.iter().map(|&(_, allowed)| allowed).collect(),
            ..self.clone()
        }
    }

    /// Depth at which the gap of a node is zero.
    fn slack(&self, place: usize) -> f64 {
        self.allowed(place) + self.kept(place)
    }

    fn position(&self, node: usize, y: &[f64]) -> Point {
        let y = &y[node * self.dimension..(node + 1) * self.dimension];
        std::array::from_fn(|i| y.get(i).copied().unwrap_or(0.0))
    }

    fn local(&self, node: usize, y: &[f64]) -> Local {
        let place = self.position(node, y);
        self.carrier.as_ref().map_or(Local::fixed(place), |carrier| carrier.local(place, y, self.dimension))
    }

    /// The piece of the obstacle that an inactive node faces: the closest one if the node is
    /// outside, that through which it entered if it is inside; searched from the last one.
    fn facing(&self, last: usize, before: Point, now: Point) -> usize {
        let nearest = self.shape.facing(now, last);
        if self.shape.near(nearest, now).is_some_and(|near| near.gap >= 0.0) {
            return nearest;
        }
        self.shape.entered(before, now).map_or(nearest, |entry| entry.piece)
    }

    /// The piece across a sharp corner from that which a node, given by index, would face, on which
    /// the node presses instead: the piece is parallel to a facet at the node, and that which the
    /// node would face is not.
    fn pressed(&self, place: usize, faced: usize, local: &Local, y: &[f64]) -> Option<usize> {
        let own = self.own.as_ref()?;
        let length = *self.lengths.get(place)?;
        let past = NEAR_END * length;
        let here = self.shape.near(faced, local.at).filter(|here| here.gap <= past)?;
        let over = self.shape.over(local.at, length, past);
        // A corner of the obstacle has no normal to which a facet could be parallel.
        let is_flat = here.bend == 0.0;
        let turns = |piece: &usize| {
            let there = self.shape.near(*piece, local.at);
            there.is_some_and(|there| !is_flat || dot(here.normal, there.normal) < KINK.cosine)
        };
        let mut across = over.into_iter().filter(turns).peekable();
        across.peek()?;
        let normals = own.normals(self.secondary[place], y);
        let outward: Vec<Point> = normals.into_iter().map(|normal| local.back(normal)).collect();
        if is_flat && is_opposed(here.normal, &outward) {
            return None;
        }
        let presses = |piece: &usize| {
            self.shape.near(*piece, local.at).is_some_and(|there| is_opposed(there.normal, &outward))
        };
        across.find(presses)
    }

    /// The piece of the obstacle on which the gap of a pair is measured.
    fn measured(&self, pair: &Pair, local: &Local, y: &[f64]) -> usize {
        let at = local.at;
        if self.shape.pieces() == 1 {
            return 0;
        }
        if pair.joint.is_some() {
            return pair.facet;
        }
        if pair.active {
            return self.shape.followed(pair.facet, at);
        }
        let nearest = self.shape.facing(at, pair.facet);
        let is_inside = |piece: usize| self.shape.near(piece, at).is_some_and(|near| near.gap < 0.0);
        let faced = if is_inside(nearest) && is_inside(pair.facet) { pair.facet } else { nearest };
        self.pressed(pair.node, faced, local, y).unwrap_or(faced)
    }

    /// Whether a node still needs a pair, one of several in a concave corner.
    fn is_held(&self, pair: &Pair, at: Point) -> bool {
        let length = self.lengths.get(pair.node).copied().unwrap_or(0.0);
        let is_near = |near: Near| near.gap <= NEAR_END * length;
        pair.active || self.shape.near(pair.facet, at).is_some_and(is_near)
    }

    /// A pair as its node has moved, and whether anything but an inactive pair has changed; none if
    /// it leaves one of several pieces.
    fn slid(
        &self,
        mut pair: Pair,
        before: Point,
        local: &Local,
        now: &[f64],
        left: &mut BTreeMap<usize, usize>,
        events: &mut Vec<PairEvent>,
    ) -> (Option<Pair>, bool) {
        let node = self.secondary[pair.node];
        let at = local.at;
        let is_one = pair.joint.is_none();
        if !pair.active {
            if !is_one {
                return (Some(pair), false);
            }
            let facing = self.facing(pair.facet, before, at);
            let facing = self.pressed(pair.node, facing, local, now).unwrap_or(facing);
            let is_inside = self.shape.near(facing, at).is_some_and(|near| near.gap < 0.0);
            let changed = facing != pair.facet && is_inside;
            pair.facet = facing;
            return (Some(pair), changed);
        }
        pair.facet = self.shape.followed(pair.facet, at);
        match self.shape.at_corner(pair.facet, at) {
            AtCorner::Goes(next) if left.get(&pair.node) != Some(&next) => {
                events.push(PairEvent::HandOver { node, from: pair.facet, to: next });
                left.insert(pair.node, pair.facet);
                pair.facet = next;
                (Some(pair), true)
            }
            AtCorner::Leaves => {
                let nearest = self.shape.facing(at, pair.facet);
                if let Some(pressed) = self.pressed(pair.node, nearest, local, now).filter(|_| is_one) {
                    let changed = pressed != pair.facet;
                    pair.facet = pressed;
                    return (Some(pair), changed);
                }
                events.push(PairEvent::SlidOff { node, facet: pair.facet });
                (is_one.then(|| Pair::open(pair.node, nearest, 0.0)), true)
            }
            AtCorner::Goes(_) | AtCorner::Stays => (Some(pair), false),
        }
    }

    /// New pairs of a node with pieces at concave corners of those of its pairs, behind which it
    /// lies, too, and which turn by more than 30° from each.
    fn walls(&self, held: &[Pair], at: Point) -> Vec<Pair> {
        let mut walls: Vec<Pair> = Vec::new();
        let normal = |piece: usize| self.shape.near(piece, at).map_or([0.0; 3], |near| near.normal);
        let is_inside = |piece: usize| self.shape.near(piece, at).is_some_and(|near| near.gap < 0.0);
        for pair in held.iter().filter(|pair| pair.active || is_inside(pair.facet)) {
            for wall in self.shape.walls(pair.facet, at) {
                let turns = |other: &Pair| dot(normal(other.facet), normal(wall)) < KINK.cosine;
                if held.iter().chain(&walls).all(turns) {
                    walls.push(Pair::open(pair.node, wall, 0.0));
                }
            }
        }
        walls
    }

    /// The gap of a node, given by its global number, to a piece of the obstacle.
    fn gap(&self, piece: usize, node: usize, y: &[f64]) -> Option<ObstacleGap> {
        let local = self.local(node, y);
        let near = self.shape.near(piece, local.at)?;
        Some(ObstacleGap::new(near, local, self.carriers()))
    }

    /// The gap of any point of space to the piece of the obstacle that it faces.
    pub(super) fn gap_of_point(&self, place: Point, y: &[f64]) -> Option<ObstacleGap> {
        let carrier = self.carrier.as_ref();
        let local = carrier.map_or(Local::fixed(place), |carrier| carrier.local(place, y, self.dimension));
        let near = self.shape.near(self.shape.facing(local.at, 0), local.at)?;
        Some(ObstacleGap::new(near, local, self.carriers()))
    }

    /// Global numbers of the nodes that carry the obstacle.
    pub fn carriers(&self) -> &[usize] {
        self.carrier.as_ref().map_or(&[], |carrier| &carrier.nodes)
    }

    /// The tangents of a pair: two in space, one in the plane.
    fn tangents(&self, pair: &Pair, gap: &ObstacleGap) -> [Point; 2] {
        match self.dimension {
            2 => [gap.tangent(), [0.0; 3]],
            _ => tangents(Vector(gap.direction()), pair.tangential.tangents).map(|tangent| tangent.0),
        }
    }

    /// Adds a row with a vector for a secondary node and for each node of the carrier.
    fn push(&self, gap: f64, node: usize, vectors: impl Iterator<Item = Point>, rows: &mut Rows) {
        let carrier = self.carriers().iter().copied();
        rows.push(gap, std::iter::once(node).chain(carrier).zip(vectors));
    }
}

impl Kinematics for NodeToObstacle {
    fn secondary(&self) -> &[usize] {
        &self.secondary
    }

    fn facet_nodes(&self, _: &Pair) -> &[usize] {
        &[]
    }

    fn rotation_of_primary(&self, _: &Pair, ends: [&[f64]; 2]) -> Option<Mat<3>> {
        let carrier = self.carrier.as_ref().filter(|carrier| carrier.turns())?;
        let [before, now] = ends.map(|y| carrier.gradient(y, self.dimension));
        Some(now * before.inverse())
    }

    /// An obstacle is measured as a whole: no node enters it unseen.
    fn keeps_depth(&self, _: &Pair) -> bool {
        false
    }

    fn facets(&self, _: usize) -> usize {
        self.shape.pieces()
    }

    /// Signed distance to the piece that is nearest, or on which the node presses instead.
    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        let local = self.local(self.secondary[node], y);
        let nearest = self.shape.nearest(local.at, None);
        let pressed = if self.shape.pieces() == 1 { None } else { self.pressed(node, nearest, &local, y) };
        Some(self.shape.near(pressed.unwrap_or(nearest), local.at)?.gap + self.kept(node))
    }

    fn distance_to_obstacle(&self, node: usize, y: &[f64]) -> Option<f64> {
        let at = self.local(node, y).at;
        self.shape.near(self.shape.nearest(at, None), at).map(|near| near.gap)
    }

    fn tips(&self, y: &[f64]) -> Vec<Tip> {
        let placed = |tip: Tip| {
            let moved = self.carrier.as_ref().map(|carrier| carrier.placed(tip.center, y, self.dimension));
            Tip { center: moved.unwrap_or(tip.center), ..tip }
        };
        self.tips.iter().copied().map(placed).collect()
    }

    fn allowed(&self, node: usize) -> f64 {
        self.allowed.get(node).copied().unwrap_or(0.0)
    }

    fn keep(&mut self, depths: &[f64]) {
        self.kept = depths.to_vec();
    }

    fn kept(&self, node: usize) -> f64 {
        self.kept.get(node).copied().unwrap_or(0.0)
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        watch_every_node(self.secondary.len(), &mut pairing.pairs);
        if self.shape.pieces() == 1 {
            return false;
        }
        let Pairing { pairs, left, .. } = pairing;
        let known = std::mem::take(pairs);
        let mut changed = false;
        for of_node in known.chunk_by(|a, b| a.node == b.node) {
            let node = self.secondary[of_node[0].node];
            let [from, local] = [before, now].map(|y| self.local(node, y));
            let first = pairs.len();
            for &pair in of_node.iter().filter(|pair| of_node.len() == 1 || self.is_held(pair, local.at)) {
                let (pair, moved) = self.slid(pair, from.at, &local, now, left, events);
                pairs.extend(pair);
                changed |= moved;
            }
            if pairs.len() == first {
                pairs.push(Pair::open(of_node[0].node, self.shape.facing(local.at, of_node[0].facet), 0.0));
            }
            let walls = self.walls(&pairs[first..], local.at);
            changed |= !walls.is_empty();
            pairs.extend(walls);
            let corner = (pairs.len() > first + 1).then_some(0);
            pairs[first..].iter_mut().for_each(|pair| pair.joint = corner);
        }
        changed
    }

    fn met(&self, nodes: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>> {
        let turns = self.carrier.as_ref().is_some_and(Carrier::turns);
        let met = |&node: &usize| {
            let [from, to] = [before, now].map(|y| self.local(self.secondary[node], y).at);
            // The path relative to an obstacle that turns is not straight.
            if turns || self.slack(node) > 0.0 { None } else { self.shape.met(from, to) }
        };
        nodes.iter().map(met).collect()
    }

    /// Examines straight paths relative to the obstacle, also if it turns.
    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        let through = |(place, length): (usize, &f64)| {
            let node = self.secondary[place];
            let limit = |share: f64| self.slack(place) + share * length;
            let [from, to] = [before, now].map(|y| self.local(node, y).at);
            let Through { depth, normals } = self.shape.deepest_between(from, to, limit(SHALLOW))?;
            let limit = limit(share(normals, bounce));
            (depth > limit).then_some(Passed { what: "node", node, depth, limit })
        };
        let beyond = |passed: &Passed| passed.depth - passed.limit;
        let passed = self.lengths.iter().enumerate().filter_map(through);
        passed.max_by(|a, b| beyond(a).total_cmp(&beyond(b)))
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        pair.facet = self.measured(pair, &self.local(node, y), y);
        let gap = self.gap(pair.facet, node, y).ok_or(ContactError::Center { node })?;
        self.push(gap.distance + self.slack(pair.node), node, gap.gradient(), rows);
        Ok(())
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        match self.gap(pair.facet, self.secondary[pair.node], y) {
            Some(gap) => gap.curvature_into(self.dimension, curvature),
            None => curvature.fill(0.0),
        }
    }

    fn slip(&self, pair: &Pair, y: &[f64], _: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        let gap = self.gap(pair.facet, node, y).ok_or(ContactError::Center { node })?;
        for along in self.tangents(pair, &gap).into_iter().take(self.dimension - 1) {
            self.push(0.0, node, gap.row(along), rows);
        }
        Ok(())
    }

    fn slip_derivative_into(&self, pair: &Pair, y: &[f64], _: &[f64], tangent: usize, matrix: &mut [f64]) {
        match self.gap(pair.facet, self.secondary[pair.node], y) {
            Some(gap) => {
                let along = self.tangents(pair, &gap)[tangent];
                gap.slip_derivative_into(self.dimension, along, matrix);
            }
            None => matrix.fill(0.0),
        }
    }
}
