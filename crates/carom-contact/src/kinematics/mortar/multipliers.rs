//! The multipliers of a mortar contact: the coefficients of a pressure of lower degree than the
//! facets,
//!
//! ```text
//! p(ξ) = Σ_j p_j B_j(ξ),   B_j: Bernstein polynomials of degree q = max(1, k − 1) on facets of degree k
//! ```
//!
//! continuous over the joints of facets but for kinks of more than 30°, where each facet has a
//! coefficient of its own. B_j ≥ 0 and Σ_j B_j = 1: coefficients p_j ≥ 0 give a pressure p ≥ 0
//! everywhere. For k ≥ 2 pairs of spaces of this kind are inf–sup stable, while pressures of the
//! degree of the facets, as for k = 1, are not where supports hold nodes of the side along its
//! normal: there are more coefficients than gaps that can change. There the polynomial of a node
//! that is held is added to that of the other end of its facet, on which the pressure is constant.

use carom_solid::quadrature;

use crate::constants::ROUND_OFF;
use crate::kinematics::facets::Facets;
use crate::kinematics::surface::Surface;
use crate::places::Places;

/// A part of a multiplier: one Bernstein polynomial on one facet of the secondary side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Facet of the secondary side.
    pub(super) facet: usize,
    /// Number of the polynomial, in the direction of traversal.
    pub(super) polynomial: usize,
    /// ∫ B dΓ over the reference surface.
    pub(super) area: f64,
}

/// A coefficient of the pressure.
#[derive(Clone, Debug)]
pub(super) struct Multiplier {
    /// Global number of the node that represents it in messages and records.
    pub(super) node: usize,
    /// Polynomials of neighbouring facets that make up B_j.
    pub(super) parts: Vec<Part>,
    /// Global numbers of the nodes of these facets.
    pub(super) nodes: Vec<usize>,
    /// ∫ B_j dΓ over the reference surface.
    pub(super) area: f64,
}

/// Most polynomials on a facet.
pub(super) const MOST: usize = 3;

/// Degree of the pressure on facets of a degree.
pub(super) fn degree_of_pressure(of_facets: usize) -> usize {
    of_facets.saturating_sub(1).max(1)
}

/// Value at ξ of the Bernstein polynomial `number` of a degree, 1 or 2, on −1 … 1.
pub(super) fn bernstein(degree: usize, number: usize, xi: f64) -> f64 {
    let back = 0.5 * (1.0 - xi);
    let forth = 0.5 * (1.0 + xi);
    let binomial = if degree == 2 && number == 1 { 2.0 } else { 1.0 };
    let powers = |x: f64| [1.0, x, x * x];
    binomial * powers(back)[degree - number] * powers(forth)[number]
}

/// The multipliers of a secondary side; `reference`: reference positions, flat over all nodes.
pub(super) fn multipliers(side: &Surface, reference: &[f64]) -> Vec<Multiplier> {
    let y = Places::new(reference, 2);
    let degree = degree_of_pressure(side.shape.degree());
    let facets: Vec<usize> = (0..side.facets()).filter(|&facet| !side.is_mirror(facet)).collect();
    let mut all: Vec<Multiplier> = Vec::new();
    // The multiplier at the start of each facet, once there is one.
    let mut at_start: Vec<Option<usize>> = vec![None; side.facets()];
    for &facet in &facets {
        let nodes = side.facet(facet).nodes;
        for polynomial in 0..=degree {
            let next = side.neighbour_of_side(facet, true).filter(|&next| side.is_blunt(facet, next, y));
            let node = match polynomial {
                0 => nodes[0],
                _ if polynomial == degree => nodes[1],
                // Facets of degree 3 have a node after the start.
                _ => nodes[2],
            };
            let shared = match polynomial {
                0 => at_start[facet],
                _ if polynomial == degree => next.and_then(|next| at_start[next]),
                _ => None,
            };
            let number = shared.unwrap_or_else(|| {
                all.push(Multiplier { node, parts: Vec::new(), nodes: Vec::new(), area: 0.0 });
                all.len() - 1
            });
            if polynomial == 0 {
                at_start[facet] = Some(number);
            } else if let Some(next) = next.filter(|_| polynomial == degree) {
                at_start[next] = Some(number);
            }
            let rule = quadrature::line(2 * side.shape.degree() + degree);
            let of = &mut all[number];
            let mut area = 0.0;
            for (xi, weight) in rule.iter() {
                let measure = side.facet(facet).at(y, xi[0]).measure;
                let part = weight * measure * bernstein(degree, polynomial, xi[0]);
                area += part;
                of.area += part;
            }
            of.parts.push(Part { facet, polynomial, area });
            for &node in nodes {
                if !of.nodes.contains(&node) {
                    of.nodes.push(node);
                }
            }
        }
    }
    all
}

/// Adds the polynomials of degree 1 of nodes that are held along the normal to those of the other
/// ends of their facets; a facet of which both ends are held keeps both. `fixed`: by dof, whether a
/// support holds it.
pub(super) fn without_held(
    mut all: Vec<Multiplier>,
    side: &Surface,
    reference: &[f64],
    fixed: &[bool],
) -> Vec<Multiplier> {
    let y = Places::new(reference, 2);
    let is_held = |of: &Multiplier| {
        of.parts.iter().all(|part| {
            let end = if part.polynomial == 0 { -1.0 } else { 1.0 };
            let normal = side.facet(part.facet).at(y, end).normal;
            (0..2).all(|i| fixed[2 * of.node + i] || normal.0[i].abs() <= ROUND_OFF)
        })
    };
    let held: Vec<bool> = all.iter().map(is_held).collect();
    let mut gained: Vec<(usize, Part)> = Vec::new();
    for part in (0..all.len()).filter(|&of| held[of]).flat_map(|of| &all[of].parts) {
        let is_opposite = |other: &Part| other.facet == part.facet && other.polynomial + part.polynomial == 1;
        let opposite = all.iter().position(|of| of.parts.iter().any(is_opposite));
        gained.extend(opposite.filter(|&of| !held[of]).map(|of| (of, *part)));
    }
    for (of, part) in gained {
        let is_other = |own: &Part| (own.facet, own.polynomial) != (part.facet, part.polynomial);
        all.iter_mut().for_each(|of| of.parts.retain(is_other));
        all[of].parts.push(part);
        all[of].area += part.area;
    }
    all.retain(|of| !of.parts.is_empty());
    all
}
