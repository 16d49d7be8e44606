//! Facets in a plane of symmetry: they are no surface, since the mirror image of the body continues
//! it there.

use carom_contact::kinematics::mirror::is_mirror;

#[test]
fn an_edge_on_the_axis_is_no_surface_if_it_may_slide_along_it() {
    let y = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let bodies = y.chunks(2).collect();
    let across = |_: usize, axis: usize| axis == 0;
    assert!(is_mirror(&[0, 1], &y, 2, &bodies, &across));
    // Not the edge beside it, nor one that is held, nor a free one.
    assert!(!is_mirror(&[1, 2], &y, 2, &bodies, &across));
    assert!(!is_mirror(&[0, 1], &y, 2, &bodies, &|_, _| true));
    assert!(!is_mirror(&[0, 1], &y, 2, &bodies, &|_, _| false));
    // Nor one beyond which another body reaches.
    let beyond = [[-0.1, 0.0], [1.0, 1.0]].iter().collect();
    assert!(!is_mirror(&[0, 1], &y, 2, &beyond, &across));
}
