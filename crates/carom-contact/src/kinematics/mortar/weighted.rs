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

use super::cache::{Faced, Measured};
use super::cut::{Quadrature, Rule};
use super::joint::Joint;
use super::multipliers::{Part, bernstein};
use super::opposite::PointGap;
use super::sides::Mortar;
use super::turned::Turned;
use crate::pair::{ContactError, Pair};
use crate::places::Places;

/// A point of quadrature in the weighted gap of a multiplier.
#[derive(Debug)]
pub(super) struct Sample {
    /// Weight of the gap in the weighted gap.
    pub(super) share: f64,
    /// The secondary facet, and the weights of its nodes in the point, N_a, and in its tangent.
    own: usize,
    values: [f64; 4],
    slopes: [f64; 4],
    pub(super) gap: PointGap,
    /// Derivatives of the weight with which the point faces the primary, where that is partly.
    turned: Option<Box<Turned>>,
    /// Initial depth that is kept, by which the gap is larger.
    kept: f64,
    /// Facet of the primary, and the closest point on it; 0 of an obstacle.
    pub(super) facet: usize,
    pub(super) eta: f64,
}

/// The nodes of a weighted gap: those of the secondary side, then those of the primary. Near the
/// tip of a fold a side meets itself at nodes of its own, which occur once.
pub(super) struct Stencil {
    pub(super) nodes: Vec<usize>,
    /// Number of nodes of the secondary side.
    pub(super) own: usize,
}

/// Most nodes of a facet in the plane.
const NODES: usize = 4;

/// Places of the nodes of two facets, or a facet and a carrier, in a stencil.
struct Placed {
    own: [usize; NODES],
    others: [usize; NODES],
}

/// A node of a stencil on which the point or a node of the primary facet depends, with its weight.
type Weighted = (usize, f64);

impl Sample {
    /// The gap, with the initial depth that is kept; 0 at a border.
    pub(super) fn distance(&self) -> f64 {
        if self.is_border() { 0.0 } else { self.gap.distance() + self.kept }
    }

    /// Whether it only adds to the derivatives.
    pub(super) fn is_border(&self) -> bool {
        matches!(self.gap, PointGap::Border(_))
    }

    /// Calls a function with the gradients of the weighted gap of the point, over its weight, by
    /// the point, the nodes opposite, and the tangent.
    pub(super) fn gradient(&self, mut of: impl FnMut(usize, Vector<2>)) {
        self.gap.gradient(self.kept, &mut of);
        if let Some(turned) = &self.turned {
            turned.gradient(self.distance(), of);
        }
    }

    /// Second derivative of the weighted gap of the point, over its weight. Returns the number of
    /// vectors by which it is.
    pub(super) fn curvature_into(&self, matrix: &mut [f64]) -> usize {
        let Some(turned) = &self.turned else {
            self.gap.curvature_into(matrix);
            return self.gap.count();
        };
        turned.curvature_into(self.distance(), &self.gap, matrix);
        turned.count()
    }
}

impl Stencil {
    fn place(&self, mortar: &Mortar, sample: &Sample) -> Placed {
        let place = |node: usize| self.nodes.iter().position(|&other| other == node).unwrap_or_default();
        let mut placed = Placed { own: [0; NODES], others: [0; NODES] };
        let own = mortar.secondary.facet(sample.own).nodes;
        let others = mortar.opposite.nodes(sample.facet);
        placed.own.iter_mut().zip(own).for_each(|(at, &node)| *at = place(node));
        placed.others.iter_mut().zip(others).for_each(|(at, &node)| *at = place(node));
        placed
    }

    /// A function that adds the part of a row of a point, number 0, or of a node opposite to a row
    /// over the stencil.
    pub(super) fn adder<'a>(
        &self,
        mortar: &Mortar,
        sample: &'a Sample,
        sum: &'a mut [Vector<2>],
    ) -> impl FnMut(usize, Vector<2>) + 'a {
        let placed = self.place(mortar, sample);
        move |p, slope| {
            placed.each(p, sample, |(place, weight)| sum[place] += slope * (sample.share * weight));
        }
    }

    /// Adds a matrix over a point, the nodes opposite and perhaps the tangent, two components each,
    /// to one over the stencil.
    pub(super) fn add_matrix(&self, mortar: &Mortar, sample: &Sample, matrix: &[f64], sum: &mut [f64]) {
        let placed = self.place(mortar, sample);
        let n = matrix.len().isqrt();
        let count = n / 2;
        let size = 2 * self.nodes.len();
        for p in 0..count {
            placed.each(p, sample, |(row, of_row)| {
                for q in 0..count {
                    placed.each(q, sample, |(column, of_column)| {
                        let weight = sample.share * of_row * of_column;
                        for i in 0..2 {
                            let from = (2 * p + i) * n + 2 * q;
                            let to = (2 * row + i) * size + 2 * column;
                            sum[to] += weight * matrix[from];
                            sum[to + 1] += weight * matrix[from + 1];
                        }
                    });
                }
            });
        }
    }
}

impl Placed {
    /// Calls a function with the nodes of the stencil on which number `p` of the vectors of a gap
    /// depends: the point, number 0, a node opposite, or, last, the tangent.
    fn each(&self, p: usize, sample: &Sample, mut of: impl FnMut(Weighted)) {
        let is_tangent = p == sample.gap.count();
        if p > 0 && !is_tangent {
            of((self.others[p - 1], 1.0));
            return;
        }
        let nodes = self.own.iter().zip(if is_tangent { sample.slopes } else { sample.values });
        nodes.filter(|(_, value)| *value != 0.0).for_each(|(&place, value)| of((place, value)));
    }
}

impl Mortar {
    /// The nodes of a pair's weighted gap.
    pub(super) fn stencil(&self, pair: &Pair) -> Stencil {
        let mut nodes = self.multipliers[pair.node].nodes.clone();
        let own = nodes.len();
        for &facet in self.opposite.window(pair) {
            for &node in self.opposite.nodes(facet) {
                if !nodes.contains(&node) {
                    nodes.push(node);
                }
            }
        }
        Stencil { nodes, own }
    }

    /// The gaps of a pair at the points of quadrature that face its window.
    ///
    /// # Errors
    /// If a point has no unique closest point on the primary.
    pub(super) fn samples(&self, pair: &Pair, y: Places) -> Result<Vec<Sample>, ContactError> {
        let multiplier = &self.multipliers[pair.node];
        let kept = self.kept_depths.get(pair.node).copied().unwrap_or(0.0);
        self.at(y, &multiplier.parts, |of_facets| {
            let mut samples = Vec::new();
            for &Part { facet, polynomial, .. } in &multiplier.parts {
                let shape = self.secondary.facet(facet).shape;
                let Faced { points, borders, carriers, .. } = &of_facets[facet];
                let carriers = carriers.unwrap_or_default();
                let carried: Vec<usize> =
                    (0..=self.degree).filter(|&other| carriers[other] == polynomial).collect();
                for Measured { at, gap, area, turned } in
                    points.iter().chain(borders).filter(|_| !carried.is_empty())
                {
                    if !self.opposite.is_in_window(pair, at.facet) {
                        continue;
                    }
                    let of_point = Pair { facet: at.facet, xi: at.eta, ..*pair };
                    gap.unless_regular(multiplier.node, &of_point)?;
                    let values = carried.iter().map(|&number| bernstein(self.degree, number, at.xi));
                    let shape = shape.at(at.xi);
                    samples.push(Sample {
                        share: values.sum::<f64>() * area / multiplier.area,
                        own: facet,
                        values: shape.values,
                        slopes: shape.first,
                        gap: *gap,
                        turned: turned.clone(),
                        kept,
                        facet: at.facet,
                        eta: at.eta,
                    });
                }
            }
            Ok(samples)
        })
    }

    /// Adds the terms of the joints of the primary to the derivative of a row of a pair; `jump`:
    /// that of the row at a joint.
    pub(super) fn add_joints(
        &self,
        pair: &Pair,
        y: Places,
        stencil: &Stencil,
        matrix: &mut [f64],
        jump: impl Fn(&Joint) -> Vector<2>,
    ) {
        let multiplier = &self.multipliers[pair.node];
        let size = 2 * stencil.nodes.len();
        let place = |node: usize| stencil.nodes.iter().position(|&other| other == node);
        self.at(y, &multiplier.parts, |of_facets| {
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
        });
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
