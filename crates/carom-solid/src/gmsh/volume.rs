//! A physical volume as a body of dimension 3, with the named surfaces on its boundary as sides.
//!
//! A facet of one cell belongs to the boundary; one of two cells is traversed by them in opposite
//! directions and has the same nodes in both.

use std::collections::{BTreeMap, HashMap};

use super::checks::orient;
use super::error::{Fault, MshError};
use super::file::MshFile;
use super::group::{Found, Group};
use super::order;
use crate::element_shape::of_shape;
use crate::mesh::{Facet, Mesh};

impl MshFile {
    /// The mesh of a physical volume. Its sides are the physical surfaces with facets on its
    /// boundary.
    ///
    /// # Errors
    /// With line or byte: an unknown name, cells other than tetrahedra of one order 1 to 3 or
    /// hexahedra of order 1 or 2, cells that are folded or overlap, coincident nodes, facets of
    /// more than two cells, edges at which the boundary touches itself.
    pub fn volume(&self, name: &str) -> Result<Mesh, MshError> {
        let mut group = Group::<3>::of(self, name)?;
        let element = group.element;
        group.cells.chunks_exact_mut(element.nodes()).for_each(|cell| order::read(element, cell));
        let none = MshError::whole(Fault::NoCells { what: "volume", name: name.to_owned() });
        of_shape!(3, group.element, orient(&mut group), Err(none))?;
        let facets = facets(&group)?;
        if !self.slits {
            unpinched(&group, &facets.open)?;
        }
        let sides = surfaces(&mut group, &facets)?;
        Ok(group.into_mesh(sides))
    }
}

/// Corners of a facet in ascending order: a key common to its cells.
type Corners = Vec<usize>;

fn key(nodes: &[usize], corners: usize) -> Corners {
    let mut key = nodes[..corners].to_vec();
    key.sort_unstable();
    key
}

/// The facets of the cells of a body.
struct Facets {
    /// Facets of only one cell.
    open: BTreeMap<Corners, Facet>,
    /// The two cells of the others.
    closed: HashMap<Corners, [usize; 2]>,
}

fn facets(group: &Group<3>) -> Result<Facets, MshError> {
    let element = group.element;
    let ends = group.element.facet_shape().corners();
    let mut open: BTreeMap<Corners, Facet> = BTreeMap::new();
    let mut closed: HashMap<Corners, [usize; 2]> = HashMap::new();
    for (cell, nodes) in group.cells.chunks_exact(element.nodes()).enumerate() {
        for local in element.facets() {
            let facet = Facet { cell, nodes: local.iter().map(|&a| nodes[a]).collect() };
            let key = key(&facet.nodes, ends);
            let at = |fault| Err(group.file.at(&group.rows[cell], fault));
            let name = group.name.to_owned();
            let tags = || key.iter().map(|&n| group.node(n).tag).collect();
            if let Some(others) = closed.get(&key) {
                let cells = others.iter().chain([&cell]).map(|&c| group.rows[c].tag).collect();
                return at(Fault::Crowded { name, cells, corners: tags() });
            }
            let Some(other) = open.remove(&key) else {
                open.insert(key, facet);
                continue;
            };
            let a = group.rows[other.cell].tag;
            let b = group.rows[cell].tag;
            // The cell after the first corner, in each direction.
            let next = |nodes: &[usize]| {
                let first = nodes[..ends].iter().position(|n| *n == key[0]).unwrap_or_default();
                nodes[(first + 1) % ends]
            };
            if next(&other.nodes) == next(&facet.nodes) {
                return at(Fault::SameSide { name, a, b, corners: tags() });
            }
            if !same(&other.nodes, &facet.nodes) {
                let a = format!("cell {a}");
                let b = format!("cell {b}");
                return at(Fault::FacetNodes { a, b, corners: tags() });
            }
            closed.insert(key, [other.cell, cell]);
        }
    }
    Ok(Facets { open, closed })
}

/// Whether two lists have the same nodes.
fn same(a: &[usize], b: &[usize]) -> bool {
    key(a, a.len()) == key(b, b.len())
}

/// At every edge of the boundary two of its facets meet.
fn unpinched(group: &Group<3>, boundary: &BTreeMap<Corners, Facet>) -> Result<(), MshError> {
    let ends = group.element.facet_shape().corners();
    let mut at: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for facet in boundary.values() {
        for k in 0..ends {
            let [a, b] = [facet.nodes[k], facet.nodes[(k + 1) % ends]];
            at.entry([a.min(b), a.max(b)]).or_default().push(facet.cell);
        }
    }
    match at.iter().find(|(_, cells)| cells.len() > 2) {
        Some((&[a, b], cells)) => {
            let [start, end] = [a, b].map(|n| group.node(n).tag);
            let fault = Fault::Pinched {
                name: group.name.to_owned(),
                facets: cells.len(),
                start,
                end,
                cells: cells.iter().map(|&c| group.rows[c].tag).collect(),
                at: [0, 1, 2].map(|i| 0.5 * (group.positions[a][i] + group.positions[b][i])).to_vec(),
            };
            Err(group.file.at(&group.rows[cells[0]], fault))
        }
        None => Ok(()),
    }
}

/// Named surfaces on the boundary.
fn surfaces(group: &mut Group<3>, facets: &Facets) -> Result<BTreeMap<String, Vec<Facet>>, MshError> {
    let ends = group.element.facet_shape().corners();
    group.sides(|group, name, nodes| {
        if nodes.len() < ends {
            return Ok(Found::Elsewhere);
        }
        let key = key(nodes, ends);
        let Some(facet) = facets.open.get(&key) else {
            let inside = facets.closed.contains_key(&key);
            return Ok(if inside { Found::Inside } else { Found::Elsewhere });
        };
        if !same(&facet.nodes, nodes) {
            let corners = key.iter().map(|&n| group.node(n).tag).collect();
            let a = format!("surface \"{name}\"");
            let b = format!("cell {}", group.rows[facet.cell].tag);
            return Err(Fault::FacetNodes { a, b, corners });
        }
        Ok(Found::Boundary(facet))
    })
}
