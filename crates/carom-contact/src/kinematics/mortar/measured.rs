//! The points of quadrature of all secondary facets at the positions of the last calls. Several
//! pairs share a facet, and a state is measured more than once. A cache: it never changes a result.
//!
//! A multiplier of whose area hardly anything faces the primary, as beside the end of a body, would
//! carry an arbitrary pressure. Its polynomials are added to those of a neighbour on the same
//! facet, whose pressure then extends over them.

use std::sync::PoisonError;

use carom_algebra::Vector;

use super::border::{self, Border, End};
use super::cache::{Cache, Configuration, Faced};
use super::cut::{Crossing, Facing, Meeting, Opposed, Regions};
use super::joint::Joint;
use super::multipliers::{MOST, Multiplier, Part, bernstein};
use super::opposite::{Opposite, PointGap};
use super::patch::Measured;
use super::sides::Mortar;
use super::turned::{Own, Turned, faces};
use crate::constants::MORTAR_COVERED;
use crate::kinematics::projection::{Facet, FacetPoint};
use crate::places::Places;

/// Jump of a unit normal that is round-off.
const STRAIGHT: f64 = 1e-10;

impl Mortar {
    /// Calls a function with the secondary facets at positions `y`, of which those of some parts
    /// have been measured.
    pub(super) fn at<T>(&self, y: Places, parts: &[Part], of: impl FnOnce(&mut [Faced]) -> T) -> T {
        let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        let known = self.configuration(&mut cache, y);
        let Configuration { regions, of_facets, .. } = cache.get(known);
        for part in parts {
            self.measure_facet(part.facet, regions, of_facets, y);
        }
        of(of_facets)
    }

    /// Calls a function with the regions of the primary at two positions.
    pub(super) fn with_regions<T>(&self, ends: [Places; 2], of: impl FnOnce([&Regions; 2]) -> T) -> T {
        let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        let known = ends.map(|y| self.configuration(&mut cache, y));
        of(cache.regions(known))
    }

    /// Number of the configuration with positions `y` in a cache.
    fn configuration(&self, cache: &mut Cache, y: Places) -> usize {
        let regions = || self.opposite.regions(self.opposite.facets(), y);
        cache.find(&self.surface, y, regions, self.secondary.facets())
    }

    /// Measures a facet, and those on which its carriers depend.
    fn measure_facet(&self, facet: usize, regions: &Regions, faced: &mut [Faced], y: Places) {
        if faced[facet].carriers.is_some() {
            return;
        }
        let facing = self.opposite.facing(regions, &self.rule, y);
        let of_facet = &self.of_facets[facet][..=self.degree];
        for part in of_facet.iter().flat_map(|&multiplier| &self.multipliers[multiplier].parts) {
            let of = &mut faced[part.facet];
            if of.is_measured {
                continue;
            }
            let own = self.secondary.facet(part.facet);
            let Facing { points, ends, borders, joints } = facing(part.facet, own);
            for at in points {
                if let Some(point) = self.measured(own, at, y).filter(|point| point.area > 0.0) {
                    of.patch_of(at.facet, own.nodes.len()).points.push(point);
                }
            }
            for at in &borders {
                if let Some(point) = self.border(own, at, y) {
                    of.patch_of(at.facet, own.nodes.len()).points.push(point);
                }
            }
            of.joints = joints.iter().filter_map(|at| self.joint(own, at, y)).collect();
            of.ends = ends;
            of.is_measured = true;
        }
        let carriers = self.carriers(of_facet, faced);
        let kept = std::array::from_fn(|number| {
            of_facet.get(number).and_then(|&of| self.kept_depths.get(of)).copied().unwrap_or(0.0)
        });
        let value = |number: usize, xi: f64| -> f64 {
            let carried = (0..=self.degree).filter(|&other| carriers[other] == number);
            carried.map(|other| bernstein(self.degree, other, xi)).sum()
        };
        let of = &mut faced[facet];
        of.carriers = Some(carriers);
        of.patches.iter_mut().for_each(|patch| patch.weigh(value, kept));
    }

    fn measured(&self, own: Facet, at: Opposed, y: Places) -> Option<Measured> {
        let place = own.at(y, at.xi);
        let gap = self.opposite.gap(&at, place.position, y)?;
        let (weight, turned) = Turned::of(&Own { tangent: place.tangent, normal: place.normal }, &gap);
        let area = weight * at.weight * own.tangent(self.reference(), at.xi).norm();
        let shape = own.shape.at(at.xi);
        Some(Measured { at, gap, area, turned, shape })
    }

    /// The term of the gradient from the motion of an end of the primary over a secondary facet.
    fn border(&self, own: Facet, at: &Crossing, y: Places) -> Option<Measured> {
        let Opposite::Side(primary) = &self.opposite else { return None };
        let mut jumps = [0.0; 2];
        let mut of_jump = [Vector::ZERO; border::MOST];
        for (side, sign) in at.sides.into_iter().zip([1.0, -1.0]) {
            let Some(side) = side.and_then(|side| self.measured(own, Opposed { weight: 1.0, ..side }, y))
            else {
                continue;
            };
            jumps[0] += sign * side.area * side.gap.distance();
            jumps[1] += sign * side.area;
            if side.at.facet == at.facet {
                side.gap.gradient(0.0, |p, slope| of_jump[p] += slope * (sign * side.area));
            }
        }
        if jumps == [0.0; 2] {
            return None;
        }
        let facet = primary.surface.facet(at.facet);
        let FacetPoint { position, tangent, measure, .. } = facet.at(y, at.eta);
        let along = at.plane.unwrap_or(tangent * measure.recip());
        let turns = if at.plane.is_some() { 0.0 } else { measure.recip() };
        let shape = &facet.shape.at(at.eta);
        let end = End { place: position, along, turns, shape, nodes: facet.nodes.len() };
        let border = Border::new(&own.at(y, at.xi), &end, jumps, of_jump)?;
        let at = Opposed { xi: at.xi, weight: 0.0, facet: at.facet, eta: at.eta };
        let shape = own.shape.at(at.xi);
        Some(Measured { at, gap: PointGap::Border(border), area: 1.0, turned: None, shape })
    }

    /// The term of the second derivative from the motion of a joint of the primary over a secondary
    /// facet.
    fn joint(&self, own: Facet, at: &Meeting, y: Places) -> Option<Joint> {
        let Opposite::Side(primary) = &self.opposite else { return None };
        let [before, after] = at.facets.map(|facet| primary.surface.facet(facet));
        let [eta, other] = if at.forward { [1.0, -1.0] } else { [-1.0, 1.0] };
        let [before_it, after_it] = [before.at(y, eta), after.at(y, other)];
        let normal = before_it.normal - after_it.normal;
        let along = |at: &FacetPoint| at.tangent * at.measure.recip();
        let tangent = along(&before_it) - along(&after_it);
        if normal.norm() < STRAIGHT {
            return None;
        }
        let place = own.at(y, at.xi);
        let faces =
            0.5 * [&before_it, &after_it].map(|at| faces(place.normal, at.normal)).iter().sum::<f64>();
        let rate = normal.dot(&place.tangent);
        let node = before.nodes[usize::from(at.forward)];
        let weight = faces * own.at(self.reference(), at.xi).measure / rate;
        (faces > 0.0 && weight.is_finite()).then_some(Joint {
            xi: at.xi,
            facets: at.facets,
            node,
            normal,
            tangent,
            weight,
        })
    }

    /// For each polynomial of a facet, with its multipliers, the polynomial that carries it:
    /// itself, if enough of its multiplier is covered, or else the nearest one on the facet of
    /// which that holds, or the one that is covered most.
    fn carriers(&self, of_facet: &[usize], faced: &[Faced]) -> [usize; MOST] {
        let mut carriers = std::array::from_fn(|number| number);
        if self.springs {
            return carriers;
        }
        let mut covers = [0.0; MOST];
        for (cover, &multiplier) in covers.iter_mut().zip(of_facet) {
            *cover = self.cover(&self.multipliers[multiplier], faced);
        }
        let is_covered = |number: usize| covers[number] >= MORTAR_COVERED;
        let all = 0..of_facet.len();
        for number in all.clone().filter(|&number| !is_covered(number)) {
            let nearest = all.clone().filter(|&other| is_covered(other));
            let most = all.clone().max_by(|&a, &b| covers[a].total_cmp(&covers[b]));
            let carrier = nearest.min_by_key(|other| other.abs_diff(number)).or(most);
            carriers[number] = carrier.unwrap_or(number);
        }
        carriers
    }

    /// Share of the area of a multiplier that faces the primary.
    fn cover(&self, multiplier: &Multiplier, faced: &[Faced]) -> f64 {
        let of_part = |part: &Part| -> f64 {
            let value = |point: &Measured| bernstein(self.degree, part.polynomial, point.at.xi);
            let points = faced[part.facet].patches.iter().flat_map(|patch| &patch.points);
            points.filter(|point| !point.is_border()).map(|point| value(point) * point.area).sum()
        };
        multiplier.parts.iter().map(of_part).sum::<f64>() / multiplier.area
    }
}
