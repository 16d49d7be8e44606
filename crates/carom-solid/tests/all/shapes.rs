//! Shape functions: nodality, completeness, and derivatives by differences.

use carom_algebra::Vector;
use carom_solid::line_shape;
use carom_solid::shape::{
    Domain, Hex8, Hex27, Line2, Line3, Line4, Quad4, Quad9, Shape, Tet4, Tet10, Tet20, Tri3, Tri6, Tri10,
};
use proptest::prelude::*;

fn check<const R: usize, const N: usize, S: Shape<R, N>>(xi: [f64; 3]) {
    for (a, node) in S::NODES.iter().enumerate() {
        for (b, value) in S::values(node).iter().enumerate() {
            assert!((value - f64::from(u8::from(a == b))).abs() < 4e-15, "φ{b} at node {a} is {value}");
        }
        assert!(S::Domain::excess(node) < 1e-15);
    }
    let xi = Vector(std::array::from_fn(|i| xi[i]));
    let size: f64 = S::values(&xi).iter().map(|value| value.abs()).sum();
    assert!((S::values(&xi).iter().sum::<f64>() - 1.0).abs() < 1e-14 * (10.0 + size));
    let gradients = S::gradients(&xi);
    for i in 0..R {
        let size: f64 = gradients.iter().map(|g| g[i].abs()).sum();
        assert!(gradients.iter().map(|g| g[i]).sum::<f64>().abs() < 2e-14 * (1.0 + size));
        let h = 1e-4;
        let at = |s: f64| {
            let mut moved = xi;
            moved[i] += s * h;
            S::values(&moved)
        };
        // Fourth-order differences are exact for cubics.
        let (p, m, pp, mm) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
        for a in 0..N {
            let slope = (8.0 * (p[a] - m[a]) - (pp[a] - mm[a])) / (12.0 * h);
            assert!(
                (slope - gradients[a][i]).abs() < 1e-9 * (1.0 + size),
                "∂φ{a}/∂ξ{i}: {slope} against {}",
                gradients[a][i]
            );
        }
    }
}

proptest! {
    #[test]
    fn shapes_are_nodal_complete_and_have_exact_gradients(xi in [-1.3..1.3, -1.3..1.3, -1.3..1.3]) {
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
    fn second_derivatives_are_the_slope_of_the_first(xi in -1.5..1.5) {
        let h = 1e-4;
        for nodes in 1..=4 {
            let (here, plus, minus) = (line_shape(nodes, xi), line_shape(nodes, xi + h), line_shape(nodes, xi - h));
            for a in 0..4 {
                let slope = (plus.first[a] - minus.first[a]) / (2.0 * h);
                prop_assert!((slope - here.second[a]).abs() < 1e-9);
            }
        }
    }
}
