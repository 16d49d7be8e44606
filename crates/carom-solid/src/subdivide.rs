//! Uniform subdivision of a mesh: every edge of a cell becomes `parts` edges, every cell of the
//! plane `parts`² cells, every cell in space `parts`³ cells. New nodes lie on the curved cell that
//! they divide, so the geometry stays that of the given mesh.
//!
//! ```text
//!  |\            nodes at (i, j)/(degree · parts) in reference coordinates;
//!  | \           upright triangles at (p, q), inverted ones between them
//!  |__\
//!  |\ |\         a node on an edge belongs to all cells that have the edge
//!  |_\|_\
//! ```

mod nodes;
mod tensor;
mod tetrahedra;

use std::collections::HashMap;

use carom_algebra::Vector;

use crate::mesh::{Element, Facet, Mesh};
use crate::shape::{
    Hex8, Hex27, Line2, Line3, Line4, Quad4, Quad9, Shape, Tet4, Tet10, Tet20, Tri3, Tri6, Tri10, lattice,
};
use nodes::Nodes;
use tensor::tensor;
pub(crate) use tetrahedra::freudenthal;
use tetrahedra::tetrahedra;

impl Mesh {
    /// The mesh with every edge divided into `parts` edges; a copy for 0 or 1.
    #[must_use]
    pub fn subdivided(&self, parts: usize) -> Self {
        if parts < 2 {
            return self.clone();
        }
        match self.element {
            Element::L2 => tensor::<1, 2, Line2>(self, parts),
            Element::L3 => tensor::<1, 3, Line3>(self, parts),
            Element::L4 => tensor::<1, 4, Line4>(self, parts),
            Element::T3 => triangles::<3, Tri3>(self, parts),
            Element::T6 => triangles::<6, Tri6>(self, parts),
            Element::T10 => triangles::<10, Tri10>(self, parts),
            Element::Q4 => tensor::<2, 4, Quad4>(self, parts),
            Element::Q9 => tensor::<2, 9, Quad9>(self, parts),
            Element::Tet4 => tetrahedra::<4, Tet4>(self, parts),
            Element::Tet10 => tetrahedra::<10, Tet10>(self, parts),
            Element::Tet20 => tetrahedra::<20, Tet20>(self, parts),
            Element::Hex8 => tensor::<3, 8, Hex8>(self, parts),
            Element::Hex27 => tensor::<3, 27, Hex27>(self, parts),
        }
    }
}

fn triangles<const N: usize, S: Shape<2, N>>(mesh: &Mesh, parts: usize) -> Mesh {
    let degree = S::DEGREE;
    let count = S::DEGREE * parts;
    let steps = lattice::<2, N, S>();
    // Upright triangles row by row, each followed by the inverted one on its right.
    let children: Vec<([usize; 2], bool)> = (0..parts)
        .flat_map(|q| (0..parts - q).flat_map(move |p| [([p, q], true), ([p, q], false)]))
        .filter(|([p, q], upright)| *upright || p + q + 2 <= parts)
        .collect();
    let child = |at: [usize; 2]| children.iter().position(|c| *c == (at, true)).unwrap_or_default();
    let mut nodes = Nodes::new(mesh);
    let mut cells = Vec::with_capacity(mesh.cells.len() * parts * parts);
    let mut lattice: HashMap<[usize; 2], usize> = HashMap::new();
    for cell in 0..mesh.cell_count() {
        lattice.clear();
        for j in 0..=count {
            for i in 0..=count - j {
                let xi = Vector([i as f64 / count as f64, j as f64 / count as f64]);
                lattice.insert([i, j], nodes.at(&[count - i - j, i, j], cell, &S::values(&xi)));
            }
        }
        for &([p, q], upright) in &children {
            cells.extend(steps.iter().map(|&[r, s]| {
                let at = |origin: usize, step: usize| {
                    if upright { degree * origin + step } else { degree * (origin + 1) - step }
                };
                lattice[&[at(p, r), at(q, s)]]
            }));
        }
    }
    let divided = |facet: &Facet| {
        let edge = (0..3).find(|&e| mesh.cell(facet.cell)[e] == facet.nodes[0]).unwrap_or_default();
        let part = |m: usize| {
            let at = [[m, 0], [parts - 1 - m, m], [0, parts - 1 - m]][edge];
            let cell = facet.cell * children.len() + child(at);
            let local = mesh.element.facets()[edge];
            Facet { cell, nodes: local.iter().map(|&a| cells[cell * N + a]).collect() }
        };
        (0..parts).map(part).collect()
    };
    nodes.into_mesh(cells.clone(), divided)
}
