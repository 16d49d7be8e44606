//! Convex parts of a rigid obstacle against facets: gaps, their derivatives and those of the slip
//! against differences, rigid motions, balance, and which parts act.

use carom_algebra::jacobian_error;
use carom_contact::{
    Carrier, Kinematics, NodeToObstacle, Obstacle, Pair, Pairing, Polyline, Rows, Surface, TipToFacet,
};
use carom_solid::FacetShape;

/// A wedge with the corner (0.2, 0.3) above, and a circle, fixed, moving along with a node and on a
/// simplex, over a facet, straight or curved: nodes 0, 1, … of the facet, then those of the
/// carrier.
fn scenes() -> Vec<(TipToFacet, Vec<f64>)> {
    let wedge = [[-0.8, 1.3], [0.2, 0.3], [1.2, 1.3]];
    let mut scenes = Vec::new();
    for shape in [FacetShape::L2, FacetShape::L3] {
        let mut facet = vec![1.0, 0.02, -1.0, 0.05];
        if shape == FacetShape::L3 {
            facet.extend([0.1, -0.07]);
        }
        let count = facet.len() / 2;
        let side = Surface::new(shape, &[(0..count).collect()], &[1.0]);
        for obstacle in [
            Obstacle::Polyline(Polyline::new(&wedge, 0.0).unwrap()),
            Obstacle::Polyline(Polyline::new(&wedge, 0.1).unwrap()),
            Obstacle::circle(&[0.2, 0.4], 0.15, false),
        ] {
            let fixed = NodeToObstacle::new((0..count).collect(), 2, obstacle);
            let along = Carrier { nodes: vec![count], origin: [0.1, 0.6, 0.0], length: 0.7 };
            let turning = Carrier { nodes: (count..count + 3).collect(), ..along.clone() };
            // Turned by 0.1 and moved.
            let (sin, cos) = 0.1_f64.sin_cos();
            let simplex =
                [0.12, 0.58, 0.12 + 0.7 * cos, 0.58 + 0.7 * sin, 0.12 - 0.7 * sin, 0.58 + 0.7 * cos];
            for (contact, carriers) in [
                (fixed.clone(), &simplex[..0]),
                (fixed.clone().carried_by(along), &simplex[..2]),
                (fixed.carried_by(turning), &simplex[..]),
            ] {
                let y = [&facet[..], carriers].concat();
                scenes.push((TipToFacet::new(&contact, side.clone(), &y), y));
            }
        }
    }
    scenes
}

/// The pair at its contact point, its gap, and over all dofs the gradient and the row of the slip.
fn measured(contact: &TipToFacet, y: &[f64]) -> (Pair, f64, [Vec<f64>; 2]) {
    let mut pair = Pair { active: true, ..Pair::open(0, 0, 0.1) };
    let mut rows = Rows::new(2);
    contact.measure(&mut pair, y, &mut rows).unwrap();
    contact.slip(&pair, y, &[], &mut rows).unwrap();
    let over = |row: usize| {
        let mut all = vec![0.0; y.len()];
        rows.row(row).add_to(1.0, &mut all);
        all
    };
    (pair, rows.row(0).gap, [over(0), over(1)])
}

#[test]
fn derivatives_are_those_of_differences() {
    for (k, (contact, y)) in scenes().iter().enumerate() {
        let (pair, _, [gradient, slip]) = measured(contact, y);
        let error = jacobian_error(y, 1e-5, |y| vec![measured(contact, y).1], &gradient);
        assert!(error < 1e-9, "gradient {k}: {error:e}");
        let mut matrix = vec![0.0; y.len() * y.len()];
        contact.curvature_into(&pair, y, &mut matrix);
        let error = jacobian_error(y, 1e-5, |y| measured(contact, y).2[0].clone(), &matrix);
        assert!(error < 1e-8, "curvature {k}: {error:e}");
        contact.slip_derivative_into(&pair, y, &[], 0, &mut matrix);
        let error = jacobian_error(y, 1e-4, |y| measured(contact, y).2[1].clone(), &matrix);
        assert!(error < 1e-7, "slip {k}: {error:e}");
        assert_eq!(slip.len(), gradient.len());
    }
}

/// In a dent whose facets turn by less than 3° a circle over the joint meets both: its gap is the
/// mean, symmetric where they are, with derivatives that are those of differences.
#[test]
fn over_a_joint_the_row_is_the_mean_of_those_of_its_facets() {
    let side = Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2]], &[1.0; 2]);
    let circle = Obstacle::circle(&[0.0, 0.16], 0.15, false);
    let carrier = Carrier { nodes: vec![3], origin: [0.0, 0.16, 0.0], length: 1.0 };
    let obstacle = NodeToObstacle::new(vec![0, 1, 2], 2, circle).carried_by(carrier);
    let y = [1.0, 0.02, 0.0, 0.0, -1.0, 0.02, 0.0, 0.16];
    let contact = TipToFacet::new(&obstacle, side.clone(), &y);
    let single = TipToFacet::new(&obstacle, side, &y).with_single_facets();
    let measured = |y: &[f64]| {
        let mut pair = Pair { active: true, joint: Some(1), ..Pair::open(0, 0, 1.0) };
        let mut rows = Rows::new(2);
        contact.measure(&mut pair, y, &mut rows).unwrap();
        let mut gradient = vec![0.0; y.len()];
        rows.row(0).add_to(1.0, &mut gradient);
        // The order of the second derivative is that of the row.
        let order: Vec<usize> = rows.row(0).nodes.iter().flat_map(|node| [2 * node, 2 * node + 1]).collect();
        (pair, rows.row(0).gap, gradient, order)
    };
    let (pair, gap, gradient, order) = measured(&y);
    assert!((gap - (0.16 / (1.0_f64 + 0.02 * 0.02).sqrt() - 0.15)).abs() < 1e-15, "{gap}");
    assert!(gradient[6].abs() < 1e-16 && gradient[7] > 0.99, "{gradient:?}");
    assert!(jacobian_error(&y, 1e-5, |y| vec![measured(y).1], &gradient) < 1e-9);
    let mut matrix = vec![0.0; 64];
    contact.curvature_into(&pair, &y, &mut matrix);
    let ordered = |y: &[f64]| -> Vec<f64> {
        let gradient = measured(y).2;
        order.iter().map(|&dof| gradient[dof]).collect()
    };
    let permuted: Vec<f64> = (0..64)
        .map(|k| {
            let column = order.iter().position(|&dof| dof == k % 8).unwrap();
            matrix[k / 8 * 8 + column]
        })
        .collect();
    let error = jacobian_error(&y, 1e-5, ordered, &permuted);
    assert!(error < 1e-8, "{error:e}");
    // At the start of a solve the pair is on the joint, but where each has one facet.
    for (contact, joint) in [(contact, Some(1)), (single, None)] {
        let mut pairing = Pairing::new(vec![Pair { joint: None, ..pair }]);
        contact.search(&y, &y, &mut pairing, &mut Vec::new());
        assert_eq!(pairing.pairs[0].joint, joint);
    }
}

#[test]
fn forces_are_balanced_and_finite_rigid_motions_do_not_slip() {
    for (k, (contact, y)) in scenes().iter().enumerate().filter(|(k, _)| k % 3 == 2) {
        let (_, _, forces) = measured(contact, y);
        for force in &forces {
            for i in 0..2 {
                assert!(force.iter().skip(i).step_by(2).sum::<f64>().abs() < 1e-13, "{k}");
            }
            let moments = y.as_chunks::<2>().0.iter().zip(force.as_chunks::<2>().0);
            let moment = moments.map(|(y, f)| y[0] * f[1] - y[1] * f[0]).sum::<f64>();
            assert!(moment.abs() < 1e-13, "{k}: {moment:e}");
        }
        let (sin, cos) = 1.1_f64.sin_cos();
        let turned = |[x, y]: &[f64; 2]| [cos * x - sin * y + 3.0, sin * x + cos * y - 1.0];
        let end: Vec<f64> = y.as_chunks::<2>().0.iter().flat_map(turned).collect();
        let middle: Vec<f64> = y.iter().zip(&end).map(|(a, b)| 0.5 * (a + b)).collect();
        let slip = &measured(contact, &middle).2[1];
        let slipped: f64 = slip.iter().zip(y.iter().zip(&end)).map(|(h, (a, b))| h * (b - a)).sum();
        assert!(slipped.abs() < 1e-13, "{k}: {slipped:e}");
        assert!((measured(contact, &end).1 - measured(contact, y).1).abs() < 1e-14, "{k}");
    }
}

/// The corner is 0.3 above a flat side.
#[test]
fn the_gap_is_the_distance_of_the_centre_less_the_radius() {
    let y = [2.0, 0.0, 0.6, 0.0, -1.0, 0.0];
    let side = Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2]], &[1.0; 2]);
    let wedge = Polyline::new(&[[-0.8, 1.3], [0.2, 0.3], [1.2, 1.3]], 0.0).unwrap();
    for (shape, gap) in [(Obstacle::Polyline(wedge), 0.3), (Obstacle::circle(&[0.2, 0.5], 0.4, false), 0.1)] {
        let nodes = NodeToObstacle::new(vec![0, 1, 2], 2, shape);
        let contact = TipToFacet::new(&nodes, side.clone(), &y);
        let mut rows = Rows::new(2);
        contact.measure(&mut Pair::open(0, 1, 0.0), &y, &mut rows).unwrap();
        let row = rows.row(0);
        assert!((row.gap - gap).abs() < 1e-14 && (row.normal()[1] + 1.0).abs() < 1e-14, "{row:?}");
        // Node 1 takes most of the force.
        assert!((row.shares().next().unwrap().1 - 0.75).abs() < 1e-14);
        assert_eq!(contact.secondary(), [1]);
    }
}

/// Whether the part acts on the side from −1 to 1 along x, with a node at 0, which has come up to
/// it.
fn acts(points: &[[f64; 2]], radius: f64, x: f64) -> bool {
    let before = [1.0, -0.1, 0.0, -0.1, -1.0, -0.1];
    let now = [1.0, 0.05, 0.0, 0.05, -1.0, 0.05];
    let side = Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2]], &[1.0; 2]);
    let moved: Vec<[f64; 2]> = points.iter().map(|point| [point[0] + x, point[1]]).collect();
    let shape = Obstacle::Polyline(Polyline::new(&moved, radius).unwrap());
    let nodes = NodeToObstacle::new(vec![0, 1, 2], 2, shape);
    let contact = TipToFacet::new(&nodes, side, &before);
    let mut pairing = Pairing::default();
    contact.search(&before, &now, &mut pairing, &mut Vec::new());
    let mut rows = Rows::new(2);
    pairing.pairs.iter_mut().for_each(|pair| contact.measure(pair, &now, &mut rows).unwrap());
    rows.iter().any(|row| row.gap < 0.0)
}

#[test]
fn a_part_acts_between_nodes_and_where_its_row_is_not_that_of_a_node() {
    let wedge = [[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0]];
    let edge = [[0.0, 1.0], [0.0, 0.0], [1.0, 0.0]];
    for x in [0.3, -0.5, 0.01] {
        assert!(acts(&wedge, 0.0, x) && acts(&edge, 0.0, x) && acts(&wedge, 0.1, x), "{x}");
    }
    // At a node: the corner's plane is that of a facet, the node's that of a flank of the wedge,
    // but that of the flat side of the edge, and that of the arc.
    assert!(acts(&wedge, 0.0, 0.0) && !acts(&edge, 0.0, 0.0) && !acts(&wedge, 0.02, 0.0));
}
