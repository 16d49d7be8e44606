//! Mortar contact in the plane: the gap is constrained on average, with the weights of a pressure
//! (`multipliers.rs`), over the part of the secondary side that faces the primary (`cut.rs`). A
//! uniform pressure passes meshes that do not match.
//!
//! A pair is a multiplier with a window of the primary, the facets that it may face in a step. The
//! window only says over which nodes its row extends; the points of quadrature follow from
//! positions alone.

mod border;
mod cache;
mod cut;
mod field;
mod joint;
mod measured;
mod multipliers;
mod opposite;
mod patch;
mod sides;
mod symmetry;
mod turned;
mod weighted;
mod windows;

use std::sync::Mutex;

use carom_algebra::Vector;

pub use self::cut::Quadrature;
use self::multipliers::Part;
use self::opposite::Opposite;
use self::patch::{Kind, Patch};
pub use self::sides::Mortar;
use super::obstacle::Tip;
use super::passed::Passed;
use super::{InPlane, Kinematics, NodalPressure};
use crate::constants::ROUND_OFF;
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::places::Places;
use crate::rows::Rows;

impl Mortar {
    /// Share of the area of a multiplier that faces the primary in the reference configuration.
    fn cover_at_start(&self, multiplier: usize) -> f64 {
        let Some(all) = self.opposite.whole(multiplier) else { return 0.0 };
        let mut covered = 0.0;
        let add = |part: &Part, patch: &mut Patch| {
            let shares = patch.shares(part.polynomial).filter(|(point, _)| !point.is_border());
            covered += shares.map(|(_, share)| share).sum::<f64>();
        };
        let parts = &self.multipliers[multiplier].parts;
        let measured = self.at(self.reference(), parts, |of_facets| self.each_patch(&all, of_facets, add));
        measured.map_or(0.0, |()| covered / self.multipliers[multiplier].area)
    }

    /// Weighted gap of a multiplier in the reference configuration, without what it keeps.
    fn gap_at_start(&self, multiplier: usize) -> Option<f64> {
        Some(self.signed_distance(multiplier, &self.reference)? - self.kept(multiplier))
    }

    /// Depths in the reference configuration of the nodes of both sides in the other one.
    fn depths_at_start(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let depth = |place: usize| -self.sides.signed_distance(place, &self.reference).unwrap_or(0.0);
        let nodes = self.sides.secondary().iter().enumerate();
        nodes.map(move |(place, &node)| (node, depth(place).max(0.0)))
    }

    /// Whether the forces of a row add up to zero, with their moments, as those between two sides
    /// do; an obstacle has no nodes to act on.
    fn is_balanced(&self, nodes: &[usize], slopes: &[Vector<2>], y: Places) -> bool {
        let Opposite::Side(_) = &self.opposite else { return true };
        let origin = y.at(nodes[0]);
        let round_off_of_places = f64::EPSILON / ROUND_OFF * origin.norm();
        let mut sum = Vector::ZERO;
        let mut moment = 0.0;
        let mut size = 0.0;
        let mut arm = round_off_of_places;
        for (&node, slope) in nodes.iter().zip(slopes) {
            let place = y.at(node) - origin;
            sum += *slope;
            moment += place.turned_right().dot(slope);
            size += slope.norm();
            arm = arm.max(place.norm());
        }
        // A diverging iterate is rejected elsewhere.
        !size.is_finite() || sum.norm() <= ROUND_OFF * size && moment.abs() <= ROUND_OFF * size * arm
    }
}

impl Kinematics for Mortar {
    fn secondary(&self) -> &[usize] {
        &self.nodes
    }

    /// Multipliers are not nodes, so the count is 0.
    fn nodes(&self) -> usize {
        0
    }

    fn keep(&mut self, depths: &[f64]) {
        self.kept = depths.to_vec();
        let depth = |(multiplier, depth): (usize, &f64)| {
            let cover = self.cover_at_start(multiplier);
            if cover > 0.0 { depth / cover } else { 0.0 }
        };
        self.kept_depths = depths.iter().enumerate().map(depth).collect();
        // Integrals without them are out of date.
        self.cache = Mutex::default();
        let all: f64 = (0..self.nodes.len()).filter_map(|of| self.gap_at_start(of)).map(f64::abs).sum();
        let kept: f64 = depths.iter().map(|depth| depth.abs()).sum();
        let share = if all > 0.0 { kept / all } else { 0.0 };
        self.sides_kept = self.depths_at_start().map(|(node, depth)| (node, share * depth)).collect();
    }

    fn kept_at_nodes(&self) -> Vec<(usize, f64)> {
        self.sides_kept.clone()
    }

    fn kept(&self, multiplier: usize) -> f64 {
        self.kept.get(multiplier).copied().unwrap_or(0.0)
    }

    fn facet_nodes(&self, pair: &Pair) -> &[usize] {
        match &self.opposite {
            Opposite::Side(primary) => primary.surface.facet(pair.facet).nodes,
            Opposite::Obstacle(_) => &[],
        }
    }

    /// Pairs never count as lying on one facet: nodes have gaps of their own.
    fn is_on_facet(&self, _: &Pair) -> bool {
        false
    }

    /// The gap of a coefficient is a mean, which no other row has held before.
    fn keeps_depth(&self, _: &Pair) -> bool {
        false
    }

    fn facets(&self, _: usize) -> usize {
        match &self.opposite {
            Opposite::Side(primary) => primary.surface.facets(),
            Opposite::Obstacle(_) => 1,
        }
    }

    fn signed_distance(&self, multiplier: usize, y: &[f64]) -> Option<f64> {
        let mut all = self.opposite.whole(multiplier)?;
        let mut rows = Rows::new(2);
        self.measure(&mut all, y, &mut rows).ok()?;
        let gap = rows.pop();
        gap.is_finite().then_some(gap)
    }

    fn distance_to_obstacle(&self, node: usize, y: &[f64]) -> Option<f64> {
        self.sides.distance_to_obstacle(node, y)
    }

    fn tips(&self, y: &[f64]) -> Vec<Tip> {
        self.sides.tips(y)
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        self.find_windows(before, now, pairing, events)
    }

    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        self.sides.passed(before, now, bounce)
    }

    fn met(&self, multipliers: &[usize], _: &[f64], _: &[f64]) -> Vec<Option<f64>> {
        vec![None; multipliers.len()]
    }

    /// The recorded contact point becomes that on the middle facet of the window that weighs most.
    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let y = Places::new(y, 2);
        let stencil = self.stencil(pair);
        let mut gap = 0.0;
        let mut heaviest: Option<(f64, f64)> = None;
        let slopes = self.row((pair, Kind::Gap), &stencil, y, |part, patch| {
            gap += patch.gap(part.polynomial);
            if patch.facet != pair.facet {
                return;
            }
            for (point, share) in patch.shares(part.polynomial).filter(|(point, _)| !point.is_border()) {
                if heaviest.is_none_or(|(most, _)| share >= most) {
                    heaviest = Some((share, point.at.eta));
                }
            }
        })?;
        pair.xi = heaviest.map_or(pair.xi, |(_, eta)| eta.clamp(-1.0, 1.0));
        let Some(slopes) = slopes else {
            // Nothing is left for a pressure to act on.
            pair.active = false;
            pair.lambda = 0.0;
            rows.push_open();
            return Ok(());
        };
        debug_assert!(self.is_balanced(&stencil.nodes, &slopes, y), "mortar row {}", pair.node);
        gap /= self.multipliers[pair.node].area;
        rows.push_of_many(gap, &stencil.nodes, stencil.own, &slopes);
        Ok(())
    }

    fn nearest(&self, pair: &Pair, gap: f64, y: &[f64]) -> f64 {
        self.nearest_of(pair, Places::new(y, 2)).map_or(gap, |nearest| nearest.min(gap))
    }

    fn is_of_field(&self, _: usize) -> bool {
        true
    }

    fn area(&self, multiplier: usize) -> Option<f64> {
        Some(self.multipliers[multiplier].area)
    }

    fn in_plane_of_symmetry(&self, multiplier: usize) -> Option<InPlane> {
        self.plane_of_symmetry_of(multiplier)
    }

    fn pressure_field(&self, pairs: &[Pair], y: &[f64], thickness: f64) -> Vec<NodalPressure> {
        self.field(pairs, Places::new(y, 2), thickness)
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        self.derivative_into((pair, Kind::Gap), Places::new(y, 2), curvature);
    }

    fn slip(&self, pair: &Pair, y: &[f64], _: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let stencil = self.stencil(pair);
        let row = self.row((pair, Kind::Slip), &stencil, Places::new(y, 2), |_, _| {})?;
        let slopes = row.unwrap_or_else(|| vec![Vector::ZERO; stencil.nodes.len()]);
        rows.push_of_many(0.0, &stencil.nodes, stencil.own, &slopes);
        Ok(())
    }

    fn slip_derivative_into(&self, pair: &Pair, y: &[f64], _: &[f64], _: usize, matrix: &mut [f64]) {
        self.derivative_into((pair, Kind::Slip), Places::new(y, 2), matrix);
    }
}
