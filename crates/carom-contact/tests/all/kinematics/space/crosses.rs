//! A boundary in space that crosses itself, and where its nodes lie.

use carom_contact::{Boundary, ClosedSurface, InsideItself, Side};
use carom_solid::FacetShape;

/// A C of hexahedra with its mouth to the right, one cell deep: the outline of the plane
/// (`inside_itself.rs`), from z = 0 to 1.
fn c() -> (ClosedSurface, Vec<f64>) {
    let outline: [[f64; 2]; 8] =
        [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 2.0], [3.5, 2.0], [3.5, 3.0], [0.0, 3.0]];
    let layers = [0.0, 1.0].into_iter().flat_map(|z| outline.map(|[x, y]| [x, y, z]));
    let y: Vec<f64> = layers.flatten().collect();
    let over = |k: usize| vec![k, (k + 1) % 8, 8 + (k + 1) % 8, 8 + k];
    let ends = [[0, 1, 2, 3], [0, 3, 4, 7], [4, 5, 6, 7]];
    let below = ends.iter().map(|end| end.iter().rev().copied().collect());
    let above = ends.iter().map(|end| end.iter().map(|k| 8 + k).collect());
    let facets: Vec<Vec<usize>> = (0..8).map(over).chain(below).chain(above).collect();
    let boundary = Boundary::new(FacetShape::Q4, &facets, &[], 0);
    assert!(boundary.is_whole());
    let mut surface = ClosedSurface::new(boundary).with_pieces(&[0; 16], 0, &y);
    surface.update(&y);
    (surface, y)
}

#[test]
fn an_arm_pushed_through_the_side_of_its_own_body_is_found_with_its_depth() {
    let (mut surface, mut y) = c();
    assert!(!surface.crosses_itself(&y, |_, _| false));
    assert_eq!(surface.deepest_in_itself(&y), None);
    // The end of the upper arm is bent down by 1.3 into the lower one.
    for node in [5, 6, 13, 14] {
        y[3 * node + 1] -= 1.3;
    }
    surface.update(&y);
    assert!(surface.crosses_itself(&y, |_, _| false));
    let InsideItself { node, facet, depth } = surface.deepest_in_itself(&y).unwrap();
    // The sides of both arms lie in the same planes, where no depth is larger than zero.
    assert!([5, 13].contains(&node) && depth < 1e-12, "{node} {facet} {depth}");
    // Moved inwards, the arm is as deep as it is below the face of the lower one.
    for (node, z) in [(5, 0.35), (6, 0.35), (13, 0.65), (14, 0.65)] {
        y[3 * node + 2] = z;
    }
    surface.update(&y);
    let InsideItself { node, facet, depth } = surface.deepest_in_itself(&y).unwrap();
    assert!([5, 13].contains(&node) && facet == 2, "{node} {facet}");
    assert!((depth - 0.3).abs() < 1e-15, "{depth}");
}

#[test]
fn a_node_is_measured_against_the_arm_that_it_faces_and_not_against_its_own() {
    let (mut surface, start) = c();
    let mut y = start.clone();
    let depth = |surface: &ClosedSurface, node: usize, y: &[f64]| {
        [Side::Later, Side::Earlier].map(|side| surface.depth_of(node, side, 5.0, y).map(|d| d.distance))
    };
    // Node 5 lies 1 above the lower arm, whose face comes before that of its own.
    for node in [5, 13] {
        y[3 * node + 2] = 0.5;
        assert_eq!(depth(&surface, node, &y), [Some(1.0), Some(1.0)]);
    }
    // Below the face of the lower arm.
    for node in [5, 13] {
        y[3 * node + 1] = 0.9;
    }
    surface.update(&y);
    let [later, earlier] = depth(&surface, 5, &y).map(Option::unwrap);
    assert!((later + 0.1).abs() < 1e-15 && earlier == -later, "{later} {earlier}");
    // Pressed to a tenth of its thickness, the upper arm has no depth in itself.
    let mut y = start;
    for node in [6, 7, 14, 15] {
        y[3 * node + 1] = 2.1;
    }
    surface.update(&y);
    let found = depth(&surface, 6, &y);
    assert!(found.iter().flatten().all(|distance| *distance > 1.0), "{found:?}");
}
