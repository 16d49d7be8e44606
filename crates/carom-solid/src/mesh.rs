//! A body's mesh: nodes, cells of one element type, named sides.
//!
//! Node order inside a cell and a facet is Gmsh's (and VTK's): corners, then the nodes of each edge in the direction of the edge, then the
//! interior. A boundary is walked with the body on its left, so a facet's outward normal is its tangent turned right.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Cell type: a simplex of degree 1, 2 or 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum Element {
    L2,
    L3,
    L4,
    T3,
    T6,
    T10,
    /// Keeps the code beneath honest about the third dimension.
    #[cfg(test)]
    Tet4,
}

impl Element {
    /// Polynomial degree of the shape functions.
    pub fn degree(self) -> usize {
        match self {
            Self::L2 | Self::T3 => 1,
            #[cfg(test)]
            Self::Tet4 => 1,
            Self::L3 | Self::T6 => 2,
            Self::L4 | Self::T10 => 3,
        }
    }

    /// Dimension of the reference cell.
    pub fn dimension(self) -> usize {
        match self {
            Self::L2 | Self::L3 | Self::L4 => 1,
            Self::T3 | Self::T6 | Self::T10 => 2,
            #[cfg(test)]
            Self::Tet4 => 3,
        }
    }

    /// Nodes of a cell.
    pub fn nodes(self) -> usize {
        let k = self.degree();
        match self.dimension() {
            1 => k + 1,
            2 => (k + 1) * (k + 2) / 2,
            _ => (k + 1) * (k + 2) * (k + 3) / 6,
        }
    }
}

/// A piece of a body's boundary: one edge of a cell (dimension 2) or one node (dimension 1).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Facet {
    /// The cell it bounds.
    pub cell: usize,
    /// Its nodes: start, end, then the interior ones from start to end.
    pub nodes: Vec<usize>,
}

/// Nodes, cells and named sides of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh<const D: usize> {
    /// Cell type of every cell.
    pub element: Element,
    /// Reference positions X.
    pub nodes: Vec<[f64; D]>,
    /// Node numbers, cell after cell.
    pub cells: Vec<usize>,
    /// Facets of each named side, in the order in which the boundary is walked.
    pub sides: BTreeMap<String, Vec<Facet>>,
    /// What was put right when the mesh was read from a file, as sentences; nothing for built-in shapes.
    pub repairs: Vec<String>,
}

impl<const D: usize> Mesh<D> {
    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.cells.len() / self.element.nodes()
    }

    /// Node numbers of a cell.
    pub fn cell(&self, cell: usize) -> &[usize] {
        let n = self.element.nodes();
        &self.cells[cell * n..(cell + 1) * n]
    }

    /// The nodes of a side, each once, in the order of the walk.
    pub fn side_nodes(&self, side: &str) -> Option<Vec<usize>> {
        let facets = self.sides.get(side)?;
        let mut seen = std::collections::HashSet::new();
        let mut nodes = Vec::new();
        for facet in facets {
            let (ends, interior) = facet.nodes.split_at(facet.nodes.len().min(2));
            let ordered = ends.iter().take(1).chain(interior).chain(ends.iter().skip(1));
            nodes.extend(ordered.filter(|n| seen.insert(**n)));
        }
        Some(nodes)
    }

    /// Whether each node lies on the boundary: on an end of one cell alone (dimension 1), or on an edge of one cell alone (dimension 2).
    pub fn on_boundary(&self) -> Vec<bool> {
        let inside = self.element.degree() - 1;
        // Corners of a facet, in ascending order, with all its nodes.
        let mut facets: BTreeMap<Vec<usize>, Option<Vec<usize>>> = BTreeMap::new();
        for cell in (0..self.cell_count()).map(|c| self.cell(c)) {
            let corners = self.element.dimension() + 1;
            for k in 0..corners {
                let (mut ends, mut nodes) = (vec![cell[k]], vec![cell[k]]);
                if D == 2 {
                    ends.push(cell[(k + 1) % corners]);
                    nodes.push(ends[1]);
                    nodes.extend(&cell[corners + k * inside..corners + (k + 1) * inside]);
                }
                ends.sort_unstable();
                facets.entry(ends).and_modify(|shared| *shared = None).or_insert(Some(nodes));
            }
        }
        let mut on = vec![false; self.nodes.len()];
        facets.into_values().flatten().flatten().for_each(|node| on[node] = true);
        on
    }

    /// Diagonal of the box around the reference nodes.
    pub fn diameter(&self) -> f64 {
        diameter(&self.nodes)
    }
}

/// Diagonal of the box around positions.
pub(crate) fn diameter<const D: usize>(positions: &[[f64; D]]) -> f64 {
    let mut square = 0.0;
    for i in 0..D {
        let low = positions.iter().map(|x| x[i]).fold(f64::INFINITY, f64::min);
        let high = positions.iter().map(|x| x[i]).fold(f64::NEG_INFINITY, f64::max);
        square += (high - low) * (high - low);
    }
    square.sqrt()
}
