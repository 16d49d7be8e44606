//! Rectangle of nx × ny rectangles: quadrilaterals, or each cut into two triangles.
//!
//! Diagonals alternate as on a chessboard, starting at the lower left corner: with even nx and ny
//! the mesh is symmetric, and no cell has two edges on the boundary.

use std::collections::BTreeMap;

use super::elevate::{Side, Skeleton, elevate};
use super::{MeshError, check, lerp};
use crate::mesh::{Element, Facet, Mesh};
use crate::shape::{Quad4, Quad9, lattice};

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
    match element {
        Element::Q4 => return Ok(quadrilaterals(element, min, max, cells, &lattice::<2, 4, Quad4>())),
        Element::Q9 => return Ok(quadrilaterals(element, min, max, cells, &lattice::<2, 9, Quad9>())),
        _ => {}
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

/// The rectangle of quadrilaterals whose nodes have these places in the lattice of one of them.
fn quadrilaterals(
    element: Element,
    min: [f64; 2],
    max: [f64; 2],
    cells: [usize; 2],
    places: &[[usize; 2]],
) -> Mesh {
    let (k, [nx, ny]) = (element.degree(), cells);
    let counts = cells.map(|n| k * n + 1);
    let at = |i: usize, count: usize, axis: usize| lerp(min[axis], max[axis], i as f64 / (count - 1) as f64);
    let row = |j: usize| (0..counts[0]).map(move |i| [at(i, counts[0], 0), at(j, counts[1], 1)]);
    let nodes: Vec<_> = (0..counts[1]).flat_map(row).collect();
    let cell = |i: usize, j: usize| {
        places.iter().map(move |place| (k * j + place[1]) * counts[0] + k * i + place[0])
    };
    let numbers: Vec<usize> =
        (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j))).flat_map(|(i, j)| cell(i, j)).collect();
    let facet = |i: usize, j: usize, edge: usize| {
        let (cell, size) = (j * nx + i, places.len());
        Facet { cell, nodes: element.facets()[edge].iter().map(|&a| numbers[cell * size + a]).collect() }
    };
    let sides = BTreeMap::from([
        ("bottom".to_owned(), (0..nx).map(|i| facet(i, 0, 0)).collect()),
        ("right".to_owned(), (0..ny).map(|j| facet(nx - 1, j, 1)).collect()),
        ("top".to_owned(), (0..nx).rev().map(|i| facet(i, ny - 1, 2)).collect()),
        ("left".to_owned(), (0..ny).rev().map(|j| facet(0, j, 3)).collect()),
    ]);
    Mesh { element, nodes: nodes.into(), cells: numbers, sides, repairs: Vec::new() }
}

/// Number of nodes of a rectangle; saturates.
pub fn rectangle_nodes(element: Element, cells: [usize; 2]) -> usize {
    let [x, y] = cells.map(|n| super::interval_nodes(element, n));
    x.saturating_mul(y)
}
