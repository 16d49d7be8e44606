//! Which parts of a body's boundary can meet each other. With the body on the left, and T the turn
//! of the boundary's tangent from one of two points to the other, left turns positive:
//!
//! ```text
//! the points meet across a pocket of free space      T = −180° along the arc around the pocket
//! they lie side by side on a smooth part             T = 0
//! they are the two faces of a thin part              T = +180°
//! ```
//!
//! The first line follows from the theorem of turning tangents (Hopf, Compos. Math. 2 (1935)): the
//! arc and the point where it closes turn by −360° together, the point alone by −180°. A node is
//! compared with a facet only if T along one of the two arcs is within 80° of −180°; at a corner,
//! the normal may be any of its normals. A smooth part is never compared with itself, however short
//! the arc; the flanks of a notch are, up to its tip, however sharp. Facets that contain the node,
//! or have a node in common with one that does on the same smooth part, are excluded by this or as
//! its own.
//!
//! A slit that is closed turns by −180° at its tip, and a sharp corner by nearly +180°. Which of
//! both a joint is follows from the angle of the body at its node.
//!
//! The boundaries of a hole and of its body are separated by material and cannot meet; pieces
//! without a common cell always can.
//!
//! The secondary one of two places that meet is that which comes later along the boundary. Each
//! loop begins where it is least likely to meet itself: the boundary turns back least to the right
//! after the beginning, and least to the right before it. At a beginning within a zone of contact
//! the roles would change there. Any place of a hole may meet another one.

use std::f64::consts::PI;
use std::ops::Range;

use super::facets::Facets;
use super::surface::Surface;
use crate::constants::{FACING, FOLDED_BACK, MEETS};
use crate::places::Places;

/// The order of the facets of a body along the loops of its boundary, and its corners.
#[derive(Clone, Debug)]
pub struct Folds {
    /// All facets in the order of traversal, loop by loop.
    order: Vec<usize>,
    /// Place of each facet in the order of traversal.
    place: Vec<usize>,
    /// Turn of the tangent at the joint after each facet in the reference configuration.
    joints: Vec<f64>,
    /// First place of each loop in the order of traversal, and the end of the last loop.
    starts: Vec<usize>,
    /// Number of the loop to which each facet belongs.
    of: Vec<usize>,
    /// Connected piece of the body that each loop bounds.
    pieces: Vec<usize>,
    /// Smallest global number of a node of the boundary.
    first: usize,
    /// For each node from the smallest on, the places of the facets before and after it.
    around: Vec<[usize; 2]>,
}

/// Order of a node and a facet of one boundary along that boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The node comes later than the facet.
    Later,
    /// The node comes earlier than the facet.
    Earlier,
}

/// Turns of the tangent along the boundary of a body at given positions.
#[derive(Clone, Debug, Default)]
pub struct Turns {
    /// Turn of the tangent from the start of the loop to the start of each facet, in the order of
    /// traversal.
    start: Vec<f64>,
    /// Turn of the tangent from the start of each facet to its end, in the order of traversal.
    within: Vec<f64>,
    /// Turn of the tangent along each whole loop.
    total: Vec<f64>,
}

impl Folds {
    /// Orders all facets of a surface at reference positions, independently of the order in which
    /// they are given; `piece`: number of the connected piece of the body to which each node
    /// belongs, from `first_node` on.
    pub fn new(surface: &Surface, piece: &[usize], first_node: usize, reference: &[f64]) -> Self {
        let count = surface.all();
        let mut order = Vec::with_capacity(count);
        let mut starts = vec![0];
        let mut pieces = Vec::new();
        let mut place = vec![usize::MAX; count];
        let mut of = vec![0; count];
        let mut begins: Vec<usize> = (0..count).collect();
        begins.sort_unstable_by_key(|&facet| surface.facet(facet).nodes[0]);
        for begin in begins {
            let mut next = Some(begin);
            while let Some(facet) = next.filter(|&facet| place[facet] == usize::MAX) {
                place[facet] = order.len();
                of[facet] = pieces.len();
                order.push(facet);
                next = surface.neighbour(facet, true);
            }
            if order.len() > starts[pieces.len()] {
                pieces.push(piece[surface.facet(begin).nodes[0] - first_node]);
                starts.push(order.len());
            }
        }
        let at_start = Places::new(reference, 2);
        let turn = |facet| {
            let next = surface.neighbour(facet, true);
            next.map_or(0.0, |next| joint(surface, [facet, next], at_start, 0.0))
        };
        let joints: Vec<f64> = (0..count).map(turn).collect();
        let mut turns = Turns::default();
        turns.update_loops(&order, &starts, &joints, surface, at_start);
        for (run, ends) in starts.windows(2).enumerate() {
            order[ends[0]..ends[1]].rotate_left(turns.best_start(run, ends[0]..ends[1]));
        }
        order.iter().enumerate().for_each(|(at, &facet)| place[facet] = at);
        let nodes = |facet: usize| surface.facet(facet).nodes;
        let all = || (0..count).flat_map(nodes).copied();
        let first = all().min().unwrap_or(0);
        let end = all().max().map_or(0, |last| last + 1);
        let mut around = vec![[usize::MAX; 2]; end - first];
        for (at, &facet) in order.iter().enumerate() {
            for (k, &node) in nodes(facet).iter().enumerate() {
                let around = &mut around[node - first];
                match k {
                    0 => around[1] = at,
                    1 => around[0] = at,
                    _ => *around = [at; 2],
                }
            }
        }
        Self { order, place, joints, starts, of, pieces, first, around }
    }

    /// Places, in the order of traversal, of the facets before and after a node; both are equal for
    /// a node inside a facet.
    fn around(&self, node: usize) -> Option<[usize; 2]> {
        let around = *node.checked_sub(self.first).and_then(|k| self.around.get(k))?;
        (!around.contains(&usize::MAX)).then_some(around)
    }

    /// Whether a node and a facet may form a pair in which the node comes on the given side of the
    /// facet.
    pub fn admits(&self, side: Side, node: usize, facet: usize) -> bool {
        let Some(around) = self.around(node) else { return false };
        let at = self.place[facet];
        // At the joint that closes a loop, a node belongs to the end.
        let later = around[0] >= at;
        let own = self.of[self.order[around[0]]];
        let other = self.of[facet];
        !around.contains(&at)
            && later == (side == Side::Later)
            && (own == other || self.pieces[own] != self.pieces[other])
    }

    /// Whether points of two facets may be compared, of which the first comes later.
    pub(crate) fn admits_facet(&self, own: usize, other: usize) -> bool {
        let [run, opposite] = [own, other].map(|facet| self.of[facet]);
        self.place[own] > self.place[other] && (run == opposite || self.pieces[run] != self.pieces[opposite])
    }

    /// Whether the boundary folds such that two facets face each other.
    pub(crate) fn facets_face(&self, turns: &Turns, own: usize, other: usize) -> bool {
        let run = self.of[own];
        if self.of[other] != run {
            return true;
        }
        let middle = |facet: usize| {
            let at = self.place[facet];
            turns.start[at] + 0.5 * turns.within[at]
        };
        let total = turns.total[run];
        let ahead = middle(other) - middle(own);
        let on = ahead + if self.place[own] > self.place[other] { total } else { 0.0 };
        [on, total - on].iter().any(|turn| (turn + PI).abs() < FOLDED_BACK)
    }

    /// Whether the body consists of several connected pieces.
    pub(crate) fn has_pieces(&self) -> bool {
        self.pieces.iter().any(|piece| *piece != self.pieces[0])
    }

    /// Whether a facet bounds another connected piece of the body than that of a node.
    pub(crate) fn is_of_another_piece(&self, node: usize, facet: usize) -> bool {
        self.around(node).is_some_and(|[before, _]| {
            self.pieces[self.of[self.order[before]]] != self.pieces[self.of[facet]]
        })
    }

    /// Whether the boundary folds such that a node faces a facet; only then is an admissible pair
    /// compared.
    pub fn face(&self, turns: &Turns, node: usize, facet: usize) -> bool {
        let Some([before, after]) = self.around(node) else { return false };
        let run = self.of[facet];
        let at = self.place[facet];
        if self.of[self.order[before]] != run {
            return true;
        }
        let total = turns.total[run];
        let middle = turns.start[at] + 0.5 * turns.within[at];
        let (arriving, leaving) = if before == after {
            let own = turns.start[before] + 0.5 * turns.within[before];
            (own, own)
        } else {
            (turns.start[before] + turns.within[before], turns.start[after])
        };
        // From the node on to the facet, and from the facet on to the node.
        let on = middle - leaving + if at < after { total } else { 0.0 };
        let back = arriving - middle + if at > before { total } else { 0.0 };
        let kink = total - on - back;
        let meets = |turn: f64| (turn + 0.5 * kink + PI).abs() < FOLDED_BACK + 0.5 * kink.max(0.0);
        meets(on) || meets(back)
    }
}

/// The representative of an angle, up to multiples of a whole turn, that is nearest to another one.
fn nearest_to(other: f64, angle: f64) -> f64 {
    angle + 2.0 * PI * ((other - angle) / (2.0 * PI)).round()
}

/// Turn of the tangent at the joint of a facet and the next one: π less the angle of the body
/// there. A closed slit and a sharp corner differ in it by a whole turn, and in what a node sees of
/// its boundary. Facets of a fold that closes may pass each other by a little at its crease.
/// `before`: the turn in another configuration, from which a blunt joint has turned by less than
/// half a turn.
fn joint(surface: &Surface, [facet, next]: [usize; 2], y: Places, before: f64) -> f64 {
    let kink = surface.kink(facet, next, y);
    let turns_back = kink.cosine < FACING && surface.is_whole();
    let near = if turns_back { PI - surface.seen_from(surface.facet(next).nodes[0], y) } else { before };
    nearest_to(near, kink.sine.atan2(kink.cosine))
}

impl Turns {
    /// Recomputes the turns of the tangent at the positions `y`.
    pub fn update(&mut self, folds: &Folds, surface: &Surface, y: Places) {
        self.update_loops(&folds.order, &folds.starts, &folds.joints, surface, y);
    }

    fn update_loops(
        &mut self,
        order: &[usize],
        starts: &[usize],
        joints: &[f64],
        surface: &Surface,
        y: Places,
    ) {
        self.start.clear();
        self.within.clear();
        self.total.clear();
        for run in starts.windows(2) {
            let facets = &order[run[0]..run[1]];
            let mut turn = 0.0;
            for (k, &facet) in facets.iter().enumerate() {
                let side = surface.facet(facet);
                let [from, to] = [-1.0, 1.0].map(|xi| side.at(y, xi).tangent);
                let within = (from[0] * to[1] - from[1] * to[0]).atan2(from.dot(&to));
                self.start.push(turn);
                self.within.push(within);
                turn += within;
                turn += joint(surface, [facet, facets[(k + 1) % facets.len()]], y, joints[facet]);
            }
            self.total.push(turn);
        }
    }

    /// Index within a loop of the facet at which its order should begin.
    fn best_start(&self, run: usize, places: Range<usize>) -> usize {
        let start = &self.start[places.clone()];
        let within = &self.within[places];
        let total = self.total[run];
        let n = start.len();
        let end = |k: usize| start[k] + within[k];
        // Least and largest angles from each facet on, and those before the current one.
        let mut on = vec![[f64::INFINITY, f64::NEG_INFINITY]; n + 1];
        for k in (0..n).rev() {
            on[k] = [on[k + 1][0].min(start[k]).min(end(k)), on[k + 1][1].max(start[k]).max(end(k))];
        }
        let mut least = f64::INFINITY;
        let mut largest = f64::NEG_INFINITY;
        let mut best = (0, f64::NEG_INFINITY);
        for k in 0..n {
            let arriving = if k == 0 { end(n - 1) - total } else { end(k - 1) };
            let ahead = on[k][0].min(least + total) - start[k];
            let behind = arriving - largest.max(on[k][1] - total);
            // The first place is taken where several are equal.
            if ahead.min(behind) > best.1 + MEETS {
                best = (k, ahead.min(behind));
            }
            least = least.min(start[k]).min(end(k));
            largest = largest.max(start[k]).max(end(k));
        }
        best.0
    }
}
