//! Solids that touch along whole faces, as one: where two plane faces of opposite orientation have
//! the same rim, both are inside the union and are left out. They may be divided differently.

use std::collections::{BTreeMap, HashMap};

use crate::triangles::Corners;

/// Distance from its plane, relative to its size, that is round-off of a face in numbers of four
/// bytes.
const PLANE: f64 = 1e-6;

/// An edge of a triangle, in its direction.
type Edge = [usize; 2];

/// Whether each triangle is left out; `nodes`: the vertices of the triangles.
pub(super) fn inner(triangles: &[Corners], nodes: &[[usize; 3]]) -> Vec<bool> {
    let mut at: HashMap<Edge, Vec<usize>> = HashMap::new();
    for (k, corners) in nodes.iter().enumerate() {
        edges(*corners).into_iter().for_each(|edge| at.entry(sorted(edge)).or_default().push(k));
    }
    let mut inner = vec![false; nodes.len()];
    if at.values().all(|there| there.len() <= 2) {
        return inner;
    }
    // Faces by their rims, ascending.
    let mut faces: BTreeMap<Vec<Edge>, Vec<usize>> = BTreeMap::new();
    let mut seen = vec![false; nodes.len()];
    for first in 0..nodes.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let mut face = vec![first];
        let mut rim = Vec::new();
        let mut next = 0;
        while let Some(&k) = face.get(next) {
            next += 1;
            for edge in edges(nodes[k]) {
                let there = &at[&sorted(edge)];
                if there.len() != 2 {
                    rim.push(edge);
                }
                for &other in there.iter().filter(|_| there.len() == 2) {
                    if !std::mem::replace(&mut seen[other], true) {
                        face.push(other);
                    }
                }
            }
        }
        rim.sort_unstable();
        let mut back: Vec<Edge> = rim.iter().map(|[a, b]| [*b, *a]).collect();
        back.sort_unstable();
        if rim.is_empty() || !is_plane(face.iter().map(|&k| &triangles[k])) {
            continue;
        }
        match faces.remove(&back) {
            Some(other) => face.iter().chain(&other).for_each(|&k| inner[k] = true),
            None => {
                faces.insert(rim, face);
            }
        }
    }
    inner
}

fn edges([a, b, c]: [usize; 3]) -> [Edge; 3] {
    [[a, b], [b, c], [c, a]]
}

fn sorted([a, b]: Edge) -> Edge {
    [a.min(b), a.max(b)]
}

/// Whether triangles are in one plane.
fn is_plane<'a>(face: impl Iterator<Item = &'a Corners> + Clone) -> bool {
    let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let normal = |corners: &Corners| {
        let [u, v] = [minus(corners[1], corners[0]), minus(corners[2], corners[0])];
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let area = |corners: &&Corners| dot(normal(corners), normal(corners));
    let Some(largest) = face.clone().max_by(|a, b| area(a).total_cmp(&area(b))) else { return false };
    let n = normal(largest);
    let offsets = face.flatten().map(|corner| minus(*corner, largest[0]));
    let [height, size] = offsets.fold([0.0_f64; 2], |[height, size], offset| {
        [height.max(dot(n, offset).abs()), size.max(dot(offset, offset))]
    });
    height <= PLANE * (dot(n, n) * size).sqrt()
}
