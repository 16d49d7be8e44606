//! A rigid triangulated surface: faces, edges and vertices, of which the nearest one to a point
//! gives its distance.
//!
//! ```text
//! face      g = (x − a)·n          ∇²g = 0
//! edge      g = |(1 − t tᵀ)(x − a)|   ∇²g = (1 − n nᵀ − t tᵀ)/g
//! vertex    g = |x − a|            ∇²g = (1 − n nᵀ)/g
//! ```
//!
//! A point is inside where it lies behind the nearest point of the surface; on edges and vertices
//! the angle-weighted normal says so (Bærentzen and Aanæs, 2005). Beyond a rim it is outside. A
//! point inside belongs to a face: an edge or a vertex has no normal there. A node in contact keeps
//! its face, and goes across edges as at the corners of a polyline.
//!
//! Pieces are numbered: faces, then edges, then vertices.

use std::collections::HashMap;
use std::sync::Arc;

use carom_solid::{Bounds, Tree, Triangles};

use super::corner::AtCorner;
use super::near::{Entry, Near, Point, Tip, around, cross, distance, dot, minus};
use crate::constants::{KINK, ROUND_OFF};
use crate::kinematics::space::Feature;

/// A rigid triangulated surface: triangles with their normals and a hierarchy of bounding boxes.
#[derive(Clone, Debug)]
pub struct Faceted(Arc<Surface>);

#[derive(Debug)]
struct Surface {
    triangles: Triangles,
    /// Normals of all pieces: unit normals of faces, their sums at edges, their sums weighted with
    /// angles at vertices.
    normals: Vec<Point>,
    edges: Vec<Edge>,
    /// Numbers of the three edges of every face.
    edges_of: Vec<[usize; 3]>,
    /// For every vertex, one of its faces and whether the vertex is on a rim.
    corners: Vec<(usize, bool)>,
    tree: Tree,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    start: Point,
    along: Point,
    faces: [usize; 2],
    is_rim: bool,
}

impl Faceted {
    /// The rigid surface that triangles form.
    pub fn new(triangles: Triangles) -> Self {
        let points = triangles.points();
        let faces = triangles.corners().len();
        let unit = |v: Point| v.map(|x| x / dot(v, v).sqrt());
        let normal = |nodes: &[usize; 3]| {
            let [a, b, c] = nodes.map(|node| points[node]);
            unit(cross(minus(b, a), minus(c, a)))
        };
        let mut normals: Vec<Point> = triangles.corners().iter().map(normal).collect();
        let mut edges = Vec::new();
        let mut edges_of = vec![[0; 3]; faces];
        let mut number = HashMap::new();
        let mut of_vertices = vec![[0.0; 3]; points.len()];
        let mut corners = vec![(0, false); points.len()];
        for face in 0..faces {
            for edge in 0..3 {
                let [a, b] = triangles.edge(face, edge);
                let other = triangles.across(face, edge);
                edges_of[face][edge] = *number.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    let along = unit(minus(points[b], points[a]));
                    let faces = [face, other.unwrap_or(face)];
                    edges.push(Edge { start: points[a], along, faces, is_rim: other.is_none() });
                    edges.len() - 1
                });
                let c = triangles.edge(face, (edge + 1) % 3)[1];
                let out = minus(points[b], points[a]);
                let back = minus(points[c], points[a]);
                let turn = cross(out, back);
                let angle = dot(turn, turn).sqrt().atan2(dot(out, back));
                (0..3).for_each(|i| of_vertices[a][i] += angle * normals[face][i]);
                corners[a].0 = face;
                for end in [a, b] {
                    corners[end].1 |= other.is_none();
                }
            }
        }
        let sums = |edge: &Edge| {
            let [one, two] = edge.faces.map(|face| normals[face]);
            std::array::from_fn(|i| one[i] + two[i])
        };
        let of_edges: Vec<Point> = edges.iter().map(sums).collect();
        normals.extend(of_edges);
        normals.extend(of_vertices);
        let tree = Tree::new(faces, |face| {
            let mut bounds = Bounds::EMPTY;
            triangles.corners()[face].iter().for_each(|&node| bounds.add(&points[node]));
            bounds
        });
        Self(Arc::new(Surface { triangles, normals, edges, edges_of, corners, tree }))
    }

    /// Points of the sharp convex edges, their ends among them.
    pub(crate) fn tips(&self, spacing: f64) -> Vec<Tip> {
        let surface = &*self.0;
        let points = surface.triangles.points();
        let mut tips = Vec::new();
        for (face, edge) in (0..surface.faces()).flat_map(|face| [0, 1, 2].map(|edge| (face, edge))) {
            let is_sharp = surface.triangles.across(face, edge).is_some_and(|next| {
                let turn = dot(surface.normals[face], surface.normals[next]);
                face < next && turn < KINK.cosine && surface.is_convex(face, edge)
            });
            if !is_sharp {
                continue;
            }
            let [a, b] = surface.triangles.edge(face, edge).map(|node| points[node]);
            let pieces = (distance(a, b) / spacing).ceil().max(1.0);
            tips.extend((0..=pieces as usize).map(|k| {
                let share = k as f64 / pieces;
                let center = std::array::from_fn(|i| a[i] + share * (b[i] - a[i]));
                Tip { center, radius: 0.0, size: 0.0, normals: None }
            }));
        }
        tips
    }

    /// Number of pieces of the surface: faces, edges and vertices.
    pub(in super::super) fn pieces(&self) -> usize {
        self.0.normals.len()
    }

    /// The piece of the surface closest to a point, searched from a piece near it if one is known;
    /// always a face for a point inside.
    pub(in super::super) fn nearest(&self, at: Point, from: Option<usize>) -> usize {
        let from = from.map(|piece| self.0.face(piece));
        let Some((face, _)) = self.0.tree.nearest(&at, from, |face| Some(self.0.closest(face, at).1)) else {
            return 0;
        };
        let (feature, away, closest) = self.0.closest(face, at);
        let (piece, is_rim) = self.0.piece(face, feature);
        let outward = dot(minus(at, closest), self.0.normals[piece]) >= 0.0;
        if away > 0.0 && (outward || is_rim) { piece } else { self.followed(piece, at) }
    }

    /// The faces within a distance of a point over or under which it lies, to within a distance
    /// `past` their edges; in ascending order.
    pub(in super::super) fn over(&self, at: Point, within: f64, past: f64) -> Vec<usize> {
        let surface = &*self.0;
        let is_over = |face: &usize| {
            let height = surface.height(*face, at);
            let foot = std::array::from_fn(|i| at[i] - height * surface.normals[*face][i]);
            surface.closest(*face, foot).1 <= past
        };
        let bounds = Bounds::of(&at).grown(within);
        let mut faces: Vec<usize> = surface.tree.meeting(&bounds).filter(is_over).collect();
        faces.sort_unstable();
        faces
    }

    /// Signed distance from a piece of the surface to a point, with its derivatives.
    pub(in super::super) fn near(&self, piece: usize, at: Point) -> Option<Near> {
        let Surface { triangles, edges, normals, .. } = &*self.0;
        let faces = triangles.corners();
        let points = triangles.points();
        if let Some(nodes) = faces.get(piece) {
            let normal = normals[piece];
            return Some(Near::flat(dot(minus(at, points[nodes[0]]), normal), normal));
        }
        match edges.get(piece - faces.len()) {
            Some(Edge { start, along, .. }) => around(minus(at, *start), *along, 0.0, 1.0),
            None => around(minus(at, points[piece - faces.len() - edges.len()]), [0.0; 3], 0.0, 1.0),
        }
    }

    /// The face on which the gap of a node in contact with a piece is measured.
    pub(in super::super) fn followed(&self, piece: usize, at: Point) -> usize {
        match piece.checked_sub(self.0.faces()) {
            None => piece,
            Some(edge) => self.0.steepest(edge, at),
        }
    }

    /// The faces at the corners of a face that rise in front of it, behind which a point lies, and
    /// which it is over or as near to as to the face.
    pub(in super::super) fn walls(&self, face: usize, at: Point) -> Vec<usize> {
        let surface = &*self.0;
        let away = surface.closest(face, at).1;
        let is_wall = |&wall: &usize| {
            let is_near = || {
                surface.beyond(wall, at).is_none() || surface.closest(wall, at).1 <= (1.0 + ROUND_OFF) * away
            };
            let rises = || surface.rises(face, wall) && surface.rises(wall, face);
            surface.height(wall, at) < 0.0 && is_near() && rises()
        };
        let around = surface.triangles.corners()[face].iter();
        around.flat_map(|&node| surface.triangles.fan(face, node)).filter(is_wall).collect()
    }

    /// The next piece of a node in contact with a face, which may lie beyond the edges of that
    /// face.
    pub(in super::super) fn at_corner(&self, face: usize, at: Point) -> AtCorner {
        let surface = &*self.0;
        let is_blunt = |next: usize| dot(surface.normals[face], surface.normals[next]) >= KINK.cosine;
        for edge in 0..3 {
            // In a blunt groove the deeper wall constrains it; in a sharp one both do (`walls`).
            if let Some(next) = surface.triangles.across(face, edge)
                && !surface.is_convex(face, edge)
                && is_blunt(next)
                && surface.height(next, at) < surface.height(face, at)
                && surface.beyond(next, at).is_none()
            {
                return AtCorner::Goes(next);
            }
        }
        let mut visited = vec![face];
        let mut here = face;
        while let Some(edge) = surface.beyond(here, at) {
            let Some(next) = surface.triangles.across(here, edge) else { return AtCorner::Leaves };
            let turn = dot(surface.normals[here], surface.normals[next]);
            if turn < KINK.cosine {
                if surface.is_convex(here, edge) {
                    return AtCorner::Leaves;
                }
                break;
            }
            // Between the normals of two faces it stays on that from which it came.
            if let Some(known) = visited.iter().position(|&face| face == next) {
                here = if known + 2 == visited.len() { next } else { here };
                break;
            }
            visited.push(next);
            here = next;
        }
        if here == face { AtCorner::Stays } else { AtCorner::Goes(here) }
    }

    /// Where a point on a straight path first enters through a face; of faces at the same instant
    /// the one with the lowest number.
    pub(in super::super) fn entered(&self, before: Point, now: Point) -> Option<Entry> {
        let surface = &*self.0;
        let mut path = Bounds::of(&before);
        path.add(&now);
        let mut first: Option<Entry> = None;
        for face in surface.tree.meeting(&path) {
            let [from, to] = [before, now].map(|at| surface.height(face, at));
            if from < 0.0 || to >= 0.0 {
                continue;
            }
            let theta = from / (from - to);
            let at = std::array::from_fn(|i| before[i] + theta * (now[i] - before[i]));
            let earlier = |first: Entry| theta < first.theta || theta == first.theta && face < first.piece;
            if surface.beyond(face, at).is_none() && first.is_none_or(earlier) {
                first = Some(Entry { theta, piece: face });
            }
        }
        first
    }
}

impl Surface {
    fn faces(&self) -> usize {
        self.triangles.corners().len()
    }

    /// A face that contains a piece: the face itself, or one at an edge or vertex.
    fn face(&self, piece: usize) -> usize {
        match piece.checked_sub(self.faces()) {
            None => piece,
            Some(edge) if edge < self.edges.len() => self.edges[edge].faces[0],
            Some(other) => self.corners[other - self.edges.len()].0,
        }
    }

    /// Number of the piece that is the inside, an edge or a corner of a face, and whether it lies
    /// on a rim.
    fn piece(&self, face: usize, feature: Feature) -> (usize, bool) {
        match feature {
            Feature::Inside => (face, false),
            Feature::Edge(edge) => {
                let edge = self.edges_of[face][edge];
                (self.faces() + edge, self.edges[edge].is_rim)
            }
            Feature::Corner(corner) => {
                let node = self.triangles.corners()[face][corner];
                (self.faces() + self.edges.len() + node, self.corners[node].1)
            }
        }
    }

    /// Signed distance of a point from the plane of a face.
    fn height(&self, face: usize, at: Point) -> f64 {
        let start = self.triangles.points()[self.triangles.corners()[face][0]];
        dot(minus(at, start), self.normals[face])
    }

    /// Whether the surface is convex at an edge of a face.
    fn is_convex(&self, face: usize, edge: usize) -> bool {
        let Some(next) = self.triangles.across(face, edge) else { return true };
        let ends = self.triangles.edge(face, edge);
        let apex = self.triangles.corners()[next].iter().find(|node| !ends.contains(node));
        apex.is_none_or(|&node| self.height(face, self.triangles.points()[node]) <= 0.0)
    }

    /// Whether the middle of `face` lies in front of the face `behind`.
    fn rises(&self, behind: usize, face: usize) -> bool {
        let points = self.triangles.points();
        self.triangles.corners()[face].iter().map(|&node| self.height(behind, points[node])).sum::<f64>()
            > 0.0
    }

    /// The edge of a face beyond which a point lies furthest, if any.
    fn beyond(&self, face: usize, at: Point) -> Option<usize> {
        let points = self.triangles.points();
        let height = |edge: usize, at: Point| {
            let [a, b] = self.triangles.edge(face, edge).map(|node| points[node]);
            dot(cross(self.normals[face], minus(b, a)), minus(at, a))
        };
        let share = |edge: usize| {
            let apex = self.triangles.edge(face, (edge + 1) % 3)[1];
            height(edge, at) / height(edge, points[apex])
        };
        let shares = [0, 1, 2].map(share);
        let least = (1..3).fold(0, |least, edge| if shares[edge] < shares[least] { edge } else { least });
        (shares[least] < -ROUND_OFF).then_some(least)
    }

    /// The face that a point behind an edge or a vertex sees most directly, of those that meet
    /// there; vertices are numbered after edges.
    fn steepest(&self, edge: usize, at: Point) -> usize {
        let order = |a: &usize, b: &usize| self.height(*a, at).total_cmp(&self.height(*b, at)).then(a.cmp(b));
        let faces = if let Some(edge) = self.edges.get(edge) {
            edge.faces.to_vec()
        } else {
            let node = edge - self.edges.len();
            self.triangles.fan(self.corners[node].0, node)
        };
        faces.into_iter().min_by(order).unwrap_or(0)
    }

    /// The feature of a face that is nearest to a point, their distance, and the nearest point
    /// (Ericson, Real-Time Collision Detection, §5.1.5).
    fn closest(&self, face: usize, at: Point) -> (Feature, f64, Point) {
        let [a, b, c] = self.triangles.corners()[face].map(|node| self.triangles.points()[node]);
        let ab = minus(b, a);
        let ac = minus(c, a);
        let on = |from: Point, along: Point, share: f64| -> Point {
            std::array::from_fn(|i| from[i] + share * along[i])
        };
        let found = |feature: Feature, point: Point| (feature, distance(point, at), point);
        let slopes = |from: Point| {
            let arm = minus(at, from);
            (dot(ab, arm), dot(ac, arm))
        };
        let (d1, d2) = slopes(a);
        if d1 <= 0.0 && d2 <= 0.0 {
            return found(Feature::Corner(0), a);
        }
        let (d3, d4) = slopes(b);
        if d3 >= 0.0 && d4 <= d3 {
            return found(Feature::Corner(1), b);
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return found(Feature::Edge(0), on(a, ab, d1 / (d1 - d3)));
        }
        let (d5, d6) = slopes(c);
        if d6 >= 0.0 && d5 <= d6 {
            return found(Feature::Corner(2), c);
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return found(Feature::Edge(2), on(a, ac, d2 / (d2 - d6)));
        }
        let va = d3 * d6 - d5 * d4;
        if va <= 0.0 && d4 >= d3 && d5 >= d6 {
            return found(Feature::Edge(1), on(b, minus(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6))));
        }
        // The foot of the perpendicular: exact in a plane of which this is a part.
        let height = self.height(face, at);
        let foot = on(at, self.normals[face], -height);
        (Feature::Inside, height.abs(), foot)
    }
}
