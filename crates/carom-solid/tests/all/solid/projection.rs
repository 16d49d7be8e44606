//! Stress and plastic strain of materials with memory between quadrature points, where nothing is
//! remembered.

use carom_solid::shape::{Domain, Hex8, Quad4, Shape, Tet10, Tri6};
use carom_solid::solid::projection::{monomials, weights};

/// Fields of the degree are reproduced, of every rule with enough points.
fn reproduces<const D: usize, const N: usize, S: Shape<D, N>>(rule: usize, degree: usize) {
    let points = S::Domain::rule(rule).points;
    let field = |xi: &[f64]| -> f64 {
        monomials(xi, degree).iter().enumerate().map(|(k, m)| (1.0 + k as f64) * m).sum()
    };
    for xi in [[0.0; 3], [1.0, 0.0, 0.0], [0.3, 0.2, 0.9]] {
        let xi = &xi[..D];
        let weights = weights(&points, xi, degree);
        let found: f64 = points.iter().zip(&weights).map(|(p, weight)| weight * field(&p.0)).sum();
        assert!((found - field(xi)).abs() < 1e-12 * field(xi).abs(), "{found} {}", field(xi));
    }
}

#[test]
fn polynomials_are_reproduced() {
    reproduces::<2, 6, Tri6>(4, 1);
    reproduces::<2, 6, Tri6>(6, 2);
    reproduces::<2, 4, Quad4>(2, 1);
    reproduces::<2, 4, Quad4>(4, 1);
    reproduces::<3, 10, Tet10>(4, 1);
    reproduces::<3, 10, Tet10>(6, 2);
    reproduces::<3, 8, Hex8>(2, 1);
}

/// A point alone gives its value everywhere.
#[test]
fn too_few_points_give_their_mean() {
    assert_eq!(weights(&<Tri6 as Shape<2, 6>>::Domain::rule(0).points, &[0.9, 0.1], 1), [1.0]);
    assert_eq!(monomials(&[2.0, 3.0], 2), [1.0, 2.0, 3.0, 4.0, 6.0, 9.0]);
}
