//! The whole boundary of a body in the plane: how deep a point lies inside.

use carom_contact::{Skin, Surface};
use carom_solid::FacetShape;

/// An L-shaped polygon: a convex corner at (2, 1), a concave one at (1, 1).
fn bracket() -> (Skin, Vec<f64>) {
    let y = vec![0.0, 0.0, 2.0, 0.0, 2.0, 1.0, 1.0, 1.0, 1.0, 2.0, 0.0, 2.0];
    let facets: Vec<Vec<usize>> = (0..6).map(|k| vec![k, (k + 1) % 6]).collect();
    let mut skin = Skin::new(Surface::new(FacetShape::L2, &facets, &[1.0; 6]));
    skin.update(&y);
    (skin, y)
}

#[test]
fn a_boundary_stays_clear_of_itself_for_a_quarter_of_a_facet() {
    let (mut skin, mut y) = bracket();
    skin.update(&y);
    // The shortest facets are 1 long; two may approach each other.
    assert_eq!(skin.clearance_to_itself(&y), 0.125);
    // The arm to the right is bent down to 0.2 above the lower side, which is 2 long.
    y[5] = 0.2;
    y[7] = 0.2;
    skin.update(&y);
    assert_eq!(skin.clearance_to_itself(&y), 0.0);
    assert!(!skin.crosses_itself(&y, |_, _| false));
}

#[test]
fn the_sign_is_that_of_the_polygon() {
    let (skin, y) = bracket();
    for (point, distance) in [
        ([0.5, 0.2], -0.2),
        ([2.3, 1.4], 0.5),
        ([0.7, 0.6], -0.5),
        ([1.3, 1.2], 0.2),
        ([-1.0, 0.5], 1.0),
        ([0.9, 0.8], -f64::hypot(0.1, 0.2)),
    ] {
        let found = skin.depth(point, None, &y).unwrap();
        assert_eq!(skin.depth(point, Some(4), &y), Some(found));
        assert!((found.distance - distance).abs() < 1e-14, "{point:?} {found:?}");
    }
}

#[test]
fn a_point_far_in_front_of_a_faint_dent_is_outside() {
    for depth in [1e-12, 1e-9, 1e-6, 1e-3] {
        let y = vec![0.0, 0.0, 2.0, 0.0, 2.0, 1.0, 1.0, 1.0 - depth, 0.0, 1.0];
        let facets: Vec<Vec<usize>> = (0..5).map(|k| vec![k, (k + 1) % 5]).collect();
        let mut skin = Skin::new(Surface::new(FacetShape::L2, &facets, &[1.0; 5]));
        skin.update(&y);
        let at = |height: f64| skin.depth([1.0, height], None, &y).unwrap().distance;
        assert!((at(3.4) - 2.4).abs() < 1e-3 && (at(0.8) + 0.2).abs() < 2e-3, "{depth}: {}", at(3.4));
    }
}

#[test]
fn a_boundary_that_crosses_itself_is_found() {
    let (mut skin, mut y) = bracket();
    assert!(!skin.crosses_itself(&y, |_, _| false));
    // The end of the upright arm is pushed through the lower side.
    y[9] = -0.5;
    y[11] = -0.5;
    skin.update(&y);
    assert!(skin.crosses_itself(&y, |_, _| false));
}

#[test]
fn no_point_of_a_facet_moves_further_than_its_nodes_by_more() {
    for shape in [FacetShape::L2, FacetShape::L3, FacetShape::L4] {
        let facet: Vec<usize> = (0..shape.nodes()).collect();
        let skin = Skin::new(Surface::new(shape, &[facet], &[1.0]));
        let sum = |k: i32| shape.at(f64::from(k) / 1e4).values.iter().map(|v| v.abs()).sum::<f64>();
        let most = (-10_000..=10_000).map(sum).fold(0.0, f64::max);
        assert!(most <= skin.amplification() && most > 0.9999 * skin.amplification(), "{most}");
    }
}

#[test]
fn a_curved_facet_is_measured_as_it_is() {
    // The lower half of a lens: a parabola y = x² − 1 from (−1, 0) to (1, 0), closed by a
    // chord.
    let y = vec![-1.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0];
    let facets = [vec![0, 1, 2], vec![1, 0, 3]];
    let mut skin = Skin::new(Surface::new(FacetShape::L3, &facets, &[1.0; 2]));
    skin.update(&y);
    let depth = |point| skin.depth(point, None, &y).unwrap().distance;
    assert!((depth([0.0, -1.2]) - 0.2).abs() < 1e-14);
    assert!((depth([0.0, -0.9]) + 0.1).abs() < 1e-14);
    // Below the chord between two nodes of the parabola and still inside.
    assert!(depth([0.5, -0.6]) < 0.0 && depth([0.5, -0.8]) > 0.0);
}
