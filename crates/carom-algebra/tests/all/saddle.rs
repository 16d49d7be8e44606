//! The dense system of the last unknowns and the constraints.

use carom_algebra::Saddle;

#[test]
fn meets_both_lines_of_the_system() {
    let n = 7;
    let m = 3;
    let entry = |i: usize, j: usize| if i == j { 4.0 } else { 1.0 / (1.0 + (i as f64 - j as f64).abs()) };
    let stiffness: Vec<f64> = (0..n * n).map(|k| entry(k % n, k / n)).collect();
    let row = |r: usize, j: usize| ((r * 5 + j).pow(2) as f64 * 1.3).sin();
    let mut saddle = Saddle::default();
    saddle.begin(&stiffness, n, m);
    saddle.add(4, 2, 0.25);
    for r in 0..m {
        (0..n).for_each(|j| saddle.add_row(r, j, row(r, j)));
    }
    assert!(saddle.factor());
    let b: Vec<f64> = (0..n).map(|i| i as f64 - 2.0).collect();
    let c = [0.3, -0.1, 0.7];
    let mut x = b.clone();
    let mut multipliers = c.to_vec();
    saddle.solve(&mut x, &mut multipliers);
    for i in 0..n {
        let changed = |j: usize| if (i, j) == (4, 2) || (i, j) == (2, 4) { 0.25 } else { 0.0 };
        let upper: f64 = (0..n).map(|j| (entry(i, j) + changed(j)) * x[j]).sum();
        let lower: f64 = (0..m).map(|r| row(r, i) * multipliers[r]).sum();
        assert!((upper + lower - b[i]).abs() < 1e-13);
    }
    for r in 0..m {
        assert!(((0..n).map(|j| row(r, j) * x[j]).sum::<f64>() - c[r]).abs() < 1e-13);
    }
    // Indefinite along the first row alone: augmented along that row S has a factor; otherwise
    // the whole matrix is factored.
    let push = -30.0;
    let along = |i: usize| if i == 2 { 1.0 } else { 0.0 };
    for share in [0.0, 20.0] {
        saddle.begin(&stiffness, n, 1);
        saddle.add_row(0, 2, 2.0);
        saddle.add(2, 2, push);
        saddle.augment(share);
        assert_eq!(saddle.factor(), share > 0.0);
        let mut x = b.clone();
        let mut multiplier = [0.5];
        saddle.solve(&mut x, &mut multiplier);
        assert!((2.0 * x[2] - 0.5).abs() < 1e-13);
        for i in 0..n {
            let upper: f64 = (0..n).map(|j| entry(i, j) * x[j]).sum();
            assert!((upper + along(i) * (push * x[2] + 2.0 * multiplier[0]) - b[i]).abs() < 1e-12);
        }
    }
}

/// Each row of a chain shares entries with the next one. What a row adds to S is in proportion to
/// S, not to what the rows before it have added, which would grow from row to row until S had no
/// factor, and multipliers no correct digits.
#[test]
fn rows_of_a_chain_are_augmented_alike() {
    let m = 60;
    let n = m + 2;
    let entry = |i: usize, j: usize| match i.abs_diff(j) {
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    };
    let stiffness: Vec<f64> = (0..n * n).map(|k| entry(k % n, k / n)).collect();
    let row = |r: usize, j: usize| match j.wrapping_sub(r) {
        0 | 2 => 0.25,
        1 => 0.5,
        _ => 0.0,
    };
    let mut saddle = Saddle::default();
    saddle.begin(&stiffness, n, m);
    for r in 0..m {
        (r..r + 3).for_each(|j| saddle.add_row(r, j, row(r, j)));
    }
    saddle.augment(10.0);
    assert!(saddle.factor());
    let b: Vec<f64> = (0..n).map(|i| (1.3 * i as f64).sin()).collect();
    let mut x = b.clone();
    let mut multipliers = vec![0.0; m];
    saddle.solve(&mut x, &mut multipliers);
    for i in 0..n {
        let upper: f64 = (0..n).map(|j| entry(i, j) * x[j]).sum();
        let lower: f64 = (0..m).map(|r| row(r, i) * multipliers[r]).sum();
        assert!((upper + lower - b[i]).abs() < 1e-10);
    }
    for r in 0..m {
        assert!((0..n).map(|j| row(r, j) * x[j]).sum::<f64>().abs() < 1e-12);
    }
}

/// A row at an angle to two others that is round-off is left out: the solution is that without it.
/// At a larger angle it counts, also beside a row that is a million times longer.
#[test]
fn rows_that_depend_on_earlier_ones_are_left_out() {
    let n = 5;
    let entry = |i: usize, j: usize| if i == j { 4.0 } else { 1.0 / (1.0 + (i as f64 - j as f64).abs()) };
    let stiffness: Vec<f64> = (0..n * n).map(|k| entry(k % n, k / n)).collect();
    let b: Vec<f64> = (0..n).map(|i| i as f64 - 2.0).collect();
    let solved = |rows: &[[f64; 5]], skew: bool| {
        let mut saddle = Saddle::default();
        saddle.begin(&stiffness, n, rows.len());
        if skew {
            saddle.direct();
        }
        for (r, row) in rows.iter().enumerate() {
            for (j, slope) in row.iter().enumerate() {
                saddle.add_row(r, j, *slope);
                if skew {
                    saddle.add_direction(r, j, *slope + if j == 4 { 0.1 } else { 0.0 });
                }
            }
        }
        assert!(saddle.factor());
        let mut x = b.clone();
        let mut multipliers: Vec<f64> = rows.iter().map(|row| 0.1 * row[0]).collect();
        saddle.solve(&mut x, &mut multipliers);
        (x, multipliers)
    };
    let rows = [[1e6, 0.0, 2e6, 0.0, 0.0], [1.0, -1.0, 0.5, 0.0, 0.0], [0.0, 0.0, 0.3, 1.0, 0.0]];
    for skew in [false, true] {
        let (exact, of_others) = solved(&rows, skew);
        for angle in [0.0, 1e-9] {
            let sum =
                [0, 1, 2, 3, 4].map(|j| 1e-6 * rows[0][j] + rows[1][j] + if j == 3 { angle } else { 0.0 });
            let (x, multipliers) = solved(&[rows[0], rows[1], sum, rows[2]], skew);
            assert!(x.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-12));
            assert_eq!(multipliers[2], 0.0);
            assert!((multipliers[3] - of_others[2]).abs() < 1e-12);
        }
        let near = [0, 1, 2, 3, 4].map(|j| rows[1][j] + if j == 3 { 1e-5 } else { 0.0 });
        let (x, _) = solved(&[rows[0], rows[1], near], skew);
        assert!(x[3].abs() < 1e-4, "{x:?}");
    }
}

/// Forces along other directions, with S positive definite, only on the kernel, or not at all.
#[test]
fn forces_may_act_along_other_directions() {
    let n = 6;
    let m = 2;
    let row = |r: usize, j: usize| ((r * 5 + j).pow(2) as f64 * 1.3).sin();
    let direction = |r: usize, j: usize| row(r, j) - 0.4 * ((r * 7 + 3 * j) as f64).cos();
    for (push, share) in [(0.0, 0.0), (0.0, 10.0), (-30.0, 10.0), (-30.0, 0.0)] {
        let entry = |i: usize, j: usize| match (i, j) {
            (2, 2) => 4.0 + push,
            _ if i == j => 4.0,
            _ => 1.0 / (1.0 + (i as f64 - j as f64).abs()),
        };
        let stiffness: Vec<f64> = (0..n * n).map(|k| entry(k % n, k / n)).collect();
        let mut saddle = Saddle::default();
        saddle.begin(&stiffness, n, m);
        saddle.direct();
        for r in 0..m {
            (0..n).for_each(|j| saddle.add_row(r, j, row(r, j)));
            (0..n).for_each(|j| saddle.add_direction(r, j, direction(r, j)));
        }
        saddle.augment(share);
        saddle.factor();
        let b: Vec<f64> = (0..n).map(|i| i as f64 - 2.0).collect();
        let c = [0.3, -0.1];
        let mut x = b.clone();
        let mut multipliers = c.to_vec();
        saddle.solve(&mut x, &mut multipliers);
        for i in 0..n {
            let upper: f64 = (0..n).map(|j| entry(i, j) * x[j]).sum();
            let lower: f64 = (0..m).map(|r| direction(r, i) * multipliers[r]).sum();
            assert!((upper + lower - b[i]).abs() < 1e-12, "{push} {share}");
        }
        for r in 0..m {
            assert!(((0..n).map(|j| row(r, j) * x[j]).sum::<f64>() - c[r]).abs() < 1e-12);
        }
    }
}

/// The solution of a dense system by rows, by elimination with partial pivoting.
fn dense(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            (k..n).for_each(|j| a[i][j] -= factor * a[k][j]);
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        b[k] = (b[k] - (k + 1..n).map(|j| a[k][j] * b[j]).sum::<f64>()) / a[k][k];
    }
    b
}

/// g x − C λ = c, with S positive definite, only on the kernel, or not at all.
#[test]
fn rows_that_yield_have_the_solution_of_the_dense_matrix() {
    let n = 6;
    let m = 3;
    let row = |r: usize, j: usize| ((r * 5 + j).pow(2) as f64 * 1.3).sin();
    let direction = |r: usize, j: usize| row(r, j) - 0.4 * ((r * 7 + 3 * j) as f64).cos();
    let mut seen = [0, 0];
    for (push, share) in [(0.0, 0.0), (0.0, 10.0), (-30.0, 10.0), (-30.0, 0.0)] {
        for compliances in [[0.0, 0.2, 0.0], [1e-6, 0.0, 30.0], [0.0, 1e100, 0.0], [1e100, 3.0, 1e100]] {
            let entry = |i: usize, j: usize| match (i, j) {
                (2, 2) => 4.0 + push,
                _ if i == j => 4.0,
                _ => 1.0 / (1.0 + (i as f64 - j as f64).abs()),
            };
            let stiffness: Vec<f64> = (0..n * n).map(|k| entry(k % n, k / n)).collect();
            let mut saddle = Saddle::default();
            saddle.begin(&stiffness, n, m);
            saddle.direct();
            for r in 0..m {
                (0..n).for_each(|j| saddle.add_row(r, j, row(r, j)));
                (0..n).for_each(|j| saddle.add_direction(r, j, direction(r, j)));
                saddle.yields(r, compliances[r]);
            }
            saddle.augment(share);
            seen[usize::from(saddle.factor())] += 1;
            let b: Vec<f64> = (0..n).map(|i| i as f64 - 2.0).collect();
            let c = [0.3, -0.1, 0.7];
            let mut x = b.clone();
            let mut multipliers = c.to_vec();
            saddle.solve(&mut x, &mut multipliers);
            let whole = |i: usize, j: usize| match (i < n, j < n) {
                (true, true) => entry(i, j),
                (true, false) => direction(j - n, i),
                (false, true) => row(i - n, j),
                (false, false) => {
                    if i == j {
                        -compliances[i - n]
                    } else {
                        0.0
                    }
                }
            };
            let matrix = (0..n + m).map(|i| (0..n + m).map(|j| whole(i, j)).collect()).collect();
            let expected = dense(matrix, [&b[..], &c].concat());
            for (i, (found, expected)) in x.iter().chain(&multipliers).zip(expected).enumerate() {
                // The multipliers of what yields are as small as 1/C.
                let size = if i < n { 1.0 } else { expected.abs() };
                let case = format!("{push} {share} {compliances:?} {i}: {found:e} {expected:e}");
                assert!((found - expected).abs() < 1e-10 * size, "{case}");
            }
        }
    }
    assert!(seen[0] > 3 && seen[1] > 3, "{seen:?}");
}

/// Nodes on two springs each, K_tt = 3 and K_nt = −1, that slide forward with the coefficients μ:
/// the slip u of one with a load f obeys (K_tt + μ K_nt) u = f_t + μ f_n, which says nothing for
/// μ = 3 and has, for more, solutions beside those that stick (p > 0 and f_t < μ|f_n|) or lift off.
/// R is diagonal with the entries 1 + μ K_nt/K_tt.
#[test]
fn large_friction_is_singular_where_the_springs_of_a_node_say() {
    let regularity = |coefficients: &[f64], order: &[usize]| {
        let m = coefficients.len();
        let n = 2 * coefficients.len();
        let entry = |i: usize, j: usize| match (i / 2 == j / 2, i % 2, j % 2) {
            (true, 0, 0) => 2.0,
            (true, 1, 1) => 3.0,
            (true, ..) => -1.0,
            _ => 0.0,
        };
        let stiffness: Vec<f64> = (0..n * n).map(|k| entry(k % n, k / n)).collect();
        let mut saddle = Saddle::default();
        saddle.begin(&stiffness, n, m);
        saddle.direct();
        for (r, &node) in order.iter().enumerate() {
            saddle.add_row(r, 2 * node, 1.0);
            saddle.add_direction(r, 2 * node, 1.0);
            saddle.add_direction(r, 2 * node + 1, -coefficients[node]);
        }
        saddle.augment(10.0);
        assert!(saddle.factor());
        saddle.regularity().unwrap()
    };
    for coefficient in [0.0, 0.3, 2.9, 2.9999, 3.0001, 3.1, -5.0] {
        let found = regularity(&[coefficient], &[0]);
        assert!((found - (1.0 - coefficient / 3.0)).abs() < 1e-13, "{coefficient}: {found}");
    }
    assert!(regularity(&[3.0], &[0]).abs() < 1e-12);
    // The smallest is that of the second node; each node beyond 3 changes the sign.
    for order in [[0, 1, 2], [2, 0, 1], [1, 0, 2]] {
        for (coefficients, sign) in [([0.3, 2.4, 1.0], 1.0), ([0.3, 3.6, 1.0], -1.0), ([5.0, 3.6, 0.0], 1.0)]
        {
            let found = regularity(&coefficients, &order);
            assert!((found - sign * 0.2).abs() < 1e-6, "{coefficients:?} {order:?}: {found}");
        }
    }
}
