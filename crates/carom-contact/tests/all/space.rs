//! Contact in space: derivatives of the gap against differences, balance of force and moment,
//! objectivity, the sign of the distance to a closed surface, hand-over across edges, concave
//! corners.

use carom_algebra::{Vector, jacobian_error};
use carom_contact::{
    Boundary, ClosedSurface, DiscreteGradient, Kinematics, NodeToPatch, Pair, Pairing, Rows,
};
use carom_solid::FacetShape;

pub(crate) const SHAPES: [FacetShape; 5] =
    [FacetShape::T3, FacetShape::T6, FacetShape::T10, FacetShape::Q4, FacetShape::Q9];

/// Places of the nodes of a facet in its plane: corners, then edge by edge, then the interior.
pub(crate) fn lattice(shape: FacetShape) -> Vec<[f64; 2]> {
    let k = shape.degree();
    let corners: &[[f64; 2]] = match shape.corners() {
        3 => &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
        _ => &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
    };
    let mut places = corners.to_vec();
    for (e, a) in corners.iter().enumerate() {
        let b = corners[(e + 1) % corners.len()];
        for i in 1..k {
            let s = i as f64 / k as f64;
            places.push([a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])]);
        }
    }
    match shape {
        FacetShape::T10 => places.push([1.0 / 3.0, 1.0 / 3.0]),
        FacetShape::Q9 => places.push([0.5, 0.5]),
        _ => {}
    }
    places
}

/// A curved facet (nodes 1 …) and a node (0) near it, inside or outside.
pub(crate) fn scene(shape: FacetShape, height: f64) -> (NodeToPatch, Vec<f64>) {
    let mut y = vec![0.31, 0.27, height];
    for [x, z] in lattice(shape) {
        y.extend([x + 0.05 * z * z, z - 0.07 * x * z, 0.15 * (2.0 * x + z).sin() - 0.1 * x * z]);
    }
    let facet: Vec<usize> = (1..y.len() / 3).collect();
    (NodeToPatch::new(vec![0], Boundary::new(shape, &[facet], &[], 0)), y)
}

fn measured(contact: &NodeToPatch, y: &[f64]) -> (Rows, Pair) {
    let mut rows = Rows::new(3);
    let mut pair = Pair { active: true, ..Pair::open(0, 0, 0.2) };
    contact.measure(&mut pair, y, &mut rows).unwrap();
    (rows, pair)
}

fn force(contact: &NodeToPatch, y: &[f64], lambda: f64) -> Vec<f64> {
    let mut full = vec![0.0; y.len()];
    measured(contact, y).0.row(0).add_to(lambda, &mut full);
    full
}

#[test]
fn gradient_and_second_derivative_agree_with_differences() {
    for (shape, height) in SHAPES.into_iter().flat_map(|shape| [0.5, 0.2, 0.02].map(|h| (shape, h))) {
        let (contact, y) = scene(shape, height);
        let (_, pair) = measured(&contact, &y);
        let gap = |y: &[f64]| vec![measured(&contact, y).0.row(0).gap];
        let error = jacobian_error(&y, 1e-3, gap, &force(&contact, &y, 1.0));
        assert!(error < 1e-9, "{shape:?}: gradient {error:e}");
        let mut hessian = vec![0.0; y.len() * y.len()];
        contact.curvature_into(&pair, &y, &mut hessian);
        let error = jacobian_error(&y, 1e-3, |y| force(&contact, y, 1.0), &hessian);
        assert!(error < 1e-8, "{shape:?}: second derivative {error:e}");
        let n = y.len();
        let skew = |e: usize| (hessian[e] - hessian[e % n * n + e / n]).abs();
        assert!((0..n * n).all(|e| skew(e) < 1e-12), "{shape:?}");
    }
}

#[test]
fn force_and_moment_balance_and_the_gap_sees_no_rigid_motion() {
    for shape in SHAPES {
        let (contact, y) = scene(shape, 0.4);
        let f = force(&contact, &y, -7.0);
        let mut sum = Vector::<3>::ZERO;
        let mut moment = Vector::<3>::ZERO;
        for (y, f) in y.as_chunks::<3>().0.iter().zip(f.as_chunks::<3>().0) {
            sum += Vector(*f);
            moment += Vector(std::array::from_fn(|i| {
                let j = (i + 1) % 3;
                let k = (i + 2) % 3;
                y[j] * f[k] - y[k] * f[j]
            }));
        }
        assert!(sum.norm() < 1e-13 && moment.norm() < 1e-13, "{shape:?}: {sum:?} {moment:?}");
        let (s, c) = 2.1_f64.sin_cos();
        let turned = |x: &[f64; 3]| [c * x[1] - s * x[2] + 5.0, s * x[1] + c * x[2] - 3.0, x[0]];
        let moved: Vec<f64> = y.as_chunks::<3>().0.iter().flat_map(turned).collect();
        let gap = |y: &[f64]| measured(&contact, y).0.row(0).gap;
        assert!((gap(&y) - gap(&moved)).abs() < 1e-13);
    }
}

/// Nodes and facets of the boundary of the unit cube, two triangles a face.
fn cube() -> (Vec<f64>, Vec<Vec<usize>>) {
    let y = (0..8).flat_map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (y, faces.iter().flat_map(|&[a, b, c, d]| [vec![a, b, c], vec![a, c, d]]).collect())
}

#[test]
fn the_sign_and_the_distance_are_those_of_a_cube() {
    let (y, facets) = cube();
    let mut surface = ClosedSurface::new(Boundary::new(FacetShape::T3, &facets, &[], 0));
    surface.update(&y);
    for k in 0..2000 {
        let at = [0.7, 1.1, 1.9].map(|w| 0.5 + 1.1 * (f64::from(k) * w).sin());
        let outside = at.map(|x| (x - 1.0).max(-x).max(0.0));
        let inside = at.iter().map(|x| x.min(1.0 - x)).fold(f64::INFINITY, f64::min);
        let square: f64 = outside.iter().map(|d| d * d).sum();
        let exact = if square > 0.0 { square.sqrt() } else { -inside };
        let found = surface.depth(at, None, &y).unwrap();
        assert!((found.distance - exact).abs() < 1e-14, "{at:?}: {found:?} {exact}");
    }
}

/// A strip of 2 × `count` quadrilaterals over x = 0 … count, of height `height(x)`; its nodes begin
/// at 1.
fn strip(count: usize, height: impl Fn(f64) -> f64) -> (Boundary, Vec<f64>) {
    let mut y = vec![0.0; 3];
    for x in 0..=count {
        (0..3).for_each(|z| y.extend([x as f64, f64::from(z) - 1.0, height(x as f64)]));
    }
    let node = |x: usize, z: usize| 1 + 3 * x + z;
    let facet = |k: usize| {
        let x = k / 2;
        let z = k % 2;
        vec![node(x, z), node(x + 1, z), node(x + 1, z + 1), node(x, z + 1)]
    };
    let facets: Vec<Vec<usize>> = (0..2 * count).map(facet).collect();
    (Boundary::new(FacetShape::Q4, &facets, &[], 0), y)
}

#[test]
fn a_node_that_slides_is_handed_over_and_leaves_at_the_end() {
    let (surface, y) = strip(3, |_| 0.0);
    let contact = NodeToPatch::new(vec![0], surface);
    let at = |x: f64, z: f64| {
        let mut y = y.clone();
        y[..3].copy_from_slice(&[x, 0.3, z]);
        y
    };
    let mut pairing = Pairing::default();
    let mut events = Vec::new();
    let before = at(0.5, 0.1);
    let now = at(0.6, -0.01);
    assert!(contact.search(&before, &now, &mut pairing, &mut events));
    assert_eq!((pairing.pairs.len(), pairing.pairs[0].facet), (1, 1));
    let mut last = now;
    let mut facets = Vec::new();
    for x in [1.2, 1.9, 2.4, 3.5] {
        let pairs = std::mem::take(&mut pairing.pairs);
        pairing = Pairing::new(pairs.into_iter().map(|pair| Pair { active: true, ..pair }).collect());
        let now = at(x, 0.0);
        for pair in &mut pairing.pairs {
            contact.measure(pair, &now, &mut Rows::new(3)).unwrap();
        }
        contact.search(&last, &now, &mut pairing, &mut events);
        facets.push(pairing.pairs.first().map(|pair| pair.facet));
        last = now;
    }
    assert_eq!(facets, [Some(3), Some(3), Some(5), None]);
}

/// An L-shaped plate in the plane z = 0: three unit squares of two triangles each, divided along
/// one diagonal or the other; its nodes begin at 1.
fn bracket(is_falling: bool) -> (Boundary, Vec<f64>) {
    let mut y = vec![0.0; 3];
    for k in 0..9 {
        y.extend([f64::from(k % 3), f64::from(k / 3), 0.0]);
    }
    let mut facets = Vec::new();
    for lowest in [1, 2, 4] {
        let [a, b, c, d] = [lowest, lowest + 1, lowest + 4, lowest + 3];
        facets.extend(if is_falling {
            [vec![a, b, d], vec![b, c, d]]
        } else {
            [vec![a, b, c], vec![a, c, d]]
        });
    }
    (Boundary::new(FacetShape::T3, &facets, &[], 0), y)
}

#[test]
fn nodes_meet_a_plate_above_it_and_nothing_beside_it() {
    for is_falling in [false, true] {
        let (surface, y) = bracket(is_falling);
        let contact = NodeToPatch::new(vec![0], surface);
        let at = |x: f64, z: f64, height: f64| {
            let mut y = y.clone();
            y[..3].copy_from_slice(&[x, z, height]);
            y
        };
        for k in 0..576 {
            let [x, z] = [k % 24, k / 24].map(|i| 0.1 * f64::from(i) - 0.155);
            let within = [x, z, 2.0 - x.max(z), 1.0 - x.min(z)].into_iter().fold(f64::INFINITY, f64::min);
            let mut pairing = Pairing::default();
            let before = at(x, z, 1e-3);
            contact.search(&before, &at(x, z, -1e-3), &mut pairing, &mut Vec::new());
            assert_eq!(pairing.pairs.len(), usize::from(within > 0.0), "{is_falling} {x} {z}");
        }
    }
}

#[test]
fn a_node_that_crosses_a_thin_body_in_one_step_is_found() {
    let (surface, y) = strip(2, |_| 0.0);
    let contact = NodeToPatch::new(vec![0], surface);
    let at = |z: f64| {
        let mut y = y.clone();
        y[..3].copy_from_slice(&[0.4, 0.4, z]);
        y
    };
    let mut pairing = Pairing::default();
    let mut events = Vec::new();
    assert!(contact.search(&at(3.0), &at(-5.0), &mut pairing, &mut events));
    assert_eq!(pairing.pairs.len(), 1);
    let mut pairing = Pairing::default();
    let mut events = Vec::new();
    assert!(!contact.search(&at(-5.0), &at(3.0), &mut pairing, &mut events));
}

/// The point nearest to `target` with nᵢ·x ≥ 0 for all planes, over all sets that may hold with
/// equality.
fn projected(target: [f64; 3], planes: &[Vector<3>]) -> Vector<3> {
    let of = |set: usize| {
        let mut x = Vector(target);
        let mut basis = Vec::<Vector<3>>::new();
        for (_, plane) in planes.iter().enumerate().filter(|(i, _)| set >> i & 1 == 1) {
            let rest = basis.iter().fold(*plane, |rest, axis| rest - *axis * rest.dot(axis));
            if rest.norm() > 1e-9 {
                basis.push(rest * rest.norm().recip());
            }
        }
        basis.iter().for_each(|axis| x -= *axis * x.dot(axis));
        x
    };
    let outside = |x: &Vector<3>| planes.iter().all(|plane| plane.dot(x) > -1e-12);
    let all = (0..1 << planes.len()).map(of).filter(outside);
    let distance = |x: &Vector<3>| (*x - Vector(target)).norm();
    all.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap()
}

/// Two facets meet in a valley, and end in a plane. A node that has sunk beside the valley, with
/// its foot past the end by round-off, is not below the crease; one that has sunk below it is.
#[test]
fn a_crease_is_where_a_foot_is_past_it() {
    let nodes = [
        [-1.0, 0.0, 0.2],
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.2],
        [-1.0, 1.0, 0.2],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 0.2],
    ];
    let facets = [vec![1, 2, 5, 4], vec![2, 3, 6, 5]];
    let contact = NodeToPatch::new(vec![0], Boundary::new(FacetShape::Q4, &facets, &[], 0));
    for (x, expected) in [(0.1, 1), (0.001, 2)] {
        let y = [&[[x, -1e-6, -0.1]], &nodes[..]].concat().into_flattened();
        let mut pairing = Pairing::new(vec![Pair { active: true, ..Pair::open(0, 1, 0.0) }]);
        pairing.fresh = false;
        contact.measure(&mut pairing.pairs[0], &y, &mut Rows::new(3)).unwrap();
        contact.search(&y, &y, &mut pairing, &mut Vec::new());
        assert_eq!(pairing.pairs.len(), expected, "{x}: {:?}", pairing.pairs);
    }
}

/// Facets of z = |x| + |y|, pulled at from below: what holds the node there must hold it outside of
/// all four, wherever they meet.
#[test]
fn a_node_in_a_hollow_of_four_facets_is_held_by_those_that_it_would_enter() {
    let place = |k: usize| [k / 3, k % 3].map(|i| i as f64 - 1.0);
    let mut y = vec![0.0; 3];
    (0..9).map(place).for_each(|[x, z]| y.extend([x, z, x.abs() + z.abs()]));
    let facet = |k: usize| {
        let node = 1 + 3 * (k / 2) + k % 2;
        vec![node, node + 3, node + 4, node + 1]
    };
    let facets: Vec<Vec<usize>> = (0..4).map(facet).collect();
    let contact = NodeToPatch::new(vec![0], Boundary::new(FacetShape::Q4, &facets, &[], 0));
    let normal = |facet: usize| {
        let [x, z] = [facet / 2, facet % 2].map(|i| 1.0 - 2.0 * i as f64);
        Vector([x, z, 1.0]) * (1.0 / 3.0_f64.sqrt())
    };
    let at = |x: [f64; 3]| [&x[..], &y[3..]].concat();
    for k in 0..400 {
        let wave = |w: f64| 0.12 * (f64::from(k) * w).sin();
        let mut last = at([wave(0.7), wave(1.1), 0.5]);
        let target = [wave(1.9), wave(2.3), wave(3.1) - 0.08];
        let mut pairing = Pairing::default();
        let mut now = at(target);
        // It is pulled below the hollow by up to a fifth of a facet, until it rests.
        for step in 0..12 {
            let pairs = std::mem::take(&mut pairing.pairs);
            pairing = Pairing::new(pairs);
            for _ in 0..30 {
                let changed = contact.search(&last, &now, &mut pairing, &mut Vec::new());
                let faced: Vec<usize> = pairing.pairs.iter().map(|pair| pair.facet).collect();
                assert!((1..faced.len()).all(|i| !faced[..i].contains(&faced[i])), "{k}: {faced:?}");
                let planes: Vec<Vector<3>> = faced.iter().map(|&facet| normal(facet)).collect();
                let x = projected(target, &planes);
                now = at(x.0);
                for (pair, plane) in pairing.pairs.iter_mut().zip(&planes) {
                    contact.measure(pair, &now, &mut Rows::new(3)).unwrap();
                    pair.active = plane.dot(&x).abs() < 1e-12;
                }
                if !changed && step > 0 {
                    break;
                }
            }
            last.clone_from(&now);
        }
        let exact = projected(target, &[0, 1, 2, 3].map(normal));
        let error = (0..3).fold(0.0_f64, |most, i| most.max((now[i] - exact.0[i]).abs()));
        assert!(error < 1e-9, "{k}: {:?} instead of {exact:?}, {:?}", &now[..3], pairing.pairs);
    }
}

/// ∇̄G over all dofs, its derivative to the end of the step, and the change of the gap.
fn discrete_gradient(contact: &dyn Kinematics, start: &[f64], end: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
    let middle: Vec<f64> = start.iter().zip(end).map(|(a, b)| 0.5 * (a + b)).collect();
    let moved: Vec<f64> = start.iter().zip(end).map(|(a, b)| b - a).collect();
    let mut rows = Rows::new(3);
    let mut pair = Pair { active: true, ..Pair::open(0, 0, 0.2) };
    contact.measure(&mut pair.clone(), start, &mut rows).unwrap();
    contact.measure(&mut pair.clone(), end, &mut rows).unwrap();
    contact.measure(&mut pair, &middle, &mut rows).unwrap();
    let change = rows.row(1).gap - rows.row(0).gap;
    let mut gradient = DiscreteGradient::default();
    gradient.evaluate(rows.row(2), change, &middle, &moved);
    let n = rows.row(2).gradient.len();
    let mut matrix = vec![0.0; n * n];
    let mut force = vec![0.0; start.len()];
    contact.curvature_into(&pair, &middle, &mut matrix);
    gradient.derivative_into(rows.row(1), &mut matrix);
    for ((dof, _), slope) in rows.row(2).entries().zip(gradient.gradient()) {
        force[dof] = *slope;
    }
    (force, matrix, change)
}

/// The end of a step: a finite rotation about an oblique axis, a translation, and a deformation.
fn end(y: &[f64], angle: f64, size: f64) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    let axis = [0.48, 0.6, 0.64];
    let turned = |x: &[f64; 3]| -> [f64; 3] {
        let along: f64 = (0..3).map(|i| axis[i] * x[i]).sum();
        std::array::from_fn(|i| {
            let j = (i + 1) % 3;
            let k = (i + 2) % 3;
            cos * x[i] + sin * (axis[j] * x[k] - axis[k] * x[j]) + (1.0 - cos) * along * axis[i]
        })
    };
    let moved = y.as_chunks::<3>().0.iter().flat_map(turned);
    moved.enumerate().map(|(k, x)| x + 0.03 + size * (2.3 * k as f64 + 1.0).sin()).collect()
}

#[test]
fn the_discrete_gradient_does_the_work_of_the_gap_without_force_or_moment() {
    for shape in SHAPES {
        let (contact, y) = scene(shape, 0.3);
        for (angle, size) in [(0.0, 0.05), (0.4, 0.05), (-0.7, 1e-3), (0.6, 0.0)] {
            let end = end(&y, angle, size);
            let (force, _, change) = discrete_gradient(&contact, &y, &end);
            let work: f64 = force.iter().zip(end.iter().zip(&y)).map(|(f, (b, a))| f * (b - a)).sum();
            let bound = if size > 0.01 { 1e-13 } else { 1e-9 };
            assert!((work - change).abs() < bound, "{shape:?} {angle} {size}: {work} {change}");
            let mut sum = [0.0; 3];
            let mut moment = [0.0; 3];
            let nodes = y.as_chunks::<3>().0.iter().zip(end.as_chunks::<3>().0);
            for (f, (a, b)) in force.as_chunks::<3>().0.iter().zip(nodes) {
                let arm: [f64; 3] = std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
                for i in 0..3 {
                    let j = (i + 1) % 3;
                    let k = (i + 2) % 3;
                    sum[i] += f[i];
                    moment[i] += arm[j] * f[k] - arm[k] * f[j];
                }
            }
            let worst = sum.iter().chain(&moment).fold(0.0_f64, |most, x| most.max(x.abs()));
            assert!(worst < 1e-13, "{shape:?} {angle} {size}: {sum:?} {moment:?}");
        }
    }
}

#[test]
fn the_derivative_of_the_discrete_gradient_agrees_with_differences() {
    for shape in SHAPES {
        let (contact, y) = scene(shape, 0.3);
        for (angle, size) in [(0.0, 0.1), (0.3, 0.1)] {
            let end = end(&y, angle, size);
            let (_, derivative, _) = discrete_gradient(&contact, &y, &end);
            let error =
                jacobian_error(&end, 1e-2 * size, |end| discrete_gradient(&contact, &y, end).0, &derivative);
            assert!(error < 2e-6, "{shape:?} {angle} {size}: {error:e}");
        }
    }
}

/// A node 0.03 beside the sharp edge of a face, below which its own facet leans by 40° and nearly
/// contains the edge: the edge is kept out of that facet instead, but not while the node presses.
#[test]
fn a_node_that_presses_is_not_left_to_an_edge() {
    // The face z = 0, seen from below, and the side x = 0.
    let mut y = vec![0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 0.0];
    y.extend([0.0, 1.0, 1.0, 0.0, 0.0, 1.0]);
    let face = vec![0, 1, 2, 3];
    let side = vec![0, 5, 4, 1];
    // The node, and the rest of its facet.
    let (s, c) = 40.0_f64.to_radians().sin_cos();
    y.extend([0.03, 0.5, 0.0, 0.03, 1.5, 0.0, 0.03 - c, 1.5, s, 0.03 - c, 0.5, s]);
    let own = Boundary::new(FacetShape::Q4, &[vec![6, 7, 8, 9]], &[], 0);
    let primary = Boundary::new(FacetShape::Q4, &[face, side], &[], 0);
    assert!(primary.patch(0).at(&y, [0.0; 2]).normal[2] < -0.99);
    assert!(own.patch(0).at(&y, [0.0; 2]).normal[2] > 0.7);
    let contact = NodeToPatch::new(vec![6], primary).of_body(own);
    let kept = |active: bool| {
        let mut pair = Pair { active, ..Pair::open(0, 0, 0.0) };
        contact.measure(&mut pair, &y, &mut Rows::new(3)).unwrap();
        let mut pairing = Pairing::new(vec![pair]);
        contact.search(&y, &y, &mut pairing, &mut Vec::new());
        pairing.pairs.len()
    };
    assert_eq!([kept(false), kept(true)], [0, 1]);
}
