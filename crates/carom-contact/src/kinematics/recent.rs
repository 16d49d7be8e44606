//! The last search of a solve. A node without a candidate keeps having none, and an open candidate
//! stays open, while positions at the end of the step change by less than the distance that
//! certificates leave: Newton's method converges, and most of the searches of a solve repeat the
//! one before.
//!
//! ```text
//! δ = largest change of a coordinate at the end of the step
//! distance of a node to a facet, anywhere on their paths    > s − 2√3 (1 + A) δ
//! ```
//!
//! with s the separation of the certified test (`swept`), A as in `apart.rs`, and δ for what was
//! found at one repetition and is used at another. No search outlives its solve, so that results do
//! not depend on where a run was resumed.

use super::facets::OnFacet;

/// The point of possible contact of a node, if there is one.
pub type Candidate<X> = Option<OnFacet<X>>;

/// Cache of the last search of a solve: the positions of the nodes of both sides and the candidates
/// found, with coordinates of type X on a facet.
#[derive(Clone, Debug)]
pub struct Recent<X> {
    nodes: Vec<usize>,
    dimension: usize,
    /// Factor 2√3 (1 + A) by which a change of a coordinate may reduce the distance of a node from
    /// a facet.
    weight: f64,
    margin: f64,
    /// Coordinates at the start and at the end of the step.
    places: [Vec<f64>; 2],
    /// Result for each secondary node without a pair: a candidate that is open by more than the
    /// separation, or that there is none; nothing if it has to be searched again.
    found: Vec<Option<Candidate<X>>>,
}

impl<X: Copy> Recent<X> {
    /// An empty cache for the nodes of both sides, ascending; `weight`: bound A of the sum of the
    /// weights of a facet's nodes; `secondary`: number of secondary nodes.
    pub fn new(nodes: Vec<usize>, dimension: usize, weight: f64, secondary: usize) -> Self {
        let weight = 2.0 * 3.0_f64.sqrt() * (1.0 + weight);
        let places = [Vec::new(), Vec::new()];
        Self { nodes, dimension, weight, margin: f64::NAN, places, found: vec![None; secondary] }
    }

    /// Whether a search between two positions is so close to the last one that its results hold,
    /// given the separation of the certified test.
    pub fn repeats(&self, margin: f64, [before, now]: [&[f64]; 2], separation: f64) -> bool {
        let reach = separation / self.weight;
        // A NaN is not within.
        let close = |a: &f64, b: f64| (a - b).abs() <= reach;
        margin == self.margin
            && !self.places[0].is_empty()
            && self.of_nodes(before).zip(&self.places[0]).all(|(x, at)| x == *at)
            && self.of_nodes(now).zip(&self.places[1]).all(|(x, at)| close(at, x))
    }

    /// Begins a search between two positions, without results.
    pub fn begin(&mut self, margin: f64, ends: [&[f64]; 2]) {
        self.margin = margin;
        for (k, y) in ends.into_iter().enumerate() {
            let mut places = std::mem::take(&mut self.places[k]);
            places.clear();
            places.extend(self.of_nodes(y));
            self.places[k] = places;
        }
        self.found.fill(None);
    }

    /// Forgets the last search.
    pub fn forget(&mut self) {
        self.places[0].clear();
    }

    /// Stores the candidate of a secondary node, or that there is none.
    pub fn set(&mut self, node: usize, candidate: Candidate<X>) {
        self.found[node] = Some(candidate);
    }

    /// Candidate of a secondary node in the last search, or that there is none; nothing if it was
    /// not stored.
    pub fn get(&self, node: usize) -> Option<Candidate<X>> {
        self.found[node]
    }

    fn of_nodes<'a>(&'a self, y: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let of_node = |&node: &usize| &y[node * self.dimension..(node + 1) * self.dimension];
        self.nodes.iter().flat_map(of_node).copied()
    }
}
