//! Sharp edges against sharp edges: derivatives of the gap against differences on both sides of
//! zero, balance of force and moment, when pairs arise, go on and leave.

use std::collections::BTreeSet;

use carom_algebra::{Vector, jacobian_error};
use carom_contact::{
    Boundary, Combined, DiscreteGradient, EdgeToEdge, Kinematics, NodeToPatch, Pair, PairEvent, Pairing, Rows,
};
use carom_solid::FacetShape;

use crate::space::{SHAPES, lattice};

/// Two roofs of `count` facets on each slope: one with its ridge along x over 0 … count, and one
/// upside down with its ridge along y, `height` above.
fn roofs(
    shape: FacetShape,
    count: usize,
    height: f64,
    bend: impl Fn([f64; 3]) -> [f64; 3],
) -> (Combined, Vec<f64>) {
    let mut y = Vec::<f64>::new();
    let mut sides = Vec::new();
    for is_upper in [false, true] {
        let first = y.len() / 3;
        let mut facets = Vec::new();
        for k in 0..2 * count {
            let along = (k / 2) as f64;
            let mut facet = Vec::new();
            for [s, t] in lattice(shape) {
                let low = if k % 2 == 0 { [along + s, t, -t] } else { [along + 1.0 - s, -t, -t] };
                let shift = 0.5 * count as f64;
                let at = bend(low);
                let at =
                    if is_upper { [at[1] + shift - 0.05, at[0] - shift + 0.1, height - at[2]] } else { at };
                let apart = |x: &[f64; 3]| (0..3).map(|i| (x[i] - at[i]).abs()).fold(0.0, f64::max);
                let known = y[3 * first..].as_chunks::<3>().0.iter().position(|x| apart(x) < 1e-12);
                facet.push(first + known.unwrap_or(y.len() / 3 - first));
                if known.is_none() {
                    y.extend(at);
                }
            }
            facets.push(facet);
        }
        sides.push(facets);
    }
    let lower = &sides[0];
    let upper = &sides[1];
    let [below, above] = [lower, upper].map(|facets| Boundary::new(shape, facets, &[], 0));
    let nodes = |facets: &Vec<Vec<usize>>| -> Vec<usize> {
        let mut nodes = facets.concat();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    let edges = EdgeToEdge::new([above.clone(), below.clone()], &[BTreeSet::new(), BTreeSet::new()], &y);
    let allowed = vec![1.0; nodes(lower).len()];
    let reverse = NodeToPatch::new(nodes(lower), above).with_allowed(allowed).reversed();
    let upper_nodes = NodeToPatch::new(nodes(upper), below);
    (Combined::new(vec![Box::new(upper_nodes), Box::new(reverse), Box::new(edges)]), y)
}

fn straight(x: [f64; 3]) -> [f64; 3] {
    x
}

fn bent([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x + 0.05 * x * z, y + 0.06 * (2.0 * x).sin(), z + 0.08 * x * (1.0 - x) - 0.03 * y * x]
}

/// The pair of the only edges, at its closest points.
fn measured(contact: &Combined, y: &[f64]) -> (Rows, Pair) {
    let pair = Pair { active: true, eta: -0.1, ..Pair::open(contact.nodes(), 2, 0.1) };
    let mut rows = Rows::new(3);
    let mut pair = pair;
    contact.measure(&mut pair, y, &mut rows).unwrap();
    (rows, pair)
}

fn force(contact: &Combined, y: &[f64], lambda: f64) -> Vec<f64> {
    let mut full = vec![0.0; y.len()];
    measured(contact, y).0.row(0).add_to(lambda, &mut full);
    full
}

#[test]
fn gradient_and_second_derivative_agree_with_differences_on_both_sides_of_zero() {
    for (shape, height) in SHAPES.into_iter().flat_map(|shape| [0.2, 0.0, -0.1].map(|h| (shape, h))) {
        let (contact, y) = roofs(shape, 1, height, bent);
        let (rows, pair) = measured(&contact, &y);
        assert!(rows.row(0).normal()[2] > 0.9 && (rows.row(0).gap - height).abs() < 0.1);
        let gap = |y: &[f64]| vec![measured(&contact, y).0.row(0).gap];
        let error = jacobian_error(&y, 1e-3, gap, &force(&contact, &y, 1.0));
        assert!(error < 1e-9, "{shape:?} {height}: gradient {error:e}");
        let nodes = rows.row(0).nodes;
        let count = rows.row(0).gradient.len();
        let mut hessian = vec![0.0; count * count];
        contact.curvature_into(&pair, &y, &mut hessian);
        let of_row = |y: &[f64]| -> Vec<f64> {
            let full = force(&contact, y, 1.0);
            nodes.iter().flat_map(|n| [0, 1, 2].map(|i| full[3 * n + i])).collect()
        };
        let moved = |x: &[f64]| -> Vec<f64> {
            let mut all = y.clone();
            nodes
                .iter()
                .enumerate()
                .for_each(|(k, n)| all[3 * n..3 * n + 3].copy_from_slice(&x[3 * k..3 * k + 3]));
            of_row(&all)
        };
        let start: Vec<f64> = nodes.iter().flat_map(|n| [0, 1, 2].map(|i| y[3 * n + i])).collect();
        let error = jacobian_error(&start, 1e-3, moved, &hessian);
        assert!(error < 1e-8, "{shape:?} {height}: second derivative {error:e}");
        let skew = |e: usize| (hessian[e] - hessian[e % count * count + e / count]).abs();
        assert!((0..count * count).all(|e| skew(e) < 1e-12), "{shape:?}");
    }
}

#[test]
fn force_and_moment_balance_and_rigid_motions_neither_open_nor_slip() {
    for shape in SHAPES {
        let (contact, y) = roofs(shape, 1, 0.15, bent);
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
        // v = ω × y + c.
        let rigid =
            |x: &[f64; 3]| [0.3 * x[2] - 0.7 * x[1] + 1.0, 0.7 * x[0] - 0.2 * x[2], 0.2 * x[1] - 0.3 * x[0]];
        let v: Vec<f64> = y.as_chunks::<3>().0.iter().flat_map(rigid).collect();
        let (_, pair) = measured(&contact, &y);
        let mut slips = Rows::new(3);
        contact.slip(&pair, &y, &[], &mut slips).unwrap();
        assert!(slips.len() == 2 && slips.iter().all(|slip| slip.along(&v).abs() < 1e-13), "{shape:?}");
        let whole = |row: usize| Vector(slips.row(row).first()).norm();
        // Curved edges that move along themselves turn the normal.
        let is_straight = shape.degree() == 1;
        assert!(!is_straight || (whole(0) - 1.0).abs() < 1e-13 && (whole(1) - 1.0).abs() < 1e-13);
    }
}

/// Where the edges touch: the row of the slip varies with the contact points and the normal.
#[test]
fn the_derivative_of_the_slip_agrees_with_differences() {
    for shape in SHAPES {
        let (contact, mut y) = roofs(shape, 1, 0.15, bent);
        let (rows, _) = measured(&contact, &y);
        let normal = rows.row(0).normal();
        let gap = rows.row(0).gap;
        let upper = y.len() / 2;
        y[upper..]
            .as_chunks_mut::<3>()
            .0
            .iter_mut()
            .for_each(|x| (0..3).for_each(|i| x[i] -= gap * normal[i]));
        let (rows, mut pair) = measured(&contact, &y);
        assert!(rows.row(0).gap.abs() < 1e-14);
        let mut slips = Rows::new(3);
        contact.slip(&pair, &y, &[], &mut slips).unwrap();
        pair.tangential.tangents = slips.tangents(0);
        let nodes = slips.row(0).nodes.to_vec();
        let count = 3 * nodes.len();
        for tangent in 0..2 {
            let mut matrix = vec![0.0; count * count];
            contact.slip_derivative_into(&pair, &y, &[], tangent, &mut matrix);
            let row = |x: &[f64]| {
                let mut all = y.clone();
                let of_node = |k: usize| &x[3 * k..3 * k + 3];
                nodes.iter().enumerate().for_each(|(k, n)| all[3 * n..3 * n + 3].copy_from_slice(of_node(k)));
                let mut rows = Rows::new(3);
                contact.slip(&pair, &all, &[], &mut rows).unwrap();
                rows.row(tangent).gradient.to_vec()
            };
            let start: Vec<f64> = nodes.iter().flat_map(|n| [0, 1, 2].map(|i| y[3 * n + i])).collect();
            let error = jacobian_error(&start, 1e-3, row, &matrix);
            assert!(error < 1e-8, "{shape:?} {tangent}: {error:e}");
        }
    }
}

#[test]
fn the_discrete_gradient_does_the_work_of_the_gap_without_force_or_moment() {
    let (contact, start) = roofs(FacetShape::Q9, 1, 0.05, bent);
    let (s, c) = 0.3_f64.sin_cos();
    let turned = |(k, x): (usize, &[f64; 3])| {
        let wave = |i: f64| 0.02 * (1.7 * k as f64 + i).sin();
        [c * x[0] - s * x[1] + wave(0.0), s * x[0] + c * x[1] + wave(1.0), x[2] + 0.1 + wave(2.0)]
    };
    let end: Vec<f64> = start.as_chunks::<3>().0.iter().enumerate().flat_map(turned).collect();
    let middle: Vec<f64> = start.iter().zip(&end).map(|(a, b)| 0.5 * (a + b)).collect();
    let moved: Vec<f64> = start.iter().zip(&end).map(|(a, b)| b - a).collect();
    let gap = |y: &[f64]| measured(&contact, y).0.row(0).gap;
    let change = gap(&end) - gap(&start);
    let (rows, _) = measured(&contact, &middle);
    let mut gradient = DiscreteGradient::default();
    gradient.evaluate(rows.row(0), change, &middle, &moved);
    let mut force = vec![0.0; start.len()];
    rows.row(0).entries().zip(gradient.gradient()).for_each(|((dof, _), slope)| force[dof] = *slope);
    let work: f64 = force.iter().zip(&moved).map(|(f, d)| f * d).sum();
    assert!((work - change).abs() < 1e-13, "{work} {change}");
    let mut worst = 0.0_f64;
    for i in 0..3 {
        let j = (i + 1) % 3;
        let k = (i + 2) % 3;
        let nodes = || force.as_chunks::<3>().0.iter().zip(middle.as_chunks::<3>().0);
        worst = worst.max(nodes().map(|(f, _)| f[i]).sum::<f64>().abs());
        worst = worst.max(nodes().map(|(f, y)| y[j] * f[k] - y[k] * f[j]).sum::<f64>().abs());
    }
    assert!(worst < 1e-13, "{worst:e}");
}

/// The upper body of `roofs` moved and turned about z through the crossing.
fn placed(y: &[f64], upper: usize, shift: [f64; 3], degrees: f64) -> Vec<f64> {
    let (s, c) = degrees.to_radians().sin_cos();
    let of = |(k, x): (usize, &[f64; 3])| {
        if k < upper {
            return *x;
        }
        let [a, b] = [x[0] - 1.45, x[1]];
        [1.45 + c * a - s * b + shift[0], s * a + c * b + shift[1], x[2] + shift[2]]
    };
    y.as_chunks::<3>().0.iter().enumerate().flat_map(of).collect()
}

/// The pairs of edges that a motion of the upper body finds.
fn found(contact: &Combined, before: &[f64], now: &[f64]) -> Vec<Pair> {
    let mut pairing = Pairing::default();
    contact.search(before, now, &mut pairing, &mut Vec::new());
    pairing.pairs.retain(|pair| pair.node >= contact.nodes());
    pairing.pairs
}

#[test]
fn edges_that_cross_in_a_step_form_a_pair_and_others_do_not() {
    let (contact, y) = roofs(FacetShape::Q4, 3, 0.1, straight);
    let upper = y.len() / 6;
    let at = |z: f64, degrees: f64| placed(&y, upper, [0.0, 0.0, z], degrees);
    let pairs = found(&contact, &at(0.0, 0.0), &at(-0.12, 0.0));
    assert_eq!(pairs.len(), 1);
    let mut rows = Rows::new(3);
    contact.measure(&mut pairs[0].clone(), &at(-0.12, 0.0), &mut rows).unwrap();
    assert!((rows.row(0).gap + 0.02).abs() < 1e-14 && (rows.row(0).normal()[2] - 1.0).abs() < 1e-14);
    let place = rows.row(0).shares().fold(Vector::<3>::ZERO, |sum, (node, share)| {
        sum + Vector(std::array::from_fn(|i| at(-0.12, 0.0)[3 * node + i])) * share
    });
    assert!((place - Vector([1.45, 0.0, -0.02])).norm() < 1e-14, "{place:?}");
    let theta = contact.met(&[pairs[0].node], &at(0.0, 0.0), &at(-0.12, 0.0));
    assert!((theta[0].unwrap() - 10.0 / 12.0).abs() < 1e-13, "{theta:?}");
    // Not yet met; far behind before; side by side; along each other.
    assert!(found(&contact, &at(0.0, 0.0), &at(-0.09, 0.0)).is_empty());
    assert!(found(&contact, &at(-0.3, 0.0), &at(-0.12, 0.0)).is_empty());
    let beside = |z: f64| placed(&y, upper, [4.0, 0.0, z], 0.0);
    assert!(found(&contact, &beside(0.0), &beside(-0.12)).is_empty());
    assert!(found(&contact, &at(0.0, 88.0), &at(-0.12, 88.0)).is_empty());
    assert_eq!(found(&contact, &at(0.0, 60.0), &at(-0.12, 60.0)).len(), 1);
}

#[test]
fn an_edge_that_rests_on_a_facet_is_left_to_nodes() {
    // The upper ridge tilts until it lies along a slope of the lower roof, at 45°, and a little
    // further: it finds back there after it has opened.
    let (contact, y) = roofs(FacetShape::Q4, 3, 0.0, straight);
    let upper = y.len() / 6;
    let tilted = |z: f64, degrees: f64| -> Vec<f64> {
        let (s, c) = f64::to_radians(degrees).sin_cos();
        let of = |(k, x): (usize, &[f64; 3])| {
            if k < upper { *x } else { [x[0], c * x[1] - s * x[2], s * x[1] + c * x[2] + z] }
        };
        y.as_chunks::<3>().0.iter().enumerate().flat_map(of).collect()
    };
    for (degrees, count) in
        [(0.0, 1), (30.0, 1), (43.0, 1), (-43.0, 1), (44.5, 1), (46.5, 0), (50.0, 0), (-50.0, 0)]
    {
        let pairs = found(&contact, &tilted(0.005, degrees), &tilted(-0.005, degrees));
        assert_eq!(pairs.len(), count, "{degrees}");
    }
}

#[test]
fn a_pair_goes_on_along_the_edges_and_leaves_at_their_end() {
    let (contact, y) = roofs(FacetShape::Q4, 3, 0.0, straight);
    let upper = y.len() / 6;
    // It goes on from where it is at the start of a step.
    let at = |x: f64, z: f64| placed(&y, upper, [x - 1.45, 0.0, z], 0.0);
    let mut last = at(0.4, 0.01);
    let mut pairs = Vec::new();
    let mut events = Vec::new();
    let mut edges = Vec::new();
    for (x, z) in
        [(0.5, -0.01), (0.8, 0.0), (1.3, 0.0), (1.9, 0.0), (2.2, 0.0), (2.9, 0.0), (3.2, 0.0), (3.3, 0.0)]
    {
        let mut pairing = Pairing::new(pairs);
        let now = at(x, z);
        contact.search(&last, &now, &mut pairing, &mut events);
        pairing.pairs.retain(|pair| pair.node >= contact.nodes());
        edges.push(pairing.pairs.first().map(|pair| pair.facet - contact.facets(0)));
        pairs = pairing.pairs;
        for pair in &mut pairs {
            pair.active = true;
            contact.measure(pair, &now, &mut Rows::new(3)).unwrap();
            assert!((pair.xi - 0.0).abs() < 1.0 && pairs_place(&contact, pair, &now, x));
        }
        last = now;
    }
    assert_eq!(edges, [Some(0), Some(0), Some(0), Some(1), Some(1), Some(2), Some(2), None]);
    let slid = events.iter().filter(|event| matches!(event, PairEvent::SlidOff { .. })).count();
    assert_eq!((events.len(), slid), (3, 1));
}

/// Whether a pair touches the lower ridge at x.
fn pairs_place(contact: &Combined, pair: &Pair, y: &[f64], x: f64) -> bool {
    let nodes = contact.facet_nodes(pair);
    let of = |end: usize| y[3 * nodes[end]];
    (0.5 * (1.0 - pair.eta) * of(0) + 0.5 * (1.0 + pair.eta) * of(1) - x).abs() < 1e-12
}

#[test]
fn a_crossing_at_nodes_has_one_pair() {
    let (contact, y) = roofs(FacetShape::Q4, 2, 0.0, straight);
    let upper = y.len() / 6;
    // Both ridges have a node in their middle.
    let at = |z: f64| placed(&y, upper, [0.05, -0.1, z], 0.0);
    let pairs = found(&contact, &at(0.01), &at(-0.01));
    assert_eq!(pairs.len(), 1, "{pairs:?}");
}

/// Ridges that bend at the nodes over which they cross: the normal is the mean of those of the four
/// pairs of edges, and derivatives are those of the mean gap.
#[test]
fn a_crossing_at_nodes_has_the_mean_of_all_edges_there() {
    let sags = |[x, y, z]: [f64; 3]| [x, y, z - 0.1 * (x - 1.0) * (x - 1.0)];
    let (contact, y) = roofs(FacetShape::Q4, 2, 0.0, sags);
    let upper = y.len() / 6;
    let at = |z: f64| placed(&y, upper, [0.05, -0.1, z], 0.0);
    let pairs = found(&contact, &at(0.01), &at(-0.01));
    assert!(pairs.len() == 1 && pairs[0].joint == Some(3), "{pairs:?}");
    let y = at(-0.01);
    let rows_at = |y: &[f64]| {
        let mut rows = Rows::new(3);
        let mut pair = Pair { active: true, ..pairs[0] };
        contact.measure(&mut pair, y, &mut rows).unwrap();
        (rows, pair)
    };
    let (rows, pair) = rows_at(&y);
    let [x, z, up] = rows.row(0).normal();
    assert!(x.abs().max(z.abs()) < 1e-14 && up > 0.9, "{x:e} {z:e} {up}");
    let nodes = rows.row(0).nodes.to_vec();
    assert_eq!(nodes.len(), 6);
    let moved = |x: &[f64]| {
        let mut all = y.clone();
        for (k, node) in nodes.iter().enumerate() {
            all[3 * node..3 * node + 3].copy_from_slice(&x[3 * k..3 * k + 3]);
        }
        all
    };
    let start: Vec<f64> = nodes.iter().flat_map(|node| y[3 * node..3 * node + 3].to_vec()).collect();
    let gap = |x: &[f64]| vec![rows_at(&moved(x)).0.row(0).gap];
    let error = jacobian_error(&start, 1e-3, gap, rows.row(0).gradient);
    assert!(error < 1e-9, "gradient {error:e}");
    let mut matrix = vec![0.0; start.len() * start.len()];
    contact.curvature_into(&pair, &y, &mut matrix);
    let gradient = |x: &[f64]| rows_at(&moved(x)).0.row(0).gradient.to_vec();
    let error = jacobian_error(&start, 1e-3, gradient, &matrix);
    assert!(error < 1e-8, "second derivative {error:e}");
}

#[test]
fn an_edge_that_passes_through_an_edge_within_a_step_is_found() {
    let (contact, y) = roofs(FacetShape::Q4, 3, 0.1, straight);
    let upper = y.len() / 6;
    let at = |by: [f64; 3]| placed(&y, upper, by, 0.0);
    // Through the ridge, 0.5 deep, and out past its end along it: no pair at the end of the step.
    // The upper ridge, at x = 1.45 and z = 0.1, leaves the lower one at its end, x = 3, θ = 0.62.
    let [start, end] = [at([0.0; 3]), at([2.5, 0.0, -0.6])];
    assert!(found(&contact, &start, &end).is_empty());
    let passed = contact.passed(&start, &end, 0.01).unwrap();
    // A point counts up to 0.02 of ξ, 0.01 along the edge, past its end.
    let exact = 0.6 * (1.56 / 2.5) - 0.1;
    assert!(passed.what == "the edge at node" && (passed.limit - 0.1).abs() < 1e-12, "{passed:?}");
    assert!(passed.depth <= exact + 1e-9 && passed.depth > exact / 1.126, "{passed:?} {exact}");
    // Not so deep; above; outwards; to a pair at the end.
    assert_eq!(contact.passed(&start, &at([2.5, 0.0, -0.25]), 0.01), None);
    assert_eq!(contact.passed(&start, &at([2.5, 0.0, -0.09]), 0.01), None);
    assert_eq!(contact.passed(&end, &start, 0.01), None);
    assert_eq!(contact.passed(&start, &at([0.0, 0.0, -0.15]), 0.01), None);
    assert!(contact.passed(&start, &at([0.0, 0.0, -0.4]), 0.01).is_some());
}

#[test]
fn edges_that_come_from_past_an_end_form_a_pair() {
    // At the start they are so far from each other that extended edges have no gap.
    let (contact, y) = roofs(FacetShape::Q4, 1, 0.1, straight);
    let upper = y.len() / 6;
    let start = placed(&y, upper, [7.0, 0.0, 0.4], 0.0);
    let end = placed(&y, upper, [0.0, 0.0, -0.12], 0.0);
    // It passes over the lower ridge's end at a height of 0.02 and comes down onto it.
    assert_eq!(found(&contact, &start, &end).len(), 1);
}
