//! Exact thresholds at which curved cells fold, a sampler as oracle, and motion of the whole cell.

use std::collections::BTreeMap;

use carom_algebra::{Mat, Vector};
use carom_solid::shape::{
    Domain, Hex8, Hex27, Line4, Quad4, Quad9, Shape, Tet4, Tet10, Tet20, Tri3, Tri6, Tri10,
};
use carom_solid::{Body, Element, Law, Loss, Mesh, Validity, body};

use super::random::lists;

/// The reference cell, so that J is the determinant of the cell's positions.
pub(crate) fn cell<const D: usize, const N: usize, S: Shape<D, N>>(element: Element) -> Box<dyn Body> {
    let mesh = Mesh {
        element,
        nodes: S::NODES.map(|xi| xi.0).to_vec().into(),
        cells: (0..N).collect(),
        sides: BTreeMap::new(),
        regions: Vec::new(),
        repairs: Vec::new(),
    };
    body(mesh, Law::NeoHookean { lambda: 1.0, mu: 1.0 }, 1.0, 1.0).unwrap()
}

/// The cell's positions with one node moved.
fn moved<const D: usize>(body: &dyn Body, node: usize, by: [f64; D]) -> Vec<f64> {
    let mut y = body.mesh().nodes.flat().to_vec();
    (0..D).for_each(|i| y[node * D + i] += by[i]);
    y
}

#[test]
fn a_mid_node_may_move_by_a_quarter_of_its_edge() {
    let t6 = cell::<2, 6, Tri6>(Element::T6);
    let by = |s: f64| moved(&*t6, 3, [s, 0.0]);
    let near = 0.25 - 1e-9;
    for sign in [-1.0, 1.0] {
        assert!(t6.cell_margin(0, &by(sign * near)).is_ok());
        // J = 1 + 4s (1 − 2ξ − η) is below 1e-3 only within 1e-3 of the corner towards which the
        // node moves.
        let loss = t6.cell_margin(0, &by(sign * 0.25)).unwrap_err();
        assert!(loss.det_f.abs() < 1e-3, "{loss:?}");
        let lost = t6.cell_lost_between(0, &by(0.0), &by(sign * 0.3)).unwrap();
        assert!(lost <= 5.0 / 6.0 && lost > 5.0 / 6.0 - 2e-6, "{lost:?}");
        assert_eq!(t6.cell_lost_between(0, &by(0.0), &by(sign * near)), None);
    }
}

#[test]
fn the_mid_node_of_the_hypotenuse_may_move_inwards_by_a_quarter() {
    let t6 = cell::<2, 6, Tri6>(Element::T6);
    let by = |s: f64| moved(&*t6, 4, [-s, -s]);
    assert!(t6.cell_margin(0, &by(0.25 - 1e-9)).is_ok());
    assert!(t6.cell_margin(0, &by(0.25 + 1e-9)).is_err());
    let lost = t6.cell_lost_between(0, &by(0.0), &by(0.5)).unwrap();
    assert!(lost <= 0.5 && lost > 0.5 - 1e-3, "{lost:?}");
}

#[test]
fn a_cubic_folds_in_the_middle_of_an_edge() {
    let t10 = cell::<2, 10, Tri10>(Element::T10);
    let by = |d: f64| moved(&*t10, 9, [d, 0.0]);
    let exact = 4.0 / 27.0;
    for sign in [-1.0, 1.0] {
        assert!(t10.cell_margin(0, &by(sign * (exact - 1e-6))).is_ok());
        // J = 1 ± 27d η (1 − 2ξ − η) grows from zero with the square of the distance to the middle
        // of an edge: it is below 1e-4 within 0.01 of it only.
        let loss = t10.cell_margin(0, &by(sign * (exact + 1e-6))).unwrap_err();
        assert!(loss.det_f.abs() < 1e-4, "{loss:?}");
        let lost = t10.cell_lost_between(0, &by(0.0), &by(sign * 0.2)).unwrap();
        assert!(lost <= exact / 0.2 && lost > exact / 0.2 - 1e-3, "{lost:?}");
        assert_eq!(t10.cell_lost_between(0, &by(0.0), &by(sign * (exact - 1e-4))), None);
    }
}

#[test]
fn a_cell_may_collapse_within_a_step_and_be_valid_at_its_ends() {
    // A rotation by π on straight lines passes through one point, and by 2π/3 through none.
    let t3 = cell::<2, 3, Tri3>(Element::T3);
    let turned = |angle: f64| -> Vec<f64> {
        let (sin, cos) = f64::sin_cos(angle);
        t3.mesh().nodes.iter().flat_map(|x| [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]]).collect()
    };
    let half = turned(std::f64::consts::PI);
    assert!(t3.cell_margin(0, &half).is_ok());
    let lost = t3.cell_lost_between(0, &turned(0.0), &half).unwrap();
    assert!(lost <= 0.5 && lost > 0.49);
    assert_eq!(t3.cell_lost_between(0, &turned(0.0), &turned(2.0)), None);
}

#[test]
fn a_corner_of_a_square_may_move_to_the_other_diagonal() {
    let q4 = cell::<2, 4, Quad4>(Element::Q4);
    let by = |s: f64| moved(&*q4, 2, [-s, -s]);
    // The Jacobian at the corners next to it vanishes when three corners are on a line.
    assert!(q4.cell_margin(0, &by(1.0 - 1e-9)).is_ok());
    assert!(q4.cell_margin(0, &by(1.0 + 1e-9)).is_err());
    let lost = q4.cell_lost_between(0, &by(0.0), &by(2.0)).unwrap();
    assert!(lost <= 0.5 && lost > 0.5 - 2e-6, "{lost:?}");
}

#[test]
fn a_shifted_cell_has_a_margin_and_its_mirror_image_none() {
    for body in [
        cell::<2, 3, Tri3>(Element::T3),
        cell::<2, 4, Quad4>(Element::Q4),
        cell::<3, 4, Tet4>(Element::Tet4),
        cell::<3, 10, Tet10>(Element::Tet10),
    ] {
        let d = body.mesh().dimension();
        let shift = |k: usize| 0.1 * (3.7 * (k / d) as f64 + 1.3 * (k % d) as f64).sin() + 5.0;
        let mut y: Vec<f64> =
            body.mesh().nodes.flat().iter().enumerate().map(|(k, x)| x + shift(k)).collect();
        assert!(body.cell_margin(0, &y).unwrap() > 0.0);
        (0..d).for_each(|i| y.swap(i, d + i));
        assert!(body.cell_margin(0, &y).is_err());
    }
}

/// det(∂y/∂ξ) at a point.
fn jacobian<const D: usize, const N: usize, S: Shape<D, N>>(y: &[f64], xi: &Vector<D>) -> f64 {
    let (nodes, gradients) = (y.as_chunks::<D>().0, S::gradients(xi));
    (0..N).fold(Mat::ZERO, |sum, a| sum + Vector(nodes[a]).outer(&gradients[a])).det()
}

/// Smallest determinant at 66 points, or as many in other dimensions, and whether the test agrees.
fn check<const D: usize, const N: usize, S: Shape<D, N>>(element: Element, shifts: &[[f64; 3]], amount: f64) {
    let steps = 10_usize;
    let whole = D == 1 || S::Domain::TENSOR;
    let part = |code: usize, i: usize| (code / (steps + 1).pow(i as u32) % (steps + 1)) as f64 / steps as f64;
    let samples: Vec<Vector<D>> = (0..(steps + 1).pow(D as u32))
        .filter(|&code| whole || (0..D).map(|i| part(code, i)).sum::<f64>() <= 1.0 + 1e-9)
        .map(|code| {
            let of = |i| if whole { 2.0 * part(code, i) - 1.0 } else { part(code, i) };
            Vector(std::array::from_fn(of))
        })
        .collect();
    agrees(&*cell::<D, N, S>(element), shifts, amount, &|y| {
        samples.iter().map(|xi| jacobian::<D, N, S>(y, xi)).fold(f64::INFINITY, f64::min)
    });
}

fn agrees(body: &dyn Body, shifts: &[[f64; 3]], amount: f64, least: &dyn Fn(&[f64]) -> f64) {
    let (start, d) = (body.mesh().nodes.flat(), body.mesh().dimension());
    let each = |by: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        start.iter().enumerate().map(|(k, x)| x + by(k / d, k % d)).collect()
    };
    let y = each(&|a, i| amount * shifts[a][i]);
    let found = least(&y);
    match body.cell_margin(0, &y) {
        Ok(margin) => {
            assert!(found > 0.0);
            // A change by the margin does not invert it.
            for k in 0..4 {
                let sign = |a: usize, i: usize| if shifts[(a + k) % 27][i] > 0.0 { margin } else { -margin };
                let other: Vec<f64> = y.iter().enumerate().map(|(k, y)| y + sign(k / d, k % d)).collect();
                assert!(least(&other) > 0.0);
            }
            let far: Vec<f64> = y.iter().map(|y| y + 1e3).collect();
            assert!(body.cell_margin(0, &far).is_ok() || found < 1e-9);
            // Between two valid cells, samples agree.
            let lost = body.cell_lost_between(0, start, &y);
            for step in 0..=20 {
                let theta = f64::from(step) / 20.0;
                let at: Vec<f64> = start.iter().zip(&y).map(|(x, y)| x * (1.0 - theta) + y * theta).collect();
                assert!(least(&at) > 0.0 || lost.is_some_and(|lost| lost <= theta));
            }
        }
        Err(loss) => {
            assert!(loss.det_f < 1e-9, "{loss:?}");
            assert!(body.cell_lost_between(0, start, &y).is_some());
        }
    }
}

/// Shifts of up to 27 nodes, and their amount.
fn shifts(x: &[f64]) -> (&[[f64; 3]], f64) {
    (x[..81].as_chunks().0, 0.2 * (1.0 + x[81]))
}

#[test]
fn the_test_agrees_with_samples() {
    lists(500, 82, &|x| {
        let (shifts, amount) = shifts(x);
        check::<1, 4, Line4>(Element::L4, shifts, amount);
        check::<2, 3, Tri3>(Element::T3, shifts, amount);
        check::<2, 6, Tri6>(Element::T6, shifts, amount);
        check::<2, 10, Tri10>(Element::T10, shifts, 0.5 * amount);
        check::<2, 4, Quad4>(Element::Q4, shifts, 2.0 * amount);
        check::<2, 9, Quad9>(Element::Q9, shifts, amount);
        check::<3, 4, Tet4>(Element::Tet4, shifts, amount);
    });
}

#[test]
fn the_test_agrees_with_samples_of_large_cells() {
    lists(20, 82, &|x| {
        let (shifts, amount) = shifts(x);
        check::<3, 8, Hex8>(Element::Hex8, shifts, 1.5 * amount);
        check::<3, 10, Tet10>(Element::Tet10, shifts, 0.5 * amount);
        check::<3, 20, Tet20>(Element::Tet20, shifts, 0.25 * amount);
        check::<3, 27, Hex27>(Element::Hex27, shifts, 0.5 * amount);
    });
}

/// Compiled once for each shape.
#[inline(never)]
fn margin<const D: usize, const N: usize>(
    test: &Validity<D, N>,
    nodes: &[Vector<D>; N],
) -> Result<f64, Loss<D>> {
    test.margin(nodes)
}

/// The shorter formula certifies what the general one certifies, and nodes may move as far as it
/// says: to every corner of the box of displacements, where the test of the general formula holds
/// again.
#[test]
fn cells_of_degree_one_have_a_margin_of_their_own() {
    fn check<const D: usize, const N: usize, S: Shape<D, N>>(at_least: f64) {
        let test = Validity::<D, N>::of::<S>();
        assert!(test.is_affine);
        let mut general = test.clone();
        general.is_affine = false;
        let mut nodes = S::NODES;
        for (a, node) in nodes.iter_mut().enumerate() {
            (0..D).for_each(|i| node[i] += 0.1 * (3.7 * a as f64 + 1.3 * i as f64).sin() + 5.0);
        }
        let found = margin(&test, &nodes).unwrap();
        assert!(found > at_least * margin(&general, &nodes).unwrap());
        for corner in 0..1_usize << (N * D) {
            let mut moved = nodes;
            for (k, x) in moved.iter_mut().flat_map(|node| &mut node.0).enumerate() {
                *x += if corner >> k & 1 == 1 { found } else { -found };
            }
            assert!(margin(&general, &moved).is_ok() && margin(&test, &moved).is_ok(), "{corner:b}");
        }
        // A sliver that is valid may not move at all.
        let mut flat = S::NODES;
        flat[N - 1][D - 1] *= 1e-10;
        assert_eq!(margin(&test, &flat), Ok(0.0));
        nodes.swap(0, 1);
        assert!(margin(&test, &nodes).is_err());
        assert_eq!(margin(&test, &nodes), margin(&general, &nodes));
    }
    check::<2, 3, Tri3>(0.8);
    check::<3, 4, Tet4>(20.0);
    assert!(!Validity::<2, 4>::of::<Quad4>().is_affine && !Validity::<3, 10>::of::<Tet10>().is_affine);
}
