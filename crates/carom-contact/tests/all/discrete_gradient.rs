//! The discrete gradient of a gap: work, resultant and moment of its force, and its derivative
//! against differences.

use carom_algebra::jacobian_error;
use carom_contact::{
    Carrier, Detection, DiscreteGradient, Kinematics, NodeToFacet, NodeToObstacle, Obstacle, Pair, Rows,
    Surface,
};
use carom_solid::FacetShape;

const SHAPES: [FacetShape; 3] = [FacetShape::L2, FacetShape::L3, FacetShape::L4];

/// A node (0) near a curved facet (1 …) before a step.
fn start(shape: FacetShape) -> Vec<f64> {
    let mut y = vec![0.23, 0.19, 1.0, 0.1, -1.1, -0.05];
    match shape {
        FacetShape::L3 => y.extend([0.05, 0.21]),
        FacetShape::L4 => y.extend([0.4, 0.22, -0.35, 0.12]),
        _ => {}
    }
    y
}

fn contact(shape: FacetShape) -> NodeToFacet {
    let facet: Vec<usize> = (1..=shape.nodes()).collect();
    NodeToFacet::new(vec![0], Surface::new(shape, &[facet], &[1.0]), Detection::ClosestPoint)
}

/// The end of a step: a rotation by `angle`, a translation, and a deformation of a given size.
fn end(y: &[f64], angle: f64, size: f64) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    let mut end = y.to_vec();
    for (k, (end, y)) in end.chunks_mut(2).zip(y.chunks(2)).enumerate() {
        end[0] = cos * y[0] - sin * y[1] + 0.03 + size * (3.0 * k as f64).sin();
        end[1] = sin * y[0] + cos * y[1] - 0.02 + size * (5.0 * k as f64 + 1.0).cos();
    }
    end
}

fn gap(contact: &dyn Kinematics, y: &[f64]) -> f64 {
    let mut rows = Rows::new(2);
    contact.measure(&mut Pair::open(0, 0, 0.1), y, &mut rows).unwrap();
    rows.pop()
}

/// ∇̄G over all dofs, and its derivative to the end of the step.
fn discrete_gradient(contact: &dyn Kinematics, start: &[f64], end: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let middle: Vec<f64> = start.iter().zip(end).map(|(a, b)| 0.5 * (a + b)).collect();
    let moved: Vec<f64> = start.iter().zip(end).map(|(a, b)| b - a).collect();
    let mut rows = Rows::new(2);
    let mut pair = Pair::open(0, 0, 0.1);
    contact.measure(&mut pair.clone(), end, &mut rows).unwrap();
    contact.measure(&mut pair, &middle, &mut rows).unwrap();
    let mut gradient = DiscreteGradient::default();
    gradient.evaluate(rows.row(1), rows.row(0).gap - gap(contact, start), &middle, &moved);
    let dofs: Vec<usize> = rows.row(1).entries().map(|(dof, _)| dof).collect();
    let n = dofs.len();
    let all = start.len();
    let mut matrix = vec![0.0; n * n];
    let mut force = vec![0.0; all];
    let mut full = vec![0.0; all * all];
    contact.curvature_into(&pair, &middle, &mut matrix);
    gradient.derivative_into(rows.row(0), &mut matrix);
    for (a, &row) in dofs.iter().enumerate() {
        force[row] = gradient.gradient()[a];
        for (b, &column) in dofs.iter().enumerate() {
            full[row * all + column] = matrix[a * n + b];
        }
    }
    (force, full)
}

#[test]
fn it_does_the_work_of_the_gap_and_balances_force_and_moment() {
    for shape in SHAPES {
        let contact = contact(shape);
        let y = start(shape);
        for angle in [0.0, 0.2, -0.7] {
            for size in [0.1, 1e-3] {
                let end = end(&y, angle, size);
                let (force, _) = discrete_gradient(&contact, &y, &end);
                let work: f64 = force.iter().zip(end.iter().zip(&y)).map(|(f, (b, a))| f * (b - a)).sum();
                let change = gap(&contact, &end) - gap(&contact, &y);
                // ε leaves its share (ε/|d|)² of the correction.
                let bound = if size > 0.01 { 1e-13 } else { 1e-9 };
                assert!((work - change).abs() < bound, "{shape:?} {angle} {size}: {work} {change}");
                let mut sums = [0.0; 2];
                let mut moment = 0.0;
                for (f, (a, b)) in force.chunks(2).zip(y.chunks(2).zip(end.chunks(2))) {
                    let arm = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
                    (0..2).for_each(|i| sums[i] += f[i]);
                    moment += arm[0] * f[1] - arm[1] * f[0];
                }
                assert!(sums[0].abs() + sums[1].abs() + moment.abs() < 1e-13, "{sums:?} {moment}");
            }
        }
    }
}

#[test]
fn its_derivative_agrees_with_differences() {
    for shape in SHAPES {
        let contact = contact(shape);
        let y = start(shape);
        for (angle, size) in [(0.0, 0.1), (0.3, 0.1), (-0.1, 0.02)] {
            let end = end(&y, angle, size);
            let (_, derivative) = discrete_gradient(&contact, &y, &end);
            let error =
                jacobian_error(&end, 1e-2 * size, |end| discrete_gradient(&contact, &y, end).0, &derivative);
            assert!(error < 2e-6, "{shape:?} {angle} {size}: {error:e}");
        }
    }
}

/// Where the nodes move as a rigid body there is nothing to correct, in a turn of any size.
#[test]
fn it_is_the_gradient_at_the_midpoint_in_rigid_motion_and_against_a_plane() {
    for shape in SHAPES {
        let contact = contact(shape);
        let y = start(shape);
        for angle in [0.0, 1e-4, 0.5] {
            let end = end(&y, angle, 0.0);
            let middle: Vec<f64> = y.iter().zip(&end).map(|(a, b)| 0.5 * (a + b)).collect();
            let mut rows = Rows::new(2);
            contact.measure(&mut Pair::open(0, 0, 0.1), &middle, &mut rows).unwrap();
            let mut expected = vec![0.0; y.len()];
            rows.row(0).add_to(1.0, &mut expected);
            let (force, _) = discrete_gradient(&contact, &y, &end);
            let apart = force.iter().zip(&expected).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-8, "{shape:?} {angle}: {apart:e}");
        }
    }
    let plane = NodeToObstacle::new(vec![0], 2, Obstacle::plane(&[0.0, 0.0], &[3.0, 4.0]));
    let (force, derivative) = discrete_gradient(&plane, &[1.0, 2.0], &[0.7, -0.4]);
    assert!((force[0] - 0.6).abs() + (force[1] - 0.8).abs() < 1e-15 && derivative == [0.0; 4], "{force:?}");
}

/// A node that slides along a closed curved facet keeps its force: ΔG = 0 although ∇G·Δy ≠ 0.
#[test]
fn it_keeps_the_force_of_a_node_that_slides_on_a_closed_facet() {
    let contact = contact(FacetShape::L3);
    let on_facet = |xi: f64| {
        let mut y = start(FacetShape::L3);
        let shape = FacetShape::L3.at(xi).values;
        for i in 0..2 {
            y[i] = (0..3).map(|k| shape[k] * y[2 * (k + 1) + i]).sum();
        }
        y
    };
    let before = on_facet(-0.2);
    let after = on_facet(0.4);
    assert!(gap(&contact, &before).abs() + gap(&contact, &after).abs() < 1e-15);
    let (force, _) = discrete_gradient(&contact, &before, &after);
    let work: f64 = force.iter().zip(after.iter().zip(&before)).map(|(f, (b, a))| f * (b - a)).sum();
    assert!(work.abs() < 1e-15 && (force[0].hypot(force[1]) - 1.0).abs() < 0.1, "{work:e} {force:?}");
}

/// A node that rests at the very point of an obstacle whose node carries it: nothing but round-off
/// is left of their distance, and both move by numbers that are not exact.
#[test]
fn round_off_between_a_node_and_an_obstacle_does_not_turn_the_force() {
    let carrier = Carrier { nodes: vec![1], origin: [0.0; 3], length: 1.0 };
    let wall = Obstacle::plane(&[0.0, 0.0], &[1.0, 0.0]);
    let contact = NodeToObstacle::new(vec![0], 2, wall).carried_by(carrier);
    for step in 1..50 {
        // Differences of positions are rounded where the larger one is more than twice the other.
        let from = 0.0011 * f64::from(step);
        let to = 0.0123 * f64::from(step);
        let off = from * (1.0 + f64::EPSILON);
        let end = [to * (1.0 - f64::EPSILON), 0.0, to, 0.0];
        let (force, derivative) = discrete_gradient(&contact, &[off, 1e-17, from, 0.0], &end);
        let wrong = force.iter().zip([1.0, 0.0, -1.0, 0.0]).map(|(f, e): (&f64, f64)| (f - e).abs());
        assert!(wrong.fold(0.0, f64::max) < 1e-12, "{step}: {force:?}");
        assert!(derivative.iter().all(|slope| slope.abs() < 1e-3), "{step}: {derivative:?}");
    }
}
