//! The point of a facet that is closest to a place.

use carom_solid::FacetShape;

/// A half circle's parabola, a bilinear face and its edge: feet are perpendicular, or on edges.
#[test]
fn feet_are_perpendicular_or_on_edges() {
    let parabola = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let top = FacetShape::L3.closest(&parabola, [0.0, 1.25, 0.0]);
    assert!((top.distance - 0.25).abs() < 1e-13 && top.beside < 1e-12, "{top:?}");
    let beyond = FacetShape::L3.closest(&parabola, [1.5, -0.5, 0.0]);
    assert_eq!(beyond.position, [1.0, 0.0, 0.0]);
    assert!(beyond.beside > 0.1);

    let square = [[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0], [0.0, 1.0, 1.0]];
    let inside = FacetShape::Q4.closest(&square, [0.5, 0.25, 1.125]);
    assert!((inside.distance - 0.125).abs() < 1e-14 && inside.beside < 1e-14);
    assert!((inside.values[0] - 0.75 * 0.75).abs() < 1e-13, "{:?}", inside.values);
    let aside = FacetShape::Q4.closest(&square, [0.5, -0.5, 1.0]);
    assert!((aside.position[0] - 0.5).abs() < 1e-13 && (aside.distance - 0.5).abs() < 1e-13);
    assert!((aside.beside - 0.5).abs() < 1e-13);

    let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let across = FacetShape::T3.closest(&triangle, [1.0, 1.0, 0.0]);
    assert!((across.position[0] - 0.5).abs() < 1e-13 && (across.position[1] - 0.5).abs() < 1e-13);
}
