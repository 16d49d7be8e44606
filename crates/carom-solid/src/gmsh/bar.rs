//! A physical curve on the x axis as a body of dimension 1, with the physical points at its ends as
//! sides.

use std::collections::BTreeMap;

use super::checks::orient;
use super::error::{Fault, MshError};
use super::file::MshFile;
use super::group::Group;
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
        let mut sides: BTreeMap<String, Vec<Facet>> = BTreeMap::new();
        for name in self.names(0) {
            for point in self.blocks(0, name).flat_map(|b| &b.nodes) {
                let Ok(node) = group.used.binary_search(point) else { continue };
                // Interior nodes belong to one cell as well.
                let [cell] = cells_at[node][..] else { continue };
                let facet = Facet { cell, nodes: vec![node] };
                let side = sides.entry(name.to_owned()).or_default();
                if group.cells[cell * group.element.nodes()..][..2].contains(&node) && !side.contains(&facet)
                {
                    side.push(facet);
                }
            }
        }
        sides.retain(|_, facets| !facets.is_empty());
        Ok(group.into_mesh(sides))
    }
}
