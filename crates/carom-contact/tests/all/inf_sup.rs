//! Stability of the pressure of mortar contact: the inf–sup constant of the traces u of degree k on
//! a straight side and the pressures p,
//!
//! ```text
//! β = min over p of max over u of ∫ p u dx/(‖p‖ ‖u‖),   β² = min of pᵀ B M⁻¹ Bᵀ p/(pᵀ Q p)
//! ```
//!
//! with the rows B of the weighted gaps, M = ∫ N N and Q = ∫ B B. It is 1 if every pressure is
//! a trace, and independent of the number of facets for a stable pair.

use carom_algebra::Saddle;
use carom_contact::{Combined, Detection, Kinematics, Mortar, NodeToFacet, Pair, Rows, Surface};
use carom_solid::{FacetShape, quadrature};

/// Shape functions of a facet on −1 … 1, in the order of x.
type Functions = fn(usize, f64) -> Vec<f64>;

/// Lagrange polynomials of a degree at equal distances.
fn lagrange(degree: usize, xi: f64) -> Vec<f64> {
    let at = |i: usize| -1.0 + 2.0 * i as f64 / degree as f64;
    let value = |i: usize| {
        let others = (0..=degree).filter(|&j| j != i);
        others.map(|j| (xi - at(j)) / (at(i) - at(j))).product()
    };
    (0..=degree).map(value).collect()
}

/// Bernstein polynomials of a degree, 1 or 2.
fn bernstein(degree: usize, xi: f64) -> Vec<f64> {
    let forth = 0.5 * (1.0 + xi);
    let back = 1.0 - forth;
    match degree {
        1 => vec![back, forth],
        _ => vec![back * back, 2.0 * back * forth, forth * forth],
    }
}

/// ∫ f g dx over facets of length one whose end functions are shared, row-major.
fn gram([f, g]: [Functions; 2], [of_f, of_g]: [usize; 2], facets: usize) -> Vec<f64> {
    let width = facets * of_g + 1;
    let mut gram = vec![0.0; (facets * of_f + 1) * width];
    for facet in 0..facets {
        for (xi, weight) in quadrature::line(of_f + of_g).iter() {
            for (i, a) in f(of_f, xi[0]).iter().enumerate() {
                for (j, b) in g(of_g, xi[0]).iter().enumerate() {
                    gram[(facet * of_f + i) * width + facet * of_g + j] += 0.5 * weight * a * b;
                }
            }
        }
    }
    gram
}

/// The rows of the weighted gaps times their areas, over the heights of the nodes in the order of
/// x, row-major.
fn rows(shape: FacetShape, facets: usize) -> Vec<Vec<f64>> {
    let k = shape.degree();
    let nodes = facets * k + 1;
    let mut y: Vec<f64> = (0..nodes).flat_map(|i| [i as f64 / k as f64, 0.0]).collect();
    y.extend([facets as f64 + 1.0, 0.0, -1.0, 0.0]);
    let facet = |f: usize| -> Vec<usize> {
        let inner = (1..k).map(|i| f * k + i);
        [f * k, f * k + k].into_iter().chain(inner).collect()
    };
    let above: Vec<Vec<usize>> = (0..facets).map(facet).collect();
    let below = [vec![nodes, nodes + 1]];
    let secondary = Surface::new(shape, &above, &vec![1.0; facets]);
    let primary = Surface::new(FacetShape::L2, &below, &[1.0]);
    let nodes_of =
        |nodes: Vec<usize>, to: &Surface| NodeToFacet::new(nodes, to.clone(), Detection::ClosestPoint);
    let sides = Combined::both(
        nodes_of((0..nodes).collect(), &primary),
        nodes_of(below.concat(), &secondary).reversed(),
    );
    let contact = Mortar::new(secondary, primary, &y, sides);
    let row = |multiplier: usize| {
        let mut pair = Pair { reach: 9, active: true, ..Pair::open(multiplier, 0, 0.0) };
        let mut measured = Rows::new(2);
        contact.measure(&mut pair, &y, &mut measured).unwrap();
        let mut full = vec![0.0; y.len()];
        measured.row(0).add_to(contact.area(multiplier).unwrap(), &mut full);
        (0..nodes).map(|node| full[2 * node + 1]).collect()
    };
    (0..contact.secondary().len()).map(row).collect()
}

fn solve(matrix: &[f64], right: &[f64]) -> Vec<f64> {
    let mut saddle = Saddle::default();
    saddle.begin(matrix, right.len(), 0);
    assert!(saddle.factor());
    let mut solution = right.to_vec();
    saddle.solve(&mut solution, &mut []);
    solution
}

fn times(matrix: &[f64], x: &[f64]) -> Vec<f64> {
    let row = |row: &[f64]| row.iter().zip(x).map(|(a, b)| a * b).sum();
    matrix.chunks_exact(x.len()).map(row).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// β, with all heights free or with those of both ends fixed.
fn inf_sup(shape: FacetShape, facets: usize, fixed: bool) -> f64 {
    let k = shape.degree();
    let degree = k.saturating_sub(1).max(1);
    let rows = rows(shape, facets);
    let pressures = gram([bernstein; 2], [degree; 2], facets);
    assert_eq!(rows.len(), facets * degree + 1);
    let all = facets * k + 1;
    let free = if fixed { 1..all - 1 } else { 0..all };
    let traces = gram([lagrange; 2], [k; 2], facets);
    let traces: Vec<f64> =
        free.clone().flat_map(|i| free.clone().map(move |j| i * all + j)).map(|at| traces[at]).collect();
    let rows: Vec<&[f64]> = rows.iter().map(|row| &row[free.clone()]).collect();
    let columns: Vec<Vec<f64>> = rows.iter().map(|row| solve(&traces, row)).collect();
    let schur: Vec<f64> = rows.iter().flat_map(|row| columns.iter().map(|column| dot(row, column))).collect();
    // Inverse iteration from a pressure that is nowhere zero.
    let mut pressure: Vec<f64> = (0..rows.len()).map(|j| 1.0 + (j as f64).sin()).collect();
    let mut square = 0.0;
    for _ in 0..2000 {
        let right = times(&pressures, &pressure);
        pressure = solve(&schur, &right);
        let norm = dot(&pressure, &times(&pressures, &pressure)).sqrt();
        pressure.iter_mut().for_each(|p| *p /= norm);
        square = dot(&pressure, &times(&schur, &pressure));
    }
    square.sqrt()
}

/// The rows are ∫ B N dx.
#[test]
fn rows_are_integrals() {
    for shape in [FacetShape::L2, FacetShape::L3, FacetShape::L4] {
        let k = shape.degree();
        let wanted = gram([bernstein, lagrange], [k.saturating_sub(1).max(1), k], 5);
        for (row, wanted) in rows(shape, 5).iter().zip(wanted.chunks_exact(5 * k + 1)) {
            assert!(
                row.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12),
                "{shape:?}: {row:?} {wanted:?}"
            );
        }
    }
}

/// Pressures of lower degree are among the traces if the ends are free.
#[test]
fn pressures_are_traces_where_the_ends_are_free() {
    for shape in [FacetShape::L2, FacetShape::L3, FacetShape::L4] {
        let beta = inf_sup(shape, 6, false);
        assert!((beta - 1.0).abs() < 1e-9, "{shape:?}: {beta}");
    }
}

/// With fixed ends: known to two digits, whatever the number of facets.
#[test]
fn pressures_are_stable_where_the_ends_are_fixed() {
    for (shape, known) in [(FacetShape::L3, 0.77), (FacetShape::L4, 0.67)] {
        for facets in [4, 8, 16] {
            let beta = inf_sup(shape, facets, true);
            assert!((beta - known).abs() < 5e-3, "{shape:?}, {facets} facets: {beta}");
        }
    }
}
