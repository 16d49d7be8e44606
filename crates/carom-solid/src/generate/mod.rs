//! Built-in meshes: interval, rectangle, disc, half-disc, ring and polygon; box, ball, cylinder,
//! tube and extrusion. The cells of a shape are the same for every order; `elevate` adds the nodes
//! between corners.

mod ball;
mod cuboid;
mod cylinder;
mod delaunay;
mod disc;
mod elevate;
mod extrusion;
mod frame;
mod lattice;
mod polygon;
mod rectangle;
mod ring;

use std::collections::BTreeMap;

pub use ball::{ball, ball_hexahedra};
pub use cuboid::cuboid;
pub use cylinder::{cylinder, cylinder_hexahedra, tube, tube_hexahedra};
pub use disc::{disc, half_disc};
pub use extrusion::{extruded, extrusion, plane_of};
pub use frame::Frame;
pub use polygon::{Refinement, outline, polygon};
pub use rectangle::rectangle;
pub use ring::ring;

use crate::mesh::{Element, Facet, Mesh};

/// Why a mesh cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum MeshError {
    #[error("min {min:?} must be less than max {max:?}, and both finite")]
    Extent { min: Vec<f64>, max: Vec<f64> },
    #[error("a mesh needs at least one cell in each direction, not {cells:?}")]
    Cells { cells: Vec<usize> },
    #[error("radius {radius} and size {size} must be finite and > 0, the centre {center:?} finite")]
    Disc { radius: f64, size: f64, center: [f64; 2] },
    #[error(
        "inner {inner}, outer {outer} and size {size} must be finite and > 0, with inner < outer, and the centre {center:?} finite"
    )]
    Ring { inner: f64, outer: f64, size: f64, center: [f64; 2] },
    #[error("radius {radius} and size {size} must be finite and > 0, the centre {center:?} finite")]
    Ball { radius: f64, size: f64, center: [f64; 3] },
    #[error("inner {inner} must be less than outer {outer}")]
    Tube { inner: f64, outer: f64 },
    #[error("the axis {axis:?} must not be zero, and it and the centre {origin:?} must be finite")]
    Axis { axis: [f64; 3], origin: [f64; 3] },
    #[error("planes of symmetry across x, y or z do not cut a shape with the axis {axis:?} in half")]
    Oblique { axis: [f64; 3] },
    #[error("a polygon has at least 3 points, not {count}")]
    Points { count: usize },
    #[error("point {point} of the polygon is not finite or coincides with the previous point")]
    Point { point: usize },
    #[error("side{first} and side{second} of the polygon cross, touch or fold back onto each other")]
    Crossing { first: usize, second: usize },
    #[error("{what} = {value} must be finite and > 0")]
    Size { what: &'static str, value: f64 },
    #[error("a region of refinement must have a finite centre and a radius ≥ 0, not {near:?} and {radius}")]
    Place { near: [f64; 2], radius: f64 },
    #[error("the polygon could not be meshed with angles of {angle}° or more")]
    Angles { angle: f64 },
    #[error("element {element:?} fills rectangles only; this shape has triangles")]
    Triangles { element: Element },
    #[error("element {element:?} does not fill a shape of dimension {dimension}")]
    Dimension { element: Element, dimension: usize },
}

/// The line from `min` to `max` in equal cells; sides `left` and `right`, one node each.
///
/// # Errors
/// If `min` ≥ `max`, there are no cells, or the element is not a line.
///
/// ```
/// use carom_solid::{Element, generate};
/// let bar = generate::interval(Element::L4, 0.0, 10.0, 20)?;
/// assert_eq!(bar.nodes.len(), 3 * 20 + 1);
/// # Ok::<(), carom_solid::generate::MeshError>(())
/// ```
pub fn interval(element: Element, min: f64, max: f64, cells: usize) -> Result<Mesh, MeshError> {
    check(element, &[min], &[max], &[cells])?;
    let k = element.degree();
    let at = |j: usize| [lerp(min, max, j as f64 / (k * cells) as f64)];
    let mut nodes: Vec<_> = (0..=cells).map(|i| at(k * i)).collect();
    let mut numbers = Vec::with_capacity(cells * (k + 1));
    for i in 0..cells {
        numbers.extend([i, i + 1]);
        for j in 1..k {
            numbers.push(nodes.len());
            nodes.push(at(k * i + j));
        }
    }
    let end = |cell, node| vec![Facet { cell, nodes: vec![node] }];
    let sides = BTreeMap::from([("left".into(), end(0, 0)), ("right".into(), end(cells - 1, cells))]);
    Ok(Mesh { element, nodes: nodes.into(), cells: numbers, regions: Vec::new(), sides, repairs: Vec::new() })
}

/// a + t(b − a), exact at both ends.
fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a * (1.0 - t) + b * t
}

fn check(element: Element, min: &[f64], max: &[f64], cells: &[usize]) -> Result<(), MeshError> {
    if element.dimension() != min.len() {
        return Err(MeshError::Dimension { element, dimension: min.len() });
    }
    if !min.iter().zip(max).all(|(a, b)| b > a && (b - a).is_finite()) {
        return Err(MeshError::Extent { min: min.to_vec(), max: max.to_vec() });
    }
    if cells.contains(&0) {
        return Err(MeshError::Cells { cells: cells.to_vec() });
    }
    Ok(())
}

/// Checks that an element is a triangle.
fn triangles(element: Element) -> Result<(), MeshError> {
    match element {
        Element::T3 | Element::T6 | Element::T10 => Ok(()),
        Element::Q4 | Element::Q9 => Err(MeshError::Triangles { element }),
        _ => Err(MeshError::Dimension { element, dimension: 2 }),
    }
}

/// Checks that lengths are finite and > 0.
fn positive(lengths: &[(&'static str, f64)]) -> Result<(), MeshError> {
    match lengths.iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
        Some(&(what, value)) => Err(MeshError::Size { what, value }),
        None => Ok(()),
    }
}
