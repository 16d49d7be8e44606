//! Quality of cells: the scaled Jacobian, 1 for an equilateral cell, 0 for a flat one, below 0 for
//! an inverted one.
//!
//! At a point of a cell the derivatives of X(ξ) span the affine cell nearest to it. The edges at a
//! corner of that cell give det/∏ length, here divided by its value for equal edges; the least over
//! the corners counts, and over the nodes of the cell (for straight cells: P. M. Knupp et al., The
//! Verdict Geometric Quality Library, Sandia 2007). All corners of a parallelepiped are alike.

use carom_algebra::Vector;

use crate::element_shape::of_shape;
use crate::mesh::Mesh;
use crate::reference::gradient;
use crate::shape::Shape;

impl Mesh {
    /// The smallest scaled Jacobian of its cells, of [`Self::worst_cell`].
    ///
    /// ```
    /// use carom_solid::{Element, generate};
    /// let cube = generate::cuboid(Element::Tet4, [0.0; 3], [1.0; 3], [2, 2, 2])?;
    /// assert!((cube.scaled_jacobian().unwrap() - 1.0 / 3.0_f64.sqrt()).abs() < 1e-15);
    /// # Ok::<(), carom_solid::generate::MeshError>(())
    /// ```
    pub fn scaled_jacobian(&self) -> Option<f64> {
        self.worst_cell().map(|worst| worst.scaled_jacobian)
    }

    /// The cell with the smallest scaled Jacobian, the first of equals; none for bars.
    pub fn worst_cell(&self) -> Option<WorstCell> {
        match self.element.dimension() {
            2 => of_shape!(2, self.element, worst(self), None),
            _ => of_shape!(3, self.element, worst(self), None),
        }
    }
}

/// A cell of a mesh with its quality.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstCell {
    /// Number of the cell in the mesh.
    pub cell: usize,
    /// The mean of its nodes.
    pub place: Vec<f64>,
    /// Smallest scaled Jacobian of the cell.
    pub scaled_jacobian: f64,
}

fn worst<const D: usize, const N: usize, S: Shape<D, N>>(mesh: &Mesh) -> Option<WorstCell> {
    let simplex = mesh.element.facets().len() == D + 1;
    let equal_edges = match (simplex, D) {
        (false, _) => 1.0,
        (true, 2) => 2.0 / 3.0_f64.sqrt(),
        (true, _) => 2.0_f64.sqrt(),
    };
    // Straight simplices are the same everywhere.
    let points = if simplex && S::DEGREE == 1 { 1 } else { N };
    let slopes: Vec<_> = S::NODES[..points].iter().map(S::gradients).collect();
    let positions = mesh.nodes.of_dimension::<D>();
    let mut worst: Option<WorstCell> = None;
    for (cell, nodes) in mesh.cells.as_chunks::<N>().0.iter().enumerate() {
        let x = nodes.map(|n| Vector(positions[n]));
        let mut least = f64::INFINITY;
        for slope in &slopes {
            let derivative = gradient(&x, slope);
            let edges = derivative.transposed().0.map(Vector);
            let at_first: f64 = edges.iter().map(Vector::norm).product();
            let at_others = (0..if simplex { D } else { 0 }).map(|i| {
                let to = |j: usize| if i == j { edges[i] } else { edges[j] - edges[i] };
                (0..D).map(|j| to(j).norm()).product::<f64>()
            });
            least = least.min(equal_edges * derivative.det() / at_others.fold(at_first, f64::max));
        }
        if worst.as_ref().is_none_or(|worst| least < worst.scaled_jacobian) {
            let mean = |i: usize| x.iter().map(|x| x[i]).sum::<f64>() / N as f64;
            worst = Some(WorstCell { cell, place: (0..D).map(mean).collect(), scaled_jacobian: least });
        }
    }
    worst
}
