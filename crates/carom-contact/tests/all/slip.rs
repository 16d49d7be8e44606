//! The row of the slip: zero in finite rigid motions, balance of force and moment, its derivative
//! and that of the contact point against differences.

use carom_algebra::jacobian_error;
use carom_contact::{
    Carrier, Detection, Kinematics, NodeToFacet, NodeToObstacle, Obstacle, Pair, Rows, Surface,
};
use carom_solid::FacetShape;

/// A contact of node 0, and positions: three facets, three obstacles that move along with a node,
/// and these on a simplex.
fn scenes(height: f64) -> Vec<(Box<dyn Kinematics>, Vec<f64>)> {
    let mut scenes: Vec<(Box<dyn Kinematics>, Vec<f64>)> = Vec::new();
    for shape in [FacetShape::L2, FacetShape::L3, FacetShape::L4] {
        let mut y = vec![0.23, height, 1.0, 0.1, -1.1, -0.05];
        match shape {
            FacetShape::L3 => y.extend([0.05, 0.21]),
            FacetShape::L4 => y.extend([0.4, 0.22, -0.35, 0.12]),
            _ => {}
        }
        let facet: Vec<usize> = (1..y.len() / 2).collect();
        let side = Surface::new(shape, &[facet], &[1.0]);
        scenes.push((Box::new(NodeToFacet::new(vec![0], side, Detection::ClosestPoint)), y));
    }
    for nodes in [vec![1], vec![1, 2, 3]] {
        let carrier = Carrier { nodes: nodes.clone(), origin: [0.1, -0.3, 0.0], length: 0.7 };
        for shape in [
            Obstacle::plane(&[0.0, 0.0], &[0.6, 0.8]),
            Obstacle::circle(&[0.1, -0.4], 0.5, false),
            Obstacle::circle(&[0.1, -0.4], 1.5, true),
        ] {
            let contact = NodeToObstacle::new(vec![0], 2, shape).carried_by(carrier.clone());
            let mut y = vec![0.23, height, 0.12, -0.3];
            if nodes.len() == 3 {
                let (sin, cos) = 0.14_f64.sin_cos();
                y.extend([0.12 + 0.7 * cos, -0.3 + 0.7 * sin, 0.12 - 0.7 * sin, -0.3 + 0.7 * cos]);
            }
            scenes.push((Box::new(contact), y));
        }
    }
    scenes
}

/// The pair at its contact point, and H over all dofs at the middle of a motion.
fn slip(contact: &dyn Kinematics, y: &[f64], moved: &[f64]) -> (Pair, Vec<f64>) {
    let mut rows = Rows::new(2);
    let mut pair = Pair { active: true, ..Pair::open(0, 0, 0.1) };
    contact.measure(&mut pair, y, &mut rows).unwrap();
    let mut row = vec![0.0; y.len()];
    rows.clear();
    contact.slip(&pair, y, moved, &mut rows).unwrap();
    rows.row(0).add_to(1.0, &mut row);
    (pair, row)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// y turned by an angle and moved.
fn moved(y: &[f64], angle: f64, by: [f64; 2]) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    y.as_chunks::<2>()
        .0
        .iter()
        .flat_map(|[x, y]| [cos * x - sin * y + by[0], sin * x + cos * y + by[1]])
        .collect()
}

#[test]
fn finite_rigid_motions_of_a_pair_have_no_slip() {
    for (k, (contact, start)) in scenes(0.35).iter().enumerate() {
        let turns = !(3..6).contains(&k);
        for angle in if turns { [0.3, -1.1, 2.0] } else { [0.0; 3] } {
            let end = moved(start, angle, [0.7, -2.0]);
            let (middle, change): (Vec<f64>, Vec<f64>) =
                start.iter().zip(&end).map(|(a, b)| (0.5 * (a + b), b - a)).unzip();
            let size: f64 = change.iter().map(|x| x.abs()).sum();
            let slipped = dot(&slip(contact.as_ref(), &middle, &change).1, &change);
            assert!(slipped.abs() < 1e-14 * size, "{k} {angle}: {slipped:e}");
        }
    }
}

#[test]
fn friction_has_neither_a_resultant_nor_a_moment_and_a_unit_force_on_the_node() {
    for height in [0.35, 0.12] {
        for (k, (contact, y)) in scenes(height).iter().enumerate() {
            let force = slip(contact.as_ref(), y, &[]).1;
            assert!((force[0].hypot(force[1]) - 1.0).abs() < 1e-14);
            for i in 0..2 {
                assert!(force.iter().skip(i).step_by(2).sum::<f64>().abs() < 1e-12, "{k}");
            }
            let moments = y.as_chunks::<2>().0.iter().zip(force.as_chunks::<2>().0);
            let moment = moments.map(|(y, f)| y[0] * f[1] - y[1] * f[0]).sum::<f64>();
            // That of an obstacle which does not turn is taken by its guide.
            assert!((3..6).contains(&k) || moment.abs() < 1e-12, "{k}: {moment:e}");
        }
    }
}

#[test]
fn the_derivative_of_the_row_is_that_of_differences() {
    for height in [0.35, 0.12] {
        for (k, (contact, y)) in scenes(height).iter().enumerate() {
            let contact = contact.as_ref();
            let start: Vec<f64> = y.iter().enumerate().map(|(i, y)| y - 0.1 * (i as f64).cos()).collect();
            let moved =
                |y: &[f64]| -> Vec<f64> { y.iter().zip(&start).map(|(y, s)| 2.0 * (y - s)).collect() };
            let (pair, row) = slip(contact, y, &moved(y));
            let mut matrix = vec![0.0; row.len().pow(2)];
            contact.slip_derivative_into(&pair, y, &moved(y), 0, &mut matrix);
            let error = jacobian_error(y, 1e-3, |y| slip(contact, y, &moved(y)).1, &matrix);
            assert!(error < 1e-8, "{k} {height}: {error:e}");
        }
    }
}

/// ∂ξ/∂y = H J/a with a = J² on a straight facet.
#[test]
fn on_a_straight_facet_the_slip_is_the_motion_of_the_contact_point() {
    let (contact, y) = &scenes(0.35)[0];
    let length = (y[2] - y[4]).hypot(y[3] - y[5]);
    let row: Vec<f64> = slip(contact.as_ref(), y, &[]).1.iter().map(|h| h / (0.5 * length)).collect();
    let error = jacobian_error(y, 1e-4, |y| vec![slip(contact.as_ref(), y, &[]).0.xi], &row);
    assert!(error < 1e-8, "{error:e}");
}
