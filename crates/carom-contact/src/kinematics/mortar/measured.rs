//! The points of quadrature of all secondary facets at the positions of the last call. Several pairs
//! share a facet, and a state is measured more than once. A cache: it never changes a result.

use std::sync::{Mutex, PoisonError};

use super::Mortar;
use super::cut::{self, Opposed, Region};
use crate::kinematics::gap::Gap;
use crate::places::Places;

/// A point of quadrature with the gap there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    pub(super) at: Opposed,
    pub(super) gap: Gap,
    /// Weight of quadrature, over the reference surface.
    pub(super) area: f64,
}

/// The points at one configuration.
#[derive(Debug, Default)]
pub(super) struct Cache {
    /// Positions of the nodes of both sides.
    places: Vec<f64>,
    /// Points of every secondary facet.
    of_facets: Vec<Vec<Measured>>,
}

impl Mortar {
    /// Calls a function with the points of every secondary facet at positions `y`.
    pub(super) fn at<T>(&self, y: Places, of: impl FnOnce(&[Vec<Measured>]) -> T) -> T {
        let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        let places = || self.surface.iter().flat_map(|&node| y.coordinates(node)).copied();
        if cache.places.is_empty() || !cache.places.iter().copied().eq(places()) {
            cache.places.clear();
            cache.places.extend(places());
            cache.of_facets = self.measure_facets(y);
        }
        of(&cache.of_facets)
    }

    fn measure_facets(&self, y: Places) -> Vec<Vec<Measured>> {
        let region = |&facet: &usize| (facet, Region::of(&self.primary, facet, y));
        let regions: Vec<(usize, Region)> = self.order.iter().map(region).collect();
        let of_facet = |facet: usize| {
            let own = self.secondary.facet(facet);
            let points = cut::points(own, &self.primary, &regions, &self.rule, y);
            let measured = |at: Opposed| {
                let place = own.at(y, at.xi).position;
                let gap = Gap::closest(self.primary.facet(at.facet), y, place, at.eta);
                let area = at.weight * own.at(self.reference(), at.xi).measure;
                Measured { at, gap, area }
            };
            points.into_iter().map(measured).collect()
        };
        let is_used = |facet: &usize| self.used[*facet];
        (0..self.secondary.facets())
            .map(|facet| if is_used(&facet) { of_facet(facet) } else { Vec::new() })
            .collect()
    }
}

/// The cache of a new contact.
pub(super) fn empty() -> Mutex<Cache> {
    Mutex::default()
}
