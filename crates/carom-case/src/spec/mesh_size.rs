//! Meshes before they are made: the names of their sides, an estimate of their size, finer ones.

use std::f64::consts::PI;

use carom_solid::{Element, generate};

use super::mesh::{MeshSpec, RefineSpec};
use super::polygon::area_within;
use crate::mesh_file::{FileMesh, unchanged};
use crate::no_mesh::NoMesh;
use crate::refine::whole;

/// Names of the sides in planes of symmetry across x, y and z.
pub(crate) const PLANES: [&str; 3] = ["plane_x", "plane_y", "plane_z"];

/// Index of the coordinate in whose positive direction a vector points; none if it is not along
/// one.
fn coordinate(axis: [f64; 3]) -> Option<usize> {
    (0..3).find(|&i| axis[i] > 0.0 && (0..3).all(|j| i == j || axis[j] == 0.0))
}

impl MeshSpec {
    /// Whether the mesh is still the one the case was resolved with: that its file is there and
    /// unchanged.
    ///
    /// # Errors
    /// A message with the file's name.
    pub fn verify(&self) -> Result<(), NoMesh> {
        match self.source() {
            Self::File(file) => unchanged(&file.file, &file.hash).map(|_| ()),
            _ => Ok(()),
        }
    }

    /// The mesh with cells smaller by a factor ≥ 1: a built-in shape is made anew with smaller
    /// cells, the cells of a file are divided. `refine.rs` rejects factors with which given numbers
    /// of cells, or the parts of an edge of a file, are not whole; the cells of a rectangle that is
    /// given by their size are rounded up, as without a factor.
    #[must_use]
    pub fn refined(mut self, factor: f64) -> Self {
        let more = |cells: usize| (cells as f64 * factor * (1.0 - 2e-9)).ceil() as usize;
        match &mut self {
            Self::Interval { cells, .. } => *cells = more(*cells),
            Self::Rectangle { cells, .. } => *cells = cells.map(more),
            Self::Box { cells, .. } => *cells = cells.map(more),
            Self::Extrusion { of, layers, .. } => {
                **of = of.as_ref().clone().refined(factor);
                *layers = more(*layers);
            }
            Self::Disc { size, .. }
            | Self::HalfDisc { size, .. }
            | Self::Ring { size, .. }
            | Self::Ball { size, .. }
            | Self::Cylinder { size, .. }
            | Self::Tube { size, .. } => *size /= factor,
            Self::Polygon { size, refine, .. } => {
                *size /= factor;
                refine.iter_mut().for_each(|region| region.size /= factor);
            }
            Self::File(file) => file.parts = factor.round() as usize,
        }
        self
    }

    /// Whether cells are smaller by exactly a factor: numbers of cells remain whole. Those
    /// of shapes that are given by the size of their cells are rounded up.
    pub fn is_divided_exactly(&self, factor: f64) -> bool {
        let are_whole = |cells: &[usize]| cells.iter().all(|n| whole(factor, *n));
        match self {
            Self::Interval { cells, .. } => are_whole(&[*cells]),
            Self::Rectangle { cells, .. } => are_whole(cells),
            Self::Box { cells, .. } => are_whole(cells),
            Self::Extrusion { of, layers, .. } => of.is_divided_exactly(factor) && are_whole(&[*layers]),
            Self::File(file) => are_whole(&[file.parts]),
            Self::Disc { .. }
            | Self::HalfDisc { .. }
            | Self::Ring { .. }
            | Self::Ball { .. }
            | Self::Cylinder { .. }
            | Self::Tube { .. }
            | Self::Polygon { .. } => false,
        }
    }

    /// The mesh from a shape or a file: this one, or the one that it extrudes.
    #[must_use]
    pub fn source(&self) -> &Self {
        match self {
            Self::Extrusion { of, .. } => of.source(),
            _ => self,
        }
    }

    /// Names of the sides, in order along the boundary.
    pub fn sides(&self) -> Vec<String> {
        let cut = |words: &[&str], symmetry: &[bool; 3], across: [Option<&str>; 3]| {
            let gone = |word: &str| (0..3).any(|i| symmetry[i] && across[i] == Some(word));
            let kept = words.iter().filter(|word| !gone(word)).copied();
            kept.chain((0..3).filter(|&i| symmetry[i]).map(|i| PLANES[i])).map(str::to_owned).collect()
        };
        let bottom = |axis: [f64; 3]| {
            let along = coordinate(axis);
            std::array::from_fn(|i| (along == Some(i)).then_some("bottom"))
        };
        let words: &[&str] = match self {
            Self::Box { symmetry, .. } => {
                let words = ["left", "right", "front", "back", "bottom", "top"];
                return cut(&words, symmetry, self.cut_sides().each_ref().map(Option::as_deref));
            }
            Self::Ball { symmetry, .. } => return cut(&["sphere"], symmetry, [None; 3]),
            Self::Cylinder { symmetry, axis, .. } => {
                return cut(&["side", "bottom", "top"], symmetry, bottom(*axis));
            }
            Self::Tube { symmetry, axis, .. } => {
                return cut(&["inner", "outer", "bottom", "top"], symmetry, bottom(*axis));
            }
            Self::Extrusion { of, symmetry, .. } => {
                let mut sides = of.sides();
                for (end, other) in [("bottom", "base"), ("top", "lid")] {
                    let end = if sides.iter().any(|side| side == end) { other } else { end };
                    sides.push(end.to_owned());
                }
                let words: Vec<&str> = sides.iter().map(String::as_str).collect();
                return cut(&words, symmetry, self.cut_sides().each_ref().map(Option::as_deref));
            }
            Self::File(file) => return file.sides.clone(),
            Self::Polygon { points, .. } => return (1..=points.len()).map(|k| format!("side{k}")).collect(),
            Self::Interval { .. } => &["left", "right"],
            Self::Rectangle { .. } => &["bottom", "right", "top", "left"],
            Self::Disc { .. } => &["arc"],
            Self::HalfDisc { .. } => &["arc", "axis"],
            Self::Ring { .. } => &["inner", "outer"],
        };
        words.iter().map(ToString::to_string).collect()
    }

    /// The sides of a box or of an extrusion that planes of symmetry across x, y and z replace; of
    /// other shapes, none.
    pub fn cut_sides(&self) -> [Option<String>; 3] {
        let (all, symmetry) = match self {
            Self::Box { symmetry, .. } => ([Some("left"), Some("front"), Some("bottom")], symmetry),
            Self::Extrusion { of, symmetry, .. } => {
                let low = if of.sides().iter().any(|side| side == "bottom") { "base" } else { "bottom" };
                let [x, y] = match **of {
                    Self::Rectangle { .. } => [Some("left"), Some("bottom")],
                    Self::HalfDisc { .. } => [Some("axis"), None],
                    _ => [None, None],
                };
                ([x, y, Some(low)], symmetry)
            }
            _ => return [None, None, None],
        };
        std::array::from_fn(|i| all[i].filter(|_| symmetry[i]).map(str::to_owned))
    }

    /// Estimated numbers of cells and nodes of the mesh, in floating point so that nothing
    /// overflows.
    pub fn estimate(&self, element: Element) -> (f64, f64) {
        let k = element.degree() as f64;
        let rings = |radius: f64, size: f64| (radius / size).ceil().max(1.0);
        // Equilateral triangles with the edges h fill an area.
        let filled = |area: f64, h: f64| area / (0.75_f64.sqrt() / 2.0 * h * h);
        let nodes = |cells: f64| (cells, 0.5 * k * k * cells * 1.1 + 10.0 * k);
        match *self {
            Self::Ring { inner, outer, size, .. } => {
                let h = size.min(outer - inner);
                // At least twelve edges on a small inner circle.
                let growing = 24.0 * (outer / inner).ln().max(1.0);
                nodes(filled(PI * (outer * outer - inner * inner), h) + growing)
            }
            Self::Polygon { ref points, size, ref refine } => {
                let next = points.iter().cycle().skip(1);
                let twice: f64 = points.iter().zip(next).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum();
                let area = twice.abs() / 2.0;
                let place =
                    |r: &RefineSpec| filled(area_within(points, r.near, r.radius + 3.0 * r.size), r.size);
                nodes(filled(area, size) + refine.iter().map(place).sum::<f64>())
            }
            Self::File(FileMesh { nodes, cells, parts, .. }) => {
                let times = (parts as f64).powi(element.dimension() as i32);
                (cells as f64 * times, nodes as f64 * times)
            }
            Self::Interval { cells, .. } => (cells as f64, k * cells as f64 + 1.0),
            Self::Rectangle { cells: [nx, ny], .. } => {
                let nx = nx as f64;
                let ny = ny as f64;
                let each = if matches!(element, Element::Q4 | Element::Q9) { 1.0 } else { 2.0 };
                (each * nx * ny, (k * nx + 1.0) * (k * ny + 1.0))
            }
            Self::Box { cells, .. } => {
                let [nx, ny, nz] = cells.map(|n| n as f64);
                let each = if is_hexahedral(element) { 1.0 } else { 6.0 };
                (each * nx * ny * nz, (k * nx + 1.0) * (k * ny + 1.0) * (k * nz + 1.0))
            }
            Self::Ball { radius, size, symmetry, .. } => {
                filled_space(element, generate::ball_hexahedra(radius, size, symmetry))
            }
            Self::Cylinder { radius, height, size, symmetry, .. } => {
                filled_space(element, generate::cylinder_hexahedra(radius, height, size, symmetry))
            }
            Self::Tube { inner, outer, height, size, symmetry, .. } => {
                filled_space(element, generate::tube_hexahedra([inner, outer], height, size, symmetry))
            }
            Self::Extrusion { ref of, layers, .. } => {
                let (cells, nodes) = of.estimate(generate::plane_of(element).unwrap_or(Element::T3));
                let layers = layers as f64;
                (cells * layers * if is_hexahedral(element) { 1.0 } else { 3.0 }, nodes * (k * layers + 1.0))
            }
            Self::Disc { radius, size, .. } => {
                let n = rings(radius, size);
                (6.0 * n * n, 1.0 + 3.0 * k * n * (k * n + 1.0))
            }
            Self::HalfDisc { radius, size, .. } => {
                let n = rings(radius, size);
                (3.0 * n * n, 1.0 + 1.5 * k * n * (k * n + 1.0) + k * n)
            }
        }
    }

    /// Layers of nodes along the longest extent of a shape, which bound the coupling between its
    /// ends; none where the extents are not known.
    pub fn layers(&self, element: Element) -> Option<f64> {
        let k = element.degree() as f64;
        let along = |cells: f64| k * cells + 1.0;
        match *self {
            Self::Interval { cells, .. } => Some(along(cells as f64)),
            Self::Rectangle { cells, .. } => Some(along(cells.into_iter().max()? as f64)),
            Self::Box { cells, .. } => Some(along(cells.into_iter().max()? as f64)),
            Self::Cylinder { height, size, .. } | Self::Tube { height, size, .. } => {
                Some(along(height / size))
            }
            // Each half of a ring couples both ends.
            Self::Ring { inner, outer, size, .. } => Some(along(PI / 2.0 * (inner + outer) / size)),
            Self::Extrusion { ref of, layers, .. } => {
                let plane = generate::plane_of(element).and_then(|element| of.layers(element));
                Some(plane.unwrap_or(1.0).max(along(layers as f64)))
            }
            Self::Ball { .. }
            | Self::Disc { .. }
            | Self::HalfDisc { .. }
            | Self::Polygon { .. }
            | Self::File(_) => None,
        }
    }
}

fn is_hexahedral(element: Element) -> bool {
    matches!(element, Element::Hex8 | Element::Hex27)
}

/// Cells and nodes of a body of hexahedra, about as thick in all directions.
fn filled_space(element: Element, hexahedra: f64) -> (f64, f64) {
    let along = element.degree() as f64 * hexahedra.cbrt();
    (if is_hexahedral(element) { hexahedra } else { 6.0 * hexahedra }, (along + 1.0).powi(3))
}
