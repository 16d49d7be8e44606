//! The weighted gap of a multiplier, with its derivatives:
//!
//! ```text
//! g_j(y) = (1/A_j) ∫ B_j(ξ) g(x(ξ), y) dΓ,   A_j = ∫ B_j dΓ,   x = Σ_a N_a(ξ) y_a
//! ```
//!
//! over the part of the secondary reference surface that has a partner; g is the gap of the point x
//! (`opposite.rs`), and its derivatives follow by the chain rule with the constant weights N_a. The
//! force of a multiplier λ_j = −p_j A_j is λ_j ∇g_j: at every point of quadrature equal, opposite
//! and collinear on both sides, so that forces and moments are balanced for any quadrature.

use carom_algebra::Vector;

use super::cache::Faced;
use super::cut::{Quadrature, Rule};
use super::joint::Joint;
use super::multipliers::{Part, bernstein};
use super::patch::{Kind, NODES, Patch, SIZE};
use super::sides::Mortar;
use crate::pair::{ContactError, Pair};
use crate::places::Places;

/// The nodes of a weighted gap: those of the secondary side, then those of the primary. Near the
/// tip of a fold a side meets itself at nodes of its own, which occur once.
pub(super) struct Stencil {
    pub(super) nodes: Vec<usize>,
    /// Number of nodes of the secondary side.
    pub(super) own: usize,
}

impl Stencil {
    /// Places of the nodes of a secondary facet and of what it faces.
    fn places(&self, own: &[usize], others: &[usize]) -> ([usize; 2 * NODES], usize) {
        let mut places = [0; 2 * NODES];
        let nodes = own.iter().chain(others);
        let place = |node: usize| self.nodes.iter().position(|&other| other == node).unwrap_or_default();
        places.iter_mut().zip(nodes).for_each(|(at, &node)| *at = place(node));
        (places, own.len() + others.len())
    }
}

impl Mortar {
    /// The nodes of a pair's weighted gap.
    pub(super) fn stencil(&self, pair: &Pair) -> Stencil {
        let window = self.opposite.window(pair);
        let own_nodes = &self.multipliers[pair.node].nodes;
        let own = own_nodes.len();
        let mut nodes = Vec::with_capacity(own + window.len() * NODES);
        nodes.extend_from_slice(own_nodes);
        for &facet in window {
            for &node in self.opposite.nodes(facet) {
                if !nodes.contains(&node) {
                    nodes.push(node);
                }
            }
        }
        Stencil { nodes, own }
    }

    /// Calls a function with the parts of a pair's multiplier that face its window, each with its
    /// secondary facet; `of_facets`: the secondary facets, of which its own have been measured.
    ///
    /// # Errors
    /// If a point has no unique closest point on the primary.
    pub(super) fn each_patch(
        &self,
        pair: &Pair,
        of_facets: &mut [Faced],
        mut of: impl FnMut(&Part, &mut Patch),
    ) -> Result<(), ContactError> {
        let multiplier = &self.multipliers[pair.node];
        for part in &multiplier.parts {
            let faced = &mut of_facets[part.facet];
            let carriers = faced.carriers.unwrap_or_default();
            if !carriers[..=self.degree].contains(&part.polynomial) {
                continue;
            }
            for patch in &mut faced.patches {
                if self.opposite.is_in_window(pair, patch.facet) {
                    patch.unless_regular(multiplier.node, pair)?;
                    of(part, patch);
                }
            }
        }
        Ok(())
    }

    /// The row of a pair's gap or slip, over its stencil; none if nothing of its part of the side
    /// faces the window. Calls a function with what it is the integral over.
    ///
    /// # Errors
    /// If a point has no unique closest point on the primary.
    pub(super) fn row(
        &self,
        (pair, kind): (&Pair, Kind),
        stencil: &Stencil,
        y: Places,
        mut of: impl FnMut(&Part, &mut Patch),
    ) -> Result<Option<Vec<Vector<2>>>, ContactError> {
        let multiplier = &self.multipliers[pair.node];
        let share = multiplier.area.recip();
        let mut slopes = vec![Vector::ZERO; stencil.nodes.len()];
        let mut faces = false;
        let add = |part: &Part, patch: &mut Patch| {
            faces = true;
            of(part, patch);
            let own = self.secondary.facet(part.facet).nodes;
            let (places, count) = stencil.places(own, self.opposite.nodes(patch.facet));
            let row = patch.row(kind, part.polynomial);
            places[..count].iter().zip(row).for_each(|(&at, slope)| slopes[at] += *slope * share);
        };
        self.at(y, &multiplier.parts, |of_facets| self.each_patch(pair, of_facets, add))?;
        Ok(faces.then_some(slopes))
    }

    /// Overwrites a matrix over the stencil of a pair with the derivative of the row of its gap or
    /// slip.
    pub(super) fn derivative_into(&self, (pair, kind): (&Pair, Kind), y: Places, matrix: &mut [f64]) {
        let stencil = self.stencil(pair);
        let size = 2 * stencil.nodes.len();
        let multiplier = &self.multipliers[pair.node];
        let share = multiplier.area.recip();
        matrix.fill(0.0);
        self.at(y, &multiplier.parts, |of_facets| {
            let added = self.each_patch(pair, of_facets, |part, patch| {
                let own = self.secondary.facet(part.facet).nodes;
                let (places, count) = stencil.places(own, self.opposite.nodes(patch.facet));
                let of_patch = patch.derivative(kind, part.polynomial);
                for (row, entries) in of_patch.as_chunks::<SIZE>().0[..2 * count].iter().enumerate() {
                    let sums = &mut matrix[(2 * places[row / 2] + row % 2) * size..][..size];
                    let sums = sums.as_chunks_mut::<2>().0;
                    for (&place, entry) in places[..count].iter().zip(entries.as_chunks::<2>().0) {
                        sums[place][0] += share * entry[0];
                        sums[place][1] += share * entry[1];
                    }
                }
            });
            // Without a unique closest point the row has been refused.
            if added.is_err() {
                matrix.fill(0.0);
                return;
            }
            self.add_joints(pair, of_facets, &stencil, matrix, |joint| match kind {
                Kind::Gap => joint.normal,
                Kind::Slip => joint.tangent,
            });
        });
    }

    /// Adds the terms of the joints of the primary to the derivative of a row of a pair; `jump`:
    /// that of the row at a joint.
    fn add_joints(
        &self,
        pair: &Pair,
        of_facets: &[Faced],
        stencil: &Stencil,
        matrix: &mut [f64],
        jump: impl Fn(&Joint) -> Vector<2>,
    ) {
        let multiplier = &self.multipliers[pair.node];
        let size = 2 * stencil.nodes.len();
        let place = |node: usize| stencil.nodes.iter().position(|&other| other == node);
        for &Part { facet, polynomial, .. } in &multiplier.parts {
            let own = self.secondary.facet(facet);
            let carriers = of_facets[facet].carriers.unwrap_or_default();
            for joint in &of_facets[facet].joints {
                if !joint.facets.iter().all(|&facet| self.opposite.is_in_window(pair, facet)) {
                    continue;
                }
                let carried = (0..=self.degree).filter(|&number| carriers[number] == polynomial);
                let value = carried.map(|number| bernstein(self.degree, number, joint.xi)).sum::<f64>();
                let of_point = own.nodes.iter().copied().zip(own.shape.at(joint.xi).values);
                let mut places = [(0, 0.0); NODES + 1];
                let mut count = 0;
                for (node, weight) in of_point.chain([(joint.node, -1.0)]) {
                    if let Some(place) = place(node) {
                        places[count] = (place, weight);
                        count += 1;
                    }
                }
                joint.add_to(value / multiplier.area, jump(joint), &places[..count], size, matrix);
            }
        }
    }

    /// The smallest gap of a pair at the ends of facets, of either side, on its part of the
    /// secondary side.
    pub(super) fn nearest_of(&self, pair: &Pair, y: Places) -> Option<f64> {
        let ends = Rule { points: vec![[-1.0, 0.0], [1.0, 0.0]], quadrature: Quadrature::Segments };
        let regions = self.opposite.regions(self.opposite.window(pair), y);
        let facing = self.opposite.facing(&regions, &ends, y);
        let mut nearest: Option<f64> = None;
        for part in &self.multipliers[pair.node].parts {
            let own = self.secondary.facet(part.facet);
            for at in facing(part.facet, own).points {
                let Some(gap) = self.opposite.gap(&at, own.at(y, at.xi).position, y) else { continue };
                let gap = gap.distance();
                nearest = Some(nearest.map_or(gap, |least| least.min(gap)));
            }
        }
        nearest
    }
}
