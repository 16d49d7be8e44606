//! The skin of bodies of tetrahedra and hexahedra: the faces that belong to one cell only. Faces of
//! hexahedra are two triangles each, through the same nodes.

use std::collections::HashMap;

use carom_record::{Block, Cell, FieldSet};

use crate::bodies;

/// A point or vector in space.
pub(crate) type Place = [f64; 3];

/// A face of a cell, or half of one: a Lagrange triangle, counterclockwise seen from outside, nodes
/// in VTK's order.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Facet {
    pub(crate) degree: usize,
    pub(crate) nodes: Vec<usize>,
    /// Whether each side is an edge of the cell.
    pub(crate) sides: [bool; 3],
    /// Corners of the face, in ascending order.
    pub(crate) face: Vec<usize>,
    /// Number of its block.
    pub(crate) block: usize,
}

/// Corners of VTK's edges and faces of a tetrahedron; faces counterclockwise from outside, in the
/// order in which VTK numbers their nodes.
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
const FACES: [[usize; 3]; 4] = [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]];

/// Face `f` of a tetrahedron.
fn face(degree: usize, cell: &[usize], f: usize) -> Vec<usize> {
    let inner = degree - 1;
    let corners = FACES[f];
    let mut nodes: Vec<usize> = corners.iter().map(|&c| cell[c]).collect();
    for e in 0..3 {
        let a = corners[e];
        let b = corners[(e + 1) % 3];
        for (k, &[from, to]) in EDGES.iter().enumerate() {
            let on_edge = &cell[4 + k * inner..4 + (k + 1) * inner];
            if (from, to) == (a, b) {
                nodes.extend(on_edge);
            } else if (from, to) == (b, a) {
                nodes.extend(on_edge.iter().rev());
            }
        }
    }
    if degree == 3 {
        nodes.push(cell[16 + f]);
    }
    nodes
}

/// Faces of a hexahedron, counterclockwise from outside: corners, edges, centre.
const CUBE: [[usize; 9]; 6] = [
    [0, 4, 7, 3, 16, 15, 19, 11, 20],
    [1, 2, 6, 5, 9, 18, 13, 17, 21],
    [0, 1, 5, 4, 8, 17, 12, 16, 22],
    [3, 7, 6, 2, 19, 14, 18, 10, 23],
    [0, 3, 2, 1, 11, 10, 9, 8, 24],
    [4, 5, 6, 7, 12, 13, 14, 15, 25],
];
/// The nodes of a face of nine nodes in its two halves, and which of their sides are edges.
const HALVES: [([usize; 6], [bool; 3]); 2] =
    [([0, 1, 2, 4, 5, 8], [true, true, false]), ([0, 2, 3, 8, 6, 7], [false, true, true])];

/// Corners of a face with these nodes, in ascending order: a face has three, or four if it has four
/// or nine nodes.
pub(crate) fn corners(nodes: &[usize]) -> Vec<usize> {
    let mut corners = nodes[..bodies::corners(nodes)].to_vec();
    corners.sort_unstable();
    corners
}

/// The faces of a cell, with all their nodes.
fn faces(kind: Cell, degree: usize, cell: &[usize]) -> Vec<Vec<usize>> {
    match kind {
        Cell::Tetrahedron => (0..4).map(|f| face(degree, cell, f)).collect(),
        Cell::Hexahedron => {
            let count = if degree == 1 { 4 } else { 9 };
            CUBE.iter().map(|face| face[..count].iter().map(|&k| cell[k]).collect()).collect()
        }
        Cell::Curve | Cell::Triangle | Cell::Quadrilateral => Vec::new(),
    }
}

/// The facets of all bodies, body after body.
pub(crate) fn skin(fields: &FieldSet) -> Vec<Facet> {
    fields.blocks.iter().enumerate().flat_map(|(k, block)| of_block(k, block)).collect()
}

fn of_block(number: usize, block: &Block) -> Vec<Facet> {
    let mut once: HashMap<Vec<usize>, bool> = HashMap::new();
    let faces = || block.cells().flat_map(|cell| faces(block.cell, block.degree, cell));
    for face in faces() {
        once.entry(corners(&face)).and_modify(|once| *once = false).or_insert(true);
    }
    let mut facets = Vec::new();
    for nodes in faces() {
        let face = corners(&nodes);
        if !once[&face] {
            continue;
        }
        let degree = block.degree;
        if face.len() == 3 {
            facets.push(Facet { degree, nodes, sides: [true; 3], face, block: number });
            continue;
        }
        for (half, sides) in HALVES {
            let half = half[..if degree == 1 { 3 } else { 6 }].iter().map(|&k| nodes[k]).collect();
            facets.push(Facet { degree, nodes: half, sides, face: face.clone(), block: number });
        }
    }
    facets
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use carom_record::PointArray;

    /// Lagrange tetrahedra of a degree in a box of `n` cubes per side (six tetrahedra per cube),
    /// mapped into space.
    pub(crate) fn solid(degree: usize, n: usize, map: impl Fn(Place) -> Place) -> FieldSet {
        let side = degree * n + 1;
        let number = |p: [usize; 3]| p[0] + side * (p[1] + side * p[2]);
        let mut connectivity = Vec::new();
        let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
        for (cube, order) in (0..n * n * n).flat_map(|c| orders.iter().map(move |o| (c, o))) {
            let mut corner = [cube % n, cube / n % n, cube / (n * n)].map(|i| i * degree);
            let mut corners = vec![corner];
            for &axis in order {
                corner[axis] += degree;
                corners.push(corner);
            }
            if orders.iter().position(|o| o == order).unwrap() > 2 {
                corners.swap(1, 2);
            }
            let between = |weights: [usize; 4]| {
                let sum = |d: usize| (0..4).map(|c| weights[c] * corners[c][d]).sum::<usize>() / degree;
                number([0, 1, 2].map(sum))
            };
            let mut at = |list: &[(usize, usize)]| {
                let mut weights = [0; 4];
                list.iter().for_each(|&(c, w)| weights[c] += w);
                connectivity.push(between(weights));
            };
            (0..4).for_each(|c| at(&[(c, degree)]));
            for [a, b] in EDGES {
                (1..degree).for_each(|i| at(&[(a, degree - i), (b, i)]));
            }
            if degree == 3 {
                FACES.iter().for_each(|f| at(&f.map(|c| (c, 1))));
            }
        }
        let place =
            |k: usize| [k % side, k / side % side, k / (side * side)].map(|i| i as f64 / (side - 1) as f64);
        let points: Vec<Place> = (0..side.pow(3)).map(|k| map(place(k))).collect();
        let array = |name: &str, unit: &str, components: usize| PointArray {
            name: name.into(),
            unit: unit.into(),
            components,
            values: vec![0.0; components * points.len()],
        };
        FieldSet {
            arrays: vec![array("displacement", "m", 3), array("stress", "Pa", 6)],
            blocks: vec![Block { body: "solid".into(), cell: Cell::Tetrahedron, degree, connectivity }],
            points,
            ..FieldSet::default()
        }
    }

    /// The flux of x through the skin is three times the volume; facets meet along every edge, and
    /// their nodes lie where a Lagrange triangle has them.
    #[test]
    fn the_skin_is_closed_and_turned_outwards() {
        for degree in 1..=3 {
            let fields = solid(degree, 2, |[x, y, z]| [2.0 * x + 0.1 * y, 3.0 * y, 0.5 * z - 0.2 * x]);
            let skin = skin(&fields);
            assert_eq!(skin.len(), 6 * 4 * 2);
            let mut flux = 0.0;
            let mut edges = HashMap::new();
            for facet in &skin {
                let at = |k: usize| fields.points[facet.nodes[k]];
                let [a, b, c] = [at(0), at(1), at(2)];
                flux += 0.5
                    * (0..3)
                        .map(|d| {
                            let [i, j] = [(d + 1) % 3, (d + 2) % 3];
                            a[d] * ((b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]))
                        })
                        .sum::<f64>();
                for e in 0..3 {
                    *edges.entry((facet.nodes[e], facet.nodes[(e + 1) % 3])).or_insert(0) += 1;
                    for i in 1..degree {
                        let s = i as f64 / degree as f64;
                        let node = at(3 + e * (degree - 1) + i - 1);
                        let line = |d: usize| at(e)[d] + s * (at((e + 1) % 3)[d] - at(e)[d]);
                        assert!((0..3).all(|d| (node[d] - line(d)).abs() < 1e-12));
                    }
                }
                if degree == 3 {
                    assert!((0..3).all(|d| (at(9)[d] - (a[d] + b[d] + c[d]) / 3.0).abs() < 1e-12));
                }
            }
            // The determinant of the map, which is not affine in the last row alone: 2·3·0.5.
            assert!((flux / 3.0 - 3.0).abs() < 1e-12, "{flux}");
            assert!(edges.iter().all(|(&(a, b), &n)| n == 1 && edges[&(b, a)] == 1));
        }
    }

    /// The skin of two hexahedra in a row: ten faces, without those between them, and each edge of
    /// a cell twice.
    #[test]
    fn faces_of_hexahedra_are_two_triangles() {
        let points: Vec<Place> = (0..12)
            .map(|k| [k / 4, k % 4 / 2, k % 2].map(f64::from))
            .map(|[x, y, z]| [2.0 * x, y, z])
            .collect();
        let cell = |x: usize| [0, 4, 6, 2, 1, 5, 7, 3].map(|k| k + 4 * x);
        let connectivity = [cell(0), cell(1)].concat();
        let block = Block { body: "bar".into(), cell: Cell::Hexahedron, degree: 1, connectivity };
        let fields = FieldSet { points, blocks: vec![block], arrays: Vec::new(), ..FieldSet::default() };
        let skin = skin(&fields);
        assert_eq!(skin.len(), 20);
        let mut edges: HashMap<[usize; 2], usize> = HashMap::new();
        let mut flux = 0.0;
        for facet in &skin {
            let [a, b, c] = [0, 1, 2].map(|k| fields.points[facet.nodes[k]]);
            flux += 0.5 * a[0] * ((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]));
            for e in (0..3).filter(|&e| facet.sides[e]) {
                let p = facet.nodes[e];
                let q = facet.nodes[(e + 1) % 3];
                *edges.entry([p.min(q), p.max(q)]).or_insert(0) += 1;
            }
        }
        // The volume, by the flux of (x, 0, 0).
        assert!((flux - 4.0).abs() < 1e-14);
        assert!(edges.len() == 20 && edges.values().all(|n| *n == 2));
        // The halves of a face of nine nodes share its diagonal.
        let [(first, _), (second, _)] = HALVES;
        assert_eq!([first[2], first[5], first[0]], [second[1], second[3], second[0]]);
    }
}
