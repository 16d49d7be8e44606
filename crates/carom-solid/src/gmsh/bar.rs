//! A physical curve on the x axis as a body of dimension 1, with the physical points at its ends as
//! sides.

use std::collections::HashMap;

use super::checks::orient;
use super::error::{Fault, MshError};
use super::file::MshFile;
use super::group::{Found, Group};
use crate::element_shape::of_shape;
use crate::mesh::{Facet, Mesh};

impl MshFile {
    /// The mesh of a physical curve with y = z = 0. Its sides are the physical points at its ends.
    ///
    /// # Errors
    /// As [`body`](Self::body), and if a node joins more than two cells.
    pub fn bar(&self, curve: &str) -> Result<Mesh, MshError> {
        let mut group = Group::<1>::of(self, curve)?;
        let none = MshError::whole(Fault::NoCells { what: "curve", name: curve.to_owned() });
        of_shape!(1, group.element, orient(&mut group), Err(none))?;
        let mut cells_at = vec![Vec::new(); group.used.len()];
        for (cell, nodes) in group.cells.chunks_exact(group.element.nodes()).enumerate() {
            for &n in nodes {
                cells_at[n].push(cell);
            }
        }
        if let Some(n) = cells_at.iter().position(|cells| cells.len() > 2) {
            let node = group.node(n);
            let fault = Fault::Branching { name: curve.to_owned(), node: node.tag, cells: cells_at[n].len() };
            return Err(self.at(&node, fault));
        }
        let corners = group.cells.chunks_exact(group.element.nodes()).enumerate();
        let corners = corners.flat_map(|(cell, nodes)| nodes[..2].iter().map(move |&node| (node, cell)));
        let ends: HashMap<usize, Facet> = corners
            .filter(|(node, _)| cells_at[*node].len() == 1)
            .map(|(node, cell)| (node, Facet { cell, nodes: vec![node] }))
            .collect();
        let sides = group.sides(|_, _, point| {
            // Interior nodes belong to one cell as well.
            Ok(match ends.get(&point[0]) {
                Some(facet) => Found::Boundary(facet),
                None => Found::Inside,
            })
        })?;
        Ok(group.into_mesh(sides))
    }
}
