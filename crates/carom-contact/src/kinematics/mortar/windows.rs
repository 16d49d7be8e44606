//! The windows of a mortar contact: for every multiplier that may come into contact in a step, the
//! facets of the primary that its part of the secondary side faces.

use carom_solid::{Bounds, Hull};

use super::cut::meet;
use super::opposite::{Opposite, Primary};
use super::sides::Mortar;
use crate::kinematics::drift::Drift;
use crate::kinematics::facets::Facets;
use crate::kinematics::surface::Surface;
use crate::kinematics::watch_every_node;
use crate::pair::{Pair, PairEvent, Pairing, in_order};
use crate::places::Places;
use crate::rows::Rows;

/// First and last place of facets in the order of the primary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    first: usize,
    last: usize,
}

impl Window {
    /// Whether the window contains a place.
    pub(super) fn contains(self, place: usize) -> bool {
        (self.first..=self.last).contains(&place)
    }

    fn union(self, other: Self) -> Self {
        Self { first: self.first.min(other.first), last: self.last.max(other.last) }
    }
}

impl Primary {
    /// The facets of the window of a pair.
    pub(super) fn window(&self, pair: &Pair) -> &[usize] {
        let Window { first, last } = self.places_of(pair);
        &self.order[first..=last]
    }

    /// First and last place of the window of a pair.
    pub(super) fn places_of(&self, pair: &Pair) -> Window {
        let middle = self.place[pair.facet];
        Window {
            first: middle.saturating_sub(pair.reach),
            last: (middle + pair.reach).min(self.order.len() - 1),
        }
    }

    /// A window around others, as wide on both sides of its middle.
    fn set_window(&self, pair: &mut Pair, Window { first, last }: Window) {
        let middle = usize::midpoint(first, last);
        pair.facet = self.order[middle];
        pair.reach = (middle - first).max(last - middle);
    }

    /// Makes the window of a pair contain another one; from a fresh start it becomes that one.
    /// Returns whether it was different.
    fn widen(&self, pair: &mut Pair, window: Window, is_fresh: bool) -> bool {
        let known = self.places_of(pair);
        let both = known.union(window);
        if is_fresh {
            self.set_window(pair, window);
        } else if both != known {
            self.set_window(pair, both);
        }
        both != known
    }
}

impl Mortar {
    /// Finds the windows of all multipliers that may come into contact between two positions.
    /// Returns whether anything but an inactive pair changed.
    pub(super) fn find_windows(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let Opposite::Side(primary) = &self.opposite else {
            // Every pair has the whole obstacle.
            watch_every_node(self.multipliers.len(), &mut pairing.pairs);
            return false;
        };
        let [before, now] = [before, now].map(|y| Places::new(y, 2));
        let faced = self.faced(primary, [before, now], pairing.margin);
        let mut known = std::mem::take(&mut pairing.pairs).into_iter().peekable();
        let mut changed = false;
        for (number, of) in self.multipliers.iter().enumerate() {
            let pair = known.next_if(|pair| pair.node == number);
            let window = of.parts.iter().filter_map(|part| faced[part.facet]).reduce(Window::union);
            let Some(window) = window else {
                if let Some(pair) = pair.filter(|pair| pair.active) {
                    events.push(PairEvent::SlidOff { node: of.node, facet: pair.facet });
                    changed = true;
                }
                continue;
            };
            let is_new = pair.is_none();
            let mut pair = pair.unwrap_or_else(|| Pair::open(number, primary.order[window.first], 0.0));
            let is_different = primary.widen(&mut pair, window, is_new || pairing.fresh) || is_new;
            changed |= is_different && (pair.active || self.penetrates(&pair, now));
            pairing.pairs.push(pair);
        }
        pairing.fresh = false;
        in_order(&mut pairing.pairs);
        changed
    }

    fn penetrates(&self, pair: &Pair, now: Places) -> bool {
        use crate::kinematics::Kinematics;
        let mut rows = Rows::new(2);
        self.measure(&mut pair.clone(), now.flat(), &mut rows).is_ok() && rows.pop() < 0.0
    }

    /// For every facet of the secondary side that comes near the primary on its way, the facets
    /// that it faces at either end.
    fn faced(&self, primary: &Primary, ends: [Places; 2], margin: f64) -> Vec<Option<Window>> {
        let Primary { surface, order, folds, .. } = primary;
        let hulls = [&self.secondary, surface].map(|side| Hull::line(side.shape().nodes(), 1.0));
        let drift = Drift::of(surface.nodes().iter().copied(), 2, ends.map(|y| y.flat()));
        let swept = |side: &Surface, hull: &Hull, facet: usize| {
            let nodes = side.facet(facet).nodes;
            let [old, new] = ends.map(|y| hull.bounds(|a| y.coordinates(nodes[a])));
            let bounds = drift.path(old, new);
            bounds.grown(margin * bounds.size())
        };
        let mut faced = vec![None; self.secondary.facets()];
        let boxes: Vec<Bounds> = order.iter().map(|&facet| swept(surface, &hulls[1], facet)).collect();
        let all = boxes.iter().fold(Bounds::EMPTY, Bounds::union);
        let own = (0..self.secondary.facets()).filter(|&facet| self.used[facet]);
        let own = own.map(|facet| (facet, swept(&self.secondary, &hulls[0], facet)));
        let own: Vec<(usize, Bounds)> = own.filter(|(_, bounds)| bounds.meets(&all)).collect();
        if own.is_empty() {
            return faced;
        }
        self.with_regions(ends, |regions| {
            for (facet, bounds) in own {
                let own = self.secondary.facet(facet);
                let normals = ends.map(|y| own.at(y, 0.0).normal);
                let mut window: Option<Window> = None;
                for place in 0..order.len() {
                    let is_faced = |k: usize| {
                        let (other, region) = &regions[k].of_facets[place];
                        folds.as_ref().is_none_or(|folds| meet(folds, &regions[k].turns, [facet, *other]))
                            && region.may_have_part_of(own, normals[k], ends[k])
                    };
                    if is_faced(0) || is_faced(1) {
                        window.get_or_insert(Window { first: place, last: place }).last = place;
                    }
                }
                let Some(Window { first, last }) = window else { continue };
                if boxes[first..=last].iter().any(|other| other.meets(&bounds)) {
                    faced[facet] = Some(Window { first, last });
                }
            }
        });
        faced
    }
}
