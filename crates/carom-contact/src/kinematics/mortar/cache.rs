//! Quadrature points and gaps of the secondary facets at one configuration.

use carom_algebra::Vector;

use super::cut::Regions;
use super::joint::Joint;
use super::multipliers::MOST;
use super::patch::Patch;
use crate::places::Places;

/// A secondary facet at one configuration.
#[derive(Debug, Default)]
pub(super) struct Faced {
    /// Whether its points have been found.
    pub(super) is_measured: bool,
    /// Points of quadrature, by the facet of the primary that they face, and the terms of the
    /// gradient from the motion of the ends of the primary (`border.rs`).
    pub(super) patches: Vec<Patch>,
    /// Joints of the primary over the facet.
    pub(super) joints: Vec<Joint>,
    /// Range of ξ that faces the primary.
    pub(super) ends: Option<[f64; 2]>,
    /// For each polynomial the one whose multiplier carries it, once it is known.
    pub(super) carriers: Option<[usize; MOST]>,
}

impl Faced {
    /// The points that face a facet of the primary; `own`: number of nodes of the secondary facet.
    pub(super) fn patch_of(&mut self, facet: usize, own: usize) -> &mut Patch {
        let known = self.patches.iter().position(|patch| patch.facet == facet);
        let place = known.unwrap_or(self.patches.len());
        if known.is_none() {
            self.patches.push(Patch::new(facet, own));
        }
        &mut self.patches[place]
    }
}

/// The facets at one configuration, measured when they are first asked for: few are near the other
/// side.
#[derive(Debug, Default)]
pub(super) struct Configuration {
    /// Positions of the nodes of both sides.
    places: Vec<Vector<2>>,
    /// Facets of the primary with their regions.
    pub(super) regions: Regions,
    /// The facets of the secondary side.
    pub(super) of_facets: Vec<Faced>,
}

/// The last two configurations that were asked for, as the start of a step and an iterate.
#[derive(Debug, Default)]
pub(super) struct Cache {
    known: [Configuration; 2],
    latest: usize,
}

impl Cache {
    /// The number of the configuration with the positions `y` of the `nodes` of both sides. If it
    /// is new, `regions` are those of the primary in it, and none of the `facets` of the secondary
    /// side is measured.
    pub(super) fn find(
        &mut self,
        nodes: &[usize],
        y: Places,
        regions: impl FnOnce() -> Regions,
        facets: usize,
    ) -> usize {
        let flat = y.flat().as_chunks::<2>().0;
        let is_same = |of: &Configuration| {
            !of.places.is_empty() && nodes.iter().zip(&of.places).all(|(&node, place)| flat[node] == place.0)
        };
        if !is_same(&self.known[self.latest]) {
            self.latest = 1 - self.latest;
            let other = &mut self.known[self.latest];
            if !is_same(other) {
                other.places.clear();
                other.places.extend(nodes.iter().map(|&node| y.at(node)));
                other.regions = regions();
                other.of_facets.clear();
                other.of_facets.resize_with(facets, Faced::default);
            }
        }
        self.latest
    }

    /// A configuration by its number.
    pub(super) fn get(&mut self, number: usize) -> &mut Configuration {
        &mut self.known[number]
    }

    /// The regions of two configurations by their numbers.
    pub(super) fn regions(&self, numbers: [usize; 2]) -> [&Regions; 2] {
        numbers.map(|number| &self.known[number].regions)
    }
}
