//! A curved facet in space and its point closest to a given one.

use carom_algebra::Vector;
use carom_contact::kinematics::space::patch::Patch;
use carom_solid::FacetShape;

/// Nodes of a T6 that are displaced from its plane.
fn curved() -> Vec<f64> {
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [0.0, 1.0, -0.1], [0.5, 0.0, 0.2], [0.5, 0.5, 0.15], [0.0, 0.5, 0.05]]
        .concat()
}

/// A facet of the end of a cylinder: plane, with an edge along the circle.
#[test]
fn points_beside_a_curved_edge_are_on_the_facet() {
    let circle = |angle: f64| [angle.to_radians().cos(), angle.to_radians().sin(), 0.0];
    let middle = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
    let a = circle(0.0);
    let b = circle(45.0);
    let centre = [0.6, 0.25, 0.0];
    let y = [a, b, centre, circle(22.5), middle(b, centre), middle(centre, a)].concat();
    let patch = Patch { shape: FacetShape::T6, nodes: &[0, 1, 2, 3, 4, 5] };
    for k in 1..40 {
        for depth in [1e-3, 1e-5, 1e-7] {
            let mut from = patch.at(&y, [f64::from(k) / 40.0 * (1.0 - depth), depth]).position;
            from[2] += 1e-6;
            let found = patch.nearest(&y, from);
            assert!(found.distance < 1.001e-6, "{k} {depth}: {found:?}");
        }
    }
}

#[test]
fn the_nearest_point_is_that_of_a_dense_scan() {
    let y = curved();
    let patch = Patch { shape: FacetShape::T6, nodes: &[0, 1, 2, 3, 4, 5] };
    for k in 0..60 {
        let t = f64::from(k);
        let from = Vector([
            1.6 * (t * 0.61).sin().abs() - 0.3,
            1.4 * (t * 0.37).cos().abs() - 0.2,
            (t * 0.23).sin(),
        ]);
        let mut least = f64::INFINITY;
        for i in 0..=300 {
            for j in 0..=300 - i {
                let xi = [f64::from(i) / 300.0, f64::from(j) / 300.0];
                least = least.min((from - patch.at(&y, xi).position).norm());
            }
        }
        let found = patch.nearest(&y, from);
        assert!(found.distance <= least + 1e-14 && found.distance > least - 1e-4, "{found:?} {least}");
        assert!(patch.furthest(found.xi) <= 1e-14);
    }
}
