//! Shape functions: nodality, completeness, and derivatives by differences.

use carom_algebra::Vector;
use carom_solid::shape::{
    Domain, Hex8, Hex27, Line2, Line3, Line4, Quad4, Quad9, Shape, Tet4, Tet10, Tet20, Tri3, Tri6, Tri10,
};
use carom_solid::{line_powers, line_shape};

use super::random::lists;

fn check<const R: usize, const N: usize, S: Shape<R, N>>(xi: &[f64]) {
    for node in &S::NODES {
        assert!(S::Domain::excess(node) < 1e-15);
    }
    let vector = |xi: &[f64]| Vector(std::array::from_fn(|i| xi[i]));
    check_functions(
        &S::NODES.map(|xi| xi.0.to_vec()),
        &xi[..R],
        &|xi| S::values(&vector(xi)).to_vec(),
        &|xi| S::gradients(&vector(xi)).map(|g| g.0.to_vec()).to_vec(),
    );
}

fn check_functions(
    nodes: &[Vec<f64>],
    xi: &[f64],
    values: &dyn Fn(&[f64]) -> Vec<f64>,
    gradients: &dyn Fn(&[f64]) -> Vec<Vec<f64>>,
) {
    for (a, node) in nodes.iter().enumerate() {
        for (b, value) in values(node).iter().enumerate() {
            assert!((value - f64::from(u8::from(a == b))).abs() < 4e-15, "φ{b} at node {a} is {value}");
        }
    }
    let size: f64 = values(xi).iter().map(|value| value.abs()).sum();
    assert!((values(xi).iter().sum::<f64>() - 1.0).abs() < 1e-14 * (10.0 + size));
    let gradients = gradients(xi);
    for i in 0..xi.len() {
        let size: f64 = gradients.iter().map(|g| g[i].abs()).sum();
        assert!(gradients.iter().map(|g| g[i]).sum::<f64>().abs() < 2e-14 * (1.0 + size));
        let h = 1e-4;
        let at = |s: f64| {
            let mut moved = xi.to_vec();
            moved[i] += s * h;
            values(&moved)
        };
        // Fourth-order differences are exact for cubics.
        let (p, m, pp, mm) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
        for a in 0..nodes.len() {
            let slope = (8.0 * (p[a] - m[a]) - (pp[a] - mm[a])) / (12.0 * h);
            assert!(
                (slope - gradients[a][i]).abs() < 1e-9 * (1.0 + size),
                "∂φ{a}/∂ξ{i}: {slope} against {}",
                gradients[a][i]
            );
        }
    }
}

fn check_all(xi: &[f64]) {
    check::<1, 2, Line2>(xi);
    check::<1, 3, Line3>(xi);
    check::<1, 4, Line4>(xi);
    check::<2, 3, Tri3>(xi);
    check::<2, 6, Tri6>(xi);
    check::<2, 10, Tri10>(xi);
    check::<2, 4, Quad4>(xi);
    check::<2, 9, Quad9>(xi);
    check::<3, 8, Hex8>(xi);
    check::<3, 27, Hex27>(xi);
    check::<3, 4, Tet4>(xi);
    check::<3, 10, Tet10>(xi);
    check::<3, 20, Tet20>(xi);
}

#[test]
fn shapes_are_nodal_complete_and_have_exact_gradients() {
    lists(256, 3, &|x| check_all(&[1.3 * x[0], 1.3 * x[1], 1.3 * x[2]]));
    // With many digits lost.
    check_all(&[-1.1650296519410208, -1.2229599860930884, 0.0]);
    check_all(&[-1.2014043320150636, -1.0857090827230704, -0.9996956997997588]);
}

#[test]
fn second_derivatives_are_the_slope_of_the_first() {
    lists(256, 1, &|x| {
        let (xi, h) = (1.5 * x[0], 1e-4);
        for nodes in 1..=4 {
            let [here, plus, minus] = [xi, xi + h, xi - h].map(|xi| line_shape(nodes, xi));
            for a in 0..4 {
                let slope = (plus.first[a] - minus.first[a]) / (2.0 * h);
                assert!((slope - here.second[a]).abs() < 1e-9);
            }
        }
    });
}

/// A curve by powers of ξ is that of its shape functions.
#[test]
fn a_curve_has_the_powers_of_its_shape_functions() {
    let nodes = [0.3, -1.7, 2.9, 0.8].map(|x| Vector([x]));
    for count in 1..=4 {
        let nodes = &nodes[..count];
        let powers = line_powers(nodes);
        for xi in [-1.3, -0.4, 0.0, 0.7, 1.0] {
            let by_powers: f64 = (0..4).map(|k| powers[k][0] * f64::powi(xi, k as i32)).sum();
            let values = line_shape(count, xi).values;
            let by_functions: f64 = nodes.iter().zip(values).map(|(x, value)| x[0] * value).sum();
            assert!((by_powers - by_functions).abs() < 1e-14, "{count} {xi}: {by_powers} {by_functions}");
        }
    }
}
