//! Nodes that several ties hold.

use carom_run::build::tie_links::Links;

fn node(carrier: usize) -> Vec<(usize, f64)> {
    vec![(carrier, 1.0)]
}

/// Four nodes at one place with any three of their four ties, and the fourth, are one node.
#[test]
fn a_circle_of_ties_is_closed_by_all_but_one() {
    let ties = [(0, 1), (2, 3), (0, 2), (3, 1)];
    for first in 0..4 {
        let mut links = Links::default();
        for k in 0..4 {
            let (secondary, primary) = ties[(first + k) % 4];
            links.tie(k, secondary, node(primary));
        }
        assert_eq!(links.points().len(), 3);
        let ends: Vec<usize> = (0..4).map(|node| links.end(node)).collect();
        assert!(ends.iter().all(|end| *end == ends[0]), "{links:?}");
    }
}

/// Nodes at one place that are tied to a facet as well, in any order, are all carried by it;
/// the second facet is left out.
#[test]
fn one_facet_carries_all_nodes_at_a_place() {
    let facet = vec![(7, 0.5), (8, 0.5)];
    let ties = [(0, facet), (0, node(1)), (2, node(1))];
    for order in [[0, 1, 2], [1, 0, 2], [1, 2, 0], [2, 1, 0]] {
        let mut links = Links::default();
        for k in order {
            let (secondary, primary) = &ties[k];
            links.tie(k, *secondary, primary.clone());
        }
        assert_eq!(links.points().len(), 3, "{links:?}");
        assert!((0..3).all(|node| links.end(node) == 0), "{links:?}");
        assert_eq!(links.tied(0), [vec![0], vec![]]);
        assert_eq!(links.tied(1), [vec![], vec![1]]);
        assert_eq!(links.tied(2), [vec![2], vec![]]);
        links.tie(3, 2, vec![(5, 0.5), (6, 0.5)]);
        assert_eq!(links.points().len(), 3);
    }
}
