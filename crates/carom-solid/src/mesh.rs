//! A mesh of one element type with named sides.
//!
//! Node order inside a cell and a facet is VTK's (in the plane also Gmsh's): corners, then the
//! nodes of each edge in the direction of the edge, then those of faces and of the interior. In the
//! plane a boundary is traversed with the body on its left, so a facet's outward normal is its
//! tangent rotated to the right.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::facet::FacetShape;
use crate::positions::Positions;

/// Cell type: a simplex of degree 1, 2 or 3, a quadrilateral or a hexahedron of degree 1 or 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum Element {
    L2,
    L3,
    L4,
    T3,
    T6,
    T10,
    Q4,
    Q9,
    Tet4,
    Tet10,
    Tet20,
    Hex8,
    Hex27,
}

impl Element {
    /// Polynomial degree of the shape functions.
    pub fn degree(self) -> usize {
        match self {
            Self::L2 | Self::T3 | Self::Q4 | Self::Tet4 | Self::Hex8 => 1,
            Self::L3 | Self::T6 | Self::Q9 | Self::Tet10 | Self::Hex27 => 2,
            Self::L4 | Self::T10 | Self::Tet20 => 3,
        }
    }

    /// The element of the same cell shape with another degree, if there is one.
    pub fn with_degree(self, degree: usize) -> Option<Self> {
        use Element::{Hex8, Hex27, L2, L3, L4, Q4, Q9, T3, T6, T10, Tet4, Tet10, Tet20};
        let shapes: [&[Self]; 5] =
            [&[L2, L3, L4], &[T3, T6, T10], &[Q4, Q9], &[Tet4, Tet10, Tet20], &[Hex8, Hex27]];
        let same = shapes.into_iter().find(|same| same.contains(&self))?;
        same.iter().copied().find(|element| element.degree() == degree)
    }

    /// Dimension of the reference cell.
    pub fn dimension(self) -> usize {
        match self {
            Self::L2 | Self::L3 | Self::L4 => 1,
            Self::T3 | Self::T6 | Self::T10 | Self::Q4 | Self::Q9 => 2,
            Self::Tet4 | Self::Tet10 | Self::Tet20 | Self::Hex8 | Self::Hex27 => 3,
        }
    }

    /// Number of nodes of a cell.
    pub fn nodes(self) -> usize {
        match self {
            Self::L2 => 2,
            Self::L3 | Self::T3 => 3,
            Self::L4 | Self::Q4 | Self::Tet4 => 4,
            Self::T6 => 6,
            Self::Hex8 => 8,
            Self::Q9 => 9,
            Self::T10 | Self::Tet10 => 10,
            Self::Tet20 => 20,
            Self::Hex27 => 27,
        }
    }

    /// Degrees of freedom of a cell: nodes times dimension.
    pub fn dofs(self) -> usize {
        self.nodes() * self.dimension()
    }

    /// Facets of a cell: local numbers of their nodes, corners first, each traversed with the body
    /// on its left, or in space counter-clockwise seen from outside.
    pub fn facets(self) -> &'static [&'static [usize]] {
        match self {
            Self::L2 | Self::L3 | Self::L4 => &[&[0], &[1]],
            Self::T3 => &[&[0, 1], &[1, 2], &[2, 0]],
            Self::T6 => &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]],
            Self::T10 => &[&[0, 1, 3, 4], &[1, 2, 5, 6], &[2, 0, 7, 8]],
            Self::Q4 => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
            Self::Q9 => &[&[0, 1, 4], &[1, 2, 5], &[2, 3, 6], &[3, 0, 7]],
            Self::Hex8 => {
                &[&[0, 4, 7, 3], &[1, 2, 6, 5], &[0, 1, 5, 4], &[3, 7, 6, 2], &[0, 3, 2, 1], &[4, 5, 6, 7]]
            }
            Self::Hex27 => &[
                &[0, 4, 7, 3, 16, 15, 19, 11, 20],
                &[1, 2, 6, 5, 9, 18, 13, 17, 21],
                &[0, 1, 5, 4, 8, 17, 12, 16, 22],
                &[3, 7, 6, 2, 19, 14, 18, 10, 23],
                &[0, 3, 2, 1, 11, 10, 9, 8, 24],
                &[4, 5, 6, 7, 12, 13, 14, 15, 25],
            ],
            Self::Tet4 => &[&[0, 1, 3], &[1, 2, 3], &[2, 0, 3], &[0, 2, 1]],
            Self::Tet10 => {
                &[&[0, 1, 3, 4, 8, 7], &[1, 2, 3, 5, 9, 8], &[2, 0, 3, 6, 7, 9], &[0, 2, 1, 6, 5, 4]]
            }
            Self::Tet20 => &[
                &[0, 1, 3, 4, 5, 12, 13, 11, 10, 16],
                &[1, 2, 3, 6, 7, 14, 15, 13, 12, 17],
                &[2, 0, 3, 8, 9, 10, 11, 15, 14, 18],
                &[0, 2, 1, 9, 8, 7, 6, 5, 4, 19],
            ],
        }
    }

    /// Shape of those facets.
    pub fn facet_shape(self) -> FacetShape {
        match self {
            Self::L2 | Self::L3 | Self::L4 => FacetShape::Point,
            Self::T3 | Self::Q4 => FacetShape::L2,
            Self::T6 | Self::Q9 => FacetShape::L3,
            Self::T10 => FacetShape::L4,
            Self::Tet4 => FacetShape::T3,
            Self::Tet10 => FacetShape::T6,
            Self::Tet20 => FacetShape::T10,
            Self::Hex8 => FacetShape::Q4,
            Self::Hex27 => FacetShape::Q9,
        }
    }
}

/// A cell of a body's boundary: a node in dimension 1, an edge in the plane, a face in space.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Facet {
    /// The cell that it bounds.
    pub cell: usize,
    /// Its nodes: an edge's start, end, then the interior ones from start to end; a face's in the
    /// order of a plane cell.
    pub nodes: Vec<usize>,
}

impl Facet {
    /// Its nodes in the order of traversal: those of an edge from start to end.
    pub fn walk(&self, dimension: usize) -> impl Iterator<Item = usize> {
        let ends = if dimension == 2 { 2 } else { self.nodes.len() };
        let (ends, interior) = self.nodes.split_at(ends.min(self.nodes.len()));
        let (first, last) = ends.split_at(ends.len().min(1));
        first.iter().chain(interior).chain(last).copied()
    }
}

/// Nodes, cells and named sides of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Cell type of every cell.
    pub element: Element,
    /// Reference positions X.
    pub nodes: Positions,
    /// Node numbers, cell after cell.
    pub cells: Vec<usize>,
    /// Region of each cell, of a mesh with several: the cells of a region have one material. Empty
    /// if there is one region.
    pub regions: Vec<u16>,
    /// Facets of each named side, in the order of traversal.
    pub sides: BTreeMap<String, Vec<Facet>>,
    /// Repairs made when the mesh was read from a file, as sentences; empty for built-in shapes.
    pub repairs: Vec<String>,
}

impl Mesh {
    /// Number of coordinates of each node.
    pub fn dimension(&self) -> usize {
        self.nodes.dimension()
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.cells.len() / self.element.nodes()
    }

    /// Node numbers of a cell.
    pub fn cell(&self, cell: usize) -> &[usize] {
        let n = self.element.nodes();
        &self.cells[cell * n..(cell + 1) * n]
    }

    /// Region of a cell, from 0 on.
    #[inline]
    pub fn region(&self, cell: usize) -> usize {
        self.regions.get(cell).map_or(0, |region| usize::from(*region))
    }

    /// Regions of the cells that come from those of another mesh, as many from each of them, one
    /// after the other.
    pub(crate) fn regions_of_children(&self, children: usize) -> Vec<u16> {
        let each = children / self.cell_count().max(1);
        self.regions.iter().flat_map(|region| std::iter::repeat_n(*region, each)).collect()
    }

    /// The nodes of a side, each once, in the order of traversal; in space facet by facet.
    pub fn side_nodes(&self, side: &str) -> Option<Vec<usize>> {
        let facets = self.sides.get(side)?;
        let mut seen = std::collections::HashSet::new();
        let mut nodes = Vec::new();
        for facet in facets {
            nodes.extend(facet.walk(self.dimension()).filter(|n| seen.insert(*n)));
        }
        Some(nodes)
    }

    /// Sign of a facet's outward normal: ±1 if the facet is a point; 1 if the direction of
    /// traversal gives the normal.
    pub fn orientation(&self, facet: &Facet) -> f64 {
        if self.element.facet_shape() != FacetShape::Point {
            return 1.0;
        }
        // The outward direction points away from the other nodes of the end's cell.
        let end = self.nodes[facet.nodes[0]][0];
        let cell = self.cell(facet.cell);
        (end - cell.iter().map(|&n| self.nodes[n][0]).sum::<f64>() / cell.len() as f64).signum()
    }

    /// The whole boundary: the facets of only one cell, by ascending nodes, each traversed with the
    /// body on its left, or counter-clockwise seen from outside.
    pub fn skin(&self) -> Vec<Facet> {
        let facets = self.element.facets();
        let nodes = |number: usize| {
            let cell = self.cell(number / facets.len());
            facets[number % facets.len()].iter().map(|&a| cell[a])
        };
        let mut skin = Vec::new();
        let mut keys = Vec::new();
        let mut places = Vec::new();
        for bucket in self.facets_by_lowest_node() {
            // Nodes of each facet in ascending order, as a key common to both its cells.
            keys.clear();
            for &number in &bucket {
                let first = keys.len();
                keys.extend(nodes(number));
                keys[first..].sort_unstable();
            }
            let size = keys.len() / bucket.len().max(1);
            let key = |place: usize| &keys[place * size..(place + 1) * size];
            places.clear();
            places.extend(0..bucket.len());
            places.sort_unstable_by(|&a, &b| key(a).cmp(key(b)));
            for same in places.chunk_by(|&a, &b| key(a) == key(b)) {
                if let [place] = same {
                    let number = bucket[*place];
                    skin.push(Facet { cell: number / facets.len(), nodes: nodes(number).collect() });
                }
            }
        }
        skin
    }

    /// Numbers of all facets, cell · (facets of a cell) + facet, by the lowest of their nodes.
    fn facets_by_lowest_node(&self) -> impl Iterator<Item = Vec<usize>> {
        let facets = self.element.facets();
        // Nodes that the mesh lacks, which a body rejects, count as its last one.
        let last = self.nodes.len().saturating_sub(1);
        let lowest = move |cell: usize| {
            let nodes = self.cell(cell);
            facets.iter().map(move |facet| facet.iter().fold(last, |low, &a| low.min(nodes[a])))
        };
        let mut ends = vec![0; last + 1];
        (0..self.cell_count()).flat_map(lowest).for_each(|node| ends[node] += 1);
        let mut end = 0;
        for count in &mut ends {
            end += *count;
            *count = end;
        }
        let mut order = vec![0; end];
        let mut places = ends.clone();
        for (number, node) in (0..self.cell_count()).flat_map(lowest).enumerate() {
            places[node] -= 1;
            order[places[node]] = number;
        }
        places.into_iter().zip(ends).map(move |(start, end)| order[start..end].to_vec())
    }

    /// The whole boundary; in the plane in the order of traversal, loop by loop.
    pub fn ordered_skin(&self) -> Vec<Facet> {
        let skin = self.skin();
        if self.dimension() != 2 {
            return skin;
        }
        let starts: BTreeMap<usize, usize> = skin.iter().enumerate().map(|(k, f)| (f.nodes[0], k)).collect();
        let mut order = Vec::with_capacity(skin.len());
        let mut taken = vec![false; skin.len()];
        for first in 0..skin.len() {
            let mut next = Some(first);
            while let Some(k) = next.filter(|&k| !std::mem::replace(&mut taken[k], true)) {
                next = skin[k].nodes.get(1).and_then(|end| starts.get(end)).copied();
                order.push(skin[k].clone());
            }
        }
        order
    }

    /// The connected piece to which each node belongs, named by one of its nodes: nodes of a cell
    /// are connected.
    pub fn pieces(&self) -> Vec<usize> {
        let mut of: Vec<usize> = (0..self.nodes.len()).collect();
        // Halves the chains that it follows.
        let root = |of: &mut [usize], mut node: usize| {
            while of[node] != node {
                of[node] = of[of[node]];
                node = of[node];
            }
            node
        };
        for cell in 0..self.cell_count() {
            let nodes = self.cell(cell);
            for pair in nodes.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|node| root(&mut of, node));
                let low = a.min(b);
                let high = a.max(b);
                of[high] = low;
                // Short chains: nodes point to the smallest node known.
                pair.iter().for_each(|&node| of[node] = low);
            }
        }
        (0..of.len()).map(|node| root(&mut of, node)).collect()
    }

    /// Area in the plane, of cells with straight sides between their corners.
    pub fn area(&self) -> f64 {
        let corners = self.element.facets().len();
        let of_cell = |cell: usize| {
            let at = |k: usize| &self.nodes[self.cell(cell)[k % corners]];
            let turn = |k: usize| at(k)[0] * at(k + 1)[1] - at(k)[1] * at(k + 1)[0];
            0.5 * (0..corners).map(turn).sum::<f64>().abs()
        };
        (0..self.cell_count()).map(of_cell).sum()
    }

    /// Whether each node lies on the boundary.
    pub fn on_boundary(&self) -> Vec<bool> {
        self.nodes_of(&self.skin())
    }

    /// Whether each node belongs to one of these facets.
    pub fn nodes_of(&self, facets: &[Facet]) -> Vec<bool> {
        let mut on = vec![false; self.nodes.len()];
        facets.iter().flat_map(|facet| &facet.nodes).for_each(|&node| on[node] = true);
        on
    }

    /// Diagonal of the box around the reference nodes.
    pub fn diameter(&self) -> f64 {
        self.nodes.diameter()
    }
}
