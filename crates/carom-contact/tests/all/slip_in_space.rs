//! The rows of the slip in space: zero in finite rigid motions, balance of force and moment, their
//! derivatives against differences, unit tangents that a normal carries with it.

use carom_algebra::{Vector, jacobian_error};
use carom_contact::{Carrier, Kinematics, NodeToObstacle, Obstacle, Pair, Rows};

use super::space::{SHAPES, scene};

/// A contact of node 0, and positions; and whether its primary turns with the nodes.
fn scenes(height: f64) -> Vec<(Box<dyn Kinematics>, Vec<f64>, bool)> {
    let of_shape = |shape| {
        let (contact, y) = scene(shape, height);
        (Box::new(contact) as Box<dyn Kinematics>, y, true)
    };
    let mut scenes: Vec<_> = SHAPES.into_iter().map(of_shape).collect();
    let carrier = Carrier { nodes: vec![1], origin: [0.1, -0.3, 0.2], length: 0.6 };
    let turning = Carrier { nodes: vec![1, 2, 3, 4], ..carrier.clone() };
    for shape in [
        Obstacle::plane(&[0.0, 0.0, 0.0], &[0.6, 0.48, 0.64]),
        Obstacle::circle(&[0.1, -0.4, 0.3], 0.5, false),
        Obstacle::circle(&[0.1, -0.4, 0.3], 1.5, true),
        Obstacle::cylinder(&[0.1, -0.4, 0.3], &[0.3, 0.6, -0.2], 0.5, false),
        Obstacle::cylinder(&[0.1, -0.4, 0.3], &[0.3, 0.6, -0.2], 1.5, true),
    ] {
        let contact = NodeToObstacle::new(vec![0], 3, shape.clone()).carried_by(turning.clone());
        scenes.push((Box::new(contact), [&[0.23, height, 0.7], &turning.places(3)[..]].concat(), true));
        let contact = NodeToObstacle::new(vec![0], 3, shape).carried_by(carrier.clone());
        scenes.push((Box::new(contact), vec![0.23, height, 0.7, 0.1, -0.3, 0.2], false));
    }
    scenes
}

/// Tangents of another normal.
const START: [[f64; 3]; 2] = [[0.6, 0.8, 0.0], [0.0, 0.0, 1.0]];

/// The pair at its contact point with its tangent there, and both H over all dofs.
fn slip(contact: &dyn Kinematics, y: &[f64], tangents: [[f64; 3]; 2]) -> (Pair, [Vec<f64>; 2]) {
    let mut rows = Rows::new(3);
    let mut pair = Pair { active: true, ..Pair::open(0, 0, 0.2) };
    contact.measure(&mut pair, y, &mut rows).unwrap();
    pair.tangential.tangents = tangents;
    rows.clear();
    contact.slip(&pair, y, &[], &mut rows).unwrap();
    pair.tangential.tangents = rows.tangents(0);
    let full = [0, 1].map(|row| {
        let mut full = vec![0.0; y.len()];
        rows.row(row).add_to(1.0, &mut full);
        full
    });
    (pair, full)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// y turned about an axis by an angle, and moved.
fn moved(y: &[f64], axis: [f64; 3], angle: f64) -> Vec<f64> {
    let n = Vector(axis) * Vector(axis).norm().recip();
    let (s, c) = angle.sin_cos();
    let turned = |x: &[f64; 3]| {
        let x = Vector(*x);
        x * c + n * (n.dot(&x) * (1.0 - c)) + Vector(cross(n.0, x.0)) * s + Vector([0.7, -2.0, 0.4])
    };
    y.as_chunks::<3>().0.iter().flat_map(|x| turned(x).0).collect()
}

#[test]
fn finite_rigid_motions_have_no_slip() {
    for (k, (contact, start, turns)) in scenes(0.35).iter().enumerate() {
        for (axis, angle) in [([1.0, 2.0, -0.5], 0.3), ([0.2, -1.0, 0.7], -1.1), ([0.0, 0.1, 1.0], 2.0)] {
            let end = moved(start, axis, if *turns { angle } else { 0.0 });
            let (middle, change): (Vec<f64>, Vec<f64>) =
                start.iter().zip(&end).map(|(a, b)| (0.5 * (a + b), b - a)).unzip();
            let size: f64 = change.iter().map(|x| x.abs()).sum();
            for row in slip(contact.as_ref(), &middle, START).1 {
                let slipped = dot(&row, &change);
                assert!(slipped.abs() < 1e-14 * size, "{k} {angle}: {slipped:e}");
            }
        }
    }
}

#[test]
fn friction_has_neither_a_resultant_nor_a_moment_and_unit_forces_on_the_node() {
    for (k, (contact, y, turns)) in [0.35, 0.12].into_iter().flat_map(scenes).enumerate() {
        let (pair, rows) = slip(contact.as_ref(), &y, START);
        let mut gap = Rows::new(3);
        contact.measure(&mut pair.clone(), &y, &mut gap).unwrap();
        let normal = gap.row(0).first();
        let parts = [&rows[0][..3], &rows[1][..3], &normal];
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let expected = if i == j { 1.0 } else { 0.0 };
            assert!((dot(parts[i], parts[j]) - expected).abs() < 1e-14, "{k} {i} {j}");
        }
        for row in &rows {
            let mut sum = Vector::<3>::ZERO;
            let mut moment = Vector::<3>::ZERO;
            for (y, f) in y.as_chunks::<3>().0.iter().zip(row.as_chunks::<3>().0) {
                sum += Vector(*f);
                moment += Vector(cross(*y, *f));
            }
            // That of an obstacle which does not turn is taken by its guide.
            assert!(sum.norm() < 1e-12 && (!turns || moment.norm() < 1e-12), "{k}: {sum:?} {moment:?}");
        }
    }
}

#[test]
fn the_derivatives_of_the_rows_are_those_of_differences() {
    for (k, (contact, y, _)) in [0.35, 0.12].into_iter().flat_map(scenes).enumerate() {
        let contact = contact.as_ref();
        let pair = slip(contact, &y, START).0;
        for tangent in 0..2 {
            let mut matrix = vec![0.0; y.len() * y.len()];
            contact.slip_derivative_into(&pair, &y, &[], tangent, &mut matrix);
            let row = |y: &[f64]| {
                let [first, second] = slip(contact, y, pair.tangential.tangents).1;
                if tangent == 0 { first } else { second }
            };
            let error = jacobian_error(&y, 1e-3, row, &matrix);
            assert!(error < 1e-8, "{k} {tangent}: {error:e}");
        }
    }
}

/// Those of the opposite normal are replaced.
#[test]
fn any_tangent_is_a_start() {
    for (contact, y, _) in scenes(0.35) {
        let normal = {
            let mut rows = Rows::new(3);
            let mut pair = Pair::open(0, 0, 0.2);
            contact.measure(&mut pair, &y, &mut rows).unwrap();
            rows.row(0).first()
        };
        let [first, second] = slip(contact.as_ref(), &y, START).0.tangential.tangents;
        for start in [[[0.0; 3]; 2], [first, second], [second, first], START] {
            let [first, second] = slip(contact.as_ref(), &y, start).1;
            assert!((dot(&first[..3], &first[..3]) - 1.0).abs() < 1e-14);
            assert!(dot(&first[..3], &second[..3]).abs() < 1e-14 && dot(&first[..3], &normal).abs() < 1e-14);
        }
    }
}

/// A vector of the tangent plane goes from one to another in the same way whatever its components.
#[test]
fn what_a_normal_carries_does_not_depend_on_the_tangents() {
    for (contact, y, turns) in scenes(0.35).into_iter().filter(|scene| scene.2) {
        let end = moved(&y, [1.0, 2.0, -0.5], 0.8);
        let start = slip(contact.as_ref(), &y, START).0.tangential.tangents;
        let (s, c) = 0.7_f64.sin_cos();
        let other: [[f64; 3]; 2] = [
            std::array::from_fn(|i| c * start[0][i] + s * start[1][i]),
            std::array::from_fn(|i| c * start[1][i] - s * start[0][i]),
        ];
        let [one, two] = [start, other].map(|last| slip(contact.as_ref(), &end, last).0.tangential.tangents);
        for i in 0..3 {
            assert!((c * one[0][i] + s * one[1][i] - two[0][i]).abs() < 1e-14 && turns);
        }
    }
}
