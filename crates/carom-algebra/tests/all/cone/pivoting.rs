//! The linear complementarity problem of a few unilateral contacts.

use carom_algebra::cone::pivoting::complementarity;
use carom_algebra::{Couplings, LinearError};

/// Pseudo-random numbers in (−1, 1), reproducible.
fn noise(k: usize) -> f64 {
    (k as f64 * 12.9898).sin() * 43758.5453 % 1.0
}

#[test]
fn both_sides_and_their_product_hold_for_many_matrices() {
    for case in 0..200 {
        let n = 1 + case % 23;
        let a: Vec<f64> = (0..n * n).map(|k| noise(k + 1000 * case)).collect();
        let mut d = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                d[i * n + j] =
                    (0..n).map(|k| a[i * n + k] * a[j * n + k]).sum::<f64>() + f64::from(i == j) * 0.1;
            }
        }
        let b: Vec<f64> = (0..n).map(|k| noise(k + 77 * case)).collect();
        let mut z = Vec::new();
        complementarity(&Couplings::dense(n, d.clone()), &b, &mut z).unwrap();
        for i in 0..n {
            let w = (0..n).map(|j| d[i * n + j] * z[j]).sum::<f64>() + b[i];
            assert!(z[i] >= 0.0 && w >= -1e-12 && (z[i] * w).abs() < 1e-11, "case {case}: z {} w {w}", z[i]);
        }
    }
}

/// Contacts that are coupled with a few others each, without and with the zeros between them.
#[test]
fn zeros_that_are_left_out_change_no_bit() {
    for case in 0..100 {
        let n = 1 + case % 37;
        let reach = case % 5;
        let couples = |i: usize, j: usize| i.abs_diff(j) <= reach && (i + j) % 3 != 1 || i == j;
        let value = |i: usize, j: usize| {
            let off = 0.2 * noise(i.max(j) * n + i.min(j) + 1000 * case);
            if i == j { 2.0 } else { off }
        };
        let entries = (0..n * n).map(|k| if couples(k / n, k % n) { value(k / n, k % n) } else { 0.0 });
        let dense = Couplings::dense(n, entries.collect());
        let mut sparse = Couplings::default();
        sparse.reset(n, |i, columns| columns.extend((0..n).filter(|&j| couples(i, j)))).unwrap();
        for i in 0..n {
            (0..n).for_each(|j| sparse.set(i, j, value(i, j)));
        }
        let b: Vec<f64> = (0..n).map(|k| noise(k + 77 * case)).collect();
        let [z, other] = [&dense, &sparse].map(|d| {
            let mut z = Vec::new();
            complementarity(d, &b, &mut z).unwrap();
            z
        });
        assert_eq!(z, other, "case {case}");
    }
}

#[test]
fn a_stiff_chain_and_no_rows_at_all() {
    let n = 40;
    let d: Vec<f64> = (0..n * n).map(|k| f64::from(2 * (k / n).min(k % n) as u32 + 1)).collect();
    let b: Vec<f64> = (0..n).map(|k| noise(k) - 0.2).collect();
    let mut z = Vec::new();
    complementarity(&Couplings::dense(n, d.clone()), &b, &mut z).unwrap();
    for i in 0..n {
        let w = (0..n).map(|j| d[i * n + j] * z[j]).sum::<f64>() + b[i];
        assert!(z[i] >= 0.0 && w > -1e-11 && (z[i] * w).abs() < 1e-11);
    }
    complementarity(&Couplings::default(), &[], &mut z).unwrap();
    assert!(z.is_empty());
    assert!(matches!(
        complementarity(&Couplings::dense(2, vec![1.0; 4]), &[-1.0, -2.0], &mut z),
        Err(LinearError::Singular { pivot: 1, .. })
    ));
}
