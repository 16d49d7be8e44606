//! Field files: VTK unstructured grids of Lagrange cells, orders 1 to 3, with appended raw binary
//! data.
//!
//! Nodes are in the order of VTK and Gmsh: corners, then the nodes of each edge in the direction of
//! the edge, then the interior. Points are the REFERENCE positions; `displacement` is a point
//! array, so that "Warp By Vector" at scale 1 shows the deformed bodies. Units are stored with
//! VTK's information key `UNITS_LABEL`, body names as a string array of the field data.

mod read;
mod write;

/// Shape of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cell {
    /// `VTK_LAGRANGE_CURVE`: ends, then interior.
    Curve,
    /// `VTK_LAGRANGE_TRIANGLE`: corners, edges, interior.
    Triangle,
    /// `VTK_LAGRANGE_QUADRILATERAL` of degree 1 or 2: corners, edges, interior.
    Quadrilateral,
    /// `VTK_LAGRANGE_TETRAHEDRON`: corners, edges, faces, interior.
    Tetrahedron,
    /// `VTK_LAGRANGE_HEXAHEDRON` of degree 1 or 2: corners, edges, faces, interior.
    Hexahedron,
}

impl Cell {
    /// VTK's number of the cell type.
    pub fn vtk_type(self) -> u8 {
        match self {
            Self::Curve => 68,
            Self::Triangle => 69,
            Self::Quadrilateral => 70,
            Self::Tetrahedron => 71,
            Self::Hexahedron => 72,
        }
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
    /// Quantities.
    pub arrays: Vec<PointArray>,
}

impl FieldSet {
    /// A quantity by name.
    pub fn array(&self, name: &str) -> Option<&PointArray> {
        self.arrays.iter().find(|a| a.name == name)
    }

    /// Unit of a quantity; empty when it has none or does not exist.
    pub fn unit(&self, name: &str) -> &str {
        self.array(name).map_or("", |array| &array.unit)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Two bodies: a curve of order 3 and two triangles of order 2, with every kind of array.
    pub(crate) fn sample() -> FieldSet {
        let points: Vec<[f64; 3]> = (0..13).map(|i| [f64::from(i), 0.1 * f64::from(i * i), 0.0]).collect();
        let values = |n: usize| (0..13 * n).map(|i| (i as f64).sqrt() - 1e-300 * i as f64).collect();
        let array = |name: &str, unit: &str, components| PointArray {
            name: name.into(),
            unit: unit.into(),
            components,
            values: values(components),
        };
        FieldSet {
            points,
            blocks: vec![
                Block {
                    body: "bar <1>".into(),
                    cell: Cell::Curve,
                    degree: 3,
                    connectivity: vec![0, 1, 2, 3],
                },
                Block {
                    body: "disc".into(),
                    cell: Cell::Triangle,
                    degree: 2,
                    connectivity: vec![4, 5, 6, 7, 8, 9, 5, 4, 10, 7, 11, 12],
                },
            ],
            arrays: vec![
                array("displacement", "m", 3),
                array("stress", "N/m²", 6),
                array("contact_pressure", "", 1),
            ],
        }
    }

    #[test]
    fn reads_what_it_wrote() {
        let bytes = sample().to_vtu(0.1 + 0.2).unwrap();
        assert_eq!(FieldSet::from_vtu(&bytes).unwrap(), sample());
    }

    #[test]
    fn damage_is_an_error_and_never_a_panic() {
        let bytes = sample().to_vtu(1.0).unwrap();
        for end in 0..bytes.len() {
            assert!(FieldSet::from_vtu(&bytes[..end.min(bytes.len() - 40)]).is_err(), "cut at {end}");
        }
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x15;
            let _ = FieldSet::from_vtu(&damaged);
        }
    }

    #[test]
    fn contradicting_lengths_are_an_error() {
        let mut fields = sample();
        fields.arrays[0].values.pop();
        assert!(fields.to_vtu(0.0).unwrap_err().to_string().contains("displacement"));
        let mut fields = sample();
        fields.blocks[1].connectivity[3] = 13;
        assert!(fields.to_vtu(0.0).unwrap_err().to_string().contains("13 points"));
    }
}
