//! Solids from hexahedra or prisms on a lattice, as they are or cut into tetrahedra. A generator
//! names every point of the lattice by integers, so that neighbouring cells agree on their common
//! nodes whatever their positions are rounded to, and places the points by one map that is smooth
//! in every cell.
//!
//! A cell is cut into tetrahedra by its keys alone: cones from its first corner over the faces that
//! do not contain it, every face cut into triangles from its own first corner. Neighbours therefore
//! cut their common face alike (the rule of global numbers: J. Dompierre, P. Labbé, M.-G. Vallet,
//! R. Camarero, 8th International Meshing Roundtable, 1999). The nodes of the tetrahedra are points
//! of the lattice that divides every edge of the cells by the degree.

use std::collections::{BTreeMap, HashMap};

use carom_algebra::Mat;

use super::MeshError;
use crate::element_shape::of_shape;
use crate::mesh::{Element, Facet, Mesh};
use crate::shape::lattice;

/// What identifies a point of the lattice.
pub(super) type Key = [i64; 4];

/// A convex cell: corners in steps of its edges, faces counter-clockwise seen from outside.
pub(super) struct Solid {
    corners: &'static [[usize; 3]],
    faces: &'static [&'static [usize]],
}

/// The cube; corner c is at the binary digits of c.
pub(super) const HEXAHEDRON: Solid = Solid {
    corners: &[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]],
    faces: &[&[0, 4, 6, 2], &[1, 3, 7, 5], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 2, 3, 1], &[4, 5, 7, 6]],
};

/// A triangle times an edge.
pub(super) const PRISM: Solid = Solid {
    corners: &[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
    faces: &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
};

impl Solid {
    /// Its tetrahedra with positive volume, from an order of its corners.
    fn cut(&self, order: impl Fn(usize) -> (Key, Key)) -> Vec<[usize; 4]> {
        let apex = (0..self.corners.len()).min_by_key(|&c| order(c)).unwrap_or_default();
        let mut cells = Vec::with_capacity(6);
        for face in self.faces.iter().filter(|face| !face.contains(&apex)) {
            let first = (0..face.len()).min_by_key(|&c| order(face[c])).unwrap_or_default();
            let corner = |step: usize| face[(first + step) % face.len()];
            cells.extend((1..face.len() - 1).map(|s| [apex, corner(0), corner(s), corner(s + 1)]));
        }
        cells
    }
}

/// The nodes and cells met so far.
pub(super) struct Lattice<P> {
    element: Element,
    /// The nodes of a cell in the lattice of its degree.
    local: Vec<[usize; 3]>,
    place: P,
    numbers: HashMap<Key, usize>,
    keys: Vec<Key>,
    nodes: Vec<[f64; 3]>,
    cells: Vec<usize>,
}

impl<P: Fn(Key) -> [f64; 3]> Lattice<P> {
    /// An empty lattice whose points lie where `place` says.
    ///
    /// # Errors
    /// If the element does not fill space.
    pub(super) fn new(element: Element, place: P) -> Result<Self, MeshError> {
        let other = MeshError::Dimension { element, dimension: 3 };
        let local = of_shape!(3, element, lattice(), return Err(other));
        let (numbers, keys, nodes, cells) = Default::default();
        Ok(Self { element, local, place, numbers, keys, nodes, cells })
    }

    /// Adds a cell, given the key of each of its lattice points: of every corner times the degree,
    /// and of the points between them.
    pub(super) fn add(&mut self, solid: &Solid, key: impl Fn([usize; 3]) -> Key) {
        let k = self.element.degree();
        let corner = |c: usize| key(solid.corners[c].map(|x| k * x));
        if matches!(self.element, Element::Hex8 | Element::Hex27) {
            let mirrored = self.mirrored([0, 1, 2, 4].map(corner));
            for at in self.local.clone() {
                self.node(key(if mirrored { [at[1], at[0], at[2]] } else { at }));
            }
            return;
        }
        // Mirrored halves of a shape are cut as mirror images.
        let order = |c: usize| (corner(c).map(i64::abs), corner(c));
        for mut tetrahedron in solid.cut(order) {
            if self.mirrored(tetrahedron.map(corner)) {
                tetrahedron.swap(2, 3);
            }
            let corners = tetrahedron.map(|c| solid.corners[c]);
            for [a, b, c] in self.local.clone() {
                let weights = [k - a - b - c, a, b, c];
                self.node(key([0, 1, 2].map(|i| (0..4).map(|c| weights[c] * corners[c][i]).sum())));
            }
        }
    }

    /// Whether the edges from the first of four points to the others are left-handed.
    fn mirrored(&self, points: [Key; 4]) -> bool {
        let [o, a, b, c] = points.map(&self.place);
        Mat::<3>([a, b, c].map(|x| std::array::from_fn(|i| x[i] - o[i]))).det() < 0.0
    }

    /// Adds a node to the last cell.
    fn node(&mut self, key: Key) {
        let Self { numbers, keys, nodes, place, cells, .. } = self;
        cells.push(*numbers.entry(key).or_insert_with(|| {
            keys.push(key);
            nodes.push(place(key));
            nodes.len() - 1
        }));
    }

    /// The mesh, with the sides to which a facet with these corners belongs.
    pub(super) fn into_mesh<'a, I: IntoIterator<Item = &'a str>>(
        self,
        sides_of: impl Fn([Key; 3]) -> I,
    ) -> Mesh {
        let Self { element, keys, nodes, cells, .. } = self;
        let mut mesh = Mesh {
            element,
            nodes: nodes.into(),
            cells,
            regions: Vec::new(),
            sides: BTreeMap::new(),
            repairs: Vec::new(),
        };
        let mut sides: BTreeMap<String, Vec<Facet>> = BTreeMap::new();
        for facet in mesh.skin() {
            for name in sides_of([0, 1, 2].map(|c| keys[facet.nodes[c]])) {
                sides.entry(name.to_owned()).or_default().push(facet.clone());
            }
        }
        mesh.sides = sides;
        mesh
    }
}

/// A side of a shape: where a component of the key has this value.
pub(super) struct Flat(pub(super) String, pub(super) usize, pub(super) i64);

/// The sides to which a facet with these corners belongs.
pub(super) fn on(sides: &[Flat], corners: [Key; 3]) -> Vec<&str> {
    let there = |Flat(_, i, value): &&Flat| corners.iter().all(|key| key[*i] == *value);
    sides.iter().filter(there).map(|Flat(name, ..)| name.as_str()).collect()
}

/// Number of edges of at most this size in a length.
pub(super) fn divisions(length: f64, size: f64) -> i64 {
    (length / size - 1e-9).ceil().max(1.0) as i64
}
