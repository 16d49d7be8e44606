//! Field files: VTK unstructured grids of cells of degree 1 to 3, with appended raw binary data.
//!
//! Nodes are in the order of VTK: corners, then the nodes of each edge in the direction of the
//! edge, then the interior. Points are the REFERENCE positions; `displacement` is a point array, so
//! that "Warp By Vector" at scale 1 shows the deformed bodies. Units are stored with VTK's
//! information key `UNITS_LABEL`. Each body is a number of the field data, named `body NAME`: the
//! value of the cell array `body` in its cells; where a body has several materials, each is
//! likewise `material NAME`, and the cell array `material` has its number.
//!
//! The version in the header decides who can read a file. VTK takes a Lagrange hexahedron of a file
//! older than 2.1 for one of VTK 8, in which the edges at nodes 18 and 19 were exchanged, and
//! reorders it; meshio 5.3 reads the versions 0.1 and 1.0 only. A file therefore has version 1.0
//! and, where they exist, the cell types of fixed degree, whose nodes have one order in all
//! versions and which meshio knows by name; Lagrange cells remain for degree 3, where no hexahedron
//! exists.

mod read;
mod write;

/// Beginning of the name of a body's number in the field data.
const NAMED: &str = "body ";

/// Beginning of the name of a material's number in the field data.
const MATERIAL: &str = "material ";

/// Name of the cell array with the largest von Mises stress at the quadrature points of each cell.
/// Runs in which bodies yield record it: values at nodes are projected and may exceed the yield
/// stress.
pub const LARGEST_VON_MISES: &str = "largest_von_mises";

/// Shape of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cell {
    /// Nodes at both ends, then in the interior.
    Curve,
    /// Nodes at corners, then edges, then the interior.
    Triangle,
    /// Degree 1 or 2; nodes at corners, then edges, then the interior.
    Quadrilateral,
    /// Nodes at corners, then edges, faces, and the interior.
    Tetrahedron,
    /// Degree 1 or 2; nodes at corners, then edges, faces, and the interior.
    Hexahedron,
}

impl Cell {
    const ALL: [Self; 5] =
        [Self::Curve, Self::Triangle, Self::Quadrilateral, Self::Tetrahedron, Self::Hexahedron];

    /// VTK's number of the Lagrange cell, whose degree follows from its number of nodes. The order
    /// of nodes is that of VTK 9.
    pub fn lagrange_type(self) -> u8 {
        match self {
            Self::Curve => 68,
            Self::Triangle => 69,
            Self::Quadrilateral => 70,
            Self::Tetrahedron => 71,
            Self::Hexahedron => 72,
        }
    }

    /// VTK's number of the cell type of a degree in a file.
    pub fn file_type(self, degree: usize) -> u8 {
        match (self, degree) {
            (Self::Curve, 1) => 3,
            (Self::Curve, 2) => 21,
            (Self::Triangle, 1) => 5,
            (Self::Triangle, 2) => 22,
            (Self::Quadrilateral, 1) => 9,
            (Self::Quadrilateral, 2) => 28,
            (Self::Tetrahedron, 1) => 10,
            (Self::Tetrahedron, 2) => 24,
            (Self::Hexahedron, 1) => 12,
            (Self::Hexahedron, 2) => 29,
            _ => self.lagrange_type(),
        }
    }

    /// The cell of a type in a file with its degree, from its number of nodes; of every degree it
    /// may be the Lagrange cell.
    pub(crate) fn of_type(kind: u8, nodes: usize) -> Option<(Self, usize)> {
        let of_degree = |degree: usize| Self::ALL.map(|cell| (cell, degree));
        let fits = |&(cell, degree): &(Self, usize)| {
            cell.nodes(degree) == nodes && (kind == cell.file_type(degree) || kind == cell.lagrange_type())
        };
        (1..=3).flat_map(of_degree).find(fits)
    }

    /// Nodes of a cell of the given degree.
    pub fn nodes(self, degree: usize) -> usize {
        match self {
            Self::Curve => degree + 1,
            Self::Triangle => (degree + 1) * (degree + 2) / 2,
            Self::Quadrilateral => (degree + 1).pow(2),
            Self::Hexahedron => (degree + 1).pow(3),
            Self::Tetrahedron => (degree + 1) * (degree + 2) * (degree + 3) / 6,
        }
    }
}

/// Cells of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Name of the body.
    pub body: String,
    /// Shape of every cell.
    pub cell: Cell,
    /// Degree of every cell, 1 to 3.
    pub degree: usize,
    /// Point numbers, cell after cell.
    pub connectivity: Vec<usize>,
}

impl Block {
    /// The cells, each with its point numbers.
    pub fn cells(&self) -> impl Iterator<Item = &[usize]> {
        self.connectivity.chunks_exact(self.cell.nodes(self.degree))
    }
}

/// A number for each cell of all blocks, block after block.
#[derive(Clone, Debug, PartialEq)]
pub struct CellArray {
    /// Name.
    pub name: String,
    /// Unit label, may be empty.
    pub unit: String,
    /// Cell after cell.
    pub values: Vec<f64>,
}

/// A quantity at the points.
#[derive(Clone, Debug, PartialEq)]
pub struct PointArray {
    /// Name: `displacement`, `stress`, …
    pub name: String,
    /// Unit label, may be empty.
    pub unit: String,
    /// 1 scalar, 3 vector, 6 symmetric tensor XX YY ZZ XY YZ XZ.
    pub components: usize,
    /// Point after point.
    pub values: Vec<f64>,
}

/// Bodies and quantities at one time. Bodies share no points, so quantities may be discontinuous
/// between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FieldSet {
    /// Reference positions; components beyond the dimension are zero.
    pub points: Vec<[f64; 3]>,
    /// Cells, one block per body; the points of a body need not be contiguous.
    pub blocks: Vec<Block>,
    /// Quantities at the points.
    pub arrays: Vec<PointArray>,
    /// Quantities of the cells.
    pub of_cells: Vec<CellArray>,
    /// Materials of the cells, where a body has several.
    pub materials: CellMaterials,
}

/// Materials of the cells of all blocks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellMaterials {
    /// Names.
    pub names: Vec<String>,
    /// Index of the name of each cell, block after block; empty if no body has several materials.
    pub of_cells: Vec<usize>,
}

impl FieldSet {
    /// A quantity by name.
    pub fn array(&self, name: &str) -> Option<&PointArray> {
        self.arrays.iter().find(|a| a.name == name)
    }

    /// A quantity of the cells by name.
    pub fn of_cells(&self, name: &str) -> Option<&CellArray> {
        self.of_cells.iter().find(|a| a.name == name)
    }

    /// Unit of a quantity; empty when it has none or does not exist.
    pub fn unit(&self, name: &str) -> &str {
        self.array(name).map_or("", |array| &array.unit)
    }
}
