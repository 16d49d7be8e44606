//! Conjugate gradients under constraints against a dense elimination of the whole saddle point, and
//! the blocks of their preconditioner against a product with the blocks themselves.

use carom_algebra::{
    ConjugateGradients, ConstraintPreconditioner, ConstraintRows, DiagonalBlocks, Goal, LinearError,
    NodeMatrix, Threads,
};

/// A symmetric matrix over m × m nodes with d components: dominant blocks on the diagonal, others
/// to the neighbours of a grid; and the same entries, dense by rows.
fn grid(m: usize, d: usize) -> (NodeMatrix, Vec<f64>) {
    let mut pairs = Vec::new();
    for a in 0..m * m {
        pairs.extend((a % m + 1 < m).then_some((a, a + 1)));
        pairs.extend((a / m + 1 < m).then_some((a, a + m)));
    }
    let mut coupled = vec![Vec::new(); m * m];
    for &(a, b) in &pairs {
        coupled[a].push(b as u32);
        coupled[b].push(a as u32);
    }
    let mut matrix = NodeMatrix::new(d, coupled);
    let n = m * m * d;
    let mut dense = vec![0.0; n * n];
    let mut set = |a: usize, b: usize, i: usize, j: usize, value: f32| {
        for (a, b, i, j) in [(a, b, i, j), (b, a, j, i)] {
            if a <= b {
                let slot = matrix.slot(a, b).unwrap();
                matrix.block_mut(slot)[i * d + j] = value;
            }
            dense[(a * d + i) * n + b * d + j] = f64::from(value);
        }
    };
    for a in 0..m * m {
        for (i, j) in (0..d).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            set(a, a, i, j, if i == j { 6.0 + a as f32 % 3.0 } else { 0.5 });
        }
    }
    for &(a, b) in &pairs {
        for (i, j) in (0..d).flat_map(|i| (0..d).map(move |j| (i, j))) {
            set(a, b, i, j, if i == j { -1.0 } else { 0.125 * (i as f32 - 2.0 * j as f32) });
        }
    }
    (matrix, dense)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn wave(i: usize) -> f64 {
    (i as f64 * 0.7 + 0.2).sin()
}

/// Rows over a few nodes, the second of which shares one with the first; and a spring.
fn rows(d: usize) -> Vec<(f64, Vec<(usize, f64)>)> {
    let of = |nodes: [usize; 3], seed: usize| -> Vec<(usize, f64)> {
        nodes.iter().flat_map(|node| (0..d).map(move |i| (node * d + i, wave(seed + node + 5 * i)))).collect()
    };
    vec![
        (0.0, of([3, 9, 10], 1)),
        (0.0, of([10, 11, 17], 2)),
        (0.02, of([11, 20, 21], 3)),
        (0.0, of([30, 31, 32], 4)),
    ]
}

fn blocks(matrix: &NodeMatrix, d: usize) -> DiagonalBlocks {
    let mut blocks = DiagonalBlocks::default();
    blocks.invert(d, matrix.nodes(), |node, block| {
        let slot = matrix.slot(node, node).unwrap();
        block.iter_mut().zip(matrix.block(slot)).for_each(|(entry, value)| *entry = f64::from(*value));
    });
    blocks
}

/// Overwrites `right` with the solution of a dense system, by elimination with pivots.
fn eliminate(mut matrix: Vec<f64>, right: &mut [f64]) {
    let n = right.len();
    for k in 0..n {
        let pivot =
            (k..n).max_by(|a, b| matrix[a * n + k].abs().total_cmp(&matrix[b * n + k].abs())).unwrap();
        (0..n).for_each(|j| matrix.swap(k * n + j, pivot * n + j));
        right.swap(k, pivot);
        for i in k + 1..n {
            let factor = matrix[i * n + k] / matrix[k * n + k];
            (k..n).for_each(|j| matrix[i * n + j] -= factor * matrix[k * n + j]);
            right[i] -= factor * right[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| matrix[k * n + j] * right[j]).sum();
        right[k] = (right[k] - known) / matrix[k * n + k];
    }
}

fn solve(d: usize, threads: usize) -> (Vec<f64>, Vec<f64>, usize) {
    let (matrix, dense) = grid(6, d);
    let threads = Threads::new(threads);
    let blocks = blocks(&matrix, d);
    let mut constraints = ConstraintRows::default();
    constraints.clear();
    rows(d).into_iter().for_each(|(compliance, entries)| constraints.push(compliance, entries));
    constraints.factor(&blocks).unwrap();
    let forces: Vec<f64> = (0..36 * d).map(|i| wave(3 * i)).collect();
    let gaps = [0.3, -0.2, 0.0, 0.1];
    let mut x = vec![0.0; forces.len()];
    let mut multipliers = vec![0.0; gaps.len()];
    let product = |x: &[f64], out: &mut [f64]| {
        let rows_of_matrix = dense.chunks_exact(x.len());
        out.iter_mut().zip(rows_of_matrix).for_each(|(out, row)| *out = dot(row, x));
        let (compliance, spring) = &rows(d)[2];
        let force = spring.iter().map(|(dof, slope)| slope * x[*dof]).sum::<f64>() / compliance;
        spring.iter().for_each(|(dof, slope)| out[*dof] += force * slope);
    };
    let ended = ConjugateGradients::default().solve(
        &threads,
        product,
        ConstraintPreconditioner { blocks: &blocks, rows: &mut constraints },
        [&forces, &gaps],
        [&mut x, &mut multipliers],
        Goal { reduction: 1e-13, iterations: 500 },
    );
    assert!(!ended.is_indefinite && ended.reduction <= 1e-13, "{ended:?}");
    (x, multipliers, ended.iterations)
}

#[test]
fn solutions_are_those_of_the_whole_saddle_point() {
    for d in 1..=3 {
        let (_, dense) = grid(6, d);
        let rows = rows(d);
        let n = 36 * d;
        let m = rows.len();
        let mut whole = vec![0.0; (n + m) * (n + m)];
        (0..n * n).for_each(|k| whole[k / n * (n + m) + k % n] = dense[k]);
        for (r, (compliance, entries)) in rows.iter().enumerate() {
            for (dof, slope) in entries {
                whole[(n + r) * (n + m) + dof] = *slope;
                whole[dof * (n + m) + n + r] = *slope;
            }
            whole[(n + r) * (n + m) + n + r] = -compliance;
        }
        let mut exact: Vec<f64> = (0..n).map(|i| wave(3 * i)).chain([0.3, -0.2, 0.0, 0.1]).collect();
        eliminate(whole, &mut exact);
        let (x, multipliers, iterations) = solve(d, 1);
        let error = x.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-12 && iterations < 60, "{d}: {error:e} after {iterations}");
        for (r, (compliance, entries)) in rows.iter().enumerate() {
            if *compliance == 0.0 {
                let along: f64 = entries.iter().map(|(dof, slope)| slope * x[*dof]).sum();
                assert!((along - [0.3, -0.2, 0.0, 0.1][r]).abs() < 1e-14, "{along}");
                assert!((multipliers[r] - exact[n + r]).abs() < 1e-11, "{} {}", multipliers[r], exact[n + r]);
            }
        }
    }
}

#[test]
fn same_bits_with_any_number_of_threads_of_a_projected_solve() {
    let bits = |(x, multipliers, _): (Vec<f64>, Vec<f64>, usize)| -> Vec<u64> {
        x.iter().chain(&multipliers).map(|x| x.to_bits()).collect()
    };
    let one = bits(solve(3, 1));
    [2, 3].iter().for_each(|&threads| assert_eq!(bits(solve(3, threads)), one));
}

/// A matrix of diagonal blocks alone is solved by the first iteration.
#[test]
fn the_preconditioner_of_a_block_diagonal_matrix_is_its_inverse() {
    for d in 1..=3 {
        let mut matrix = NodeMatrix::new(d, vec![Vec::new(); 7]);
        for node in 0..7 {
            let slot = matrix.slot(node, node).unwrap();
            for (k, entry) in matrix.block_mut(slot).iter_mut().enumerate() {
                *entry = if k % (d + 1) == 0 { 3.0 + node as f32 } else { -0.75 };
            }
        }
        let mut constraints = ConstraintRows::default();
        let blocks = blocks(&matrix, d);
        constraints.clear();
        constraints.factor(&blocks).unwrap();
        let exact: Vec<f64> = (0..7 * d).map(wave).collect();
        let mut forces = vec![0.0; exact.len()];
        let mut x = vec![0.0; exact.len()];
        matrix.multiply_into(&exact, &mut forces);
        let ended = ConjugateGradients::default().solve(
            &Threads::one(),
            |x, out| matrix.multiply_into(x, out),
            ConstraintPreconditioner { blocks: &blocks, rows: &mut constraints },
            [&forces, &[]],
            [&mut x, &mut []],
            Goal { reduction: 1e-6, iterations: 9 },
        );
        assert_eq!(ended.iterations, 1);
        assert!(x.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-6));
    }
}

#[test]
fn dependent_rows_and_indefinite_matrices_are_reported() {
    let (mut matrix, _) = grid(3, 2);
    let good = blocks(&matrix, 2);
    let mut constraints = ConstraintRows::default();
    constraints.clear();
    constraints.push(0.0, [(3, 1.0), (8, -0.5)]);
    constraints.push(0.0, [(3, 2.0), (8, -1.0)]);
    assert!(matches!(constraints.factor(&good), Err(LinearError::Singular { .. })));
    constraints.clear();
    let slot = matrix.slot(4, 4).unwrap();
    matrix.block_mut(slot)[0] = -50.0;
    let forces = vec![1.0; 18];
    let mut x = vec![0.0; 18];
    let ended = ConjugateGradients::default().solve(
        &Threads::one(),
        |x, out| matrix.multiply_into(x, out),
        ConstraintPreconditioner { blocks: &good, rows: &mut constraints },
        [&forces, &[]],
        [&mut x, &mut []],
        Goal { reduction: 1e-12, iterations: 50 },
    );
    assert!(ended.is_indefinite);
}

/// More nodes than a section has, coupled near and far: the product of the stored half is that of
/// the whole matrix, to single precision and with the same bits from every number of threads.
#[test]
fn a_product_with_the_stored_half_is_that_of_the_matrix() {
    const NODES: usize = 5000;
    let others = |node: usize| [(node + 1) % NODES, (node * 7 + 3) % NODES, (node * node + 11) % NODES];
    let entry = |a: usize, b: usize, i: usize, j: usize| wave(a + 3 * b + 5 * i + 7 * j) as f32;
    for d in 1..=3 {
        let mut coupled = vec![Vec::new(); NODES];
        for (a, b) in (0..NODES).flat_map(|a| others(a).map(|b| (a, b))) {
            coupled[a].push(b as u32);
            coupled[b].push(a as u32);
        }
        let mut matrix = NodeMatrix::new(d, coupled.clone());
        let x: Vec<f64> = (0..NODES * d).map(wave).collect();
        let mut exact = vec![0.0; x.len()];
        let mut scale = vec![0.0; x.len()];
        for (a, others) in coupled.iter_mut().enumerate() {
            others.push(a as u32);
            others.sort_unstable();
            others.dedup();
            for b in others.iter().map(|b| *b as usize).filter(|b| *b >= a) {
                let slot = matrix.slot(a, b).unwrap();
                for (i, j) in (0..d).flat_map(|i| (0..d).map(move |j| (i, j))) {
                    let value = if a == b { entry(a, a, i.min(j), i.max(j)) } else { entry(a, b, i, j) };
                    matrix.block_mut(slot)[i * d + j] = value;
                    let ends = [(a * d + i, b * d + j), (b * d + j, a * d + i)];
                    for (row, column) in ends.into_iter().take(if a == b { 1 } else { 2 }) {
                        exact[row] += f64::from(value) * x[column];
                        scale[row] += (f64::from(value) * x[column]).abs();
                    }
                }
            }
        }
        let product = |threads: usize| {
            let mut matrix = matrix.clone().on(&Threads::new(threads));
            let mut out = vec![f64::NAN; x.len()];
            matrix.multiply_into(&x, &mut out);
            out
        };
        let one = product(1);
        for (k, (product, exact)) in one.iter().zip(&exact).enumerate() {
            assert!((product - exact).abs() < 1e-6 * scale[k], "{d}, {k}: {product} {exact}");
        }
        [2, 3].iter().for_each(|&threads| assert_eq!(product(threads), one));
    }
}
