//! The facet that a node without a pair may have reached in a step: the first one that its path
//! crosses, else the nearest one that it was not behind before.

use carom_contact::{Boundary, Kinematics, NodeToPatch, Pairing};
use carom_solid::FacetShape;

/// Four nodes over a square of four facets: one near it, one that enters, two far away. A
/// search that repeats another one finds what a first one does.
#[test]
fn a_repeated_search_finds_the_same() {
    let grid = (0..9).flat_map(|k| [f64::from(k % 3), f64::from(k / 3), 0.0]);
    let grid: Vec<f64> = grid.collect();
    let facets: Vec<Vec<usize>> = [0, 1, 3, 4].map(|k| vec![k, k + 1, k + 4, k + 3]).to_vec();
    let contact = || NodeToPatch::new((9..13).collect(), Boundary::new(FacetShape::Q4, &facets, &[], 0));
    let at = |heights: [f64; 4]| {
        let xy = [[0.4, 0.3], [1.6, 1.2], [0.5, 1.5], [1.5, 0.4]];
        let nodes = xy.iter().zip(heights).flat_map(|([x, y], z)| [*x, *y, z]);
        [grid.clone(), nodes.collect()].concat()
    };
    let before = at([0.3, 0.2, 5.0, 5.0]);
    let now = at([0.05, -0.1, 4.9, 4.9]);
    let again = at([0.05 + 1e-9, -0.1, 4.9, 4.9]);
    let search = |contact: &NodeToPatch, now: &[f64], fresh: bool| {
        let mut pairing = Pairing::new(Vec::new());
        pairing.fresh = fresh;
        let changed = contact.search(&before, now, &mut pairing, &mut Vec::new());
        (changed, pairing.pairs)
    };
    let first = contact();
    let other = contact();
    let known = search(&first, &now, true);
    assert_eq!(known.1.iter().map(|pair| (pair.node, pair.facet)).collect::<Vec<_>>(), [(0, 0), (1, 3)]);
    assert_eq!(search(&first, &again, false), search(&other, &again, true));
    // Beyond what the certificates leave, everything is searched: the first node enters, too.
    let deep = at([-0.05, -0.1, 4.9, 4.9]);
    assert_eq!(search(&first, &deep, false), search(&contact(), &deep, true));
}
