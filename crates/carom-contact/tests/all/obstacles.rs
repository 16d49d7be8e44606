//! Rigid obstacles: gaps against elementary geometry, gradient and second derivative against
//! differences, corners.

use carom_contact::{
    Carrier, ContactError, Kinematics, NodeToObstacle, Obstacle, Pair, PairEvent, Pairing, Polyline,
    PolylineError, Rows,
};

use super::near_obstacle::{derivatives_agree, measured_in};

const SQUARE: [[f64; 2]; 5] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]];

fn polyline(points: &[[f64; 2]], radius: f64) -> NodeToObstacle {
    NodeToObstacle::new(vec![0], 2, Obstacle::Polyline(Polyline::new(points, radius).unwrap()))
}

fn distance(contact: &NodeToObstacle, x: f64, y: f64) -> f64 {
    contact.signed_distance(0, &[x, y]).unwrap()
}

fn measured(contact: &NodeToObstacle, pair: &mut Pair, y: &[f64]) -> (f64, Vec<f64>) {
    measured_in(2, contact, pair, y)
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-14, "{a} {b}");
}

#[test]
fn distances_to_a_square_are_elementary() {
    // Counter-clockwise: the square is rigid. Clockwise: it is a box.
    let block = polyline(&SQUARE, 0.0);
    let mut reversed = SQUARE;
    reversed.reverse();
    let room = polyline(&reversed, 0.0);
    for (x, y, d) in
        [(1.0, -0.5, 0.5), (5.0, 6.0, 5.0), (1.0, 0.25, -0.25), (-3.0, -4.0, 5.0), (1.9, 1.0, -0.1)]
    {
        close(distance(&block, x, y), d);
        close(distance(&room, x, y), -d);
    }
    // Rounding moves the corner by (√2 − 1) r along its bisector, inside as outside.
    let round = polyline(&SQUARE, 0.5);
    let hollow = polyline(&reversed, 0.5);
    let gap = (2.0_f64.sqrt() - 1.0) * 0.5;
    close(distance(&round, 2.0, 2.0), gap);
    close(distance(&hollow, 2.0, 2.0), -gap);
    close(distance(&round, 2.0, 1.0), 0.0);
    // An open chain has no ends.
    let slope = polyline(&[[0.0, 0.0], [-1.0, 0.0]], 0.0);
    close(distance(&slope, 50.0, 3.0), 3.0);
    close(distance(&slope, -50.0, -2.0), -2.0);
}

#[test]
fn impossible_polylines_are_named() {
    let error = |points: &[[f64; 2]], radius| Polyline::new(points, radius).unwrap_err();
    assert_eq!(error(&[[0.0, 0.0]], 0.0), PolylineError::TooFew);
    assert_eq!(error(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]], 0.0), PolylineError::Coincident(2, 3));
    assert_eq!(error(&[[0.0, 0.0], [1.0, 0.0], [0.5, 0.0]], 0.0), PolylineError::TurnsBack(2));
    let round = error(&SQUARE, 1.5);
    assert_eq!(round, PolylineError::TooRound { first: 1, second: 2, taken: 3.0, length: 2.0 });
}

/// A node, and one or three nodes of a carrier, near every kind of piece.
fn scenes() -> Vec<(NodeToObstacle, Vec<f64>)> {
    let room = [[2.0, 0.0], [0.0, 0.0], [0.0, 2.0], [2.0, 2.0], [2.0, 0.0]];
    let round = |points: &[[f64; 2]]| Obstacle::Polyline(Polyline::new(points, 0.4).unwrap());
    let shapes = [
        (Obstacle::plane(&[0.3, 0.1], &[1.0, 2.0]), [0.8, 0.4]),
        (Obstacle::circle(&[0.3, 0.1], 0.7, false), [0.9, 0.5]),
        (Obstacle::circle(&[0.3, 0.1], 2.0, true), [0.9, 0.5]),
        (round(&SQUARE), [2.1, 2.05]),
        (round(&SQUARE), [1.0, -0.2]),
        (round(&room), [0.15, 0.1]),
        (Obstacle::Polyline(Polyline::new(&SQUARE, 0.0).unwrap()), [2.3, 2.2]),
    ];
    let mut scenes = Vec::new();
    for (shape, at) in shapes {
        let fixed = NodeToObstacle::new(vec![0], 2, shape);
        let carrier = Carrier { nodes: vec![1], origin: [0.2, 0.3, 0.0], length: 1.3 };
        let turning = Carrier { nodes: vec![1, 2, 3], ..carrier.clone() };
        // Turned by 0.04 and moved.
        let (sin, cos) = 0.04_f64.sin_cos();
        let simplex = [0.21, 0.33, 0.21 + 1.3 * cos, 0.33 + 1.3 * sin, 0.21 - 1.3 * sin, 0.33 + 1.3 * cos];
        scenes.push((fixed.clone(), at.to_vec()));
        scenes.push((fixed.clone().carried_by(carrier), [&at[..], &[0.21, 0.33]].concat()));
        scenes.push((fixed.carried_by(turning), [&at[..], &simplex].concat()));
    }
    scenes
}

#[test]
fn gradient_and_second_derivative_agree_with_differences() {
    derivatives_agree(2, &scenes());
}

/// Turning and moving an obstacle together with the node changes nothing.
#[test]
fn the_gap_does_not_see_a_rigid_motion() {
    let (contact, y) = scenes().swap_remove(11);
    let (before, _) = measured(&contact, &mut Pair::open(0, 0, 0.0), &y);
    let (sin, cos) = 0.6_f64.sin_cos();
    let turned = |[x, y]: &[f64; 2]| [cos * x - sin * y + 3.0, sin * x + cos * y - 1.0];
    let moved: Vec<f64> = y.as_chunks::<2>().0.iter().flat_map(turned).collect();
    close(before, measured(&contact, &mut Pair::open(0, 0, 0.0), &moved).0);
}

fn searched(contact: &NodeToObstacle, pair: Pair, before: [f64; 2], now: [f64; 2]) -> (Pair, Vec<PairEvent>) {
    let mut pairing = Pairing::new(vec![pair]);
    let mut events = Vec::new();
    contact.search(&before, &now, &mut pairing, &mut events);
    (pairing.pairs[0], events)
}

/// Near a sharp corner the closest wall is not the one that was crossed.
#[test]
fn a_node_inside_keeps_the_side_it_came_through() {
    let block = polyline(&SQUARE, 0.0);
    let (mut pair, _) = searched(&block, Pair::open(0, 0, 0.0), [1.8, -0.1], [1.98, 0.1]);
    let (gap, gradient) = measured(&block, &mut pair, &[1.98, 0.1]);
    close(gap, -0.1);
    assert_eq!(gradient, [0.0, -1.0]);
    // The same place through the other wall.
    let (mut pair, _) = searched(&block, Pair::open(0, 0, 0.0), [2.1, 0.15], [1.98, 0.1]);
    close(measured(&block, &mut pair, &[1.98, 0.1]).0, 1.98 - 2.0);
}

#[test]
fn a_node_in_contact_slides_round_an_arc_off_a_sharp_corner_and_over_a_kink() {
    let active = |facet| Pair { active: true, lambda: -1.0, ..Pair::open(0, facet, 0.0) };
    // Round: pieces 0 (segment), 1 (arc), 2 (segment).
    let round = polyline(&SQUARE, 0.5);
    let on_arc = [1.5 + 0.3, 0.5 - 0.4];
    let (pair, events) = searched(&round, active(0), [1.0, 0.0], on_arc);
    assert!(pair.active && pair.facet == 1 && events.is_empty());
    close(measured(&round, &mut active(0), &on_arc).0, 0.0);
    close(measured(&round, &mut active(0), &[2.0, 1.0]).0, 0.0);
    // Sharp: on the line of its segment until the search releases it.
    let block = polyline(&SQUARE, 0.0);
    close(measured(&block, &mut active(0), &[2.1, 0.0]).0, 0.0);
    let (pair, events) = searched(&block, active(0), [1.9, 0.0], [2.1, 0.0]);
    assert!(!pair.active && events == [PairEvent::SlidOff { node: 0, facet: 0 }], "{pair:?} {events:?}");
    // Blunt: handed over, still in contact.
    let roof = polyline(&[[2.0, -0.3], [0.0, 0.0], [-2.0, -0.3]], 0.0);
    let (pair, events) = searched(&roof, active(0), [0.1, -0.015], [-0.1, 0.01]);
    assert!(pair.active && pair.facet == 2 && events.len() == 1, "{pair:?} {events:?}");
}

#[test]
fn the_centre_of_a_circle_is_an_error_only_for_a_node_that_has_to_leave_it() {
    let at = |inside| {
        let contact = NodeToObstacle::new(vec![0], 2, Obstacle::circle(&[1.0, 1.0], 0.5, inside));
        contact.measure(&mut Pair::open(0, 0, 0.0), &[1.0, 1.0], &mut Rows::new(2))
    };
    assert_eq!(at(true), Ok(()));
    assert_eq!(at(false), Err(ContactError::Center { node: 0 }));
}

#[test]
fn a_path_through_an_obstacle_is_found_with_its_depth() {
    let circle = Obstacle::circle(&[1.0, 1.0], 0.5, false);
    let plate = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.1], [0.0, 0.1], [0.0, 0.0]];
    let plate = Obstacle::Polyline(Polyline::new(&plate, 0.0).unwrap());
    let passed = |shape: &Obstacle, from: [f64; 2], to: [f64; 2]| {
        let contact = NodeToObstacle::new(vec![0], 2, shape.clone()).with_lengths(vec![0.1]);
        let passed = contact.passed(&from, &to, 0.01)?;
        assert!((passed.limit - 1e-3).abs() < 1e-15 && passed.node == 0);
        Some(passed.depth)
    };
    // Chords at a distance from the centre, and through it; the ends may lie on the circle.
    for (x, depth) in [(1.0, 0.5), (1.3, 0.2), (0.6, 0.1), (1.49, 0.01)] {
        let end = f64::sqrt(0.25 - (x - 1.0_f64).powi(2));
        for (above, below) in [(3.0, -7.0), (1.0 + end, 1.0 - end), (1.0 + end + 1e-9, -2.0)] {
            let found = passed(&circle, [x, above], [x, below]).unwrap();
            assert!(found <= depth + 1e-12 && found > depth - 0.01, "{x}: {found}");
        }
    }
    for (from, to, depth) in
        [([0.5, 0.3], [0.5, -4.0], 0.05), ([-1.0, 0.03], [2.0, 0.03], 0.03), ([0.97, 0.1], [1.2, -0.3], 0.02)]
    {
        let found = passed(&plate, from, to).unwrap();
        assert!(found <= depth + 1e-12 && found > depth - 5e-3, "{from:?}: {found}");
    }
    // Beside it, along it, up to it, and deep inside at the end, which its gap says.
    for (from, to) in [([1.501, 3.0], [1.501, -3.0]), ([1.0, 3.0], [1.0, 1.5]), ([1.0, 3.0], [1.0, 1.2])] {
        assert_eq!(passed(&circle, from, to), None);
    }
    for (from, to) in [([-0.5, 0.1], [1.5, 0.1]), ([1.0, 0.2], [1.01, -0.2]), ([0.5, 0.2], [0.5, 0.1])] {
        assert_eq!(passed(&plate, from, to), None);
    }
    // From inside, every chord is free.
    let room = Obstacle::circle(&[1.0, 1.0], 0.5, true);
    assert_eq!(passed(&room, [0.5, 1.0], [1.5, 1.0]), None);
    // In the frame of an obstacle that moves with node 1: it passes the node.
    let carrier = Carrier { nodes: vec![1], origin: [1.0, 1.0, 0.0], length: 1.0 };
    let moving = NodeToObstacle::new(vec![0], 2, circle).with_lengths(vec![0.1]).carried_by(carrier);
    assert!(moving.passed(&[1.0, 2.0, 1.0, 1.0], &[1.0, 2.0, 1.0, 4.0], 0.01).is_some());
    assert!(moving.passed(&[1.0, 2.0, 1.0, 1.0], &[1.0, 5.0, 1.0, 4.0], 0.01).is_none());
}

/// Facets and gaps of the pairs of a node after a motion, with the first pair given.
fn found(contact: &NodeToObstacle, pairing: &mut Pairing, before: [f64; 2], now: [f64; 2]) -> Vec<f64> {
    contact.search(&before, &now, pairing, &mut Vec::new());
    let mut rows = Rows::new(2);
    pairing.pairs.iter_mut().for_each(|pair| contact.measure(pair, &now, &mut rows).unwrap());
    rows.iter().map(|row| row.gap).collect()
}

#[test]
fn a_node_behind_both_sides_of_a_concave_corner_has_a_pair_with_either() {
    let channel = polyline(&[[2.0, 4.0], [2.0, 0.0], [-2.0, 0.0], [-2.0, 4.0]], 0.0);
    let vee = polyline(&[[4.0, 4.0], [0.0, 0.0], [-4.0, 4.0]], 0.0);
    let depth = 0.02 * 0.5_f64.sqrt();
    let scenes = [
        (&channel, [2.0, 0.1], [2.02, -0.01], [-0.02, -0.01]),
        (&channel, [1.9, 0.0], [2.02, -0.01], [-0.02, -0.01]),
        (&channel, [-2.0, 0.1], [-2.02, -0.01], [-0.02, -0.01]),
        (&vee, [0.0, 0.1], [0.0, -0.02], [-depth, -depth]),
    ];
    for (contact, before, now, gaps) in scenes {
        let mut pairing = Pairing::default();
        let mut found = found(contact, &mut pairing, before, now);
        found.sort_by(f64::total_cmp);
        assert!(found.len() == 2 && (0..2).all(|i| (found[i] - gaps[i]).abs() < 1e-15), "{found:?}");
        assert!(pairing.pairs.iter().all(|pair| !pair.active));
    }
    // A node that slides up the wall, then along the floor, keeps its pair there.
    for (away, facet) in [([2.0, 1.0], 0), ([1.0, 0.0], 2)] {
        let mut pairing = Pairing::default();
        found(&channel, &mut pairing, [2.0, 0.1], [2.02, -0.01]);
        pairing.pairs.iter_mut().for_each(|pair| pair.active = pair.facet == facet);
        let gaps = found(&channel, &mut pairing, [2.0, 0.0], away);
        assert!(gaps == [0.0] && pairing.pairs[0].facet == facet, "{gaps:?} {:?}", pairing.pairs);
    }
    // Above the wall, past its other end, the floor of the next step.
    let steps = polyline(&[[8.0, 0.5], [2.0, 0.5], [2.0, 0.0], [-2.0, 0.0]], 0.0);
    for (now, count) in [([3.0, 0.49], 1), ([2.01, 0.2], 1), ([2.01, -0.01], 2), ([1.0, -0.01], 1)] {
        let mut pairing = Pairing::default();
        assert_eq!(found(&steps, &mut pairing, [1.9, 0.6], now).len(), count, "{now:?}");
    }
}
