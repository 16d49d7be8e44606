//! Secondary nodes against a rigid obstacle, fixed or carried by a node c and turned by an angle θ.
//!
//! With the signed distance G(p) of the shape (`obstacle/`), R = R(θ), and s = p − c₀ = Rᵀ(x − c):
//!
//! ```text
//! g = G(p)      ∂g/∂x = R n = −∂g/∂c      ∂g/∂θ = −n·Js,   J = [0 −1; 1 0],   n = ∇G(p)
//! ∂²g/∂x² = R H Rᵀ = ∂²g/∂c² = −∂²g/∂x∂c     ∂²g/∂x∂θ = R (Jn − H Js) = −∂²g/∂c∂θ     ∂²g/∂θ² = Js·H Js − n·s
//! ```
//!
//! The slip has the rows ∂S/∂x = τ = −∂S/∂c of every tangent, and in the plane, with t = Jn and τ =
//! R t,
//!
//! ```text
//! ∂S/∂θ = −κ n·s,   κ = tan φ/φ,   φ = ½Δθ        dτ = −R n (h τ·(dx − dc) + (1 − h n·s) dθ),   H = h (1 − n nᵀ)
//! d(n·s) = (h (t·s) τ + R n)·(dx − dc) + (1 − h n·s)(t·s) dθ
//! ```
//!
//! A point that turns with the obstacle moves along a chord, 2 sin φ of the arm, whose middle has
//! the arm cos φ: with κ the slip is zero for every Δθ < π, and the moment of friction, κ times its
//! force times its arm, does the work that friction takes.
//!
//! The angle is the first component of a node of its own, as the arc θℓ, a length like every other
//! unknown; the force on it is moment/ℓ. So motion of an obstacle is motion of nodes: supports
//! prescribe it, masses make it free, and reactions and works are theirs.

use carom_algebra::Vector;

use super::obstacle::{AtCorner, Near, Obstacle, Point, dot};
use super::passed::Passed;
use super::tangents::tangents;
use super::way::{SHARE, share};
use super::{Kinematics, watch_every_node};
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// The nodes that carry an obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct Carrier {
    /// Global number of the node that it moves with.
    pub node: usize,
    /// Position of this node for which the shape is given.
    pub origin: [f64; 3],
    /// The node whose first component is the arc of the rotation about `node`, that component at
    /// rest, and the radius ℓ of the arc; none: the obstacle does not turn.
    pub turn: Option<(usize, f64, f64)>,
}

/// A rigid obstacle as primary.
#[derive(Clone, Debug)]
pub struct NodeToObstacle {
    secondary: Vec<usize>,
    dimension: usize,
    shape: Obstacle,
    carrier: Option<Carrier>,
    /// Length of each node's facets; empty if they have none.
    lengths: Vec<f64>,
    /// Depth that each node keeps; empty if none does.
    kept: Vec<f64>,
}

/// A point in the coordinates of the shape, with sin θ and cos θ.
struct Local {
    at: Point,
    /// s = p − c₀; zero without a carrier.
    arm: Point,
    turn: [f64; 2],
}

impl NodeToObstacle {
    /// Keeps the secondary nodes out of a fixed obstacle.
    pub fn new(secondary: Vec<usize>, dimension: usize, shape: Obstacle) -> Self {
        Self { secondary, dimension, shape, carrier: None, lengths: Vec::new(), kept: Vec::new() }
    }

    /// The same for an obstacle that moves with nodes.
    #[must_use]
    pub fn carried_by(self, carrier: Carrier) -> Self {
        Self { carrier: Some(carrier), ..self }
    }

    /// The same with the length of each node's facets, by which a path through the obstacle is
    /// judged.
    #[must_use]
    pub fn with_lengths(self, lengths: Vec<f64>) -> Self {
        Self { lengths, ..self }
    }

    fn position(&self, node: usize, y: &[f64]) -> Point {
        let y = &y[node * self.dimension..(node + 1) * self.dimension];
        std::array::from_fn(|i| y.get(i).copied().unwrap_or(0.0))
    }

    fn local(&self, node: usize, y: &[f64]) -> Local {
        let x = self.position(node, y);
        let Some(Carrier { node, origin, turn }) = &self.carrier else {
            return Local { at: x, arm: [0.0; 3], turn: [0.0, 1.0] };
        };
        let c = self.position(*node, y);
        let (sin, cos) =
            turn.map_or((0.0, 1.0), |(n, rest, l)| ((y[n * self.dimension] - rest) / l).sin_cos());
        let arm = rotated([x[0] - c[0], x[1] - c[1], x[2] - c[2]], [-sin, cos]);
        Local { at: std::array::from_fn(|i| origin[i] + arm[i]), arm, turn: [sin, cos] }
    }

    /// The piece that an inactive node faces: the closest one outside, and inside that through
    /// which it entered; searched from the last one.
    fn facing(&self, last: usize, before: Point, now: Point) -> usize {
        let nearest = self.shape.nearest(now, Some(last));
        if self.shape.near(nearest, now).is_some_and(|near| near.gap >= 0.0) {
            return nearest;
        }
        self.shape.entered(before, now).map_or(nearest, |(_, piece)| piece)
    }

    /// The piece on which a pair is measured.
    fn measured(&self, pair: &Pair, at: Point) -> usize {
        if self.shape.pieces() == 1 {
            return 0;
        }
        if pair.active {
            return self.shape.followed(pair.facet, at);
        }
        let nearest = self.shape.nearest(at, Some(pair.facet));
        let is_inside = |piece: usize| self.shape.near(piece, at).is_some_and(|near| near.gap < 0.0);
        if is_inside(nearest) && is_inside(pair.facet) { pair.facet } else { nearest }
    }

    /// The tangents of a pair, of which the plane has one.
    fn tangents(&self, pair: &Pair, normal: Point) -> [Point; 2] {
        if self.dimension == 2 {
            return [turned(normal), [0.0; 3]];
        }
        tangents(Vector(normal), pair.tangential.tangents).map(|tangent| tangent.0)
    }

    /// κ = tan φ/φ and its derivative by φ, with half of the angle by which the obstacle turns.
    fn chord(&self, moved: &[f64]) -> [f64; 2] {
        let turn = self.carrier.as_ref().and_then(|carrier| carrier.turn);
        let half = turn.map_or(0.0, |(angle, _, length)| {
            0.5 * moved.get(angle * self.dimension).copied().unwrap_or(0.0) / length
        });
        if half.abs() < 1e-3 {
            let square = half * half;
            return [1.0 + square / 3.0 + square * square * 2.0 / 15.0, half * (2.0 + square * 1.6) / 3.0];
        }
        let tan = half.tan();
        [tan / half, (1.0 + tan * tan) / half - tan / (half * half)]
    }

    /// Adds the row of a node with its gradient, that of the node which carries the obstacle, and
    /// the moment about that.
    fn push(&self, gap: f64, node: usize, [own, back]: [Point; 2], moment: f64, rows: &mut Rows) {
        let Some(Carrier { node: carrier, turn, .. }) = &self.carrier else {
            return rows.push(gap, [(node, own)]);
        };
        match turn {
            None => rows.push(gap, [(node, own), (*carrier, back)]),
            Some((angle, _, length)) => {
                let along = [moment / length, 0.0, 0.0];
                rows.push(gap, [(node, own), (*carrier, back), (*angle, along)]);
            }
        }
    }

    /// Number of nodes of a row: the node, and those that carry the obstacle.
    fn stencil(&self) -> usize {
        self.carrier.as_ref().map_or(1, |carrier| if carrier.turn.is_some() { 3 } else { 2 })
    }

    /// Fills the blocks of a node and of the one that carries the obstacle with `entry(i, k)`, with
    /// the other sign between the two.
    fn fill(&self, matrix: &mut [f64], entry: impl Fn(usize, usize) -> f64) {
        let (d, size) = (self.dimension, self.stencil() * self.dimension);
        let blocks = self.stencil().min(2);
        for (p, q) in (0..blocks).flat_map(|p| (0..blocks).map(move |q| (p, q))) {
            for (i, k) in (0..d).flat_map(|i| (0..d).map(move |k| (i, k))) {
                matrix[(p * d + i) * size + q * d + k] = sign(p) * sign(q) * entry(i, k);
            }
        }
    }

    fn near(&self, piece: usize, at: Point, node: usize) -> Result<Near, ContactError> {
        self.shape.near(piece, at).ok_or(ContactError::Center { node })
    }
}

impl Kinematics for NodeToObstacle {
    fn secondary(&self) -> &[usize] {
        &self.secondary
    }

    fn facet_nodes(&self, _: &Pair) -> &[usize] {
        &[]
    }

    fn facets(&self, _: usize) -> usize {
        self.shape.pieces()
    }

    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        Some(self.distance_to_obstacle(self.secondary[node], y)? + self.kept(node))
    }

    fn distance_to_obstacle(&self, node: usize, y: &[f64]) -> Option<f64> {
        let at = self.local(node, y).at;
        self.shape.near(self.shape.nearest(at, None), at).map(|near| near.gap)
    }

    fn tips(&self, y: &[f64]) -> Vec<([f64; 3], f64)> {
        let placed = |(at, radius): (Point, f64)| {
            let Some(Carrier { node, origin, .. }) = &self.carrier else { return (at, radius) };
            let c = self.position(*node, y);
            let arm = rotated(std::array::from_fn(|i| at[i] - origin[i]), self.local(0, y).turn);
            (std::array::from_fn(|i| c[i] + arm[i]), radius)
        };
        self.shape.tips().into_iter().map(placed).collect()
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
        let mut changed = false;
        for pair in pairs {
            let node = self.secondary[pair.node];
            let at = self.local(node, now).at;
            if !pair.active {
                let facing = self.facing(pair.facet, self.local(node, before).at, at);
                let is_inside = self.shape.near(facing, at).is_some_and(|near| near.gap < 0.0);
                changed |= facing != pair.facet && is_inside;
                pair.facet = facing;
                continue;
            }
            pair.facet = self.shape.followed(pair.facet, at);
            match self.shape.at_corner(pair.facet, at) {
                AtCorner::Goes(next) if left.get(&pair.node) != Some(&next) => {
                    events.push(PairEvent::HandOver { node, from: pair.facet, to: next });
                    left.insert(pair.node, pair.facet);
                    (pair.facet, changed) = (next, true);
                }
                AtCorner::Leaves => {
                    events.push(PairEvent::SlidOff { node, facet: pair.facet });
                    *pair = Pair::open(pair.node, self.shape.nearest(at, Some(pair.facet)), 0.0);
                    changed = true;
                }
                AtCorner::Goes(_) | AtCorner::Stays => {}
            }
        }
        changed
    }

    fn met(&self, nodes: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>> {
        let turns = self.carrier.as_ref().is_some_and(|carrier| carrier.turn.is_some());
        let met = |&node: &usize| {
            let [from, to] = [before, now].map(|y| self.local(self.secondary[node], y).at);
            // The path relative to an obstacle that turns is not straight.
            if turns || self.kept(node) > 0.0 { None } else { self.shape.met(from, to) }
        };
        nodes.iter().map(met).collect()
    }

    /// Along straight paths relative to the obstacle, also if it turns.
    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        let through = |(place, length): (usize, &f64)| {
            let node = self.secondary[place];
            let limit = |share: f64| self.kept(place) + share * length;
            let [from, to] = [before, now].map(|y| self.local(node, y).at);
            let (depth, normals) = self.shape.deepest_between(from, to, limit(SHARE))?;
            let limit = limit(share(normals, bounce));
            (depth > limit).then_some(Passed { what: "node", node, depth, limit })
        };
        let beyond = |passed: &Passed| passed.depth - passed.limit;
        let passed = self.lengths.iter().enumerate().filter_map(through);
        passed.max_by(|a, b| beyond(a).total_cmp(&beyond(b)))
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        let Local { at, arm, turn } = self.local(node, y);
        pair.facet = self.measured(pair, at);
        let mut near = self.near(pair.facet, at, node)?;
        near.gap += self.kept(pair.node);
        let n = rotated(near.normal, turn);
        let moment = -dot(near.normal, turned(arm));
        self.push(near.gap, node, [n, n.map(|n| -n)], moment, rows);
        Ok(())
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        let (d, size) = (self.dimension, self.stencil() * self.dimension);
        let curvature = &mut curvature[..size * size];
        curvature.fill(0.0);
        let Local { at, arm, turn } = self.local(self.secondary[pair.node], y);
        let Some(Near { normal, bend, straight, .. }) = self.shape.near(pair.facet, at) else { return };
        let n = rotated(normal, turn);
        self.fill(curvature, |i, k| {
            let same = if i == k { 1.0 } else { 0.0 };
            bend * (same - (n[i] * n[k] + straight[i] * straight[k]))
        });
        let Some((_, _, length)) = self.carrier.as_ref().and_then(|carrier| carrier.turn) else { return };
        let (arm_turned, normal_turned) = (turned(arm), turned(normal));
        let along = dot(normal, arm_turned);
        let bent: Point = std::array::from_fn(|i| bend * (arm_turned[i] - along * normal[i]));
        let mixed = rotated(std::array::from_fn(|i| normal_turned[i] - bent[i]), turn);
        let angle = 2 * d;
        for (p, i) in (0..2).flat_map(|p| (0..d).map(move |i| (p, i))) {
            let entry = sign(p) * mixed[i] / length;
            curvature[(p * d + i) * size + angle] = entry;
            curvature[angle * size + p * d + i] = entry;
        }
        curvature[angle * size + angle] = (dot(arm_turned, bent) - dot(normal, arm)) / (length * length);
    }

    fn slip(&self, pair: &Pair, y: &[f64], moved: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        let Local { at, arm, turn } = self.local(node, y);
        let normal = self.near(pair.facet, at, node)?.normal;
        for along in self.tangents(pair, rotated(normal, turn)).into_iter().take(self.dimension - 1) {
            let moment = -self.chord(moved)[0] * dot(normal, arm);
            self.push(0.0, node, [along, along.map(|x| -x)], moment, rows);
        }
        Ok(())
    }

    fn slip_derivative_into(
        &self,
        pair: &Pair,
        y: &[f64],
        moved: &[f64],
        tangent: usize,
        matrix: &mut [f64],
    ) {
        let (d, size) = (self.dimension, self.stencil() * self.dimension);
        let matrix = &mut matrix[..size * size];
        matrix.fill(0.0);
        let Local { at, arm, turn } = self.local(self.secondary[pair.node], y);
        let Some(near) = self.shape.near(pair.facet, at) else { return };
        let Near { normal, bend, .. } = near;
        let n = rotated(normal, turn);
        let along = self.tangents(pair, n)[tangent];
        let bent = near.bent(along);
        self.fill(matrix, |i, k| -n[i] * bent[k]);
        let Some((_, _, length)) = self.carrier.as_ref().and_then(|carrier| carrier.turn) else { return };
        let [factor, slope] = self.chord(moved);
        let [across, beside] = [normal, turned(normal)].map(|direction| dot(direction, arm));
        let turns = 1.0 - bend * across;
        let angle = 2 * d;
        for (p, i) in (0..2).flat_map(|p| (0..d).map(move |i| (p, i))) {
            matrix[(p * d + i) * size + angle] = -sign(p) * n[i] * turns / length;
            matrix[angle * size + p * d + i] = -sign(p) * factor * (bend * beside * along[i] + n[i]) / length;
        }
        matrix[angle * size + angle] = -(factor * turns * beside + slope * across) / (length * length);
    }
}

/// R v of a vector of the plane, with sin θ and cos θ.
fn rotated(v: Point, [sin, cos]: [f64; 2]) -> Point {
    if sin == 0.0 && cos == 1.0 {
        return v;
    }
    [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], v[2]]
}

/// J v.
fn turned(v: Point) -> Point {
    [-v[1], v[0], 0.0]
}

/// The sign of a block: of a node, or of the one that carries the obstacle.
fn sign(block: usize) -> f64 {
    if block == 0 { 1.0 } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gap_is_the_signed_distance() {
        let plane = NodeToObstacle::new(vec![0], 2, Obstacle::plane(&[0.0, 1.0], &[0.0, 4.0]));
        let (mut pairing, mut rows) = (Pairing::default(), Rows::new(2));
        plane.search(&[], &[], &mut pairing, &mut Vec::new());
        plane.measure(&mut pairing.pairs[0], &[7.0, 0.25], &mut rows).unwrap();
        assert_eq!((rows.row(0).gap, rows.row(0).gradient), (-0.75, &[0.0, 1.0][..]));
    }
}
