//! Two sets of nodes far from each other. Until they have moved by what lies between them, no path
//! of the one comes near a facet of the other, and a search would find nothing. A cache: it never
//! changes a result.
//!
//! ```text
//! δ = largest change of a coordinate since the last search, at the start and at the end of a step
//! box of a facet's path, grown by m of its size    within the last one grown by 3 A (1 + 2m) δ
//! box of the nodes' paths, grown by n of its size    within the last one grown by 3 (1 + 2n) δ
//! ```
//!
//! Seen from the frame of the boxes (`drift.rs`), which moves by up to 2δ in a step, the end of a
//! path has moved by up to 3δ. A bounds the sum of the weights of a facet's nodes in the points
//! around it (`Hull::weight`).

use carom_solid::Bounds;

use crate::constants::ROUND_OFF;

/// The nodes of two sets that are far from each other, and how far they may move before a search is
/// needed.
#[derive(Clone, Debug)]
pub struct Apart {
    nodes: Vec<usize>,
    dimension: usize,
    /// Bound A of the sum of the weights of a facet's nodes in the points around it.
    weight: f64,
    /// Coordinates of the nodes at the last search.
    places: Vec<f64>,
    /// Largest change of a coordinate with which the two sets stay apart; ≤ 0 if they were near
    /// each other.
    clearance: f64,
    /// Margin around facets in the last search, relative to their size.
    margin: f64,
}

impl Apart {
    /// Two sets of nodes before the first search; `weight`: a bound of the sum of the weights of a
    /// facet's nodes in the points around it.
    pub fn new(nodes: impl IntoIterator<Item = usize>, dimension: usize, weight: f64) -> Self {
        let mut nodes: Vec<usize> = nodes.into_iter().collect();
        nodes.sort_unstable();
        nodes.dedup();
        Self { nodes, dimension, weight, places: Vec::new(), clearance: 0.0, margin: 0.0 }
    }

    /// All nodes of both sets, ascending.
    pub(crate) fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Whether the two sets certainly stay apart in a motion between two positions, flat over all
    /// nodes, with a margin around facets relative to their size.
    pub fn holds(&self, margin: f64, [before, now]: [&[f64]; 2]) -> bool {
        if self.clearance <= 0.0 || margin > self.margin {
            return false;
        }
        let mut within = true;
        for (&node, at) in self.nodes.iter().zip(self.places.chunks_exact(self.dimension)) {
            for (i, at) in at.iter().enumerate() {
                let dof = node * self.dimension + i;
                // A NaN is not within.
                within &=
                    (before[dof] - at).abs() <= self.clearance && (now[dof] - at).abs() <= self.clearance;
            }
        }
        within
    }

    /// Stores the clearance after a search up to the positions `now`, from the boxes of all facets
    /// and of all nodes, which were grown by m and n of their sizes.
    pub fn searched(&mut self, [facets, nodes]: [&Bounds; 2], [m, n]: [f64; 2], now: &[f64]) {
        let low = facets.low();
        let high = facets.high();
        let between = |i: usize| (nodes.low()[i] - high[i]).max(low[i] - nodes.high()[i]);
        let between = (0..self.dimension).map(between).fold(0.0, f64::max);
        let growth = 3.0 * (self.weight * (1.0 + 2.0 * m) + 1.0 + 2.0 * n);
        let far = between + facets.size() + nodes.size();
        self.clearance = ((between - ROUND_OFF * far) / growth).max(0.0);
        self.margin = m;
        self.places.clear();
        if self.clearance > 0.0 {
            let of_node = |&node: &usize| &now[node * self.dimension..(node + 1) * self.dimension];
            self.places.extend(self.nodes.iter().flat_map(of_node));
        }
    }
}
