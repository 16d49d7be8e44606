//! A tetrahedron as `parts`³ tetrahedra. With its corners in some order at (0,0,0), (1,0,0),
//! (1,1,0) and (1,1,1), the lattice of small cubes, each cut along the orders of its directions (H.
//! Freudenthal, Ann. Math. 43 (1942) 580–582), has parts³ tetrahedra in it, and divides each face
//! into the same triangles whatever the order: neighbours agree. The order only chooses the
//! diagonal of the octahedra between the tetrahedra at corners; the shortest of the three is taken,
//! so that cells do not become flat when they are divided again (J. Bey, Computing 55 (1995)
//! 355–378).

use carom_algebra::Vector;

use super::nodes::Nodes;
use crate::mesh::{Facet, Mesh};
use crate::shape::{Shape, lattice};

/// Barycentric coordinates times a whole number.
type Weights = [usize; 4];

/// Even orders of the corners, one per diagonal of the octahedron: from the middle of 0 and the
/// third to that of the second and the fourth.
const ORDERS: [[usize; 4]; 3] = [[0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2]];

/// Paths from the lowest to the highest corner: orders of the directions, even and odd in turn.
const PATHS: [[usize; 3]; 6] = [[0, 1, 2], [1, 0, 2], [1, 2, 0], [2, 1, 0], [2, 0, 1], [0, 2, 1]];

pub(super) fn tetrahedra<const N: usize, S: Shape<3, N>>(mesh: &Mesh, parts: usize) -> Mesh {
    let count = S::DEGREE * parts;
    let weights = |[a, b, c]: [usize; 3]| [S::DEGREE - a - b - c, a, b, c];
    let steps: Vec<Weights> = lattice::<3, N, S>().into_iter().map(weights).collect();
    let children = ORDERS.map(|order| children(parts, order));
    let of = |cell: usize| &children[diagonal(mesh, cell)];
    let mut nodes = Nodes::new(mesh);
    let mut cells = Vec::with_capacity(mesh.cells.len() * parts.pow(3));
    for cell in 0..mesh.cell_count() {
        for child in of(cell) {
            cells.extend(steps.iter().map(|step| {
                let at: Weights =
                    std::array::from_fn(|c| (0..4).map(|q| step[q] * child[q][c]).sum::<usize>());
                let xi = Vector([1, 2, 3].map(|c| at[c] as f64 / count as f64));
                nodes.at(&at, cell, &S::values(&xi))
            }));
        }
    }
    let divided = |facet: &Facet| {
        // The corner of the cell opposite to the facet, which children on the facet do not contain.
        let corner = |c: &usize| !facet.nodes.contains(&mesh.cell(facet.cell)[*c]);
        let opposite = (0..4).find(corner).unwrap_or_default();
        let all = of(facet.cell);
        let mut facets = Vec::with_capacity(parts * parts);
        for (k, child) in all.iter().enumerate() {
            for local in mesh.element.facets() {
                if local[..3].iter().all(|&a| child[a][opposite] == 0) {
                    let cell = facet.cell * all.len() + k;
                    facets.push(Facet { cell, nodes: local.iter().map(|&a| cells[cell * N + a]).collect() });
                }
            }
        }
        facets
    };
    nodes.into_mesh(cells.clone(), divided)
}

/// The six tetrahedra of a small cube around the diagonal from its lowest corner: one for every
/// path along the edges to the highest one.
pub(crate) fn freudenthal(low: [usize; 3]) -> impl Iterator<Item = [[usize; 3]; 4]> {
    PATHS.iter().enumerate().map(move |(k, path)| {
        let mut corners = [low; 4];
        for (step, axis) in path.iter().enumerate() {
            corners[step + 1..].iter_mut().for_each(|corner| corner[*axis] += 1);
        }
        if k % 2 == 1 {
            // Odd orders have negative volume.
            corners.swap(1, 2);
        }
        corners
    })
}

/// Corners of all parts in the whole's weights.
fn children(parts: usize, order: [usize; 4]) -> Vec<[Weights; 4]> {
    let mut all = Vec::with_capacity(parts.pow(3));
    for cube in 0..parts.pow(3) {
        let low = [cube % parts, cube / parts % parts, cube / (parts * parts)];
        for corners in freudenthal(low) {
            if corners.iter().any(|[x, y, z]| y > x || z > y) {
                continue;
            }
            all.push(corners.map(|[x, y, z]| {
                let mut weights = [0; 4];
                for (corner, weight) in order.into_iter().zip([parts - x, x - y, y - z, z]) {
                    weights[corner] = weight;
                }
                weights
            }));
        }
    }
    all
}

/// The order of corners with the shortest diagonal; the first of equal ones.
fn diagonal(mesh: &Mesh, cell: usize) -> usize {
    let x = |corner: usize| &mesh.nodes[mesh.cell(cell)[corner]];
    let length = |order: &[usize; 4]| {
        let [a, b, c, d] = order.map(x);
        (0..3).map(|i| (a[i] + c[i] - b[i] - d[i]).powi(2)).sum::<f64>()
    };
    // Round-off does not choose between equal lengths.
    let lengths = ORDERS.each_ref().map(length);
    let least = lengths.iter().copied().fold(f64::INFINITY, f64::min);
    lengths.iter().position(|l| *l <= least * (1.0 + 1e-9)).unwrap_or_default()
}
