//! Nodes that enter a body and leave it again within one step, in the plane.

use carom_contact::{Detection, Kinematics, NodeToFacet, Passed, Surface};
use carom_solid::FacetShape;

/// A plate −1 ≤ x ≤ 1, −0.1 ≤ y ≤ 0 of two facets along its length, of which those at the top
/// are the side; node 6 moves from `start` to `end`, all of it with another motion as well.
fn passed_by(start: [f64; 2], end: [f64; 2], with: [f64; 2]) -> Option<Passed> {
    bounced(start, end, with, 0.01)
}

fn bounced(start: [f64; 2], end: [f64; 2], with: [f64; 2], bounce: f64) -> Option<Passed> {
    let plate = [[-1.0, -0.1], [0.0, -0.1], [1.0, -0.1], [1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]];
    let facet = |k: usize| vec![k, (k + 1) % 6];
    let surface = Surface::new(FacetShape::L2, &[facet(3), facet(4)], &[1.0; 2]);
    let surface = surface.bounded_by(&[facet(0), facet(1), facet(2), facet(5)], 0);
    let contact = NodeToFacet::new(vec![6], surface, Detection::ClosestPoint);
    let before: Vec<f64> = plate.iter().chain([&start]).flatten().copied().collect();
    let moved = plate.iter().chain([&end]).map(|p| [p[0] + with[0], p[1] + with[1]]);
    contact.passed(&before, &moved.flatten().collect::<Vec<_>>(), bounce)
}

#[test]
fn a_node_that_leaves_past_the_end_of_the_side_is_found() {
    for with in [[0.0, 0.0], [3.0, -7.0]] {
        // Through the plate from x = 0.5 to x = 0.7, and on to x = 2.5.
        let found = passed_by([0.1, 0.2], [2.5, -1.0], with).unwrap();
        assert_eq!(found.node, 6);
        assert!((found.depth - 0.05).abs() < 1e-6, "{found:?}");
        assert!((found.limit - 0.01).abs() < 1e-12);
    }
}

#[test]
fn a_node_that_stays_outside_or_inside_or_cuts_off_a_corner_is_not() {
    // Beside the end, above, and inside at the end.
    assert_eq!(passed_by([1.01, 0.2], [1.01, -1.0], [0.0; 2]), None);
    assert_eq!(passed_by([-3.0, 0.01], [3.0, 0.01], [0.0; 2]), None);
    assert_eq!(passed_by([0.1, 0.2], [0.1, -0.05], [0.0; 2]), None);
    // 0.001 of the top and of the end, which is 0.1 long: 0.0005 deep at most.
    assert_eq!(passed_by([0.899, 0.1], [1.1, -0.101], [0.0; 2]), None);
    assert!(passed_by([0.8, 0.1], [1.1, -0.2], [0.0; 2]).is_some());
}

#[test]
fn a_node_that_leaves_where_it_entered_may_be_as_deep_as_a_contact_allows() {
    // Through a low ridge of the top, 0.04 deep; its facets are 1 long.
    let bounce = |share: f64| {
        let plate = [[-1.0, -0.1], [0.0, -0.1], [1.0, -0.1], [1.0, 0.0], [0.0, 0.08], [-1.0, 0.0]];
        let facet = |k: usize| vec![k, (k + 1) % 6];
        let surface = Surface::new(FacetShape::L2, &[facet(3), facet(4)], &[1.0; 2]);
        let surface = surface.bounded_by(&[facet(0), facet(1), facet(2), facet(5)], 0);
        let contact = NodeToFacet::new(vec![6], surface, Detection::ClosestPoint);
        let at = |x: f64| plate.into_iter().chain([[x, 0.04]]).flatten().collect::<Vec<_>>();
        contact.passed(&at(-0.9), &at(0.9), share)
    };
    let found = bounce(0.01).unwrap();
    assert!((found.depth - 0.04 / f64::hypot(1.0, 0.08)).abs() < 1e-6, "{found:?}");
    assert_eq!(bounce(0.25), None);
    // Through the plate, however much a bounce may have.
    assert!(bounced([0.1, 0.2], [2.5, -1.0], [0.0; 2], 0.25).is_some());
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
    let facet = |k: usize| vec![k, (k + 1) % 8];
    let rest: Vec<_> = (0..7).map(facet).collect();
    let surface = Surface::new(FacetShape::L2, &[facet(7)], &[1.0]).bounded_by(&rest, 0);
    let contact = NodeToFacet::new(vec![8], surface, Detection::ClosestPoint);
    let at = |x: f64, y: f64| [channel.as_flattened(), &[x, y]].concat();
    let found = contact.passed(&at(-1.0, 0.5), &at(3.0, 0.5), 0.01).unwrap();
    assert!((0.026..0.0301).contains(&found.depth), "{found:?}");
    assert_eq!(contact.passed(&at(-1.0, 1.01), &at(3.0, 1.01), 0.01), None);
}

#[test]
fn a_node_with_a_pair_that_enters_elsewhere_has_another_one() {
    use carom_contact::{Pair, Pairing};
    // Between the inner walls of a channel, with an open pair with the left one.
    let channel =
        [[0.0, 0.0], [2.5, 0.0], [2.5, 1.0], [2.0, 1.0], [2.0, 0.5], [0.5, 0.5], [0.5, 1.0], [0.0, 1.0]];
    let facet = |k: usize| vec![k, (k + 1) % 8];
    let rest: Vec<_> = [0, 1, 2, 6, 7].map(facet).into();
    let side = [facet(3), facet(4), facet(5)];
    let surface = Surface::new(FacetShape::L2, &side, &[1.0; 3]).bounded_by(&rest, 0);
    let contact = NodeToFacet::new(vec![8], surface, Detection::ClosestPoint);
    let at = |x: f64, y: f64| [channel.as_flattened(), &[x, y]].concat();
    let found = |to: Vec<f64>| {
        let mut pairing = Pairing::new(vec![Pair::open(0, 2, 0.0)]);
        let changed = contact.search(&at(0.6, 0.75), &to, &mut pairing, &mut Vec::new());
        (changed, pairing.pairs.iter().map(|pair| pair.facet).collect::<Vec<_>>())
    };
    assert_eq!(found(at(2.1, 0.75)), (true, vec![2, 0]));
    assert_eq!(found(at(1.9, 0.75)), (false, vec![2]));
    assert_eq!(found(at(0.45, 0.75)), (false, vec![2]));
}

#[test]
fn a_node_that_starts_or_ends_at_a_depth_that_it_may_have_is_not_forgotten() {
    // The node may be 0.02 deep, is 0.015 deep at one end of its way, and 0.05 deep on it.
    let plate = [[-1.0, -0.1], [0.0, -0.1], [1.0, -0.1], [1.0, 0.0], [0.0, 0.0], [-1.0, 0.0]];
    let facet = |k: usize| vec![k, (k + 1) % 6];
    let surface = Surface::new(FacetShape::L2, &[facet(3), facet(4)], &[1.0; 2]);
    let surface = surface.bounded_by(&[facet(0), facet(1), facet(2), facet(5)], 0);
    let contact = NodeToFacet::new(vec![6], surface, Detection::ClosestPoint).with_allowed(vec![0.02]);
    let at = |x: f64, y: f64| [plate.as_flattened(), &[x, y]].concat();
    let inside = at(0.2, -0.015);
    let below = at(0.4, -0.5);
    for [from, to] in [[&inside, &below], [&below, &inside]] {
        let found = contact.passed(from, to, 0.01).unwrap();
        assert!((0.044..0.0501).contains(&found.depth), "{found:?}");
    }
    assert_eq!(contact.passed(&inside, &at(0.4, 0.5), 0.01), None);
    assert_eq!(contact.passed(&inside, &at(0.4, -0.01), 0.01), None);
}
