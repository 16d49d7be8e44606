//! A quadrilateral as `parts`² quadrilaterals, a hexahedron as `parts`³ hexahedra: the lattice of
//! its reference square or cube. A point of the lattice is known to all cells that contain it by
//! its multilinear weights at the corners, Π (i or count − i): on an edge or a face those of its
//! corners alone are not zero.

use carom_algebra::Vector;

use super::nodes::{Nodes, Place};
use crate::mesh::{Facet, Mesh};
use crate::shape::Shape;

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
    let (degree, count) = (S::DEGREE, S::DEGREE * parts);
    let corners = 1 << R;
    // Nodes in the lattice of the degree: from −1, 0, 1 to 0, …, degree.
    let steps = S::NODES.map(|xi| xi.0.map(|x| (f64::midpoint(x, 1.0) * degree as f64).round() as usize));
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
        let own = &mesh.cell(cell)[..corners];
        numbers.clear();
        for (at, values) in lattice::<R>(count + 1).zip(&values) {
            let inside = at.iter().all(|i| (1..count).contains(i));
            let place = if inside {
                Place::Inside(cell, std::array::from_fn(|axis| at.get(axis).copied().unwrap_or_default()))
            } else {
                let mut among: Vec<_> =
                    own.iter().enumerate().map(|(c, &node)| (node, weight(at, c))).collect();
                among.retain(|(_, weight)| *weight > 0);
                among.sort_unstable();
                Place::Among(among)
            };
            numbers.push(nodes.at(place, cell, values));
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
        let [first, next, last] = [0, 1, (1 << (R - 1)) - 1].map(|k| steps[local[k]]);
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

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use crate::generate::ball;
    use crate::generate::testing::{sound, volume};
    use crate::mesh::{Element, Mesh};

    /// Numbers of corners, edges, faces and cells of a mesh of hexahedra.
    fn counts(mesh: &Mesh) -> [usize; 4] {
        let (mut corners, mut edges, mut faces) = (HashSet::new(), HashSet::new(), HashSet::new());
        for cell in 0..mesh.cell_count() {
            for local in mesh.element.facets() {
                let mut face = [0, 1, 2, 3].map(|k| mesh.cell(cell)[local[k]]);
                for k in 0..4 {
                    let [a, b] = [face[k], face[(k + 1) % 4]];
                    corners.insert(a);
                    edges.insert([a.min(b), a.max(b)]);
                }
                face.sort_unstable();
                faces.insert(face);
            }
        }
        [corners.len(), edges.len(), faces.len(), mesh.cell_count()]
    }

    /// A ball and its parts have the same curved boundary, so the same volume; every edge, face and
    /// cell gets the nodes of its lattice, each once; a facet becomes parts².
    #[test]
    fn parts_fill_the_whole() {
        for element in [Element::Hex8, Element::Hex27] {
            let whole = ball(element, 1.0, [0.0; 3], 0.8, [true, false, false]).unwrap();
            let [v, e, f, c] = counts(&whole);
            assert_eq!(v + f, e + c + 1, "Euler");
            for parts in [2, 3] {
                let divided = whole.subdivided(parts);
                assert_eq!(divided.cell_count(), c * parts.pow(3));
                let between = element.degree() * parts - 1;
                let nodes = v + e * between + f * between.pow(2) + c * between.pow(3);
                assert_eq!(divided.nodes.len(), nodes, "{element:?} {parts}");
                let [v, e, f, c] = counts(&divided);
                assert_eq!(v + f, e + c + 1, "Euler");
                for (side, facets) in &whole.sides {
                    assert_eq!(divided.sides[side].len(), facets.len() * parts * parts);
                }
                let (before, after) = (volume(&whole), sound(&divided));
                assert!((before - after).abs() < 1e-14 * before, "{element:?} {parts}: {before} {after}");
            }
        }
    }

    /// Two halves of every half are four quarters: the same nodes at the same places.
    #[test]
    fn parts_of_parts_are_parts() {
        for element in [Element::Hex8, Element::Hex27] {
            let whole = ball(element, 1.0, [0.0; 3], 1.0, [true; 3]).unwrap();
            let places = |mesh: Mesh| {
                let mut all: Vec<_> = mesh.nodes.of_dimension::<3>().to_vec();
                all.sort_by_key(|x| x.map(|x| (x * 1e12).round() as i64));
                all
            };
            let (twice, once) = (places(whole.subdivided(2).subdivided(2)), places(whole.subdivided(4)));
            assert_eq!(twice.len(), once.len());
            for (a, b) in twice.iter().zip(&once) {
                assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-14), "{a:?} {b:?}");
            }
        }
    }
}
