//! Points of sharp edges against facets: derivatives of the gap against differences, balance of
//! force and moment, and when a point is held.

use std::collections::BTreeSet;

use carom_algebra::{Vector, jacobian_error};
use carom_contact::{Boundary, EdgePoints, Kinematics, Pair, Pairing, Rows};
use carom_solid::FacetShape;

use crate::space::{SHAPES, lattice};

/// Depth that a point may have.
const DEPTH: f64 = 0.02;

/// The points of the lower edge of an upside-down roof, of one facet on each slope, over a facet.
/// The edge runs along x = y, and its ends lie past the facet's; `height`: that of the edge over
/// the middle of the facet.
fn scene(shape: FacetShape, height: f64, bend: impl Fn([f64; 3]) -> [f64; 3]) -> (EdgePoints, Vec<f64>) {
    let square = lattice(shape);
    let mut y: Vec<f64> = square.iter().flat_map(|[s, t]| bend([2.0 * s, 2.0 * t, 0.0])).collect();
    let lower: Vec<usize> = (0..square.len()).collect();
    let mut slopes = Vec::new();
    for side in [1.0, -1.0] {
        let mut facet = Vec::new();
        for [s, t] in &square {
            // From one end of the edge to the other, and up the slope.
            let along = if side > 0.0 { *s } else { 1.0 - s };
            let foot = -0.8 + 3.4 * along;
            let at = bend([foot + side * t, foot - side * t, height + t]);
            let known = y.as_chunks::<3>().0[square.len()..]
                .iter()
                .position(|x| (0..3).all(|i| (x[i] - at[i]).abs() < 1e-12));
            facet.push(known.map_or(y.len() / 3, |k| square.len() + k));
            if known.is_none() {
                y.extend(at);
            }
        }
        slopes.push(facet);
    }
    let upper = Boundary::new(shape, &slopes, &[], 0);
    let facet = Boundary::new(shape, &[lower], &[], 0);
    (EdgePoints::new(&upper, facet, DEPTH, &BTreeSet::new(), &y).unwrap(), y)
}

fn straight(x: [f64; 3]) -> [f64; 3] {
    x
}

fn bent([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x + 0.05 * x * z, y + 0.06 * (2.0 * x).sin(), z + 0.08 * x * (1.0 - x) - 0.03 * y * x]
}

/// The row and the pair of the point in the middle of the edge, or a quarter along it.
fn measured(contact: &EdgePoints, y: &[f64]) -> (Rows, Pair) {
    let middle = (contact.secondary().len() - 1) / 2;
    let mut pair = Pair { active: true, eta: 0.3, ..Pair::open(middle, 0, 0.3) };
    let mut rows = Rows::new(3);
    contact.measure(&mut pair, y, &mut rows).unwrap();
    (rows, pair)
}

fn force(contact: &EdgePoints, y: &[f64], lambda: f64) -> Vec<f64> {
    let mut full = vec![0.0; y.len()];
    measured(contact, y).0.row(0).add_to(lambda, &mut full);
    full
}

#[test]
fn gradient_and_second_derivative_agree_with_differences() {
    for (shape, height) in SHAPES.into_iter().flat_map(|shape| [0.2, -0.1].map(|height| (shape, height))) {
        let (contact, y) = scene(shape, height, bent);
        let (rows, pair) = measured(&contact, &y);
        let row = rows.row(0);
        assert!((row.gap - DEPTH - height).abs() < 0.3, "{shape:?}: {}", row.gap);
        assert!((Vector(row.normal()).norm() - 1.0).abs() < 1e-12 && row.normal()[2] > 0.8);
        let shares: f64 = row.shares().map(|(_, share)| share).sum();
        assert!((shares - 1.0).abs() < 1e-12);
        let gap = |y: &[f64]| vec![measured(&contact, y).0.row(0).gap];
        let error = jacobian_error(&y, 1e-3, gap, &force(&contact, &y, 1.0));
        assert!(error < 1e-9, "{shape:?} {height}: gradient {error:e}");
        let count = row.gradient.len();
        let mut hessian = vec![0.0; count * count];
        contact.curvature_into(&pair, &y, &mut hessian);
        let of_row = |x: &[f64]| -> Vec<f64> {
            let mut all = y.clone();
            for (node, x) in row.nodes.iter().zip(x.as_chunks::<3>().0) {
                all[3 * node..3 * node + 3].copy_from_slice(x);
            }
            let full = force(&contact, &all, 1.0);
            row.nodes.iter().flat_map(|n| [0, 1, 2].map(|i| full[3 * n + i])).collect()
        };
        let start: Vec<f64> = row.nodes.iter().flat_map(|n| [0, 1, 2].map(|i| y[3 * n + i])).collect();
        let error = jacobian_error(&start, 1e-3, of_row, &hessian);
        assert!(error < 1e-8, "{shape:?} {height}: second derivative {error:e}");
    }
}

#[test]
fn force_and_moment_balance_and_rigid_motions_do_not_slip() {
    for shape in SHAPES {
        let (contact, y) = scene(shape, 0.1, bent);
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
        // v = ω × y + c.
        let rigid =
            |x: &[f64; 3]| [0.3 * x[2] - 0.7 * x[1] + 1.0, 0.7 * x[0] - 0.2 * x[2], 0.2 * x[1] - 0.3 * x[0]];
        let v: Vec<f64> = y.as_chunks::<3>().0.iter().flat_map(rigid).collect();
        let mut slips = Rows::new(3);
        contact.slip(&measured(&contact, &y).1, &y, &[], &mut slips).unwrap();
        assert!(slips.len() == 2 && slips.iter().all(|slip| slip.along(&v).abs() < 1e-13), "{shape:?}");
    }
}

#[test]
fn the_derivative_of_the_slip_agrees_with_differences() {
    for shape in SHAPES {
        let (contact, y) = scene(shape, 0.1, bent);
        let (_, mut pair) = measured(&contact, &y);
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
                for (node, x) in nodes.iter().zip(x.as_chunks::<3>().0) {
                    all[3 * node..3 * node + 3].copy_from_slice(x);
                }
                let mut rows = Rows::new(3);
                let mut moved = pair;
                contact.measure(&mut moved, &all, &mut rows).unwrap();
                rows.clear();
                contact.slip(&moved, &all, &[], &mut rows).unwrap();
                rows.row(tangent).gradient.to_vec()
            };
            let start: Vec<f64> = nodes.iter().flat_map(|n| [0, 1, 2].map(|i| y[3 * n + i])).collect();
            let error = jacobian_error(&start, 1e-3, row, &matrix);
            assert!(error < 1e-8, "{shape:?} {tangent}: {error:e}");
        }
    }
}

/// No node enters the facet: the ends of the edge are past its ends.
#[test]
fn points_that_sink_by_more_than_their_depth_are_held() {
    let (contact, y) = scene(FacetShape::Q4, 0.1, straight);
    let at = |z: f64| -> Vec<f64> {
        let moved = y.iter().enumerate().map(|(dof, x)| if dof >= 12 && dof % 3 == 2 { x + z } else { *x });
        moved.collect()
    };
    let found = |now: f64| {
        let mut pairing = Pairing::default();
        let has_changed = contact.search(&at(0.0), &at(now), &mut pairing, &mut Vec::new());
        (has_changed, pairing.pairs)
    };
    assert_eq!(found(-0.1 - 0.9 * DEPTH), (false, Vec::new()));
    let (has_changed, pairs) = found(-0.1 - 1.5 * DEPTH);
    // A quarter, the middle and three quarters of an edge from −0.8 to 2.6: all lie over the facet.
    assert!(has_changed && pairs.len() == 3, "{pairs:?}");
    for mut pair in pairs {
        let mut rows = Rows::new(3);
        contact.measure(&mut pair, &at(-0.1 - 1.5 * DEPTH), &mut rows).unwrap();
        assert!((rows.row(0).gap + 0.5 * DEPTH).abs() < 1e-14);
    }
}

/// An edge sinks into a cube and rises again: what was measured before decides nothing.
#[test]
fn a_search_that_is_left_out_would_find_nothing() {
    let corners = (0..8).flat_map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from));
    let mut start: Vec<f64> = corners.collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let cube = Boundary::new(FacetShape::Q4, &faces.map(Vec::from), &[], 0);
    assert!(cube.is_whole());
    // The lower edge of an upside-down roof, along y over the middle of the upper face.
    start.extend([
        0.5, -0.2, 1.3, 0.5, 1.2, 1.3, 0.9, 1.2, 1.7, 0.9, -0.2, 1.7, 0.1, 1.2, 1.7, 0.1, -0.2, 1.7,
    ]);
    let roof = Boundary::new(FacetShape::Q4, &[vec![8, 9, 10, 11], vec![9, 8, 13, 12]], &[], 0);
    let points = || EdgePoints::new(&roof, cube.clone(), DEPTH, &BTreeSet::new(), &start).unwrap();
    let at = |z: f64| -> Vec<f64> {
        let moved =
            start.iter().enumerate().map(|(dof, x)| if dof >= 24 && dof % 3 == 2 { x + z } else { *x });
        moved.collect()
    };
    let found = |contact: &EdgePoints, from: f64, to: f64| {
        let mut pairing = Pairing::default();
        contact.search(&at(from), &at(to), &mut pairing, &mut Vec::new());
        pairing.pairs
    };
    // Without its lower face, the cube is not known to be closed, and every search is made.
    let open = Boundary::new(
        FacetShape::Q4,
        &faces[1..].iter().map(|face| face.to_vec()).collect::<Vec<_>>(),
        &[],
        0,
    );
    let every = || EdgePoints::new(&roof, open.clone(), DEPTH, &BTreeSet::new(), &start).unwrap();
    let known = points();
    let mut last = 0.0;
    let mut deepest = 0;
    for step in 0..80 {
        let z = -0.17 * (1.0 - (f64::from(step) / 12.0).cos());
        let pairs = found(&known, last, z);
        assert_eq!(pairs, found(&points(), last, z), "{step}");
        assert_eq!(pairs.len(), found(&every(), last, z).len(), "{step}");
        assert_eq!(pairs.is_empty(), z > -0.3 - DEPTH, "{step}: {z}");
        deepest += usize::from(!pairs.is_empty());
        last = z;
    }
    assert!(deepest > 3, "{deepest}");
    // Within one step, through most of the cube.
    assert_eq!(found(&known, 0.0, -1.2).len(), found(&every(), 0.0, -1.2).len());
}
