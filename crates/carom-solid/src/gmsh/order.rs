//! Orders of nodes. In the plane Gmsh's is VTK's; in space edges and faces come in another order
//! (Gmsh reference manual, "Node ordering").

use crate::mesh::Element;

/// Gmsh's local node at each place of ours; empty if the orders agree.
pub(super) fn ours(element: Element) -> &'static [usize] {
    match element {
        Element::Tet10 => &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
        Element::Tet20 => &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 10, 15, 14, 13, 12, 17, 19, 18, 16],
        Element::Hex27 => &[
            0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26,
        ],
        _ => &[],
    }
}

/// Nodes of a cell, from Gmsh's order to ours.
pub(super) fn read(element: Element, cell: &mut [usize]) {
    let given = cell.to_vec();
    for (own, &theirs) in cell.iter_mut().zip(ours(element)) {
        *own = given[theirs];
    }
}

/// Nodes of a cell, from our order to Gmsh's.
pub(super) fn written(element: Element, cell: &[usize]) -> Vec<usize> {
    let mut nodes = cell.to_vec();
    for (own, &theirs) in cell.iter().zip(ours(element)) {
        nodes[theirs] = *own;
    }
    nodes
}
