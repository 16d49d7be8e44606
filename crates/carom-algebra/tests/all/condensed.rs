//! Factors with chosen last unknowns: solutions, signs, precision, threads.

use std::sync::Arc;

use carom_algebra::{Condensed, Elimination, LinearError, Pattern, Precision, Saddle, Threads};

/// A grid of m × m nodes with two dofs each, springs to neighbours and between the dofs.
fn grid(m: usize) -> (Pattern, Vec<f64>, Vec<usize>) {
    let mut entries = Vec::new();
    for (a, (row, column)) in (0..m * m).map(|a| (a, (a / m, a % m))) {
        entries.extend([(2 * a, 2 * a, 5.0), (2 * a + 1, 2 * a + 1, 6.0), (2 * a + 1, 2 * a, 0.5)]);
        for b in [(column + 1 < m).then_some(a + 1), (row + 1 < m).then_some(a + m)].into_iter().flatten() {
            entries.extend([(2 * b, 2 * a, -1.0), (2 * b + 1, 2 * a + 1, -1.2)]);
        }
    }
    let pattern = Pattern::from_entries(2 * m * m, entries.iter().map(|&(i, j, _)| (i, j)));
    let mut values = vec![0.0; pattern.len()];
    for (i, j, v) in entries {
        values[pattern.slot(i, j).unwrap()] += v;
    }
    (pattern, values, (0..2 * m * m).map(|i| i / 2).collect())
}

#[test]
fn solves_with_any_choice_of_last_unknowns() {
    for (m, last) in [(1, vec![0]), (3, vec![]), (9, vec![7, 20, 21, 22, 80, 3]), (9, (0..162).collect())] {
        let (pattern, values, groups) = grid(m);
        let n = pattern.size();
        let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
        let mut rhs = vec![0.0; n];
        pattern.multiply_add(&values, &exact, &mut rhs);
        let elimination = Arc::new(Elimination::new(&pattern, &groups, &last).unwrap());
        assert_eq!(elimination.schur_size(), last.len());
        for (precision, digits) in [(Precision::Double, 1e-13), (Precision::Single, 1e-5)] {
            let mut condensed = Condensed::new(&elimination, precision);
            condensed.factor(|k| values[k]).unwrap();
            let mut x = Vec::new();
            let mut out = vec![0.0; n];
            condensed.eliminate_into(&rhs, &mut x);
            let mut saddle = Saddle::default();
            saddle.begin(condensed.schur(), elimination.schur_size(), 0);
            saddle.factor();
            saddle.solve(condensed.schur_part(&mut x), &mut []);
            condensed.substitute_into(&mut x, &mut out);
            let error = out.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < digits, "{m} {}: {error:e}", last.len());
        }
    }
}

/// Any magnitude, and a dominant mass, where entries far from the diagonal underflow: each is
/// about a thousandth of the one before.
#[test]
fn single_precision_has_the_range_it_needs() {
    for (factor, coupling) in [(1e-42, 1.0), (1e42, 1.0), (1.0, 1e-3)] {
        let (pattern, mut values, groups) = grid(30);
        for j in 0..pattern.size() {
            let column = pattern.starts[j]..pattern.starts[j + 1];
            column.for_each(|k| values[k] *= if pattern.rows[k] == j { factor } else { factor * coupling });
        }
        let exact: Vec<f64> = (0..pattern.size()).map(|i| (i as f64 * 0.7).sin()).collect();
        let mut rhs = vec![0.0; exact.len()];
        let mut out = vec![0.0; exact.len()];
        pattern.multiply_add(&values, &exact, &mut rhs);
        let elimination = Arc::new(Elimination::new(&pattern, &groups, &[]).unwrap());
        let mut condensed = Condensed::new(&elimination, Precision::Single);
        condensed.factor(|k| values[k]).unwrap();
        let mut x = Vec::new();
        condensed.eliminate_into(&rhs, &mut x);
        condensed.substitute_into(&mut x, &mut out);
        let error = out.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-5, "{factor:e} {coupling:e}: {error:e}");
    }
}

/// Large enough for nested parts, with random entries: factor, Schur complement and solution.
#[test]
fn same_bits_with_any_number_of_threads() {
    let (pattern, mut values, groups) = grid(110);
    let n = pattern.size();
    let mut random = 1_u64;
    for value in &mut values {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        *value *= 0.9 + 0.1 * (random >> 40) as f64 / f64::from(1 << 24);
    }
    let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
    let mut rhs = vec![0.0; n];
    pattern.multiply_add(&values, &exact, &mut rhs);
    for last in [vec![], (0..40).chain(12_000..12_100).collect::<Vec<_>>()] {
        let elimination = Arc::new(Elimination::new(&pattern, &groups, &last).unwrap());
        assert!(elimination.parts() >= 4);
        for (precision, digits) in [(Precision::Double, 1e-13), (Precision::Single, 1e-4)] {
            let solve = |threads: usize| {
                let mut condensed = Condensed::new(&elimination, precision).on(&Threads::new(threads));
                condensed.factor(|k| values[k]).unwrap();
                let mut x = Vec::new();
                let mut out = vec![0.0; n];
                condensed.eliminate_into(&rhs, &mut x);
                let mut saddle = Saddle::default();
                saddle.begin(condensed.schur(), elimination.schur_size(), 0);
                saddle.factor();
                saddle.solve(condensed.schur_part(&mut x), &mut []);
                condensed.substitute_into(&mut x, &mut out);
                let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                (bits(condensed.schur()), bits(&out), out)
            };
            let one = solve(1);
            let mut residual = vec![0.0; n];
            pattern.multiply_add(&values, &one.2, &mut residual);
            let residual = residual.iter().zip(&rhs).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(residual < digits, "{residual:e}");
            for threads in [2, 3] {
                let other = solve(threads);
                assert!(one.0 == other.0 && one.1 == other.1, "{threads} threads, {precision:?}");
            }
        }
    }
}

/// Negative pivots among the inner unknowns, among the last ones, and in both.
#[test]
fn an_indefinite_matrix_has_a_factor_with_signs() {
    for (m, last) in [(4, vec![]), (4, vec![30, 31]), (4, vec![5, 30]), (4, vec![5, 17]), (40, vec![5, 6, 7])]
    {
        let (pattern, mut values, groups) = grid(m);
        for i in [5, 17] {
            values[pattern.slot(i, i).unwrap()] = -1.0;
        }
        let n = pattern.size();
        let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
        let mut rhs = vec![0.0; n];
        let mut x = Vec::new();
        let mut out = vec![0.0; n];
        pattern.multiply_add(&values, &exact, &mut rhs);
        let elimination = Arc::new(Elimination::new(&pattern, &groups, &last).unwrap());
        let mut condensed = Condensed::new(&elimination, Precision::Double);
        assert_eq!(condensed.factor(|k| values[k]), Ok(false));
        condensed.eliminate_into(&rhs, &mut x);
        let mut saddle = Saddle::default();
        saddle.begin(condensed.schur(), elimination.schur_size(), 0);
        saddle.factor();
        saddle.solve(condensed.schur_part(&mut x), &mut []);
        condensed.substitute_into(&mut x, &mut out);
        let error = out.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-12, "{last:?}: {error:e}");
    }
    let (pattern, mut values, groups) = grid(4);
    values[pattern.slot(5, 5).unwrap()] = f64::NAN;
    let elimination = Arc::new(Elimination::new(&pattern, &groups, &[]).unwrap());
    let factor = Condensed::new(&elimination, Precision::Double).factor(|k| values[k]);
    assert!(matches!(factor, Err(LinearError::Singular { .. })));
}
