//! Pairs that slide off their facet, in the plane and in space: between searches to the next facet
//! on which the closest point lies, during the iteration well past the end.

use std::collections::BTreeMap;

use super::facets::OnFacet;
use crate::constants::{AT_JOINT, ROUND_OFF};
use crate::friction::Tangential;
use crate::pair::{Pair, PairEvent, Pairing, in_order};

/// The facet to which a pair belongs whose closest point is past the end of its facet.
pub(super) enum Next {
    Stay,
    /// Handed over to a facet, at the coordinates ξ on it.
    HandOver(usize, [f64; 2]),
    /// A second pair of the node, in a concave corner: with a facet, at the coordinates ξ on it.
    Concave(usize, [f64; 2]),
    Leave,
}

/// The nodes and facets of known pairs, so that no node gets two pairs with one facet.
pub(super) struct Held {
    pairs: Vec<(usize, usize)>,
    follows: bool,
}

impl Held {
    /// The pairs of all nodes, kept up to date.
    pub(super) fn all(pairs: &[Pair]) -> Self {
        Self { pairs: pairs.iter().map(|pair| (pair.node, pair.facet)).collect(), follows: true }
    }

    /// The pairs of nodes that have several, in concave corners, as they are at first.
    pub(super) fn several(pairs: &[Pair]) -> Self {
        let twice = pairs.windows(2).filter(|two| two[0].node == two[1].node);
        let pairs = twice.flat_map(|two| [two[0], two[1]].map(|pair| (pair.node, pair.facet)));
        Self { pairs: pairs.collect(), follows: false }
    }

    fn contains(&self, node: usize, facet: usize) -> bool {
        self.pairs.contains(&(node, facet))
    }

    fn take(&mut self, node: usize, facet: usize) {
        if self.follows {
            self.pairs.push((node, facet));
        }
    }

    fn leave(&mut self, pair: &Pair) {
        if self.follows {
            self.pairs.retain(|&known| known != (pair.node, pair.facet));
        }
    }
}

/// The changes that a search has made so far.
struct Moves<'a> {
    held: Held,
    /// Facet from which each node was handed over.
    left: &'a mut BTreeMap<usize, usize>,
    events: &'a mut Vec<PairEvent>,
    /// Second pairs of nodes in concave corners.
    concave: Vec<Pair>,
    /// Closed pairs that give way to the pair of their node with another facet, at a point of it.
    yielding: Vec<(Pair, OnFacet<[f64; 2]>)>,
    /// Whether anything but an inactive pair has changed.
    changed: bool,
}

impl Moves<'_> {
    /// Moves a pair to the point ξ of another facet.
    fn hand_over(&mut self, pair: &mut Pair, facet: usize, xi: [f64; 2]) {
        self.left.insert(pair.node, pair.facet);
        self.held.leave(pair);
        self.held.take(pair.node, facet);
        pair.facet = facet;
        pair.joint = None;
        pair.begins = true;
        [pair.xi, pair.eta] = xi;
    }

    /// Forgets a pair that is about to be removed, with an event if it is active.
    fn drop_pair(&mut self, pair: &Pair, event: PairEvent) {
        if pair.active {
            self.events.push(event);
            self.changed = true;
        }
        self.left.remove(&pair.node);
        self.held.leave(pair);
    }
}

/// How the pairs of a side and its facets are measured.
pub(super) struct Measured<'a> {
    /// Whether a pair is well past the end of its facet.
    pub is_past: &'a dyn Fn(&Pair) -> bool,
    /// Whether a pair is within the reach of its facet.
    pub is_near: &'a dyn Fn(&Pair) -> bool,
    /// How deep a node is inside a facet at ξ.
    pub depth: &'a dyn Fn(usize, usize, [f64; 2]) -> f64,
    /// Size of a facet.
    pub size: &'a dyn Fn(usize) -> f64,
}

/// A rule for pairs that slide over the facets of a primary side.
pub(super) struct Sliding<'a, N> {
    pub nodes: &'a [usize],
    /// Number of facets of the primary side.
    pub facets: usize,
    /// Facet to which a pair belongs, given the facet from which it was handed over last, if any.
    pub next: N,
}

impl<N: Fn(&Pair, Option<usize>) -> Next> Sliding<'_, N> {
    /// Hands over, adds or drops pairs between solves. Returns whether anything but an inactive
    /// pair changed.
    pub(super) fn search(
        &self,
        pairing: &mut Pairing,
        held: Held,
        measured: &Measured,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let Measured { is_past, is_near, depth, size } = measured;
        // Whether the extension of its facet holds a pair off another facet over which its node
        // lies: at a ridge, and, unless the node is still inside the other one, well past the end.
        let is_held_off = |pair: &Pair, to: usize, xi: [f64; 2]| {
            let size = size(to);
            let below = depth(pair.node, to, xi);
            let below_own = depth(pair.node, pair.facet, [pair.xi, pair.eta]);
            below_own > below + ROUND_OFF * size || is_past(pair) && below <= AT_JOINT * size
        };
        let Pairing { pairs, left, fresh, .. } = pairing;
        let starts = std::mem::replace(fresh, false);
        let mut moves =
            Moves { held, left, events, concave: Vec::new(), yielding: Vec::new(), changed: false };
        pairs.retain_mut(|pair| {
            let node = self.nodes[pair.node];
            // Moves on to neighbours until the closest point lies on the facet, at most as many
            // times as there are facets.
            for _ in 0..=self.facets {
                match (self.next)(pair, moves.left.get(&pair.node).copied()) {
                    Next::Stay => return true,
                    Next::HandOver(to, xi)
                        if pair.active
                            && !starts
                            && moves.held.contains(pair.node, to)
                            && is_held_off(pair, to, xi) =>
                    {
                        moves.yielding.push((*pair, OnFacet { facet: to, xi }));
                        moves.drop_pair(pair, PairEvent::HandOver { node, from: pair.facet, to });
                        return false;
                    }
                    Next::HandOver(to, _) | Next::Concave(to, _) if moves.held.contains(pair.node, to) => {
                        // In the joint the node has both pairs. Beyond the reach of this facet that
                        // of the other one is responsible: an extrapolated facet is not the
                        // surface.
                        if is_near(pair) {
                            return true;
                        }
                        moves.drop_pair(pair, PairEvent::HandOver { node, from: pair.facet, to });
                        return false;
                    }
                    Next::Concave(facet, xi) => {
                        // A node that its pair has set free may have sunk into the other facet.
                        moves.changed |= pair.active || depth(pair.node, facet, xi) > 0.0;
                        moves.held.take(pair.node, facet);
                        let second = Pair::opened(pair.node, OnFacet { facet, xi });
                        // The slip of the node goes on with it where the first one leaves.
                        let Tangential { tangents, slip, .. } = pair.tangential;
                        let tangential = Tangential { tangents, slip, ..second.tangential };
                        moves.concave.push(Pair { tangential, ..second });
                        return true;
                    }
                    Next::HandOver(to, xi) => {
                        if pair.active {
                            moves.events.push(PairEvent::HandOver { node, from: pair.facet, to });
                        }
                        // At a concave joint an inactive pair may be in front of one facet and
                        // behind the other.
                        moves.changed |= pair.active || depth(pair.node, to, xi) > 0.0;
                        moves.hand_over(pair, to, xi);
                    }
                    Next::Leave if pair.active && !starts => return true,
                    Next::Leave => {
                        moves.drop_pair(pair, PairEvent::SlidOff { node, facet: pair.facet });
                        return false;
                    }
                }
            }
            true
        });
        let Moves { concave: mut added, yielding, changed, .. } = moves;
        for (old, OnFacet { facet, xi: [xi, eta] }) in yielding {
            let other = pairs.iter_mut().find(|pair| (pair.node, pair.facet) == (old.node, facet));
            let moved = Pair { facet, xi, eta, joint: None, begins: true, ..old };
            match other {
                Some(pair) if pair.active => {}
                Some(pair) => *pair = Pair { joint: pair.joint, ..moved },
                None => added.push(moved),
            }
        }
        if !added.is_empty() {
            pairs.append(&mut added);
            in_order(pairs);
        }
        changed
    }

    /// Hands over active pairs before Newton's method has converged, except those of a node with
    /// several pairs and those over joints; `is_near`: whether a pair is within the reach of its
    /// facet, which may depend on whether it was handed over before. Returns whether a pair was
    /// handed over.
    pub(super) fn update(
        &self,
        pairing: &mut Pairing,
        is_near: impl Fn(&Pair, bool) -> bool,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let Pairing { pairs, left, .. } = pairing;
        let several = Held::several(pairs);
        let mut changed = false;
        // A row over all facets of a joint holds until the solve has converged: iterates slide
        // further than the node, and a facet alone would push a symmetric contact to its side.
        let is_alone = |pair: &Pair| pair.joint.is_none() && !several.contains(pair.node, pair.facet);
        for pair in pairs.iter_mut().filter(|pair| pair.active && is_alone(pair)) {
            if is_near(pair, left.contains_key(&pair.node)) {
                continue;
            }
            let from = pair.facet;
            let mut previous = None;
            for _ in 0..self.facets {
                let Next::HandOver(facet, xi) = (self.next)(pair, previous) else { break };
                previous = Some(pair.facet);
                pair.facet = facet;
                pair.joint = None;
                pair.begins = true;
                [pair.xi, pair.eta] = xi;
            }
            if pair.facet != from {
                left.extend(previous.map(|facet| (pair.node, facet)));
                events.push(PairEvent::HandOver { node: self.nodes[pair.node], from, to: pair.facet });
                changed = true;
            }
        }
        changed
    }
}
