//! Gmsh's numbering of cell types.

use crate::mesh::Element;

/// Shape and number of nodes by Gmsh's type number.
const TYPES: &[(i64, &str, usize)] = &[
    (1, "line", 2),
    (2, "triangle", 3),
    (3, "quadrangle", 4),
    (4, "tetrahedron", 4),
    (5, "hexahedron", 8),
    (6, "prism", 6),
    (7, "pyramid", 5),
    (8, "line", 3),
    (9, "triangle", 6),
    (10, "quadrangle", 9),
    (11, "tetrahedron", 10),
    (12, "hexahedron", 27),
    (13, "prism", 18),
    (14, "pyramid", 14),
    (15, "point", 1),
    (16, "quadrangle", 8),
    (17, "hexahedron", 20),
    (18, "prism", 15),
    (19, "pyramid", 13),
    (20, "triangle", 9),
    (21, "triangle", 10),
    (22, "triangle", 12),
    (23, "triangle", 15),
    (24, "triangle", 15),
    (25, "triangle", 21),
    (26, "line", 4),
    (27, "line", 5),
    (28, "line", 6),
    (29, "tetrahedron", 20),
    (30, "tetrahedron", 35),
    (31, "tetrahedron", 56),
    (36, "quadrangle", 16),
    (37, "quadrangle", 25),
    (92, "hexahedron", 64),
    (93, "hexahedron", 125),
];

/// A cell type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CellType {
    pub(super) number: i64,
    name: &'static str,
    pub(super) nodes: usize,
}

impl CellType {
    pub(super) fn of(number: i64) -> Option<Self> {
        let &(number, name, nodes) = TYPES.iter().find(|(n, ..)| *n == number)?;
        Some(Self { number, name, nodes })
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
