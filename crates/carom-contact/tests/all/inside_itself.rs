//! Nodes of a boundary that lie inside their own body: where a fold has passed through itself,
//! places no longer face each other, and no pair says so.

use carom_contact::{Skin, Surface};
use carom_solid::FacetShape;

#[test]
fn an_arm_pushed_through_the_side_of_its_own_body_is_found_with_its_depth() {
    // A C with its mouth to the right; its upper arm is bent down by 1.3 into the lower one.
    let mut y = vec![0.0, 0.0, 4.0, 0.0, 4.0, 1.0, 1.0, 1.0, 1.0, 2.0, 3.5, 2.0, 3.5, 3.0, 0.0, 3.0];
    let facets: Vec<Vec<usize>> = (0..8).map(|k| vec![k, (k + 1) % 8]).collect();
    let mut skin = Skin::new(Surface::new(FacetShape::L2, &facets, &[1.0; 8]));
    skin.update(&y);
    assert_eq!(skin.deepest_in_itself(&y), None);
    y[11] = 0.7;
    y[13] = 1.7;
    skin.update(&y);
    let found = skin.deepest_in_itself(&y).unwrap();
    assert_eq!((found.node, found.facet), (5, 2));
    assert!((found.depth - 0.3).abs() < 1e-15, "{}", found.depth);
}
