//! Pairs that slide off their facet, in the plane and in space: between searches to the next facet
//! on which the closest point lies, during the iteration well past the end.

use crate::pair::{Pair, PairEvent, Pairing, in_order};

/// Where a pair past the end of its facet belongs.
pub(super) enum Next {
    Stay,
    /// On the neighbour, at ξ.
    HandOver(usize, [f64; 2]),
    /// On the neighbour too, at ξ.
    Concave(usize, [f64; 2]),
    Leave,
}

/// Nodes with facets of their pairs: no node has two pairs with one facet.
pub(super) struct Held {
    pairs: Vec<(usize, usize)>,
    follows: bool,
}

impl Held {
    /// Of all nodes, kept up to date.
    pub(super) fn all(pairs: &[Pair]) -> Self {
        Self { pairs: pairs.iter().map(|pair| (pair.node, pair.facet)).collect(), follows: true }
    }

    /// Of nodes with several pairs, in concave corners, as these are at first.
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

/// The pairs of nodes with the facets of a primary side.
pub(super) struct Sliding<'a, N> {
    pub nodes: &'a [usize],
    /// Number of facets.
    pub facets: usize,
    /// Where a pair belongs, which may have come from a facet.
    pub next: N,
}

impl<N: Fn(&Pair, Option<usize>) -> Next> Sliding<'_, N> {
    /// Hands over, adds or drops pairs in a search. `is_near`: whether a pair is within the reach
    /// of its facet; `enters`: whether a node is inside a facet at ξ. Returns whether anything but
    /// an inactive pair changed.
    pub(super) fn search(
        &self,
        pairing: &mut Pairing,
        mut held: Held,
        is_near: impl Fn(&Pair) -> bool,
        enters: impl Fn(usize, usize, [f64; 2]) -> bool,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let Pairing { pairs, left, fresh, .. } = pairing;
        let starts = std::mem::replace(fresh, false);
        let (mut changed, mut concave) = (false, Vec::new());
        pairs.retain_mut(|pair| {
            let node = self.nodes[pair.node];
            // Moves on to neighbours until the closest point lies on the facet, at most as many
            // times as there are facets.
            for _ in 0..=self.facets {
                match (self.next)(pair, left.get(&pair.node).copied()) {
                    Next::Stay => return true,
                    Next::HandOver(facet, _) | Next::Concave(facet, _) if held.contains(pair.node, facet) => {
                        // In the joint the node has both pairs. Beyond the reach of this facet that
                        // of the other one is responsible: an extrapolated facet is not the
                        // surface.
                        if is_near(pair) || pair.active && !starts {
                            return true;
                        }
                        if pair.active {
                            events.push(PairEvent::HandOver { node, from: pair.facet, to: facet });
                            changed = true;
                        }
                        left.remove(&pair.node);
                        held.leave(pair);
                        return false;
                    }
                    Next::Concave(facet, xi) => {
                        changed |= pair.active;
                        held.take(pair.node, facet);
                        concave.push(Pair::opened(pair.node, facet, xi));
                        return true;
                    }
                    Next::HandOver(facet, xi) => {
                        if pair.active {
                            events.push(PairEvent::HandOver { node, from: pair.facet, to: facet });
                        }
                        // At a concave joint an inactive pair may be in front of one facet and
                        // behind the other.
                        changed |= pair.active || enters(pair.node, facet, xi);
                        left.insert(pair.node, pair.facet);
                        held.leave(pair);
                        held.take(pair.node, facet);
                        (pair.facet, [pair.xi, pair.eta]) = (facet, xi);
                    }
                    Next::Leave if pair.active && !starts => return true,
                    Next::Leave => {
                        if pair.active {
                            events.push(PairEvent::SlidOff { node, facet: pair.facet });
                            changed = true;
                        }
                        left.remove(&pair.node);
                        held.leave(pair);
                        return false;
                    }
                }
            }
            true
        });
        if !concave.is_empty() {
            pairs.append(&mut concave);
            in_order(pairs);
        }
        changed
    }

    /// Hands over active pairs before Newton's method has converged, but for those of a node with
    /// several; `is_near`: whether a pair is within the reach of its facet, which may depend on
    /// whether it was handed over before. Returns whether there was one.
    pub(super) fn update(
        &self,
        pairing: &mut Pairing,
        is_near: impl Fn(&Pair, bool) -> bool,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let Pairing { pairs, left, .. } = pairing;
        let several = Held::several(pairs);
        let mut changed = false;
        for pair in pairs.iter_mut().filter(|pair| pair.active && !several.contains(pair.node, pair.facet)) {
            if is_near(pair, left.contains_key(&pair.node)) {
                continue;
            }
            let (from, mut previous) = (pair.facet, None);
            for _ in 0..self.facets {
                let Next::HandOver(facet, xi) = (self.next)(pair, previous) else { break };
                previous = Some(pair.facet);
                (pair.facet, [pair.xi, pair.eta]) = (facet, xi);
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
