//! Vectors and matrices of the body's space: `D` is 1, 2 or 3 and known at compile time.

use carom_algebra::Mat;

#[test]
fn inverse_times_matrix_is_identity_in_every_dimension() {
    let a = Mat([[2.0, -1.0, 0.5], [0.3, 4.0, 1.0], [1.0, 0.0, 3.0]]);
    let e = a * a.inverse() - Mat::identity();
    assert!(e.double_dot(&e) < 1e-28);
    let b = Mat([[2.0, -1.0], [0.3, 4.0]]);
    let e = b * b.inverse() - Mat::identity();
    assert!(e.double_dot(&e) < 1e-28);
    assert_eq!(Mat([[4.0]]).inverse(), Mat([[0.25]]));
}

#[test]
fn cofactor_is_the_derivative_of_the_determinant() {
    let a = Mat([[2.0, -1.0, 0.5], [0.3, 4.0, 1.0], [1.0, 0.0, 3.0]]);
    let h = 1e-6;
    for i in 0..3 {
        for j in 0..3 {
            let mut p = a;
            let mut m = a;
            p.0[i][j] += h;
            m.0[i][j] -= h;
            let slope = (p.det() - m.det()) / (2.0 * h);
            assert!((slope - a.cofactor().0[i][j]).abs() < 1e-8);
        }
    }
}
