//! A line as `parts` lines, a quadrilateral as `parts`² quadrilaterals, a hexahedron as `parts`³
//! hexahedra: the lattice of its reference interval, square or cube. A point of the lattice is
//! known to all cells that contain it by its multilinear weights at the corners, Π (i or
//! count − i): on an edge or a face those of its corners alone are not zero.

use carom_algebra::Vector;

use super::nodes::Nodes;
use crate::mesh::{Facet, Mesh};
use crate::shape::{self, Shape};

/// Whole coordinates from 0, of a point of the lattice or of a part.
type At<const R: usize> = [usize; R];

/// All points of a lattice of `size` points along each axis, the first axis fastest.
fn lattice<const R: usize>(size: usize) -> impl Iterator<Item = At<R>> {
    (0..size.pow(R as u32)).map(move |k| std::array::from_fn(|axis| k / size.pow(axis as u32) % size))
}

/// The number of a point among them.
fn number<const R: usize>(at: At<R>, size: usize) -> usize {
    at.iter().rev().fold(0, |sum, i| sum * size + i)
}

pub(super) fn tensor<const R: usize, const N: usize, S: Shape<R, N>>(mesh: &Mesh, parts: usize) -> Mesh {
    let degree = S::DEGREE;
    let count = S::DEGREE * parts;
    let corners = 1 << R;
    let steps = shape::lattice::<R, N, S>();
    let values: Vec<[f64; N]> = lattice::<R>(count + 1)
        .map(|at| S::values(&Vector(at.map(|i| 2.0 * i as f64 / count as f64 - 1.0))))
        .collect();
    let weight = |at: At<R>, corner: usize| -> usize {
        (0..R).map(|axis| if steps[corner][axis] > 0 { at[axis] } else { count - at[axis] }).product()
    };
    let mut nodes = Nodes::new(mesh);
    let mut cells = Vec::with_capacity(mesh.cells.len() * parts.pow(R as u32));
    let mut numbers = Vec::with_capacity(values.len());
    for cell in 0..mesh.cell_count() {
        numbers.clear();
        for (at, values) in lattice::<R>(count + 1).zip(&values) {
            let weights: Vec<usize> = (0..corners).map(|corner| weight(at, corner)).collect();
            numbers.push(nodes.at(&weights, cell, values));
        }
        for part in lattice::<R>(parts) {
            cells.extend(steps.iter().map(|step| {
                let at: At<R> = std::array::from_fn(|axis| degree * part[axis] + step[axis]);
                numbers[number(at, count + 1)]
            }));
        }
    }
    let divided = |facet: &Facet| {
        let whole = mesh.cell(facet.cell);
        let its = |local: &&&[usize]| local.iter().all(|&a| facet.nodes.contains(&whole[a]));
        let local = mesh.element.facets().iter().find(its).copied().unwrap_or_default();
        // The corner at which the facet begins and the next ones along its two directions.
        let [first, next, last] = [0, 1.min(R - 1), (1 << (R - 1)) - 1].map(|k| steps[local[k]]);
        let along = lattice::<2>(parts).take(parts.pow(R as u32 - 1));
        let part = |[m, n]: At<2>| {
            let at: At<R> = std::array::from_fn(|axis| {
                let step = if first[axis] != next[axis] {
                    m
                } else if first[axis] != last[axis] {
                    n
                } else {
                    0
                };
                if first[axis] == 0 { step } else { parts - 1 - step }
            });
            let cell = facet.cell * parts.pow(R as u32) + number(at, parts);
            Facet { cell, nodes: local.iter().map(|&a| cells[cell * N + a]).collect() }
        };
        along.map(part).collect()
    };
    nodes.into_mesh(cells.clone(), divided)
}
