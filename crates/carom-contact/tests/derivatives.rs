//! Gap derivatives of node-to-segment contact on curved facets of every order against differences; balance of force and moment; objectivity.

#![allow(clippy::unwrap_used)]

use carom_algebra::{Vector, jacobian_error};
use carom_contact::{ContactMethod, Detection, Linearised, NodeToSegment, Pair, Surface};

/// A bent facet of 2, 3 or 4 nodes (1 …) and a node (0) near it, inside or outside.
fn scene(order: usize, height: f64) -> (NodeToSegment, Vec<[f64; 2]>) {
    let mut y = vec![[0.23, height], [1.0, 0.1], [-1.1, -0.05]];
    match order {
        2 => {}
        3 => y.push([0.05, 0.21]),
        _ => y.extend([[0.4, 0.22], [-0.35, 0.12]]),
    }
    let facet: Vec<usize> = (1..y.len()).collect();
    (NodeToSegment::new(vec![0], Surface::new(&[facet]), Detection::ClosestPoint), y)
}

fn pair() -> Pair {
    Pair { node: 0, facet: 0, xi: 0.1, active: true, lambda: -3.0, start: None, left: None }
}

fn linearised(contact: &NodeToSegment, y: &[[f64; 2]], lambda: f64) -> Linearised<2> {
    let mut out = Linearised::default();
    contact.linearise(&mut pair(), y, lambda, &mut out).unwrap();
    out
}

/// Gradient over all dofs of the scene.
fn gradient(contact: &NodeToSegment, y: &[[f64; 2]], lambda: f64) -> Vec<f64> {
    let gap = linearised(contact, y, lambda);
    let mut full = vec![0.0; 2 * y.len()];
    for p in 0..gap.count {
        for i in 0..2 {
            full[2 * gap.nodes[p] + i] += lambda * gap.gradient[p][i];
        }
    }
    full
}

#[test]
fn gradient_and_second_derivative_agree_with_differences() {
    for order in 2..=4 {
        for height in [0.4, 0.17, 0.02] {
            let (contact, y) = scene(order, height);
            let flat: Vec<f64> = y.concat();
            let at = |x: &[f64]| x.as_chunks::<2>().0.to_vec();
            let g = gradient(&contact, &y, 1.0);
            let error = jacobian_error(&flat, 1e-3, |x| vec![linearised(&contact, &at(x), 1.0).gap], &g);
            assert!(error < 1e-9, "order {order}: gradient {error:e}");

            let lambda = -2.5;
            let gap = linearised(&contact, &y, lambda);
            let n = flat.len();
            let mut hessian = vec![0.0; n * n];
            for p in 0..gap.count {
                for q in 0..gap.count {
                    for i in 0..2 {
                        for j in 0..2 {
                            let (a, b) = (2 * gap.nodes[p] + i, 2 * gap.nodes[q] + j);
                            hessian[a * n + b] = gap.hessian[p][q].0[i][j];
                        }
                    }
                }
            }
            let error = jacobian_error(&flat, 1e-3, |x| gradient(&contact, &at(x), lambda), &hessian);
            assert!(error < 1e-8, "order {order}: second derivative {error:e}");
            for a in 0..n {
                for b in 0..n {
                    assert!((hessian[a * n + b] - hessian[b * n + a]).abs() < 1e-12);
                }
            }
        }
    }
}

#[test]
fn force_and_moment_balance() {
    for order in 2..=4 {
        let (contact, y) = scene(order, 0.05);
        let f = gradient(&contact, &y, -7.0);
        let forces = f.as_chunks::<2>().0;
        let (mut sum, mut moment) = (Vector::ZERO, 0.0);
        for (y, f) in y.iter().zip(forces) {
            sum += Vector(*f);
            moment += y[0] * f[1] - y[1] * f[0];
        }
        assert!(sum.norm() < 7e-12 && moment.abs() < 7e-12, "order {order}: {sum:?} {moment:e}");
    }
}

#[test]
fn the_gap_does_not_see_a_rigid_motion() {
    let (contact, y) = scene(4, 0.3);
    let (s, c) = 2.1_f64.sin_cos();
    let moved: Vec<[f64; 2]> = y.iter().map(|x| [c * x[0] - s * x[1] + 5.0, s * x[0] + c * x[1] - 3.0]).collect();
    assert!((linearised(&contact, &y, 1.0).gap - linearised(&contact, &moved, 1.0).gap).abs() < 1e-13);
}

/// A chain of straight facets walked from right to left (body below): y = 0 for x > 0, rising to the left by `kink`.
fn chain(kink: f64) -> (Surface, Vec<[f64; 2]>) {
    let y = vec![[1.0, 0.0], [0.0, 0.0], [-1.0, kink]];
    (Surface::new(&[vec![0, 1], vec![1, 2]]), y)
}

#[test]
fn a_sliding_node_is_handed_over_once_and_not_back() {
    let (surface, mut y) = chain(0.05);
    y.push([-0.3, -0.001]);
    let contact = NodeToSegment::new(vec![3], surface, Detection::ClosestPoint);
    let mut pairs = vec![Pair { xi: 1.3, ..pair() }];
    let mut events = Vec::new();
    assert!(contact.detect(&y, &y, &mut pairs, &mut events).unwrap());
    assert_eq!((pairs[0].facet, pairs[0].left, events.len()), (1, Some(0), 1));
    pairs[0].xi = -1.1;
    y[3] = [0.1, -0.001];
    contact.detect(&y, &y, &mut pairs, &mut events).unwrap();
    assert_eq!(pairs[0].facet, 1, "not back within the step");
}

#[test]
fn a_fast_node_is_caught_on_a_closed_thin_body() {
    // A plate of thickness 0.01, all four sides one loop; the node flies right through it in one step.
    let y0 = vec![[-1.0, 0.0], [1.0, 0.0], [1.0, 0.01], [-1.0, 0.01], [0.3, 2.0]];
    let mut y1 = y0.clone();
    y1[4] = [0.31, -2.0];
    let loop_ = Surface::new(&[vec![0, 1], vec![1, 2], vec![2, 3], vec![3, 0]]);
    let contact = NodeToSegment::new(vec![4], loop_, Detection::ClosestPoint);
    let mut pairs = Vec::new();
    assert!(contact.detect(&y0, &y1, &mut pairs, &mut Vec::new()).unwrap());
    assert_eq!((pairs.len(), pairs[0].facet), (1, 2), "it entered through the upper side");
}

#[test]
fn a_node_behind_a_plate_that_never_crossed_its_upper_side_is_left_alone() {
    let (surface, mut y) = chain(0.0);
    y.push([0.5, -0.2]);
    let contact = NodeToSegment::new(vec![3], surface, Detection::ClosestPoint);
    let mut now = y.clone();
    now[3][1] = -0.15;
    let mut pairs = Vec::new();
    assert!(!contact.detect(&y, &now, &mut pairs, &mut Vec::new()).unwrap());
    assert!(pairs.is_empty());
}

/// A node that round-off left inside crosses no surface any more; missing it once would be missing it for ever.
#[test]
fn a_node_inside_by_round_off_is_found_under_both_rules() {
    for detection in [Detection::ClosestPoint, Detection::Trajectory] {
        for depth in [1e-16, 1e-12, 1e-9] {
            let (surface, mut y) = chain(0.0);
            y.push([0.5, -depth]);
            let contact = NodeToSegment::new(vec![3], surface, detection);
            let mut now = y.clone();
            now[3][1] = -depth - 1e-7;
            let mut pairs = Vec::new();
            assert!(contact.detect(&y, &now, &mut pairs, &mut Vec::new()).unwrap(), "{detection:?} {depth:e}");
            assert_eq!(pairs.len(), 1);
        }
    }
}
