//! How many boxes a query is compared with.

use super::*;

/// Boxes of the edges of a regular polygon rotated by an angle and stretched.
fn polygon(count: usize, turned: f64, stretched: f64) -> impl Fn(usize) -> Bounds {
    let at = move |k: usize| {
        let (sin, cos) = (turned + std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
        [stretched * cos, stretched * sin]
    };
    move |k| [at(k), at(k + 1)].iter().collect()
}

impl Tree {
    /// Number of boxes that a query is compared with.
    fn visited(&self, query: &Bounds) -> usize {
        let mut k = 0;
        let mut count = 0;
        while let Some(node) = self.nodes.get(k) {
            count += 1;
            k = if node.bounds.meets(query) { k + 1 } else { node.end };
        }
        count
    }
}

#[test]
fn a_query_costs_a_logarithm() {
    let mean = |count: usize| {
        let facet = polygon(count, 0.1, 1.0);
        let tree = Tree::new(count, &facet);
        (0..count).map(|k| tree.visited(&facet(k))).sum::<usize>() as f64 / count as f64
    };
    let means = [1_000, 10_000, 100_000].map(mean);
    // Two boxes per level, and a few for neighbours: a decade has 3.3 levels.
    assert!(means[0] < 3.0 * 10.0, "{means:?}");
    assert!(means.windows(2).all(|m| m[1] - m[0] < 3.0 * 3.4), "{means:?}");
}

#[test]
fn a_tree_that_has_become_poor_is_built_anew() {
    let count = 512;
    let mut tree = Tree::new(count, polygon(count, 0.0, 1.0));
    // Uniform scaling and rotation do not degrade a tree.
    assert!(!tree.update(polygon(count, 0.0, 7.0)));
    assert!(!tree.update(polygon(count, 1.0, 1.0)));
    // Neighbouring facets are far apart.
    let facet = polygon(count, 0.0, 1.0);
    let shuffled = |k: usize| facet(k * 201 % count);
    assert!(tree.update(shuffled));
    assert!(!tree.update(shuffled));
    let fresh = Tree::new(count, shuffled);
    let query = shuffled(100);
    assert_eq!(tree.visited(&query), fresh.visited(&query));
}
