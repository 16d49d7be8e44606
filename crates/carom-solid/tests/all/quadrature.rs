//! Quadrature rules: exact on monomials, with positive weights.

use carom_algebra::Vector;
use carom_solid::quadrature::{line, tetrahedron, triangle};

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

#[test]
fn lines_are_exact_on_monomials() {
    for degree in 0..=15 {
        for p in 0..=degree {
            let sum: f64 = line(degree).iter().map(|(x, w)| w * x[0].powi(p as i32)).sum();
            let exact = if p % 2 == 0 { 2.0 / (p as f64 + 1.0) } else { 0.0 };
            assert!((sum - exact).abs() < 2e-15, "degree {degree}, x^{p}: {:e}", sum - exact);
        }
    }
    assert!((line(5).points[2][0] - 0.6_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn triangles_are_exact_on_monomials_with_positive_weights() {
    for degree in 1..=10 {
        let rule = triangle(degree);
        assert!(rule.weights.iter().all(|w| *w > 0.0));
        for p in 0..=degree {
            for q in 0..=degree - p {
                let sum: f64 = rule.iter().map(|(x, w)| w * x[0].powi(p as i32) * x[1].powi(q as i32)).sum();
                let exact = factorial(p) * factorial(q) / factorial(p + q + 2);
                assert!((sum - exact).abs() < 1e-15, "degree {degree}, x^{p} y^{q}: {:e}", sum - exact);
            }
        }
    }
}

#[test]
fn tetrahedra_are_exact_on_monomials_with_positive_weights() {
    for degree in 1..=8 {
        let rule = tetrahedron(degree);
        assert!(rule.weights.iter().all(|w| *w > 0.0));
        for p in 0..=degree {
            for q in 0..=degree - p {
                for r in 0..=degree - p - q {
                    let monomial =
                        |x: &Vector<3>| x[0].powi(p as i32) * x[1].powi(q as i32) * x[2].powi(r as i32);
                    let sum: f64 = rule.iter().map(|(x, w)| w * monomial(x)).sum();
                    let exact = factorial(p) * factorial(q) * factorial(r) / factorial(p + q + r + 3);
                    assert!(
                        (sum - exact).abs() < 1e-15,
                        "degree {degree}, x^{p} y^{q} z^{r}: {:e}",
                        sum - exact
                    );
                }
            }
        }
    }
}
