//! A primary side as a chain of curved facets in global node numbers, with neighbours, and the
//! search for facets near a node's path.

use carom_contact::Surface;
use carom_solid::FacetShape;

#[test]
fn a_closed_loop_has_neighbours_everywhere_and_an_open_chain_has_two_ends() {
    let closed = Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2], vec![2, 0]], &[1.0; 3]);
    assert_eq!(closed.neighbour(2, true), Some(0));
    assert_eq!(closed.neighbour(0, false), Some(2));
    let open = Surface::new(FacetShape::L3, &[vec![0, 1, 7], vec![1, 2, 8]], &[1.0; 2]);
    assert_eq!((open.neighbour(0, false), open.neighbour(1, true)), (None, None));
    assert_eq!(open.facet(1).nodes, [1, 2, 8]);
}
