//! Rigid cylinders and triangulated surfaces: gaps against elementary geometry, gradient and second
//! derivative against differences, the face through which a node entered, hand-over.

use carom_contact::{Carrier, Faceted, Kinematics, NodeToObstacle, Obstacle, Pair, PairEvent, Pairing, Rows};
use carom_solid::Triangles;

use super::near_obstacle::{derivatives_agree, measured_in};

fn contact(shape: Obstacle) -> NodeToObstacle {
    NodeToObstacle::new(vec![0], 3, shape)
}

/// A box from the origin to the given corner, its faces outward.
pub(crate) fn cuboid(size: [f64; 3]) -> Triangles {
    let point = |k: usize| [0, 1, 2].map(|i| if k >> i & 1 == 1 { size[i] } else { 0.0 });
    // Corners of every side, counter-clockwise as seen from outside.
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let corners = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Triangles::new((0..8).map(point).collect(), corners).unwrap()
}

/// A sphere around the origin: an octahedron whose triangles are divided so often.
fn sphere(radius: f64, divisions: u32) -> Triangles {
    let mut points: Vec<[f64; 3]> = (0..6)
        .map(|k| [0, 1, 2].map(|i| if i == k / 2 { 1.0 - 2.0 * f64::from(k % 2) } else { 0.0 }))
        .collect();
    let mut corners = Vec::new();
    for (x, y, z) in (0..2).flat_map(|x| (0..2).flat_map(move |y| (0..2).map(move |z| (x, y, z)))) {
        let [a, b, c] = [x, 2 + y, 4 + z];
        corners.push(if (x + y + z) % 2 == 0 { [a, b, c] } else { [a, c, b] });
    }
    for _ in 0..divisions {
        let mut middles = std::collections::HashMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in corners {
            let mut middle = |p: usize, q: usize| {
                *middles.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                    let at: [f64; 3] = std::array::from_fn(|i| points[p][i] + points[q][i]);
                    let length = at.iter().map(|x| x * x).sum::<f64>().sqrt();
                    points.push(at.map(|x| x / length));
                    points.len() - 1
                })
            };
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        corners = finer;
    }
    points.iter_mut().flatten().for_each(|x| *x *= radius);
    Triangles::new(points, corners).unwrap()
}

fn faceted(triangles: Triangles) -> NodeToObstacle {
    contact(Obstacle::Faceted(Faceted::new(triangles)))
}

fn distance(contact: &NodeToObstacle, at: [f64; 3]) -> f64 {
    contact.signed_distance(0, &at).unwrap()
}

fn measured(contact: &NodeToObstacle, pair: &mut Pair, y: &[f64]) -> (f64, Vec<f64>) {
    measured_in(3, contact, pair, y)
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-14, "{a} {b}");
}

#[test]
fn distances_to_a_cylinder_are_elementary() {
    // Around the line through (1, 2, 3) along (0, 0.6, 0.8).
    let of = |inside| contact(Obstacle::cylinder(&[1.0, 2.0, 3.0], &[0.0, 3.0, 4.0], 0.5, inside));
    for (along, x, across, d) in
        [(0.0, 0.75, 0.0, 0.25), (-7.0, 0.0, 2.0, 1.5), (3.0, 0.3, 0.4, 0.0), (1.0, 0.18, 0.24, -0.2)]
    {
        let at = [1.0 + x, 2.0 + 0.6 * along + 0.8 * across, 3.0 + 0.8 * along - 0.6 * across];
        close(distance(&of(false), at), d);
        close(distance(&of(true), at), -d);
    }
    // On the axis only a node inside has nothing to leave.
    let at = |inside| {
        let upright = contact(Obstacle::cylinder(&[1.0, 2.0, 3.0], &[0.0, 0.0, 4.0], 0.5, inside));
        upright.measure(&mut Pair::open(0, 0, 0.0), &[1.0, 2.0, 7.0], &mut Rows::new(3))
    };
    assert!(at(true).is_ok() && at(false).is_err());
}

#[test]
fn distances_to_a_box_of_triangles_are_elementary() {
    let block = faceted(cuboid([2.0, 2.0, 1.0]));
    let room = faceted(cuboid([2.0, 2.0, 1.0]).placed(1.0, true));
    for (at, d) in [
        ([1.0, 1.0, 1.5], 0.5),
        ([0.3, 1.7, 1.5], 0.5),
        ([5.0, 6.0, 0.3], 5.0),
        ([4.0, 5.0, 7.0], 7.0),
        ([1.0, 1.3, 0.75], -0.25),
        ([1.9, 1.0, 0.6], -0.1),
        ([1.0, 1.0, 1.0], 0.0),
    ] {
        close(distance(&block, at), d);
        if d != 5.0 && d != 7.0 {
            close(distance(&room, at), -d);
        }
    }
    // Behind the edges and corners of the room the walls go on.
    close(distance(&room, [2.1, 2.2, 0.5]), -0.2);
    // A sheet is nothing beyond its rim.
    let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let sheet = faceted(Triangles::new(square, vec![[0, 1, 2], [0, 2, 3]]).unwrap());
    close(distance(&sheet, [0.5, 0.2, -0.3]), -0.3);
    close(distance(&sheet, [0.5, 0.2, 0.3]), 0.3);
    close(distance(&sheet, [1.3, 0.2, -0.4]), 0.5);
}

#[test]
fn a_divided_sphere_approaches_the_sphere_with_the_square_of_its_triangles() {
    let places = [[0.3, 0.5, -0.9], [1.1, 0.1, 0.2], [-0.4, 0.7, 0.45], [0.2, -0.3, 0.6]];
    let error = |divisions| {
        let surface = faceted(sphere(1.0, divisions));
        let error =
            |at: [f64; 3]| distance(&surface, at) - (at.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0);
        places.map(error).into_iter().map(f64::abs).fold(0.0, f64::max)
    };
    let errors = [3, 4, 5].map(error);
    // Triangles of edge h are about h²/6 below the sphere at most; the coarsest have h < 0.3.
    assert!(errors[0] < 0.015 && errors[1] < 0.3 * errors[0] && errors[2] < 0.3 * errors[1], "{errors:?}");
}

/// A node near every kind of piece, also of obstacles that move.
pub(crate) fn scenes() -> Vec<(NodeToObstacle, Vec<f64>)> {
    let axis = [0.3, 0.6, -0.2];
    let block = || Obstacle::Faceted(Faceted::new(cuboid([2.0, 2.0, 1.0])));
    let shapes = [
        (Obstacle::cylinder(&[0.1, -0.4, 0.3], &axis, 0.5, false), [0.23, 0.35, 0.7]),
        (Obstacle::cylinder(&[0.1, -0.4, 0.3], &axis, 1.5, true), [0.23, 0.35, 0.7]),
        (block(), [1.4, 0.7, 1.2]),
        (block(), [2.2, 0.7, 1.3]),
        (block(), [2.2, -0.1, 1.3]),
        (block(), [1.5, 0.9, 0.9]),
    ];
    let mut scenes = Vec::new();
    for (shape, at) in shapes {
        let carrier = Carrier { nodes: vec![1], origin: [0.1, -0.3, 0.2], length: 0.8 };
        let turning = Carrier { nodes: vec![1, 2, 3, 4], ..carrier.clone() };
        // Moved, and turned by a little about an axis across space.
        let simplex: Vec<f64> =
            turning.places(3).as_chunks::<3>().0.iter().flat_map(|x| tilted(*x)).collect();
        scenes.push((contact(shape.clone()).carried_by(turning), [&at[..], &simplex].concat()));
        scenes.push((contact(shape.clone()), at.to_vec()));
        scenes.push((contact(shape).carried_by(carrier), [&at[..], &[0.12, -0.33, 0.21]].concat()));
    }
    scenes
}

/// A place turned by 0.03 about an axis through the origin, and moved by a little.
fn tilted(x: [f64; 3]) -> [f64; 3] {
    let axis = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
    let (sin, cos) = 0.03_f64.sin_cos();
    let along = (0..3).map(|i| axis[i] * x[i]).sum::<f64>();
    let across = |i: usize| axis[(i + 1) % 3] * x[(i + 2) % 3] - axis[(i + 2) % 3] * x[(i + 1) % 3];
    std::array::from_fn(|i| cos * x[i] + sin * across(i) + (1.0 - cos) * along * axis[i] + 0.01 * i as f64)
}

#[test]
fn gradient_and_second_derivative_agree_with_differences() {
    derivatives_agree(3, &scenes());
}

fn searched(contact: &NodeToObstacle, pair: Pair, before: [f64; 3], now: [f64; 3]) -> (Pair, Vec<PairEvent>) {
    let mut pairing = Pairing::new(vec![pair]);
    let mut events = Vec::new();
    contact.search(&before, &now, &mut pairing, &mut events);
    (pairing.pairs[0], events)
}

/// Near an edge the closest face is not the one that was crossed.
#[test]
fn a_node_inside_keeps_the_face_it_came_through() {
    let block = faceted(cuboid([2.0, 2.0, 1.0]));
    let now = [1.98, 1.0, 0.9];
    for (before, gap, normal) in
        [([1.9, 1.0, 1.1], -0.1, [0.0, 0.0, 1.0]), ([2.1, 1.0, 0.85], 1.98 - 2.0, [1.0, 0.0, 0.0])]
    {
        let (mut pair, _) = searched(&block, Pair::open(0, 0, 0.0), before, now);
        let (found, gradient) = measured(&block, &mut pair, &now);
        close(found, gap);
        assert_eq!(gradient, normal);
        let theta = block.met(&[0], &before, &now)[0].unwrap();
        let at = |i: usize| before[i] + theta * (now[i] - before[i]);
        assert!((at(2) - 1.0).abs() < 1e-14 || (at(0) - 2.0).abs() < 1e-14);
    }
    // Through the whole box, and beside it.
    let path = contact(Obstacle::Faceted(Faceted::new(cuboid([2.0, 2.0, 1.0])))).with_lengths(vec![0.1]);
    let passed = path.passed(&[0.6, 1.2, 3.0], &[0.6, 1.2, -3.0], 0.01).unwrap();
    assert!((passed.depth - 0.5).abs() < 0.01, "{passed:?}");
    assert_eq!(path.passed(&[2.1, 1.2, 3.0], &[2.1, 1.2, -3.0], 0.01), None);
}

#[test]
fn a_node_in_contact_goes_across_flat_and_blunt_edges_and_off_sharp_ones() {
    let active = |facet| Pair { active: true, lambda: -1.0, ..Pair::open(0, facet, 0.0) };
    let block = faceted(cuboid([2.0, 2.0, 1.0]));
    // The faces 10 and 11 are the halves of the top.
    let (pair, events) = searched(&block, active(10), [1.5, 0.5, 1.0], [0.5, 1.5, 1.0]);
    assert!(pair.active && pair.facet == 11 && events.len() == 1, "{pair:?} {events:?}");
    let (pair, events) = searched(&block, active(10), [1.9, 0.5, 1.0], [2.1, 0.5, 1.0]);
    assert!(!pair.active && events == [PairEvent::SlidOff { node: 0, facet: 10 }], "{pair:?} {events:?}");
    // Far over a sphere within one step, by the faces between.
    let ball = faceted(sphere(1.0, 4));
    let start = searched(&ball, Pair::open(0, 0, 0.0), [0.1, 0.2, 1.0], [0.1, 0.2, 0.9]).0.facet;
    let away = [0.55, 0.6, 0.64];
    let (pair, _) = searched(&ball, active(start), [0.1, 0.2, 0.9], away);
    assert!(pair.active && pair.facet != start);
    let length = away.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (gap, normal) = measured(&ball, &mut pair.clone(), &away);
    assert!((gap - (length - 1.0)).abs() < 5e-3, "{gap}");
    assert!((0..3).all(|i| (normal[i] - away[i] / length).abs() < 0.1), "{normal:?}");
    // In a groove both walls hold it.
    let room = faceted(cuboid([2.0, 2.0, 1.0]).placed(1.0, true));
    let floor = searched(&room, Pair::open(0, 0, 0.0), [1.0, 0.3, 0.1], [1.0, 0.3, -0.01]).0.facet;
    let mut pairing = Pairing::new(vec![active(floor)]);
    room.search(&[1.0, 0.1, 0.0], &[1.0, -0.1, 0.0], &mut pairing, &mut Vec::new());
    let gap = |pair: &Pair| measured(&room, &mut pair.clone(), &[1.0, -0.1, 0.0]).0;
    let gaps: Vec<f64> = pairing.pairs.iter().map(gap).collect();
    assert!(gaps.len() == 2 && gaps[0] == 0.0, "{gaps:?}");
    close(gaps[1], -0.1);
}

#[test]
fn a_node_behind_several_faces_of_a_concave_corner_has_a_pair_with_each() {
    let room = faceted(cuboid([2.0, 2.0, 2.0]).placed(1.0, true));
    for turn in 0..3 {
        let scenes = [
            ([0.1, 0.1, 0.1], [-0.01, -0.02, -0.03], &[-0.03, -0.02, -0.01][..]),
            ([0.1, 0.1, 0.7], [-0.01, -0.02, 0.7], &[-0.02, -0.01]),
            ([0.1, 0.1, 0.7], [0.01, -0.02, 0.7], &[-0.02]),
            ([0.3, 0.1, 0.3], [0.3, -0.02, 0.3], &[-0.02]),
        ];
        for (before, now, gaps) in scenes {
            let [before, now] = [before, now].map(|x| [0, 1, 2].map(|i| x[(i + turn) % 3]));
            let mut pairing = Pairing::default();
            room.search(&before, &now, &mut pairing, &mut Vec::new());
            let mut rows = Rows::new(3);
            pairing.pairs.iter_mut().for_each(|pair| room.measure(pair, &now, &mut rows).unwrap());
            let mut found: Vec<f64> = rows.iter().map(|row| row.gap).collect();
            found.sort_by(f64::total_cmp);
            let agrees =
                found.len() == gaps.len() && found.iter().zip(gaps).all(|(a, b)| (a - b).abs() < 1e-15);
            assert!(agrees, "{turn}: {found:?} {gaps:?}");
        }
    }
}
