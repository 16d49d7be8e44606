//! The pressure field of a mortar contact at the nodes of the secondary side:
//!
//! ```text
//! p(ξ) = Σ_j p_j B_j(ξ),   p_j = −λ_j / (t A_j)
//! ```
//!
//! per area of the reference surface, of a body of thickness t; per area of the deformed surface it
//! is p |Y'| / |y'|. A node that faces nothing, beside the end of the primary, has the pressure at
//! the last point of its facet that does: p means nothing beyond.

use std::collections::BTreeMap;

use super::cache::Faced;
use super::multipliers::{MOST, Part, bernstein};
use super::sides::Mortar;
use crate::kinematics::NodalPressure;
use crate::pair::Pair;
use crate::places::Places;

impl Mortar {
    /// The pressures of pairs at all nodes of the secondary side. At a joint, where the pressure
    /// per deformed area jumps with the stretch, it is the mean of both sides; at a corner, where
    /// each facet has a pressure of its own, the larger one.
    pub(super) fn field(&self, pairs: &[Pair], y: Places, thickness: f64) -> Vec<NodalPressure> {
        let mut coefficients: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        for pair in pairs.iter().filter(|pair| pair.active) {
            let multiplier = &self.multipliers[pair.node];
            for part in &multiplier.parts {
                let coefficient = -pair.lambda / (thickness * multiplier.area);
                coefficients.insert((part.facet, part.polynomial), coefficient);
            }
        }
        let facets = (0..self.secondary.facets()).filter(|&facet| self.used[facet]);
        let all: Vec<Part> = self.multipliers.iter().flat_map(|of| of.parts.iter().copied()).collect();
        let carried = |of: &Faced| (of.ends, of.carriers.unwrap_or_default());
        let faced: Vec<(Option<[f64; 2]>, [usize; MOST])> =
            self.at(y, &all, |of_facets| of_facets.iter().map(carried).collect());
        let mut at_nodes: BTreeMap<usize, Vec<NodalPressure>> = BTreeMap::new();
        for facet in facets {
            let own = self.secondary.facet(facet);
            let (Some([from, to]), carriers) = faced[facet] else {
                for &node in own.nodes {
                    let none = NodalPressure { node, actual: 0.0, nominal: 0.0 };
                    at_nodes.entry(node).or_default().push(none);
                }
                continue;
            };
            for (place, &node) in own.nodes.iter().enumerate() {
                let xi = own.coordinate(place).clamp(from, to);
                let of = |number: usize| {
                    let carrier = carriers[number];
                    coefficients.get(&(facet, carrier)).copied().unwrap_or(0.0)
                };
                let parts = (0..=self.degree).map(|number| of(number) * bernstein(self.degree, number, xi));
                let nominal: f64 = parts.sum();
                let stretch = own.at(y, xi).measure / own.at(self.reference(), xi).measure;
                let found = NodalPressure { node, actual: nominal / stretch, nominal };
                at_nodes.entry(node).or_default().push(found);
            }
        }
        at_nodes.into_values().map(|of_facets| united(&of_facets)).collect()
    }
}

/// The pressure at a node of one facet or two.
fn united(of_facets: &[NodalPressure]) -> NodalPressure {
    let largest = of_facets.iter().fold(0.0_f64, |most, of| most.max(of.nominal));
    let alike = || of_facets.iter().filter(|of| of.nominal >= (1.0 - ALIKE) * largest);
    let actual = alike().map(|of| of.actual).sum::<f64>() / alike().count().max(1) as f64;
    NodalPressure { node: of_facets[0].node, actual, nominal: largest }
}

/// Difference of two pressures per reference area, relative to the larger one, that is round-off.
const ALIKE: f64 = 1e-12;
