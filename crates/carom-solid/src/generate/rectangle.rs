//! Rectangle of nx × ny rectangles: quadrilaterals, or each cut into two triangles.
//!
//! Diagonals alternate as on a chessboard, starting at the lower left corner: with even nx and ny
//! the mesh is symmetric, and no cell has two edges on the boundary.

use super::cuboid::filled;
use super::elevate::{Side, Skeleton, elevate};
use super::{MeshError, check, lerp};
use crate::mesh::{Element, Mesh};
use crate::shape::{Quad4, Quad9, lattice};

/// Sides: axis, and whether at its upper end.
const SIDES: [(&str, usize, bool); 4] =
    [("bottom", 1, false), ("right", 0, true), ("top", 1, true), ("left", 0, false)];

/// Rectangle from `min` to `max`, `cells` along x and y; sides `bottom`, `right`, `top`, `left`,
/// each traversed counter-clockwise.
///
/// # Errors
/// If an extent is not positive, there are no cells, or the element does not fill the plane.
pub fn rectangle(
    element: Element,
    min: [f64; 2],
    max: [f64; 2],
    cells: [usize; 2],
) -> Result<Mesh, MeshError> {
    check(element, &min, &max, &cells)?;
    let quadrilateral = match element {
        Element::Q4 => lattice::<2, 4, Quad4>(),
        Element::Q9 => lattice::<2, 9, Quad9>(),
        _ => Vec::new(),
    };
    if !quadrilateral.is_empty() {
        let mut mesh = filled(element, [min, max], cells, &[quadrilateral], &SIDES);
        // Against the axes.
        for side in ["top", "left"] {
            mesh.sides.entry(side.to_owned()).or_default().reverse();
        }
        return Ok(mesh);
    }
    let [nx, ny] = cells;
    let node = |i: usize, j: usize| j * (nx + 1) + i;
    let mut skeleton = Skeleton::default();
    for j in 0..=ny {
        let y = lerp(min[1], max[1], j as f64 / ny as f64);
        skeleton.points.extend((0..=nx).map(|i| [lerp(min[0], max[0], i as f64 / nx as f64), y]));
    }
    for j in 0..ny {
        for i in 0..nx {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            let pair = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            skeleton.triangles.extend(pair);
        }
    }
    let mut side = |name: &str, edges| skeleton.sides.push(Side { name: name.into(), edges, circle: None });
    side("bottom", (0..nx).map(|i| [node(i, 0), node(i + 1, 0)]).collect());
    side("right", (0..ny).map(|j| [node(nx, j), node(nx, j + 1)]).collect());
    side("top", (0..nx).rev().map(|i| [node(i + 1, ny), node(i, ny)]).collect());
    side("left", (0..ny).rev().map(|j| [node(0, j + 1), node(0, j)]).collect());
    Ok(elevate(skeleton, element))
}
