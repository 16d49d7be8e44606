//! Which parts of a body's boundary can meet each other.

use std::f64::consts::PI;

use carom_contact::kinematics::folds::{Folds, Turns};
use carom_contact::places::Places;
use carom_contact::{Side, Surface};
use carom_solid::FacetShape;

/// A closed polygon, and whether a node faces a facet. The midside nodes are left out.
fn face(corners: &[[f64; 2]], node: usize, facet: usize) -> bool {
    let n = corners.len();
    let facets: Vec<Vec<usize>> = (0..n).map(|k| vec![k, (k + 1) % n]).collect();
    let surface = Surface::new(FacetShape::L2, &facets, &vec![1.0; n]);
    let folds = Folds::new(&surface, &vec![0; n], 0, corners.as_flattened());
    let mut turns = Turns::default();
    turns.update(&folds, &surface, Places::new(corners.as_flattened(), 2));
    let admitted = [Side::Later, Side::Earlier].map(|side| folds.admits(side, node, facet));
    assert!(admitted != [true, true]);
    admitted.contains(&true) && folds.face(&turns, node, facet)
}

/// A block with a slot from the top: nodes 3, 4 on its right flank, 5 at the tip, 6, 7 on the
/// left.
fn slotted(half: f64) -> Vec<[f64; 2]> {
    vec![
        [-2.0, 0.0],
        [2.0, 0.0],
        [2.0, 2.0],
        [half, 2.0],
        [0.5 * half, 1.5],
        [0.0, 1.0],
        [-0.5 * half, 1.5],
        [-half, 2.0],
        [-2.0, 2.0],
    ]
}

#[test]
fn the_flanks_of_a_slot_meet_up_to_its_tip_even_if_it_is_closed() {
    for half in [0.3, 1e-3, 0.0, -1e-3] {
        let block = slotted(half);
        // Facet k begins at node k.
        for (node, facet) in [(4, 5), (4, 6), (3, 6), (6, 4), (6, 3), (7, 3)] {
            assert!(face(&block, node, facet), "{half}: node {node}, facet {facet}");
        }
        // Along one flank, over its mouth, and through the body.
        for (node, facet) in [(4, 3), (4, 4), (3, 4), (1, 7), (0, 3), (2, 3), (3, 1), (5, 0)] {
            assert!(!face(&block, node, facet), "{half}: node {node}, facet {facet}");
        }
    }
}

#[test]
fn a_convex_body_meets_itself_nowhere() {
    // Wedges of 10° and less, with nodes on their flanks.
    for half in [0.0875, 0.03, 1e-3, 1e-6] {
        let wedge = [[0.0, 0.0], [1.0, -half], [2.0, -2.0 * half], [2.0, 2.0 * half], [1.0, half]];
        assert!((0..5).all(|node| (0..5).all(|facet| !face(&wedge, node, facet))), "{half}");
    }
    let disc: Vec<[f64; 2]> = (0..12).map(|k| f64::from(k) * PI / 6.0).map(|a| [a.cos(), a.sin()]).collect();
    assert!((0..12).all(|node| (0..12).all(|facet| !face(&disc, node, facet))));
    // Seen from inside, it is a hole whose opposite sides may meet, but not its neighbours.
    let hole: Vec<[f64; 2]> = disc.into_iter().rev().collect();
    assert!(face(&hole, 0, 5) && face(&hole, 0, 6) && !face(&hole, 0, 1) && !face(&hole, 0, 10));
}

#[test]
fn a_tongue_in_a_hole_does_not_meet_itself_through_its_material() {
    // A square hole, traversed with the body on the left, with a thin tongue from below.
    let hole = [
        [-2.0, 0.0],
        [-2.0, 3.0],
        [2.0, 3.0],
        [2.0, 0.0],
        [0.1, 0.0],
        [0.1, 1.0],
        [0.1, 2.0],
        [-0.1, 2.0],
        [-0.1, 1.0],
        [-0.1, 0.0],
    ];
    assert!(!face(&hole, 5, 8) && !face(&hole, 5, 7) && !face(&hole, 8, 5));
    assert!(face(&hole, 5, 2) && face(&hole, 8, 0) && face(&hole, 6, 1));
}
