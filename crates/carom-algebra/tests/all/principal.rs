//! Principal values and axes of a symmetric tensor.

use carom_algebra::{Mat, PrincipalAxes, principal, principal_axes};

fn near(found: [f64; 3], expected: [f64; 3]) {
    let size = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 4e-16 * size), "{found:?} {expected:?}");
}

/// By hand: pure shear 3 on a pressure of 2; the circulant with 2 and 1 has 4, 1, 1; and the
/// plane stress 7, 1 with shear 4 has 4 ± 5.
#[test]
fn simple_states() {
    near(principal([[-2.0, 0.0, 3.0], [0.0, -2.0, 0.0], [3.0, 0.0, -2.0]]), [1.0, -2.0, -5.0]);
    near(principal([[2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0]]), [4.0, 1.0, 1.0]);
    near(principal([[7.0, 4.0, 0.0], [4.0, 1.0, 0.0], [0.0, 0.0, 0.0]]), [9.0, 0.0, -1.0]);
    near(principal([[0.0; 3]; 3]), [0.0; 3]);
    assert!(principal([[f64::NAN; 3]; 3])[0].is_nan());
}

/// The three invariants are those of the tensor.
#[test]
fn invariants_are_kept() {
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    for _ in 0..1000 {
        let [a, b, c, d, e, f] = std::array::from_fn(|_| 1e6 * random());
        let [l, m, n] = principal([[a, d, f], [d, b, e], [f, e, c]]);
        let det = a * (b * c - e * e) - d * (d * c - e * f) + f * (d * e - b * f);
        assert!((l + m + n - a - b - c).abs() < 1e-8 && l >= m && m >= n);
        assert!((l * m + m * n + n * l - (a * b + b * c + c * a - d * d - e * e - f * f)).abs() < 1e-2);
        assert!((l * m * n - det).abs() < 1e4);
    }
}
/// The axes are orthonormal and diagonalise the tensor, with equal and with close eigenvalues.
#[test]
fn axes_diagonalise() {
    for close in [0.0, 1e-300, 1e-17, 1e-12, 1e-6, 0.3] {
        let a = Mat([[2.0, 1.0, 1.0 + close], [1.0, 2.0, 1.0], [1.0 + close, 1.0, 2.0]]);
        let PrincipalAxes { values, axes } = principal_axes(&a);
        let mut scaled = axes;
        for i in 0..3 {
            (0..3).for_each(|j| scaled.0[i][j] *= values[j]);
        }
        let error = scaled * axes.transposed() - a;
        assert!(error.double_dot(&error) < 1e-29, "{close}");
        let error = axes * axes.transposed() - Mat::identity();
        assert!(error.double_dot(&error) < 1e-30, "{close}");
    }
    assert_eq!(principal_axes(&Mat([[3.0]])).values, [3.0]);
}
