//! Functions of F = I + H without cancellation for small H.

use carom_algebra::Mat;
use carom_solid::material::kinematics::{exp_m1, ln_1p};
use carom_solid::material::{excess_cofactor, excess_det};

#[test]
fn exponential_keeps_its_digits() {
    for x in [0.0499_f64, -0.0499, 0.0501, -1.3, 1e-5, -1e-17] {
        assert!((exp_m1(x) / x.exp_m1() - 1.0).abs() < 4e-16, "{x}");
    }
    assert_eq!(exp_m1(0.0), 0.0);
}

#[test]
fn excesses_are_the_plain_formulae() {
    let h = Mat([[0.3, -0.2, 0.1], [0.05, -0.4, 0.2], [0.1, 0.15, 0.25]]);
    let f = Mat::identity() + h;
    assert!((excess_det(&h) - (f.det() - 1.0)).abs() < 1e-15);
    let e = excess_cofactor(&h) - (f.cofactor() - Mat::identity());
    assert!(e.double_dot(&e) < 1e-30);
    let h = Mat([[0.3, -0.2], [0.05, -0.4]]);
    let f = Mat::identity() + h;
    assert!((excess_det(&h) - (f.det() - 1.0)).abs() < 1e-15);
    let e = excess_cofactor(&h) - (f.cofactor() - Mat::identity());
    assert!(e.double_dot(&e) < 1e-30);
}

#[test]
fn logarithm_keeps_its_digits() {
    for x in [0.0999_f64, -0.0999, 0.03, 1e-5] {
        let [ln, excess] = ln_1p(x);
        assert!((ln / x.ln_1p() - 1.0).abs() < 4e-16, "{x}");
        assert!((excess / (x - x.ln_1p()) - 1.0).abs() < 1e-15 / x.abs(), "{x}");
    }
    let x = 1e-9;
    assert!((ln_1p(x)[1] / (0.5 * x * x * (1.0 - 2.0 * x / 3.0)) - 1.0).abs() < 1e-15);
    assert_eq!(ln_1p(0.0), [0.0, 0.0]);
}
