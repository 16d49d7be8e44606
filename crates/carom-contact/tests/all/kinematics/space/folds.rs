//! Which parts of a body's boundary in space can meet each other.

use carom_contact::kinematics::space::folds::{PatchFolds, update_normals};
use carom_contact::kinematics::space::patch::place;
use carom_contact::{Boundary, Side};
use carom_solid::FacetShape;

/// A prism over a polygon, counter-clockwise, from z = 0 to 1; its ends are divided into these
/// quadrilaterals. Facet k lies over the edge from corner k.
fn prism(polygon: &[[f64; 2]], ends: &[[usize; 4]]) -> (Boundary, Vec<f64>) {
    let n = polygon.len();
    let layers = [0.0, 1.0].into_iter().flat_map(|z| polygon.iter().flat_map(move |p| [p[0], p[1], z]));
    let over = |k: usize| vec![k, (k + 1) % n, n + (k + 1) % n, n + k];
    let below = ends.iter().map(|end| end.iter().rev().copied().collect());
    let above = ends.iter().map(|end| end.iter().map(|k| n + k).collect());
    let facets: Vec<Vec<usize>> = (0..n).map(over).chain(below).chain(above).collect();
    let boundary = Boundary::new(FacetShape::Q4, &facets, &[], 0);
    assert!(boundary.is_whole());
    (boundary, layers.collect())
}

/// Whether a node may reach a facet.
fn meet((boundary, y): &(Boundary, Vec<f64>), node: usize, facet: usize) -> bool {
    let folds = PatchFolds::new(boundary, &vec![0; y.len() / 3], 0, y);
    let mut normals = Vec::new();
    update_normals(boundary, y, &mut normals);
    let met = folds.met(node, facet, |facet| normals[facet]);
    assert!(met.is_none_or(|side| folds.admits(side, node, facet)));
    // A node behind a facet does not come from outside.
    met.is_some() && boundary.height(facet, place(y, node), y).height > -1e-9
}

/// A block with a slot from the top: corners 3, 4 on its right flank, 5 at the tip, 6, 7 on the
/// left.
fn slotted(half: f64) -> (Boundary, Vec<f64>) {
    let polygon = [
        [-2.0, 0.0],
        [2.0, 0.0],
        [2.0, 2.0],
        [half, 2.0],
        [0.5 * half, 1.5],
        [0.0, 1.0],
        [-0.5 * half, 1.5],
        [-half, 2.0],
        [-2.0, 2.0],
    ];
    // The ends are not plane figures without overlap; here only their edges count.
    prism(&polygon, &[[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 7], [0, 7, 8, 8]])
}

#[test]
fn the_flanks_of_a_slot_meet_up_to_its_tip_even_if_it_is_closed() {
    for half in [0.3, 1e-3, 0.0] {
        let block = slotted(half);
        for (node, facet) in [(4, 5), (4, 6), (3, 6), (6, 4), (6, 3), (7, 3)] {
            assert!(meet(&block, node, facet), "{half}: node {node}, facet {facet}");
        }
        // Along one flank, over its mouth, and through the body.
        for (node, facet) in [(4, 3), (4, 4), (3, 4), (2, 3), (3, 1), (5, 0)] {
            assert!(!meet(&block, node, facet), "{half}: node {node}, facet {facet}");
        }
    }
}

/// A plate of two cells, 0.01 thick: corners 0, 1, 2 below and 3, 4, 5 above.
#[test]
fn the_faces_of_a_wall_do_not_meet_however_thin_it_is() {
    for thickness in [1e-4, 0.01, 1.0] {
        let polygon =
            [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, thickness], [1.0, thickness], [0.0, thickness]];
        let plate = prism(&polygon, &[[0, 1, 4, 5], [1, 2, 3, 4]]);
        for node in 0..12 {
            for facet in 0..10 {
                assert!(!meet(&plate, node, facet), "{thickness}: node {node}, facet {facet}");
            }
        }
    }
}

#[test]
fn a_convex_body_meets_itself_nowhere_and_a_hole_its_other_side() {
    let n: usize = 12;
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / n as f64;
    let circle: Vec<[f64; 2]> = (0..n).map(|k| [angle(k).cos(), angle(k).sin()]).collect();
    let ends = [[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 7], [0, 7, 8, 9], [0, 9, 10, 11]];
    let disc = prism(&circle, &ends);
    assert!((0..2 * n).all(|node| (0..n).all(|facet| !meet(&disc, node, facet))));
    // Seen from inside, it is a hole whose opposite sides may meet, but not its neighbours.
    let inside: Vec<[f64; 2]> = circle.into_iter().rev().collect();
    let hole = prism(&inside, &ends);
    assert!(meet(&hole, 0, 5) && meet(&hole, 0, 6) && !meet(&hole, 0, 1) && !meet(&hole, 0, 10));
}

#[test]
fn of_two_places_that_meet_one_is_the_later() {
    let slot = slotted(0.3);
    let folds = PatchFolds::new(&slot.0, &[0; 18], 0, &slot.1);
    let mut normals = Vec::new();
    update_normals(&slot.0, &slot.1, &mut normals);
    let later =
        |node: usize, facet: usize| folds.met(node, facet, |facet| normals[facet]) == Some(Side::Later);
    // All nodes of the left flank, whose facets come after those of the right one.
    assert!(later(6, 4) && later(6, 3) && later(7, 3));
    assert!(!later(4, 5) && !later(4, 6) && !later(3, 6));
}

/// In a block with a deep slot the flanks bound walls; its outer sides bound none with each other:
/// between them lies free space.
#[test]
fn what_lies_beyond_a_slot_is_no_face_of_a_wall() {
    let polygon =
        [[-2.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.3, 2.0], [0.3, 0.2], [-0.3, 0.2], [-0.3, 2.0], [-2.0, 2.0]];
    let (boundary, y) = prism(&polygon, &[[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 7]]);
    let folds = PatchFolds::new(&boundary, &[0; 16], 0, &y);
    let mut normals = Vec::new();
    update_normals(&boundary, &y, &mut normals);
    let may_meet = |node: usize, facet: usize| folds.met(node, facet, |facet| normals[facet]).is_some();
    // The right side and the right flank, then the two outer sides.
    assert!(!may_meet(2, 3) && !may_meet(1, 3));
    assert!(may_meet(2, 7) && may_meet(7, 1));
}
