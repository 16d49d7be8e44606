//! Nodes in space that enter a body and leave it again within one step.

use carom_contact::{Boundary, Kinematics, NodeToPatch, Passed};
use carom_solid::FacetShape;

/// A prism 0 ≤ z ≤ 1 over a polygon, whose ends are divided into quadrilaterals, and whose
/// facets over some edges are the side; the last node moves from `start` to `end`, all of it
/// with another motion as well.
fn through_prism(
    polygon: &[[f64; 2]],
    ends: &[[usize; 4]],
    side: &[usize],
    [start, end, with]: [[f64; 3]; 3],
) -> Option<Passed> {
    let n = polygon.len();
    let over = |k: usize| vec![k, (k + 1) % n, n + (k + 1) % n, n + k];
    let below = ends.iter().map(|end| end.iter().rev().copied().collect());
    let above = ends.iter().map(|end| end.iter().map(|k| n + k).collect());
    let of_side: Vec<Vec<usize>> = side.iter().map(|&k| over(k)).collect();
    let others = (0..n).filter(|k| !side.contains(k)).map(over);
    let rest: Vec<Vec<usize>> = others.chain(below).chain(above).collect();
    let boundary = Boundary::new(FacetShape::Q4, &of_side, &rest, 0);
    assert!(boundary.is_whole());
    let contact = NodeToPatch::new(vec![2 * n], boundary);
    let layers = [0.0, 1.0].into_iter().flat_map(|z| polygon.iter().map(move |p| [p[0], p[1], z]));
    let nodes: Vec<[f64; 3]> = layers.collect();
    let before = [nodes.as_flattened(), &start[..]].concat();
    let now: Vec<f64> = [nodes.as_flattened(), &end[..]].concat();
    let now: Vec<f64> = now.iter().enumerate().map(|(dof, x)| x + with[dof % 3]).collect();
    contact.passed(&before, &now, 0.01)
}

/// A plate −1 ≤ x ≤ 1, −0.1 ≤ y ≤ 0, of which the top is the side.
fn through_plate(start: [f64; 3], end: [f64; 3], with: [f64; 3]) -> Option<Passed> {
    let plate = [[-1.0, -0.1], [0.0, -0.1], [1.0, -0.1], [1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]];
    through_prism(&plate, &[[0, 1, 4, 5], [1, 2, 3, 4]], &[3, 4], [start, end, with])
}

#[test]
fn a_node_that_leaves_past_the_end_of_the_side_is_found() {
    for with in [[0.0; 3], [3.0, -7.0, 2.0]] {
        // Through the plate from x = 0.5 to x = 0.7, and on to x = 2.5.
        let found = through_plate([0.1, 0.2, 0.4], [2.5, -1.0, 0.6], with).unwrap();
        assert_eq!(found.node, 12);
        assert!((found.depth - 0.05).abs() < 1e-6, "{found:?}");
        assert!((found.limit - 0.01).abs() < 1e-12);
    }
}

#[test]
fn a_node_that_stays_outside_or_inside_or_cuts_off_a_corner_is_not() {
    let passed =
        |from: [f64; 2], to: [f64; 2]| through_plate([from[0], from[1], 0.4], [to[0], to[1], 0.6], [0.0; 3]);
    assert_eq!(passed([1.01, 0.2], [1.01, -1.0]), None);
    assert_eq!(passed([-3.0, 0.01], [3.0, 0.01]), None);
    assert_eq!(passed([0.1, 0.2], [0.1, -0.05]), None);
    // 0.001 of the top and of the end: 0.0005 deep at most.
    assert_eq!(passed([0.899, 0.1], [1.1, -0.101]), None);
    assert!(passed([0.8, 0.1], [1.1, -0.2]).is_some());
    // Beside the plate in the third direction.
    assert_eq!(through_plate([0.1, 0.2, 1.01], [2.5, -1.0, 1.2], [0.0; 3]), None);
}

#[test]
fn thin_walls_of_a_hollow_body_are_not_missed() {
    // The way from the first entry, x = 0, to the last exit, x = 2.06, is outside for 94 %.
    let channel = [
        [0.0, 0.0],
        [2.06, 0.0],
        [2.06, 1.0],
        [2.0, 1.0],
        [2.0, 0.06],
        [0.06, 0.06],
        [0.06, 1.0],
        [0.0, 1.0],
    ];
    let ends = [[0, 5, 6, 7], [0, 1, 4, 5], [1, 2, 3, 4]];
    let path = [[-1.0, 0.5, 0.45], [3.0, 0.5, 0.55], [0.0; 3]];
    let found = through_prism(&channel, &ends, &[7], path).unwrap();
    assert!((0.026..0.0301).contains(&found.depth), "{found:?}");
    let above = [[-1.0, 1.01, 0.45], [3.0, 1.01, 0.55], [0.0; 3]];
    assert_eq!(through_prism(&channel, &ends, &[7], above), None);
}

#[test]
fn a_node_with_a_pair_that_enters_elsewhere_has_another_one() {
    use carom_contact::{Pair, Pairing};
    // Between two walls x = 0 and x = 2 of one side.
    let wall = |x: f64, inwards: bool| {
        let corners = [[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 1.0, 1.0], [x, 0.0, 1.0]];
        if inwards { corners } else { [0, 3, 2, 1].map(|k| corners[k]) }
    };
    let nodes = [wall(0.0, true), wall(2.0, false)].concat();
    let facets = [vec![0, 1, 2, 3], vec![4, 5, 6, 7]];
    let contact = NodeToPatch::new(vec![8], Boundary::new(FacetShape::Q4, &facets, &[], 0));
    let at = |x: f64| [nodes.as_flattened(), &[x, 0.4, 0.6]].concat();
    let found = |to: f64| {
        let mut pairing = Pairing::new(vec![Pair::open(0, 0, 0.0)]);
        let changed = contact.search(&at(0.1), &at(to), &mut pairing, &mut Vec::new());
        (changed, pairing.pairs.iter().map(|pair| pair.facet).collect::<Vec<_>>())
    };
    assert_eq!(found(2.1), (true, vec![0, 1]));
    assert_eq!(found(1.9), (false, vec![0]));
    assert_eq!(found(-0.1), (false, vec![0]));
}
