//! The outline of a body as straight pieces, chords in the plane and triangles in space, and how
//! deep a point lies inside: without tree and nearest facet.
//!
//! ```text
//! inside    the outline turns around the point by 2π, or covers 4π of the directions from it
//! depth     the smallest distance to a piece
//! ```

use std::f64::consts::PI;

use carom_algebra::Vector;
use carom_contact::solid_angle;
use carom_solid::{Bounds, FacetShape};

use crate::check::skins::skin_facets;
use crate::model::BodyInstance;

/// Chords of a curved facet in the plane.
const CHORDS: usize = 16;
/// Pieces into which an edge of a curved facet in space is cut, and of one of degree 1 that is not
/// plane.
const CUTS: usize = 8;
const TWISTED: usize = 4;
/// Distance of nodes from a plane facet with straight edges, over its length.
const FLAT: f64 = 1e-9;

/// The pieces of a body's outline at one instant, corners of each in turn, with zeros for the
/// directions that a model does not have.
pub(crate) struct Outline {
    corners: Vec<Vector<3>>,
    of_piece: usize,
    bounds: Bounds,
}

impl Outline {
    /// Of a body at positions `y`, flat over all nodes.
    pub(crate) fn new(part: &BodyInstance, y: &[f64]) -> Self {
        let shape = part.body.mesh().element.facet_shape();
        let d = shape.dimension();
        let mut corners = Vec::new();
        for facet in skin_facets(part) {
            let place = |n: usize| Vector(std::array::from_fn(|i| if i < d { y[d * n + i] } else { 0.0 }));
            let nodes: Vec<Vector<3>> = facet.into_iter().map(place).collect();
            match shape.corners() {
                2 => add_chords(shape, &nodes, &mut corners),
                _ => add_triangles(shape, &nodes, &mut corners),
            }
        }
        let bounds = corners.iter().map(|corner| corner.0).collect();
        Self { corners, of_piece: d, bounds }
    }

    /// Box around all pieces.
    pub(crate) fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Depth of a point inside, 0 outside.
    pub(crate) fn depth(&self, point: [f64; 3]) -> f64 {
        if !self.bounds.contains(&point) {
            return 0.0;
        }
        let point = Vector(point);
        let pieces = || self.corners.chunks_exact(self.of_piece);
        let (inside, nearest) = if self.of_piece == 2 {
            let turn: f64 = pieces().map(|piece| turn(piece[0] - point, piece[1] - point)).sum();
            (turn > PI, pieces().map(|p| to_chord(p[0] - point, p[1] - point)).fold(f64::MAX, f64::min))
        } else {
            let seen = |p: &[Vector<3>]| solid_angle([p[0] - point, p[1] - point, p[2] - point]);
            if pieces().map(seen).sum::<f64>() <= 2.0 * PI {
                return 0.0;
            }
            let away = |p: &[Vector<3>]| to_triangle([p[0] - point, p[1] - point, p[2] - point]);
            (true, pieces().map(away).fold(f64::MAX, f64::min))
        };
        if inside { nearest } else { 0.0 }
    }
}

fn at(shape: FacetShape, nodes: &[Vector<3>], xi: [f64; 2]) -> Vector<3> {
    let values = shape.functions(xi).values;
    nodes.iter().zip(values).fold(Vector::ZERO, |sum, (x, value)| sum + *x * value)
}

fn add_chords(shape: FacetShape, nodes: &[Vector<3>], corners: &mut Vec<Vector<3>>) {
    let steps = if shape.degree() == 1 { 1 } else { CHORDS };
    let place = |k: usize| at(shape, nodes, [2.0 * k as f64 / steps as f64 - 1.0, 0.0]);
    (0..steps).for_each(|k| corners.extend([place(k), place(k + 1)]));
}

/// Triangles with the orientation of the facet, cut in equal parts of its coordinates: neighbours
/// have the same points on their common edge, or it is straight.
fn add_triangles(shape: FacetShape, nodes: &[Vector<3>], corners: &mut Vec<Vector<3>>) {
    let count = if is_flat(shape, nodes) {
        1
    } else if shape.degree() == 1 {
        TWISTED
    } else {
        CUTS
    };
    let is_square = shape.corners() == 4;
    let place = |i: usize, j: usize| {
        let [s, t] = [i, j].map(|k| k as f64 / count as f64);
        at(shape, nodes, if is_square { [2.0 * s - 1.0, 2.0 * t - 1.0] } else { [s, t] })
    };
    for i in 0..count {
        for j in 0..if is_square { count } else { count - i } {
            corners.extend([place(i, j), place(i + 1, j), place(i, j + 1)]);
            if is_square || i + j + 1 < count {
                corners.extend([place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)]);
            }
        }
    }
}

/// Whether a facet is plane with straight edges.
fn is_flat(shape: FacetShape, nodes: &[Vector<3>]) -> bool {
    let count = shape.corners();
    let [a, b] = [nodes[1] - nodes[0], nodes[count - 1] - nodes[0]];
    let size = FLAT * (a.norm() + b.norm());
    let linear = if count == 3 { FacetShape::T3 } else { FacetShape::Q4 };
    let steps = 2 * shape.degree();
    let is_plane = count == 3 || {
        let normal = cross(a, b);
        (nodes[2] - nodes[0]).dot(&normal).abs() <= size * normal.norm()
    };
    is_plane
        && (0..=steps).all(|i| {
            (0..=if count == 3 { steps - i } else { steps }).all(|j| {
                let [s, t] = [i, j].map(|k| k as f64 / steps as f64);
                let xi = if count == 3 { [s, t] } else { [2.0 * s - 1.0, 2.0 * t - 1.0] };
                (at(shape, nodes, xi) - at(linear, &nodes[..count], xi)).norm() <= size
            })
        })
}

fn cross(a: Vector<3>, b: Vector<3>) -> Vector<3> {
    Vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
}

fn turn(a: Vector<3>, b: Vector<3>) -> f64 {
    cross(a, b)[2].atan2(a.dot(&b))
}

/// Distance of the origin to a chord.
fn to_chord(a: Vector<3>, b: Vector<3>) -> f64 {
    let along = b - a;
    let share = -a.dot(&along) / along.dot(&along);
    // A chord without length is a point.
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    (a + along * share).norm()
}

/// Distance of the origin to a triangle: to its plane if it lies over it, else to an edge.
fn to_triangle([a, b, c]: [Vector<3>; 3]) -> f64 {
    let normal = cross(b - a, c - a);
    let over = |p: Vector<3>, q: Vector<3>| cross(p, q).dot(&normal) >= 0.0;
    let size = normal.norm();
    if size > 0.0 && over(a, b) && over(b, c) && over(c, a) {
        return a.dot(&normal).abs() / size;
    }
    to_chord(a, b).min(to_chord(b, c)).min(to_chord(c, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(corners: Vec<Vector<3>>, of_piece: usize) -> Outline {
        let bounds = corners.iter().map(|corner| corner.0).collect();
        Outline { corners, of_piece, bounds }
    }

    #[test]
    fn a_point_is_inside_a_square_or_not() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| Vector([x, y, 0.0]));
        let square = outline((0..4).flat_map(|k| [corners[k], corners[(k + 1) % 4]]).collect(), 2);
        assert!((square.depth([0.3, 1.0, 0.0]) - 0.3).abs() < 1e-15);
        assert_eq!(square.depth([-0.3, 1.0, 0.0]), 0.0);
        assert_eq!(square.depth([2.3, 2.4, 0.0]), 0.0);
    }

    /// A cube of side 2 without what is over a smaller one of its corners' octants: not convex.
    #[test]
    fn a_point_is_inside_a_notched_prism_or_not() {
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let point = |k: usize, z: f64| Vector([l[k][0], l[k][1], z]);
        for shape in [FacetShape::Q4, FacetShape::Q9] {
            let mut corners = Vec::new();
            let mut quad = |c: [Vector<3>; 4]| {
                let bilinear = |xi| at(FacetShape::Q4, &c, xi);
                let inner = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, 0.0]].map(bilinear);
                let nodes = [&c[..], &inner[..]].concat();
                add_triangles(shape, &nodes[..shape.nodes()], &mut corners);
            };
            (0..6).for_each(|k| {
                let next = (k + 1) % 6;
                quad([point(k, 0.0), point(next, 0.0), point(next, 2.0), point(k, 2.0)]);
            });
            for end in [[0, 1, 2, 3], [0, 3, 4, 5]] {
                quad(end.map(|k| point(k, 2.0)));
                quad([3, 2, 1, 0].map(|k| point(end[k], 0.0)));
            }
            let solid = outline(corners, 3);
            assert_eq!(solid.corners.len(), 3 * 2 * 10, "plane facets are not cut");
            assert!((solid.depth([0.9, 1.7, 1.0]) - 0.1).abs() < 1e-14);
            assert!((solid.depth([0.9, 0.9, 1.0]) - 0.02_f64.sqrt()).abs() < 1e-14);
            assert!((solid.depth([0.5, 0.5, 0.2]) - 0.2).abs() < 1e-14);
            for outside in [[1.1, 1.1, 1.0], [1.9, 1.9, 0.1], [0.5, 0.5, -0.1], [3.0, 0.5, 1.0]] {
                assert_eq!(solid.depth(outside), 0.0);
            }
        }
    }

    #[test]
    fn a_twisted_facet_is_cut_and_seen_as_a_whole() {
        // What a bilinear and a curved facet cover, seen from below, is that of a finer cut.
        let angle = |corners: &[Vector<3>]| -> f64 {
            corners.chunks_exact(3).map(|p| solid_angle([p[0], p[1], p[2]])).sum()
        };
        let twisted = [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.4], [1.0, 1.0, 0.8], [-1.0, 1.0, 1.2]].map(Vector);
        let mut corners = Vec::new();
        add_triangles(FacetShape::Q4, &twisted, &mut corners);
        assert_eq!(corners.len(), 3 * 2 * TWISTED * TWISTED);
        let place = |i: i32, j: i32| at(FacetShape::Q4, &twisted, [i, j].map(|k| f64::from(k) / 50.0 - 1.0));
        let fine = (0..100).flat_map(|i| {
            (0..100)
                .flat_map(move |j| [(i, j), (i + 1, j), (i, j + 1), (i + 1, j), (i + 1, j + 1), (i, j + 1)])
        });
        let fine: Vec<_> = fine.map(|(i, j)| place(i, j)).collect();
        assert!((angle(&corners) - angle(&fine)).abs() < 1e-2, "{} {}", angle(&corners), angle(&fine));
        // A sixth of all directions through the face of a cube.
        let face = [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]].map(Vector);
        let mut corners = Vec::new();
        add_triangles(FacetShape::Q4, &face, &mut corners);
        assert!((angle(&corners) - 4.0 * PI / 6.0).abs() < 1e-14);
    }
}
