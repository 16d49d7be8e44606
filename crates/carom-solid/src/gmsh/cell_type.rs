//! Gmsh's numbering of cell types.

use super::error::Fault;
use crate::mesh::Element;

/// Number, shape, order and nodes of the types up to order 5 (Gmsh 4.15, `getElementProperties`).
#[rustfmt::skip]
const TYPES: &[(i64, &str, usize, usize)] = &[
    (1, "line", 1, 2),
    (2, "triangle", 1, 3),
    (3, "quadrangle", 1, 4),
    (4, "tetrahedron", 1, 4),
    (5, "hexahedron", 1, 8),
    (6, "prism", 1, 6),
    (7, "pyramid", 1, 5),
    (8, "line", 2, 3),
    (9, "triangle", 2, 6),
    (10, "quadrangle", 2, 9),
    (11, "tetrahedron", 2, 10),
    (12, "hexahedron", 2, 27),
    (13, "prism", 2, 18),
    (14, "pyramid", 2, 14),
    (15, "point", 0, 1),
    (16, "quadrangle", 2, 8),
    (17, "hexahedron", 2, 20),
    (18, "prism", 2, 15),
    (19, "pyramid", 2, 13),
    (20, "triangle", 3, 9),
    (21, "triangle", 3, 10),
    (22, "triangle", 4, 12),
    (23, "triangle", 4, 15),
    (24, "triangle", 5, 15),
    (25, "triangle", 5, 21),
    (26, "line", 3, 4),
    (27, "line", 4, 5),
    (28, "line", 5, 6),
    (29, "tetrahedron", 3, 20),
    (30, "tetrahedron", 4, 35),
    (31, "tetrahedron", 5, 56),
    (32, "tetrahedron", 4, 22),
    (33, "tetrahedron", 5, 28),
    (36, "quadrangle", 3, 16),
    (37, "quadrangle", 4, 25),
    (38, "quadrangle", 5, 36),
    (39, "quadrangle", 3, 12),
    (40, "quadrangle", 4, 16),
    (41, "quadrangle", 5, 20),
    (90, "prism", 3, 40),
    (91, "prism", 4, 75),
    (92, "hexahedron", 3, 64),
    (93, "hexahedron", 4, 125),
    (94, "hexahedron", 5, 216),
    (99, "hexahedron", 3, 32),
    (100, "hexahedron", 4, 44),
    (101, "hexahedron", 5, 56),
    (118, "pyramid", 3, 30),
    (119, "pyramid", 4, 55),
    (120, "pyramid", 5, 91),
    (125, "pyramid", 3, 21),
    (126, "pyramid", 4, 29),
    (127, "pyramid", 5, 37),
    (137, "tetrahedron", 3, 16),
];

/// A cell type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CellType {
    pub(super) number: i64,
    name: &'static str,
    pub(super) order: usize,
    pub(super) nodes: usize,
}

impl CellType {
    pub(super) fn of(number: i64) -> Option<Self> {
        let &(number, name, order, nodes) = TYPES.iter().find(|(n, ..)| *n == number)?;
        Some(Self { number, name, order, nodes })
    }

    /// The element, if bodies can consist of it.
    pub(super) fn element(self) -> Option<Element> {
        use Element::{Hex8, Hex27, L2, L3, L4, Q4, Q9, T3, T6, T10, Tet4, Tet10, Tet20};
        [L2, L3, L4, T3, T6, T10, Q4, Q9, Tet4, Tet10, Tet20, Hex8, Hex27]
            .into_iter()
            .find(|e| number(*e) == self.number)
    }

    pub(super) fn dimension(self) -> i64 {
        match self.name {
            "point" => 0,
            "line" => 1,
            "triangle" | "quadrangle" => 2,
            _ => 3,
        }
    }

    pub(super) fn described(self) -> String {
        format!("a {} of {} nodes", self.name, self.nodes)
    }

    /// Nodes of the complete cell of this shape and order; others have none in their middle.
    pub(super) fn complete(self) -> usize {
        let p = self.order;
        match self.name {
            "point" => 1,
            "line" => p + 1,
            "triangle" => (p + 1) * (p + 2) / 2,
            "quadrangle" => (p + 1).pow(2),
            "tetrahedron" => (p + 1) * (p + 2) * (p + 3) / 6,
            "prism" => (p + 1).pow(2) * (p + 2) / 2,
            "pyramid" => (p + 1) * (p + 2) * (2 * p + 3) / 6,
            _ => (p + 1).pow(3),
        }
    }

    /// Why bodies cannot consist of it, as cell number `cell` of the group `name`.
    pub(super) fn unsupported(self, name: &str, cell: i64) -> Fault {
        let name = name.to_owned();
        let kind = self.described();
        let order = self.order;
        match self.complete() {
            _ if ["prism", "pyramid"].contains(&self.name) => Fault::Shape { name, cell, kind },
            complete if complete != self.nodes => Fault::Incomplete { name, cell, kind, order, complete },
            _ => Fault::Order { name, cell, kind, order },
        }
    }
}

/// Gmsh's number of an element.
pub(super) fn number(element: Element) -> i64 {
    match element {
        Element::L2 => 1,
        Element::L3 => 8,
        Element::L4 => 26,
        Element::T3 => 2,
        Element::T6 => 9,
        Element::T10 => 21,
        Element::Tet4 => 4,
        Element::Tet10 => 11,
        Element::Tet20 => 29,
        Element::Q4 => 3,
        Element::Q9 => 10,
        Element::Hex8 => 5,
        Element::Hex27 => 12,
    }
}
