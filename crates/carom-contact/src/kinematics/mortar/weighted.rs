//! The weighted gap of a multiplier, with its derivatives:
//!
//! ```text
//! g_j(y) = (1/A_j) ∫ B_j(ξ) g(x(ξ), y) dΓ,   A_j = ∫ B_j dΓ,   x = Σ_a N_a(ξ) y_a
//! ```
//!
//! over the part of the secondary reference surface that has a partner; g is the gap of the point x
//! (`gap.rs`), and its derivatives follow by the chain rule with the constant weights N_a. The force
//! of a multiplier λ_j = −p_j A_j is λ_j ∇g_j: at every point of quadrature equal, opposite and
//! collinear on both sides, so that forces and moments are balanced for any quadrature.
//! (M. Hiermeier, W. A. Wall and A. Popp, 2018, derive a mortar method from such a potential.)

use carom_algebra::Vector;

use super::Mortar;
use super::cut;
use super::multipliers::{Part, bernstein};
use crate::kinematics::gap::Gap;
use crate::pair::{ContactError, Pair};
use crate::places::Places;

/// A point of quadrature with the gap there.
pub(super) struct Sample<'a> {
    /// Weight of the gap in the weighted gap.
    pub(super) share: f64,
    /// Weights N_a of the nodes of the secondary facet in the point.
    pub(super) values: [f64; 4],
    pub(super) own: &'a [usize],
    pub(super) gap: Gap,
    /// Facet of the primary, and the closest point on it.
    pub(super) facet: usize,
    pub(super) eta: f64,
    pub(super) others: &'a [usize],
}

/// The nodes of a weighted gap: those of the secondary side, then those of the primary.
pub(super) struct Stencil {
    pub(super) nodes: Vec<usize>,
    /// Number of nodes of the secondary side.
    pub(super) own: usize,
}

impl Stencil {
    /// Places in the stencil of the nodes of a sample, with their weights: the node that a gap is
    /// made for stands for the point, those of the facet follow.
    fn places(&self, sample: &Sample) -> Vec<Vec<(usize, f64)>> {
        let place =
            |of: &[usize], node: usize| of.iter().position(|&other| other == node).unwrap_or_default();
        let [own, others] = [&self.nodes[..self.own], &self.nodes[self.own..]];
        let point = sample.own.iter().zip(sample.values).map(|(&node, value)| (place(own, node), value));
        let facet = sample.others.iter().map(|&node| vec![(self.own + place(others, node), 1.0)]);
        std::iter::once(point.collect()).chain(facet).collect()
    }

    /// Adds a row over a sample's nodes to one over the stencil.
    pub(super) fn add_row(
        &self,
        sample: &Sample,
        slopes: impl Iterator<Item = Vector<2>>,
        sum: &mut [Vector<2>],
    ) {
        for (places, slope) in self.places(sample).iter().zip(slopes) {
            for &(place, weight) in places {
                sum[place] += slope * (sample.share * weight);
            }
        }
    }

    /// Adds a matrix over a sample's nodes, two components each, to one over the stencil.
    pub(super) fn add_matrix(&self, sample: &Sample, matrix: &[f64], sum: &mut [f64]) {
        let places = self.places(sample);
        let n = 2 * places.len();
        let size = 2 * self.nodes.len();
        for (p, rows) in places.iter().enumerate() {
            for (q, columns) in places.iter().enumerate() {
                for &(row, of_row) in rows {
                    for &(column, of_column) in columns {
                        let weight = sample.share * of_row * of_column;
                        for i in 0..2 {
                            for k in 0..2 {
                                sum[(2 * row + i) * size + 2 * column + k] +=
                                    weight * matrix[(2 * p + i) * n + 2 * q + k];
                            }
                        }
                    }
                }
            }
        }
    }
}

impl Mortar {
    /// The nodes of a pair's weighted gap.
    pub(super) fn stencil(&self, pair: &Pair) -> Stencil {
        let mut nodes = self.multipliers[pair.node].nodes.clone();
        let own = nodes.len();
        for facet in self.window(pair) {
            for &node in self.primary.facet(facet).nodes {
                if !nodes[own..].contains(&node) {
                    nodes.push(node);
                }
            }
        }
        Stencil { nodes, own }
    }

    /// The gaps of a pair at the points of quadrature.
    ///
    /// # Errors
    /// If a point has no unique closest point on the primary.
    pub(super) fn samples<'a>(&'a self, pair: &Pair, y: Places<'a>) -> Result<Vec<Sample<'a>>, ContactError> {
        let multiplier = &self.multipliers[pair.node];
        let mut samples = Vec::new();
        for &Part { facet, polynomial } in &multiplier.parts {
            let own = self.secondary.facet(facet);
            for point in cut::points(own, &self.primary, self.window(pair), &self.rule, y) {
                let measure = own.at(self.reference(), point.xi).measure;
                let value = bernstein(self.degree, polynomial, point.xi);
                let opposite = self.primary.facet(point.facet);
                let gap = Gap::closest(opposite, y, own.at(y, point.xi).position, point.eta);
                let at = Pair { facet: point.facet, xi: point.eta, ..*pair };
                ContactError::unless_regular(multiplier.node, &at, gap.a)?;
                samples.push(Sample {
                    share: value * point.weight * measure / multiplier.area,
                    values: own.shape.at(point.xi).values,
                    own: own.nodes,
                    gap,
                    facet: point.facet,
                    eta: point.eta,
                    others: opposite.nodes,
                });
            }
        }
        Ok(samples)
    }

    /// The smallest gap of a pair at the ends of facets, of either side, on its part of the
    /// secondary side.
    pub(super) fn nearest_of(&self, pair: &Pair, y: Places) -> Option<f64> {
        const ENDS: [[f64; 2]; 2] = [[-1.0, 0.0], [1.0, 0.0]];
        let gaps = self.multipliers[pair.node].parts.iter().flat_map(|part| {
            let own = self.secondary.facet(part.facet);
            let points = cut::points(own, &self.primary, self.window(pair), &ENDS, y);
            points.into_iter().map(move |at| {
                let place = own.at(y, at.xi).position;
                self.primary.gap(at.facet, at.eta, place, y)
            })
        });
        gaps.min_by(f64::total_cmp)
    }
}
