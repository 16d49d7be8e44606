//! Exact thresholds at which curved cells fold, a sampler as oracle, and motion of the whole cell.

use proptest::prelude::*;

use super::*;
use crate::reference::gradient;
use crate::shape::{Domain, Hex8, Hex27, Line4, Quad4, Quad9, Tet4, Tet10, Tet20, Tri3, Tri6, Tri10};

/// The reference cell.
fn cell<const D: usize, const N: usize, S: Shape<D, N>>() -> [Vector<D>; N] {
    S::NODES
}

/// T6 with the mid node of an edge, moved by s along the edge or inwards.
fn moved(node: usize, by: [f64; 2]) -> [Vector<2>; 6] {
    let mut nodes = cell::<2, 6, Tri6>();
    nodes[node] += Vector(by);
    nodes
}

fn barycentric(loss: &Loss<2>) -> [f64; 3] {
    let Vector([x, y]) = loss.place;
    [1.0 - x - y, x, y]
}

#[test]
fn a_mid_node_may_move_by_a_quarter_of_its_edge() {
    let test = Validity::<2, 6>::of::<Tri6>();
    let near = 0.25 - 1e-9;
    for sign in [-1.0, 1.0] {
        assert!(test.margin(&moved(3, [sign * near, 0.0])).is_ok());
        let loss = test.margin(&moved(3, [sign * 0.25, 0.0])).unwrap_err();
        // The corner towards which it moves.
        assert!(barycentric(&loss)[usize::from(sign > 0.0)] > 0.999, "{loss:?}");
        let lost = test.lost_between(&moved(3, [0.0; 2]), &moved(3, [sign * 0.3, 0.0])).unwrap();
        assert!(lost.theta <= 5.0 / 6.0 && lost.theta > 5.0 / 6.0 - 2e-6, "{lost:?}");
        assert_eq!(test.lost_between(&moved(3, [0.0; 2]), &moved(3, [sign * near, 0.0])), None);
    }
}

#[test]
fn the_mid_node_of_the_hypotenuse_may_move_inwards_by_a_quarter() {
    let test = Validity::<2, 6>::of::<Tri6>();
    let by = |s: f64| moved(4, [-s, -s]);
    assert!(test.margin(&by(0.25 - 1e-9)).is_ok());
    assert!(test.margin(&by(0.25 + 1e-9)).is_err());
    let lost = test.lost_between(&by(0.0), &by(0.5)).unwrap();
    assert!(lost.theta <= 0.5 && lost.theta > 0.5 - 1e-3, "{lost:?}");
}

#[test]
fn a_cubic_folds_in_the_middle_of_an_edge() {
    let test = Validity::<2, 10>::of::<Tri10>();
    let by = |d: f64| {
        let mut nodes = cell::<2, 10, Tri10>();
        nodes[9][0] += d;
        nodes
    };
    let exact = 4.0 / 27.0;
    for sign in [-1.0, 1.0] {
        assert!(test.margin(&by(sign * (exact - 1e-6))).is_ok());
        let loss = test.margin(&by(sign * (exact + 1e-6))).unwrap_err();
        let middle = barycentric(&loss).iter().filter(|x| (**x - 0.5).abs() < 0.01).count();
        assert_eq!(middle, 2, "{loss:?}");
        let lost = test.lost_between(&by(0.0), &by(sign * 0.2)).unwrap();
        assert!(lost.theta <= exact / 0.2 && lost.theta > exact / 0.2 - 1e-3, "{lost:?}");
        assert_eq!(test.lost_between(&by(0.0), &by(sign * (exact - 1e-4))), None);
    }
}

#[test]
fn a_cell_may_collapse_within_a_step_and_be_valid_at_its_ends() {
    // A rotation by π on straight lines passes through one point, and by 2π/3 through none.
    let test = Validity::<2, 3>::of::<Tri3>();
    let turned = |angle: f64| {
        let (sin, cos) = f64::sin_cos(angle);
        cell::<2, 3, Tri3>().map(|x| Vector([cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]]))
    };
    let half = turned(std::f64::consts::PI);
    assert!(test.margin(&half).is_ok());
    let lost = test.lost_between(&turned(0.0), &half).unwrap();
    assert!(lost.theta <= 0.5 && lost.theta > 0.49);
    assert_eq!(test.lost_between(&turned(0.0), &turned(2.0)), None);
}

/// Smallest determinant at 66 points, and whether the test agrees.
fn check<const D: usize, const N: usize, S: Shape<D, N>>(shifts: &[[f64; 3]], amount: f64) {
    let test = Validity::<D, N>::of::<S>();
    let nodes: [Vector<D>; N] =
        std::array::from_fn(|a| S::NODES[a] + Vector(std::array::from_fn(|i| amount * shifts[a][i])));
    let least = |nodes: &[Vector<D>; N]| {
        let steps = 10_usize;
        let mut least = f64::INFINITY;
        for code in 0..(steps + 1).pow(D as u32) {
            let part = |i: usize| (code / (steps + 1).pow(i as u32) % (steps + 1)) as f64 / steps as f64;
            let whole = D == 1 || S::Domain::TENSOR;
            let xi = Vector(std::array::from_fn(|i| if whole { 2.0 * part(i) - 1.0 } else { part(i) }));
            if whole || (0..D).map(part).sum::<f64>() <= 1.0 + 1e-9 {
                least = least.min(gradient(nodes, &S::gradients(&xi)).det());
            }
        }
        least
    };
    let found = least(&nodes);
    match test.margin(&nodes) {
        Ok(margin) => {
            assert!(found > 0.0);
            // A change by the margin does not invert it.
            for k in 0..4 {
                let mut other = nodes;
                for a in 0..N {
                    for i in 0..D {
                        other[a][i] += if shifts[(a + k) % 27][i] > 0.0 { margin } else { -margin };
                    }
                }
                assert!(least(&other) > 0.0);
            }
            let far = nodes.map(|x| x + Vector([1e3; D]));
            assert!(test.margin(&far).is_ok() || found < 1e-9);
            // Between two valid cells, samples agree.
            let lost = test.lost_between(&S::NODES, &nodes);
            for step in 0..=20 {
                let theta = f64::from(step) / 20.0;
                let at = std::array::from_fn(|a| S::NODES[a] * (1.0 - theta) + nodes[a] * theta);
                assert!(least(&at) > 0.0 || lost.is_some_and(|l| l.theta <= theta));
            }
        }
        Err(loss) => {
            assert!(gradient(&nodes, &S::gradients(&loss.place)).det() < 1e-9, "{loss:?}");
            assert!(test.lost_between(&S::NODES, &nodes).is_some());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]
    #[test]
    fn the_test_agrees_with_samples(
        shifts in prop::collection::vec([-1.0..1.0, -1.0..1.0, -1.0..1.0], 27),
        amount in 0.0..0.4,
    ) {
        check::<1, 4, Line4>(&shifts, amount);
        check::<2, 3, Tri3>(&shifts, amount);
        check::<2, 6, Tri6>(&shifts, amount);
        check::<2, 10, Tri10>(&shifts, 0.5 * amount);
        check::<2, 4, Quad4>(&shifts, 2.0 * amount);
        check::<2, 9, Quad9>(&shifts, amount);
        check::<3, 4, Tet4>(&shifts, amount);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]
    #[test]
    fn the_test_agrees_with_samples_of_large_cells(
        shifts in prop::collection::vec([-1.0..1.0, -1.0..1.0, -1.0..1.0], 27),
        amount in 0.0..0.4,
    ) {
        check::<3, 8, Hex8>(&shifts, 1.5 * amount);
        check::<3, 10, Tet10>(&shifts, 0.5 * amount);
        check::<3, 20, Tet20>(&shifts, 0.25 * amount);
        check::<3, 27, Hex27>(&shifts, 0.5 * amount);
    }
}

#[test]
fn a_corner_of_a_square_may_move_to_the_other_diagonal() {
    let test = Validity::<2, 4>::of::<Quad4>();
    let by = |s: f64| {
        let mut nodes = cell::<2, 4, Quad4>();
        nodes[2] += Vector([-s, -s]);
        nodes
    };
    // The Jacobian at the corners next to it vanishes when three corners are on a line.
    assert!(test.margin(&by(1.0 - 1e-9)).is_ok());
    assert!(test.margin(&by(1.0 + 1e-9)).is_err());
    let lost = test.lost_between(&by(0.0), &by(2.0)).unwrap();
    assert!(lost.theta <= 0.5 && lost.theta > 0.5 - 2e-6, "{lost:?}");
}

/// The determinant of edges alone gives the bits of the general formula.
#[test]
fn cells_of_degree_one_have_the_margin_of_their_edges() {
    fn check<const D: usize, const N: usize, S: Shape<D, N>>(expected: bool) {
        let test = Validity::<D, N>::of::<S>();
        assert_eq!(test.is_affine, expected);
        let general = Validity { is_affine: false, ..test.clone() };
        let mut nodes = cell::<D, N, S>();
        for (a, node) in nodes.iter_mut().enumerate() {
            (0..D).for_each(|i| node[i] += 0.1 * (3.7 * a as f64 + 1.3 * i as f64).sin() + 5.0);
        }
        assert_eq!(test.margin(&nodes), general.margin(&nodes));
        assert!(test.margin(&nodes).unwrap() > 0.0);
        nodes.swap(0, 1);
        assert!(test.margin(&nodes).is_err());
        assert_eq!(test.margin(&nodes), general.margin(&nodes));
    }
    check::<2, 3, Tri3>(true);
    check::<3, 4, Tet4>(true);
    check::<2, 4, Quad4>(false);
    check::<3, 10, Tet10>(false);
}
