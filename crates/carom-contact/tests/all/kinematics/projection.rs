//! The closest point of a curved facet.

use carom_algebra::Vector;
use carom_contact::kinematics::projection::Facet;
use carom_contact::places::Places;
use carom_solid::FacetShape;

#[test]
fn finds_the_nearest_of_two_valleys() {
    // A cubic through (−1, 1) (1, 1) with unevenly lowered interior nodes, compared with a
    // dense scan.
    let y = [-1.0, 1.0, 1.0, 1.0, -0.4, -0.3, 0.4, -0.6];
    let y = Places::new(&y, 2);
    let facet = Facet { shape: FacetShape::L4, nodes: &[0, 1, 2, 3], orientation: 1.0 };
    for k in 0..20 {
        let from = Vector([-0.9 + 0.09 * f64::from(k), 1.2]);
        let scan = (-1000..=1000)
            .map(|i| f64::from(i) * 1.2e-3)
            .map(|xi| ((from - facet.at(y, xi).position).norm(), xi))
            .fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
        if scan.1.abs() < 1.19 {
            let xi = facet.closest_point(y, from, 1.2).unwrap();
            assert!((xi - scan.1).abs() < 2e-3, "{xi} {scan:?}");
            assert!((facet.closest_from(y, from, xi + 1e-3, 1.3).unwrap() - xi).abs() < 1e-13);
        }
    }
}
