//! A physical surface as a body, with the named curves on its boundary as sides.
//!
//! An edge of only one cell belongs to the boundary; its counter-clockwise cell traverses it with
//! the body on the left.

use std::collections::{BTreeMap, HashMap};

use super::checks::orient;
use super::error::{Fault, MshError};
use super::file::MshFile;
use super::group::{Found, Group};
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
        let edges = edges(&group)?;
        let sides = curves(&mut group, &edges)?;
        Ok(group.into_mesh(sides))
    }
}

/// The same edge from its end to its start.
fn reversed(edge: &[usize]) -> Vec<usize> {
    [edge[1], edge[0]].into_iter().chain(edge[2..].iter().rev().copied()).collect()
}

/// Edges of the cells by start and end, each in the direction in which its cell is on the left.
type Edges = HashMap<(usize, usize), Facet>;

/// The edges of all cells; one between two cells occurs in both directions.
fn edges(group: &Group<2>) -> Result<Edges, MshError> {
    let n = group.element.nodes();
    let sides = group.element.facets();
    let mut edges = Edges::with_capacity(group.cells.len() / n * sides.len());
    for (cell, nodes) in group.cells.chunks_exact(n).enumerate() {
        for side in sides {
            let facet = Facet { cell, nodes: side.iter().map(|&a| nodes[a]).collect() };
            if let Some(other) = edges.insert((facet.nodes[0], facet.nodes[1]), facet) {
                let [start, end] = [other.nodes[0], other.nodes[1]].map(|n| group.node(n).tag);
                let a = group.rows[other.cell].tag;
                let b = group.rows[cell].tag;
                let fault = Fault::Overlap { name: group.name.to_owned(), a, b, start, end };
                return Err(group.file.at(&group.rows[cell], fault));
            }
        }
    }
    for (&(start, end), facet) in &edges {
        let Some(other) = edges.get(&(end, start)) else { continue };
        if facet.nodes != reversed(&other.nodes) {
            // The map is unordered: name the cells in the order of the file.
            let [a, b] = [facet.cell.min(other.cell), facet.cell.max(other.cell)].map(|c| group.rows[c]);
            let [start, end] = [start.min(end), start.max(end)].map(|n| group.node(n).tag);
            let a = format!("cell {}", a.tag);
            let at = b;
            let fault = Fault::EdgeNodes { a, b: format!("cell {}", b.tag), start, end };
            return Err(group.file.at(&at, fault));
        }
    }
    Ok(edges)
}

/// Named curves on the boundary, which consists of the edges of only one cell.
fn curves(group: &mut Group<2>, edges: &Edges) -> Result<BTreeMap<String, Vec<Facet>>, MshError> {
    let sides = group.sides(|group, name, line| {
        let ends = [(line[0], line[1]), (line[1], line[0])];
        let (facet, place) = match ends.map(|ends| edges.get(&ends)) {
            [None, None] => return Ok(Found::Elsewhere),
            [Some(facet), None] | [None, Some(facet)] => (facet, Found::Boundary(facet)),
            [Some(facet), Some(_)] => (facet, Found::Inside),
        };
        if facet.nodes != line && facet.nodes != reversed(line) {
            let [start, end] = [line[0], line[1]].map(|n| group.node(n).tag);
            let a = format!("curve \"{name}\"");
            let b = format!("cell {}", group.rows[facet.cell].tag);
            return Err(Fault::EdgeNodes { a, b, start, end });
        }
        Ok(place)
    })?;
    Ok(sides.into_iter().map(|(name, facets)| (name, walked(&facets))).collect())
}

/// Facets in chains from end to start; chains and closed loops keep the file's order.
fn walked(facets: &[Facet]) -> Vec<Facet> {
    let mut next: HashMap<usize, Vec<usize>> = HashMap::new();
    let mut ends = std::collections::HashSet::new();
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
