//! Factors and solves on a square grid of nodes with two unknowns each, coupled to all nodes within
//! two columns and rows (as dense as quadratic triangles): the factor with the nodes of one side
//! eliminated last, and the small systems of contact.
//!
//!     cargo bench -p carom-algebra            times
//!     bench/instructions.py carom-algebra     instructions

use std::hint::black_box;
use std::sync::Arc;

use carom_algebra::{Condensed, Cone, Couplings, Elimination, Kind, Pattern, Precision, Saddle, Threads};
use divan::Bencher;

/// Nodes along an edge: 2 178 and 18 818 unknowns.
const EDGES: [usize; 2] = [33, 97];
/// The same and 200 978 unknowns, with the precisions and numbers of threads of a reused factor.
const REUSED: [(usize, Precision, usize); 7] = [
    (33, Precision::Double, 1),
    (33, Precision::Single, 1),
    (97, Precision::Double, 1),
    (97, Precision::Single, 1),
    (97, Precision::Single, 2),
    (317, Precision::Single, 1),
    (317, Precision::Single, 2),
];
/// Nodes in contact, of small systems.
const IN_CONTACT: [usize; 2] = [12, 48];

fn main() {
    divan::main();
}

/// A positive definite matrix.
struct Grid {
    pattern: Pattern,
    values: Vec<f64>,
    groups: Vec<usize>,
    side: Vec<usize>,
}

fn grid(edge: usize) -> Grid {
    let nodes = edge * edge;
    let mut entries = Vec::new();
    for a in 0..nodes {
        for b in 0..=a {
            if (a / edge).abs_diff(b / edge).max((a % edge).abs_diff(b % edge)) <= 2 {
                let of_pair = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(p, q)| (2 * a + p, 2 * b + q));
                let lower = of_pair.into_iter().filter(|(i, j)| i >= j);
                entries.extend(lower.map(|(i, j)| (i, j, if i == j { 35.0 } else { -0.7 })));
            }
        }
    }
    let pattern = Pattern::from_entries(2 * nodes, entries.iter().map(|&(i, j, _)| (i, j)));
    let mut values = vec![0.0; pattern.len()];
    for (i, j, value) in entries {
        values[pattern.slot(i, j).expect("made of these")] = value;
    }
    let groups = (0..2 * nodes).map(|dof| dof / 2).collect();
    Grid { pattern, values, groups, side: (0..2 * edge).collect() }
}

#[divan::bench(args = EDGES)]
fn analyse(bencher: Bencher, edge: usize) {
    let grid = grid(edge);
    bencher.bench_local(|| Elimination::new(black_box(&grid.pattern), &grid.groups, &grid.side).is_ok());
}

fn elimination(grid: &Grid) -> Arc<Elimination> {
    Arc::new(Elimination::new(&grid.pattern, &grid.groups, &grid.side).expect("memory"))
}

fn condensed(grid: &Grid, precision: Precision, threads: usize) -> Condensed {
    let mut condensed = Condensed::new(&elimination(grid), precision).on(&Threads::new(threads));
    condensed.factor(|k| grid.values[k]).expect("numbers");
    condensed
}

#[divan::bench(args = REUSED)]
fn factor(bencher: Bencher, (edge, precision, threads): (usize, Precision, usize)) {
    let grid = grid(edge);
    let mut condensed = condensed(&grid, precision, threads);
    bencher.bench_local(|| condensed.factor(|k| grid.values[k]).is_ok());
}

#[divan::bench(args = REUSED)]
fn solve(bencher: Bencher, (edge, precision, threads): (usize, Precision, usize)) {
    let grid = grid(edge);
    let mut condensed = condensed(&grid, precision, threads);
    let right = vec![1.0; grid.pattern.size()];
    let mut x = Vec::new();
    let mut out = vec![0.0; grid.pattern.size()];
    bencher.bench_local(|| {
        condensed.eliminate_into(black_box(&right), &mut x);
        condensed.substitute_into(&mut x, &mut out);
    });
}

/// One constraint per node in contact: two unknowns each, and as many that are only near.
#[divan::bench(args = IN_CONTACT)]
fn saddle_factor_and_solve(bencher: Bencher, contacts: usize) {
    let size = 4 * contacts;
    let stiffness: Vec<f64> =
        (0..size * size).map(|k| if k / size == k % size { 40.0 } else { -30.0 / size as f64 }).collect();
    let mut saddle = Saddle::default();
    let mut x = vec![0.0; size];
    let mut multipliers = vec![0.0; contacts];
    bencher.bench_local(|| {
        saddle.begin(black_box(&stiffness), size, contacts);
        for row in 0..contacts {
            saddle.add_row(row, 2 * row, 0.1);
            saddle.add_row(row, 2 * row + 1, 1.0);
        }
        x.fill(1.0);
        multipliers.fill(0.0);
        let factored = saddle.factor();
        saddle.solve(&mut x, &mut multipliers);
        factored
    });
}

/// Half of the nodes stay open.
#[divan::bench(args = IN_CONTACT)]
fn complementarity_problem(bencher: Bencher, contacts: usize) {
    let n = contacts;
    let d: Vec<f64> = (0..n * n).map(|k| if k / n == k % n { 2.0 } else { 0.5 / n as f64 }).collect();
    let b: Vec<f64> = (0..n).map(|k| (1.3 * k as f64).sin()).collect();
    let d = Couplings::dense(n, d);
    let kinds = vec![Kind::Normal; n];
    let mut z = Vec::new();
    bencher.bench_local(|| {
        let mut matrix = black_box(&d).clone();
        let mut right = b.clone();
        Cone { matrix: &mut matrix, right: &mut right, kinds: &kinds, is_dependent: false }
            .solve(&mut z)
            .is_ok()
    });
}
