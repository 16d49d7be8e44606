//! Conjugate gradients under constraints against a dense elimination of the whole saddle point, and
//! the blocks of their preconditioner against a product with the blocks themselves.

use carom_algebra::{ConjugateGradients, ConstraintRows, DiagonalBlocks, LinearError, NodeMatrix, Threads};

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
            let slot = matrix.slot(a, b).unwrap();
            matrix.block_mut(slot)[i * d + j] = value;
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
    let (matrix, _) = grid(6, d);
    let threads = Threads::new(threads);
    let (matrix, blocks) = (matrix.on(&threads), blocks(&grid(6, d).0, d));
    let mut constraints = ConstraintRows::default();
    constraints.clear();
    rows(d).into_iter().for_each(|(compliance, entries)| constraints.push(compliance, entries));
    constraints.factor(&blocks).unwrap();
    let forces: Vec<f64> = (0..36 * d).map(|i| wave(3 * i)).collect();
    let gaps = [0.3, -0.2, 0.0, 0.1];
    let (mut x, mut multipliers) = (vec![0.0; forces.len()], vec![0.0; gaps.len()]);
    let product = |x: &[f64], out: &mut [f64]| {
        matrix.multiply_into(x, out);
        let (compliance, spring) = &rows(d)[2];
        let force = spring.iter().map(|(dof, slope)| slope * x[*dof]).sum::<f64>() / compliance;
        spring.iter().for_each(|(dof, slope)| out[*dof] += force * slope);
    };
    let ended = ConjugateGradients::default().solve(
        &threads,
        product,
        &blocks,
        &mut constraints,
        [&forces, &gaps],
        [&mut x, &mut multipliers],
        (1e-13, 500),
    );
    assert!(!ended.is_indefinite && ended.reduction <= 1e-13, "{ended:?}");
    (x, multipliers, ended.iterations)
}

#[test]
fn solutions_are_those_of_the_whole_saddle_point() {
    for d in 1..=3 {
        let ((_, dense), rows) = (grid(6, d), rows(d));
        let (n, m) = (36 * d, rows.len());
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
        let (mut constraints, blocks) = (ConstraintRows::default(), blocks(&matrix, d));
        constraints.clear();
        constraints.factor(&blocks).unwrap();
        let exact: Vec<f64> = (0..7 * d).map(wave).collect();
        let (mut forces, mut x) = (vec![0.0; exact.len()], vec![0.0; exact.len()]);
        matrix.multiply_into(&exact, &mut forces);
        let ended = ConjugateGradients::default().solve(
            &Threads::one(),
            |x, out| matrix.multiply_into(x, out),
            &blocks,
            &mut constraints,
            [&forces, &[]],
            [&mut x, &mut []],
            (1e-12, 9),
        );
        assert_eq!(ended.iterations, 1);
        assert!(x.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-14));
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
    let (forces, mut x) = (vec![1.0; 18], vec![0.0; 18]);
    let ended = ConjugateGradients::default().solve(
        &Threads::one(),
        |x, out| matrix.multiply_into(x, out),
        &good,
        &mut constraints,
        [&forces, &[]],
        [&mut x, &mut []],
        (1e-12, 50),
    );
    assert!(ended.is_indefinite);
}
