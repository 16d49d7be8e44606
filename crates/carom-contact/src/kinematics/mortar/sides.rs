//! The two sides of a mortar contact with their multipliers.

use std::sync::Mutex;

use carom_solid::quadrature;

use super::cache::Cache;
use super::multipliers::{Multiplier, degree_of_pressure, multipliers};
use crate::kinematics::facets::Facets;
use crate::kinematics::surface::Surface;
use crate::kinematics::{BothSides, NodeToFacet};
use crate::places::Places;

/// Contact of two sides of bodies in the plane on average.
#[derive(Debug)]
pub struct Mortar {
    pub(super) secondary: Surface,
    pub(super) primary: Surface,
    /// Facets of the primary side, each followed by the next one along the side if there is one.
    pub(super) order: Vec<usize>,
    /// Place of each facet of the primary in `order`.
    pub(super) place: Vec<usize>,
    pub(super) multipliers: Vec<Multiplier>,
    /// Nodes that represent the multipliers.
    pub(super) nodes: Vec<usize>,
    /// Degree of the pressure.
    pub(super) degree: usize,
    /// Points and weights of quadrature on −1 … 1.
    pub(super) rule: Vec<[f64; 2]>,
    pub(super) reference: Vec<f64>,
    /// Nodes of both sides.
    pub(super) surface: Vec<usize>,
    /// Whether each secondary facet belongs to a multiplier.
    pub(super) used: Vec<bool>,
    pub(super) cache: Mutex<Cache>,
    /// Initial depth that is kept for each multiplier; empty if all are zero.
    pub(super) kept: Vec<f64>,
    /// Depth that is kept at every point of a multiplier's part of the side.
    pub(super) kept_depths: Vec<f64>,
    /// Nodes of both sides against the other one: none may pass through it.
    pub(super) sides: BothSides<NodeToFacet>,
    /// Initial depths that are kept at the nodes of both sides; multipliers keep `kept`.
    pub(super) sides_kept: Vec<(usize, f64)>,
}

impl Mortar {
    /// Contact of a secondary with a primary side; `reference`: reference positions, flat over all
    /// nodes; `sides`: contact of their nodes, which finds those that pass through a body.
    pub fn new(
        secondary: Surface,
        primary: Surface,
        reference: &[f64],
        sides: BothSides<NodeToFacet>,
    ) -> Self {
        let multipliers = multipliers(&secondary, reference);
        let order = along(&primary);
        let mut place = vec![0; primary.all()];
        order.iter().enumerate().for_each(|(at, &facet)| place[facet] = at);
        let degree_of = |side: &Surface| side.shape().degree();
        let exact = 2 * degree_of(&secondary).max(degree_of(&primary)) + 3;
        let rule = quadrature::line(exact).iter().map(|(xi, weight)| [xi[0], weight]).collect();
        let mut used = vec![false; secondary.facets()];
        let parts = multipliers.iter().flat_map(|of| &of.parts);
        parts.for_each(|part| used[part.facet] = true);
        let facets = |side: &Surface| side.nodes[..side.facets() * side.shape.nodes()].to_vec();
        let mut surface = [facets(&secondary), facets(&primary)].concat();
        surface.sort_unstable();
        surface.dedup();
        Self {
            surface,
            used,
            cache: Mutex::default(),
            nodes: multipliers.iter().map(|of| of.node).collect(),
            degree: degree_of_pressure(degree_of(&secondary)),
            secondary,
            primary,
            order,
            place,
            multipliers,
            rule,
            reference: reference.to_vec(),
            kept: Vec::new(),
            kept_depths: Vec::new(),
            sides,
            sides_kept: Vec::new(),
        }
    }

    /// Positions of the reference configuration.
    pub(super) fn reference(&self) -> Places<'_> {
        Places::new(&self.reference, 2)
    }
}

/// The facets of a side that are surfaces, from the starts of its chains on.
fn along(side: &Surface) -> Vec<usize> {
    let mut order = Vec::new();
    let mut seen = vec![false; side.facets()];
    let is_start = |facet: &usize| side.neighbour_of_side(*facet, false).is_none();
    // Loops, which have no start, come last.
    let starts = (0..side.facets()).filter(is_start).chain(0..side.facets());
    for start in starts.filter(|&facet| !side.is_mirror(facet)) {
        let mut next = Some(start);
        while let Some(facet) = next.filter(|&facet| !seen[facet]) {
            seen[facet] = true;
            order.push(facet);
            next = side.neighbour_of_side(facet, true);
        }
    }
    order
}
