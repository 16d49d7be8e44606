//! Gap derivatives of contact with curved facets of every order against differences, at the closest
//! point and at a frozen one; balance of force and moment; objectivity.

use carom_algebra::{Vector, jacobian_error};
use carom_contact::{
    ContactPoint, Detection, Kinematics, NodeToFacet, Pair, PairEvent, Pairing, Rows, Surface,
};
use carom_solid::FacetShape;

const SHAPES: [FacetShape; 3] = [FacetShape::L2, FacetShape::L3, FacetShape::L4];

const POINTS: [ContactPoint; 2] = [ContactPoint::Closest, ContactPoint::Frozen];

/// A curved facet of 2, 3 or 4 nodes (1 …) and a node (0) near it, inside or outside.
fn scene(shape: FacetShape, point: ContactPoint, height: f64) -> (NodeToFacet, Vec<f64>) {
    let mut y = vec![0.23, height, 1.0, 0.1, -1.1, -0.05];
    match shape {
        FacetShape::L3 => y.extend([0.05, 0.21]),
        FacetShape::L4 => y.extend([0.4, 0.22, -0.35, 0.12]),
        _ => {}
    }
    let facet: Vec<usize> = (1..y.len() / 2).collect();
    let contact = NodeToFacet::new(vec![0], Surface::new(shape, &[facet], &[1.0]), Detection::Trajectory);
    (contact.with_point(point), y)
}

fn pair() -> Pair {
    Pair { active: true, lambda: -3.0, ..Pair::open(0, 0, 0.1) }
}

/// The row of the scene's pair, and the pair at its contact point.
fn measured(contact: &NodeToFacet, y: &[f64]) -> (Rows, Pair) {
    let mut rows = Rows::new(2);
    let mut pair = pair();
    contact.measure(&mut pair, y, &mut rows).unwrap();
    (rows, pair)
}

fn gap(contact: &NodeToFacet, y: &[f64]) -> f64 {
    measured(contact, y).0.row(0).gap
}

/// λ ∂g/∂y over all dofs of the scene.
fn force(contact: &NodeToFacet, y: &[f64], lambda: f64) -> Vec<f64> {
    let mut full = vec![0.0; y.len()];
    measured(contact, y).0.row(0).add_to(lambda, &mut full);
    full
}

/// λ ∂²g/∂y∂y over all dofs of the scene.
fn stiffness(contact: &NodeToFacet, y: &[f64], lambda: f64) -> Vec<f64> {
    let (rows, pair) = measured(contact, y);
    let dofs: Vec<usize> = rows.row(0).entries().map(|(dof, _)| dof).collect();
    let m = dofs.len();
    let n = y.len();
    let mut curvature = vec![0.0; m * m];
    let mut full = vec![0.0; n * n];
    contact.curvature_into(&pair, y, &mut curvature);
    for (a, row) in dofs.iter().enumerate() {
        for (b, column) in dofs.iter().enumerate() {
            full[row * n + column] = lambda * curvature[a * m + b];
        }
    }
    full
}

#[test]
fn gradient_and_second_derivative_agree_with_differences() {
    for (shape, point) in SHAPES.into_iter().flat_map(|shape| POINTS.map(|point| (shape, point))) {
        for height in [0.4, 0.17, 0.02] {
            let (contact, y) = scene(shape, point, height);
            let error = jacobian_error(&y, 1e-3, |y| vec![gap(&contact, y)], &force(&contact, &y, 1.0));
            assert!(error < 1e-9, "{shape:?} {point:?}: gradient {error:e}");

            let lambda = -2.5;
            let n = y.len();
            let hessian = stiffness(&contact, &y, lambda);
            let error = jacobian_error(&y, 1e-3, |y| force(&contact, y, lambda), &hessian);
            assert!(error < 1e-8, "{shape:?} {point:?}: second derivative {error:e}");
            for a in 0..n {
                for b in 0..n {
                    assert!((hessian[a * n + b] - hessian[b * n + a]).abs() < 1e-12);
                }
            }
        }
    }
}

/// With a frozen ξ this needs the extra term of eq. (11): without it the moment would be that of λ
/// on the arm of the slip.
#[test]
fn force_and_moment_balance() {
    for (shape, point) in SHAPES.into_iter().flat_map(|shape| POINTS.map(|point| (shape, point))) {
        let (contact, y) = scene(shape, point, 0.05);
        let f = force(&contact, &y, -7.0);
        let mut sum = Vector::ZERO;
        let mut moment = 0.0;
        for (y, f) in y.as_chunks::<2>().0.iter().zip(f.as_chunks::<2>().0) {
            sum += Vector(*f);
            moment += y[0] * f[1] - y[1] * f[0];
        }
        assert!(sum.norm() < 7e-12 && moment.abs() < 7e-12, "{shape:?} {point:?}: {sum:?} {moment:e}");
    }
}

#[test]
fn the_gap_does_not_see_a_rigid_motion() {
    for point in POINTS {
        let (contact, y) = scene(FacetShape::L4, point, 0.3);
        let (s, c) = 2.1_f64.sin_cos();
        let motion = |x: &[f64]| [c * x[0] - s * x[1] + 5.0, s * x[0] + c * x[1] - 3.0];
        let moved: Vec<f64> = y.chunks(2).flat_map(motion).collect();
        assert!((gap(&contact, &y) - gap(&contact, &moved)).abs() < 1e-13);
    }
}

/// A node that slides by s on a circle's tangent is κs²/2 off the circle, to fourth order in s.
#[test]
fn a_frozen_point_leaves_the_node_on_the_tangent_line() {
    let radius = 2.0;
    // An arc of ±0.2 rad by a cubic through four of its points, traversed with the body below.
    let arc =
        [-0.2, 0.2, -0.2 / 3.0, 0.2 / 3.0].map(|angle: f64| [-radius * angle.sin(), radius * angle.cos()]);
    let surface = Surface::new(FacetShape::L4, &[vec![1, 2, 3, 4]], &[1.0]);
    let contact = NodeToFacet::new(vec![0], surface, Detection::Trajectory).with_point(ContactPoint::Frozen);
    for slip in [0.01, 0.02, 0.04] {
        let y = [&[slip, radius][..], arc.as_flattened()].concat();
        let mut rows = Rows::new(2);
        let mut pair = Pair { xi: 0.0, ..pair() };
        contact.measure(&mut pair, &y, &mut rows).unwrap();
        let printed = rows.row(0).gap;
        contact.start_step(&mut pair, &y);
        contact.measure(&mut pair, &y, &mut rows).unwrap();
        let distance = rows.row(1).gap - printed;
        // The cubic misses the circle by 0.2⁴/216 of its radius, on both lines of this difference.
        let expected = (radius * radius + slip * slip).sqrt() - radius;
        assert!((distance - expected).abs() < 0.05 * expected, "{slip}: {distance:e}, {expected:e}");
        assert!((expected - slip * slip / (2.0 * radius)).abs() < 1e-3 * expected);
    }
}

/// The contact point of a step is the closest point at its start, on the facet where that lies.
#[test]
fn a_frozen_point_changes_facets_between_steps_only() {
    let (surface, mut y) = chain(0.0);
    y.extend([-0.3, 0.0]);
    let contact = NodeToFacet::new(vec![3], surface, Detection::Trajectory).with_point(ContactPoint::Frozen);
    let mut pairing = Pairing::new(vec![Pair { xi: 0.9, ..pair() }]);
    let mut events = Vec::new();
    assert!(!contact.search(&y, &y, &mut pairing, &mut events) && events.is_empty());
    assert!(!contact.update_facets(&y, &mut pairing, &mut events) && events.is_empty());
    contact.start_step(&mut pairing.pairs[0], &y);
    assert!(contact.search(&y, &y, &mut pairing, &mut events));
    assert!(pairing.pairs[0].facet == 1 && (pairing.pairs[0].xi - -0.4).abs() < 1e-12);
}

/// A chain of straight facets traversed from right to left (body below): y = 0 for x > 0, rising to
/// the left by `kink`.
fn chain(kink: f64) -> (Surface, Vec<f64>) {
    let y = vec![1.0, 0.0, 0.0, 0.0, -1.0, kink];
    (Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2]], &[1.0; 2]), y)
}

#[test]
fn a_sliding_node_is_handed_over_once_and_not_back() {
    let (surface, mut y) = chain(0.05);
    y.extend([-0.3, -0.001]);
    let contact = NodeToFacet::new(vec![3], surface, Detection::ClosestPoint);
    let mut pairing = Pairing::new(vec![Pair { xi: 1.3, ..pair() }]);
    let mut events = Vec::new();
    assert!(contact.search(&y, &y, &mut pairing, &mut events));
    assert_eq!(
        (pairing.pairs[0].facet, &events[..]),
        (1, &[PairEvent::HandOver { node: 3, from: 0, to: 1 }][..])
    );
    pairing.pairs[0].xi = -1.1;
    y[6] = 0.1;
    contact.search(&y, &y, &mut pairing, &mut events);
    assert_eq!(pairing.pairs[0].facet, 1, "not back within the step");
}

#[test]
fn a_fast_node_is_caught_on_a_closed_thin_body() {
    // A plate of thickness 0.01, all four sides one loop; the node passes through it in one step.
    let plate = [-1.0, 0.0, 1.0, 0.0, 1.0, 0.01, -1.0, 0.01];
    let [y0, y1] = [[0.3, 2.0], [0.31, -2.0]].map(|node| [&plate[..], &node].concat());
    let loop_ = Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2], vec![2, 3], vec![3, 0]], &[1.0; 4]);
    let contact = NodeToFacet::new(vec![4], loop_, Detection::ClosestPoint);
    let mut pairing = Pairing::default();
    assert!(contact.search(&y0, &y1, &mut pairing, &mut Vec::new()));
    assert_eq!((pairing.pairs.len(), pairing.pairs[0].facet), (1, 2), "it entered through the upper side");
}

#[test]
fn a_node_behind_a_plate_that_never_crossed_its_upper_side_is_left_alone() {
    let (surface, mut y) = chain(0.0);
    y.extend([0.5, -0.2]);
    let contact = NodeToFacet::new(vec![3], surface, Detection::ClosestPoint);
    let mut now = y.clone();
    now[7] = -0.15;
    let mut pairing = Pairing::default();
    assert!(!contact.search(&y, &now, &mut pairing, &mut Vec::new()));
    assert!(pairing.pairs.is_empty());
}

/// A node inside by round-off no longer crosses a surface; if it were missed once, it would always
/// be missed.
#[test]
fn a_node_inside_by_round_off_is_found_under_both_rules() {
    for detection in [Detection::ClosestPoint, Detection::Trajectory] {
        for depth in [1e-16, 1e-12, 1e-9] {
            let (surface, mut y) = chain(0.0);
            y.extend([0.5, -depth]);
            let contact = NodeToFacet::new(vec![3], surface, detection);
            let mut now = y.clone();
            now[7] = -depth - 1e-7;
            let mut pairing = Pairing::default();
            assert!(contact.search(&y, &now, &mut pairing, &mut Vec::new()), "{detection:?} {depth:e}");
            assert_eq!(pairing.pairs.len(), 1);
        }
    }
}
