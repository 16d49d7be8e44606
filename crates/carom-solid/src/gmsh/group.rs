//! The cells of a named group as a separate mesh: one element, only the nodes in use, in the order
//! of the file.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::error::{Fault, MshError};
use super::file::{Block, GROUPS, MshFile, Row};
use crate::mesh::{Element, Facet, Mesh};

/// Where a cell of a dimension less is in a body.
pub(super) enum Found<'f> {
    Boundary(&'f Facet),
    /// Between two cells.
    Inside,
    /// A facet that belongs to no cell.
    Elsewhere,
}

/// Cells of a group before they are checked. Node numbers are local to the group.
pub(super) struct Group<'a, const D: usize> {
    pub(super) file: &'a MshFile,
    pub(super) name: &'a str,
    pub(super) element: Element,
    /// Indices into the file's list of nodes, ascending.
    pub(super) used: Vec<usize>,
    pub(super) positions: Vec<[f64; D]>,
    pub(super) rows: Vec<Row>,
    pub(super) cells: Vec<usize>,
    /// Region of each cell; empty if the file has none.
    pub(super) regions: Vec<u16>,
    pub(super) repairs: Vec<String>,
}

impl<'a, const D: usize> Group<'a, D> {
    pub(super) fn of(file: &'a MshFile, name: &'a str) -> Result<Self, MshError> {
        let what = GROUPS[D.min(3)];
        file.known(D, std::iter::once(name).chain(file.regions.iter().map(String::as_str)))?;
        let mut element: Option<Element> = None;
        let mut rows = Vec::new();
        let mut cells = Vec::new();
        let mut regions = Vec::new();
        for block in file.blocks(D, name) {
            let Some(row) = block.rows.first() else { continue };
            let name = || name.to_owned();
            let Some(this) = block.kind.element() else {
                return Err(file.at(row, block.kind.unsupported(&name(), row.tag)));
            };
            let first = *element.get_or_insert(this);
            if first.facets().len() != this.facets().len() {
                let kind = block.kind.described();
                let name = name();
                return Err(file.at(row, Fault::MixedKinds { name, cell: row.tag, kind }));
            }
            if first != this {
                let order = this.degree();
                let before = first.degree();
                return Err(file.at(row, Fault::MixedOrders { name: name(), cell: row.tag, order, before }));
            }
            let region = file.region(D, block, &name())?;
            if !file.regions.is_empty() {
                regions.extend(std::iter::repeat_n(region, block.rows.len()));
            }
            rows.extend_from_slice(&block.rows);
            cells.extend_from_slice(&block.nodes);
        }
        let none = || MshError::whole(Fault::NoCells { what, name: name.to_owned() });
        let element = element.ok_or_else(none)?;

        for (k, region) in file.regions.iter().enumerate() {
            if !regions.contains(&(k as u16)) {
                let fault = Fault::EmptyRegion { what, name: name.to_owned(), region: region.clone() };
                return Err(MshError::whole(fault));
            }
        }

        // Numbered in the order of the file, so that writing and reading preserves it.
        let mut number = vec![usize::MAX; file.nodes.len()];
        for &n in &cells {
            number[n] = 0;
        }
        let used: Vec<usize> = (0..number.len()).filter(|&n| number[n] == 0).collect();
        for (i, &n) in used.iter().enumerate() {
            number[n] = i;
        }
        for n in &mut cells {
            *n = number[*n];
        }

        let mut group = Self {
            file,
            name,
            element,
            used,
            positions: Vec::new(),
            rows,
            cells,
            regions,
            repairs: Vec::new(),
        };
        group.flatten()?;
        if !file.slits {
            group.apart()?;
        }
        Ok(group)
    }

    /// Drops the coordinates equal for all nodes: z, and on a line y, which must be zero.
    fn flatten(&mut self) -> Result<(), MshError> {
        let x = |i: usize| &self.file.nodes[self.used[i]].1;
        let size = (0..self.used.len()).flat_map(|i| x(i).iter().map(|c| c.abs())).fold(0.0, f64::max);
        for axis in D..3 {
            let first = if D == 1 { 0.0 } else { x(0)[axis] };
            if let Some(i) = (0..self.used.len()).find(|&i| (x(i)[axis] - first).abs() > 1e-9 * size) {
                let node = self.node(i);
                let name = self.name.to_owned();
                let value = x(i)[axis];
                let axis = ['x', 'y', 'z'][axis];
                let fault = Fault::NotFlat { name, node: node.tag, axis, value, other: first };
                return Err(self.file.at(&node, fault));
            }
            if first.abs() > 1e-9 * size {
                let z = format!("the body lies in the plane z = {first}; z was dropped");
                self.repairs.push(z);
            }
        }
        self.positions = (0..self.used.len()).map(|i| std::array::from_fn(|d| x(i)[d])).collect();
        Ok(())
    }

    /// Coincident nodes would not connect their cells.
    fn apart(&self) -> Result<(), MshError> {
        let near = 1e-9 * crate::Positions::from(self.positions.clone()).diameter();
        let mut order: Vec<usize> = (0..self.positions.len()).collect();
        order.sort_unstable_by(|&a, &b| self.positions[a][0].total_cmp(&self.positions[b][0]));
        // Many nodes may share x: the second coordinate is compared by sorting each such column.
        let mut start = 0;
        for i in 1..=order.len() {
            if i < order.len() && self.positions[order[i]][0] - self.positions[order[i - 1]][0] <= near {
                continue;
            }
            let column = &mut order[start..i];
            start = i;
            column.sort_unstable_by(|&a, &b| self.positions[a][D - 1].total_cmp(&self.positions[b][D - 1]));
            let column = &*column;
            let last = |k: usize| self.positions[column[k]][D - 1];
            // Many may share the last coordinate as well, in space.
            let pairs = (0..column.len()).flat_map(|k| {
                let end = (k + 1..column.len()).find(|&l| last(l) - last(k) > near).unwrap_or(column.len());
                (k + 1..end).map(move |l| (k, l))
            });
            for (k, l) in pairs {
                let a = column[k].min(column[l]);
                let b = column[k].max(column[l]);
                if (0..D).all(|d| (self.positions[a][d] - self.positions[b][d]).abs() <= near) {
                    let name = self.name.to_owned();
                    let at = self.positions[b].to_vec();
                    let fault = Fault::Coincident { name, a: self.node(a).tag, b: self.node(b).tag, at };
                    return Err(self.file.at(&self.node(b), fault));
                }
            }
        }
        Ok(())
    }

    /// The row of a node in the file.
    pub(super) fn node(&self, node: usize) -> Row {
        self.file.nodes[self.used[node]].0
    }

    /// Facets of the boundary that belong to each named group of a dimension less, each once in the
    /// order of the file, as `find` knows them by that name and their nodes. Those inside the body
    /// are left out, with a note.
    pub(super) fn sides<'f>(
        &mut self,
        find: impl Fn(&Self, &str, &[usize]) -> Result<Found<'f>, Fault>,
    ) -> Result<BTreeMap<String, Vec<Facet>>, MshError> {
        let own: HashMap<usize, usize> = self.used.iter().enumerate().map(|(i, &n)| (n, i)).collect();
        let mut sides = BTreeMap::new();
        for name in self.file.names(D - 1) {
            let mut facets = Vec::new();
            let mut seen = HashSet::new();
            let mut inside = 0;
            for (row, nodes) in self.file.blocks(D - 1, name).flat_map(Block::cells) {
                // A cell that leaves the body is not a facet of it.
                let nodes: Option<Vec<usize>> = nodes.iter().map(|n| own.get(n).copied()).collect();
                let Some(nodes) = nodes else { continue };
                match find(self, name, &nodes).map_err(|fault| self.file.at(row, fault))? {
                    Found::Boundary(facet) if seen.insert(&facet.nodes) => facets.push(facet.clone()),
                    Found::Inside => inside += 1,
                    Found::Boundary(_) | Found::Elsewhere => {}
                }
            }
            self.note_inside(name, inside, facets.len());
            if !facets.is_empty() {
                sides.insert(name.to_owned(), facets);
            }
        }
        Ok(sides)
    }

    /// Notes how many facets of a group are not on the boundary.
    fn note_inside(&mut self, name: &str, inside: usize, outside: usize) {
        if inside > 0 {
            let group = GROUPS[D - 1];
            let facet = ["points", "edges", "faces"][D - 1];
            let all = inside + outside;
            self.repairs.push(format!(
                "{inside} of {all} {facet} of the physical {group} \"{name}\" lie inside the body, between two of its cells, and are not in its side"
            ));
        }
    }

    /// The mesh with these sides, and the repairs, including what was dropped.
    pub(super) fn into_mesh(mut self, sides: BTreeMap<String, Vec<Facet>>) -> Mesh {
        let elsewhere: usize = self.file.unused();
        if elsewhere > 0 {
            self.repairs.push(format!("nodes of the file that belong to no cell were dropped: {elsewhere}"));
        }
        let Self { element, positions, cells, regions, repairs, .. } = self;
        Mesh { element, nodes: positions.into(), cells, regions, sides, repairs }
    }
}

impl MshFile {
    /// Counts the nodes that no line, triangle or other cell uses.
    fn unused(&self) -> usize {
        let mut used = vec![false; self.nodes.len()];
        self.blocks.iter().filter(|b| b.kind.nodes > 1).flat_map(|b| &b.nodes).for_each(|&n| used[n] = true);
        used.iter().filter(|u| !**u).count()
    }
}
