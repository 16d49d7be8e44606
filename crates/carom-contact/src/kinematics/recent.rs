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

/// Facet and ξ of possible contact of a node, if there is one.
pub(crate) type Candidate<X> = Option<(usize, X)>;

/// Nodes of both sides, and what a search found, with coordinates X of a facet.
#[derive(Clone, Debug)]
pub(crate) struct Recent<X> {
    nodes: Vec<usize>,
    dimension: usize,
    /// 2√3 (1 + A).
    weight: f64,
    margin: f64,
    /// Coordinates at the start and at the end of the step.
    places: [Vec<f64>; 2],
    /// Of each secondary node without a pair: a candidate that is open by more than the separation,
    /// or that there is none.
    found: Vec<Option<Candidate<X>>>,
}

impl<X: Copy> Recent<X> {
    /// Of the nodes of both sides, ascending, with A; `secondary`: number of secondary nodes.
    pub(crate) fn new(nodes: Vec<usize>, dimension: usize, weight: f64, secondary: usize) -> Self {
        let weight = 2.0 * 3.0_f64.sqrt() * (1.0 + weight);
        let places = [Vec::new(), Vec::new()];
        Self { nodes, dimension, weight, margin: f64::NAN, places, found: vec![None; secondary] }
    }

    /// Whether a search between these positions repeats the last one, up to `separation`.
    pub(crate) fn repeats(&self, margin: f64, [before, now]: [&[f64]; 2], separation: f64) -> bool {
        let reach = separation / self.weight;
        // A NaN is not within.
        let close = |a: &f64, b: f64| (a - b).abs() <= reach;
        margin == self.margin
            && !self.places[0].is_empty()
            && self.of_nodes(before).zip(&self.places[0]).all(|(x, at)| x == *at)
            && self.of_nodes(now).zip(&self.places[1]).all(|(x, at)| close(at, x))
    }

    /// A search between these positions begins: nothing is known of it.
    pub(crate) fn begin(&mut self, margin: f64, ends: [&[f64]; 2]) {
        self.margin = margin;
        for (k, y) in ends.into_iter().enumerate() {
            let mut places = std::mem::take(&mut self.places[k]);
            places.clear();
            places.extend(self.of_nodes(y));
            self.places[k] = places;
        }
        self.found.fill(None);
    }

    /// Forgets the search.
    pub(crate) fn forget(&mut self) {
        self.places[0].clear();
    }

    /// What was found of a secondary node.
    pub(crate) fn set(&mut self, node: usize, candidate: Candidate<X>) {
        self.found[node] = Some(candidate);
    }

    /// What the last search found of a secondary node.
    pub(crate) fn get(&self, node: usize) -> Option<Candidate<X>> {
        self.found[node]
    }

    fn of_nodes<'a>(&'a self, y: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let of_node = |&node: &usize| &y[node * self.dimension..(node + 1) * self.dimension];
        self.nodes.iter().flat_map(of_node).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes 0 and 2 in the plane, A = 1: positions may change by s/(4√3).
    #[test]
    fn a_search_is_repeated_up_to_what_certificates_leave() {
        let mut recent: Recent<f64> = Recent::new(vec![0, 2], 2, 1.0, 1);
        let (before, now) = ([0.0, 0.0, 9.0, 9.0, 3.0, 1.0], [0.1, 0.0, 9.0, 9.0, 3.0, 1.0]);
        let (separation, margin) = (4.0 * 3.0_f64.sqrt(), 0.5);
        let with = |dof: usize, by: f64| {
            let mut moved = now;
            moved[dof] += by;
            moved
        };
        assert!(!recent.repeats(margin, [&before, &now], separation));
        recent.begin(margin, [&before, &now]);
        assert_eq!(recent.get(0), None);
        recent.set(0, Some((7, 0.5)));
        assert!(recent.repeats(margin, [&before, &with(4, 0.99)], separation));
        assert!(!recent.repeats(margin, [&before, &with(4, 1.01)], separation));
        assert!(!recent.repeats(margin, [&before, &with(0, f64::NAN)], separation));
        // Node 1 belongs to neither side. The start must be the same to the last bit.
        assert!(recent.repeats(margin, [&before, &with(3, 5.0)], separation));
        assert!(!recent.repeats(margin, [&with(0, -0.1 + 1e-16), &now], separation));
        assert!(!recent.repeats(0.4, [&before, &now], separation));
        assert_eq!(recent.get(0), Some(Some((7, 0.5))));
        recent.forget();
        assert!(!recent.repeats(margin, [&before, &now], separation));
        recent.begin(margin, [&before, &now]);
        assert_eq!(recent.get(0), None);
    }
}
