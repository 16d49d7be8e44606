//! A physical surface as a body, with the named curves on its boundary as sides.
//!
//! An edge of only one cell belongs to the boundary; its counter-clockwise cell traverses it with
//! the body on the left.

use std::collections::{BTreeMap, HashMap};

use super::checks::orient;
use super::error::{Fault, MshError};
use super::file::MshFile;
use super::group::Group;
use crate::element_shape::of_shape;
use crate::mesh::{Facet, Mesh};

impl MshFile {
    /// The mesh of a physical surface. Its sides are the physical curves with edges on its
    /// boundary.
    ///
    /// # Errors
    /// With line or byte: an unknown name, cells other than triangles of one order 1 to 3 or
    /// quadrilaterals of order 1 or 2, folded cells, coincident nodes, edges of more than two
    /// cells, nodes off the plane.
    pub fn body(&self, surface: &str) -> Result<Mesh, MshError> {
        let mut group = Group::<2>::of(self, surface)?;
        let none = MshError::whole(Fault::NoCells { what: "surface", name: surface.to_owned() });
        of_shape!(2, group.element, orient(&mut group), Err(none))?;
        let boundary = boundary(&group)?;
        let sides = group.sides(&boundary)?;
        Ok(group.into_mesh(sides))
    }
}

/// The same edge from its end to its start.
fn reversed(edge: &[usize]) -> Vec<usize> {
    [edge[1], edge[0]].into_iter().chain(edge[2..].iter().rev().copied()).collect()
}

/// Edges of only one cell, by start and end.
fn boundary(group: &Group<2>) -> Result<HashMap<(usize, usize), Facet>, MshError> {
    let (n, sides) = (group.element.nodes(), group.element.facets());
    let mut edges: HashMap<(usize, usize), Facet> =
        HashMap::with_capacity(group.cells.len() / n * sides.len());
    for (cell, nodes) in group.cells.chunks_exact(n).enumerate() {
        for side in sides {
            let facet = Facet { cell, nodes: side.iter().map(|&a| nodes[a]).collect() };
            if let Some(other) = edges.insert((facet.nodes[0], facet.nodes[1]), facet) {
                let [start, end] = [other.nodes[0], other.nodes[1]].map(|n| group.node(n).tag);
                let (a, b) = (group.rows[other.cell].tag, group.rows[cell].tag);
                let fault = Fault::Overlap { name: group.name.to_owned(), a, b, start, end };
                return Err(group.file.at(&group.rows[cell], fault));
            }
        }
    }
    let mut alone = HashMap::new();
    for (&(start, end), facet) in &edges {
        let Some(other) = edges.get(&(end, start)) else {
            alone.insert((start, end), facet.clone());
            continue;
        };
        if facet.nodes != reversed(&other.nodes) {
            // The map is unordered: name the cells in the order of the file.
            let [a, b] = [facet.cell.min(other.cell), facet.cell.max(other.cell)].map(|c| group.rows[c]);
            let [start, end] = [start.min(end), start.max(end)].map(|n| group.node(n).tag);
            let (a, at) = (format!("cell {}", a.tag), b);
            let fault = Fault::EdgeNodes { a, b: format!("cell {}", b.tag), start, end };
            return Err(group.file.at(&at, fault));
        }
    }
    Ok(alone)
}

impl Group<'_, 2> {
    /// Named curves on the boundary.
    fn sides(
        &self,
        boundary: &HashMap<(usize, usize), Facet>,
    ) -> Result<BTreeMap<String, Vec<Facet>>, MshError> {
        let own: HashMap<usize, usize> = self.used.iter().enumerate().map(|(i, &n)| (n, i)).collect();
        let mut sides = BTreeMap::new();
        for name in self.file.names(1) {
            let mut facets = Vec::new();
            for block in self.file.blocks(1, name) {
                for (row, line) in block.cells() {
                    // A curve that leaves the body is not an edge of it.
                    let Some(line) = line.iter().map(|n| own.get(n).copied()).collect::<Option<Vec<_>>>()
                    else {
                        continue;
                    };
                    let facet =
                        boundary.get(&(line[0], line[1])).or_else(|| boundary.get(&(line[1], line[0])));
                    let Some(facet) = facet else { continue };
                    if facet.nodes != line && facet.nodes != reversed(&line) {
                        let [start, end] = [line[0], line[1]].map(|n| self.node(n).tag);
                        let (a, b) =
                            (format!("curve \"{name}\""), format!("cell {}", self.rows[facet.cell].tag));
                        return Err(self.file.at(row, Fault::EdgeNodes { a, b, start, end }));
                    }
                    facets.push(facet.clone());
                }
            }
            if !facets.is_empty() {
                sides.insert(name.to_owned(), walked(facets));
            }
        }
        Ok(sides)
    }
}

/// Each facet once, in chains from end to start; chains and closed loops keep the file's order.
fn walked(facets: Vec<Facet>) -> Vec<Facet> {
    let mut next: HashMap<usize, Vec<usize>> = HashMap::new();
    let mut ends = std::collections::HashSet::new();
    let mut seen = std::collections::HashSet::new();
    let facets: Vec<Facet> = facets.into_iter().filter(|f| seen.insert((f.nodes[0], f.nodes[1]))).collect();
    for (i, facet) in facets.iter().enumerate().rev() {
        next.entry(facet.nodes[0]).or_default().push(i);
        ends.insert(facet.nodes[1]);
    }
    let heads = (0..facets.len()).filter(|&i| !ends.contains(&facets[i].nodes[0]));
    let starts: Vec<usize> = heads.chain(0..facets.len()).collect();
    let mut order = Vec::with_capacity(facets.len());
    let mut taken = vec![false; facets.len()];
    for start in starts {
        let mut here = Some(start).filter(|&i| !taken[i]);
        while let Some(i) = here {
            taken[i] = true;
            order.push(i);
            let after = next.get_mut(&facets[i].nodes[1]);
            here = after.and_then(|list| std::iter::from_fn(|| list.pop()).find(|&j| !taken[j]));
        }
    }
    order.into_iter().map(|i| facets[i].clone()).collect()
}
