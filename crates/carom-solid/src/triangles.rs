//! Surfaces of plane triangles in space, as rigid tools have them: oriented, with at most two
//! triangles at an edge and one fan at a vertex. Closed, or open with a rim.

use std::collections::HashMap;

/// The corners of a triangle.
pub(crate) type Corners = [[f64; 3]; 3];

/// A triangulated surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangles {
    points: Vec<[f64; 3]>,
    corners: Vec<[usize; 3]>,
    across: Vec<[Option<usize>; 3]>,
    inner: usize,
}

/// Why triangles are not a surface; they are numbered from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum TrianglesError {
    #[error("there are no triangles")]
    Empty,
    #[error("triangle {triangle} has no area; a corner of it is at {at:.6?}")]
    Flat { triangle: usize, at: [f64; 3] },
    #[error("the triangles {first}, {second} and {third} meet at one edge, at {at:.6?}")]
    Crowded { first: usize, second: usize, third: usize, at: [f64; 3] },
    #[error(
        "the triangles {first} and {second} are oriented in opposite ways: both run along their common edge at {at:.6?} in the same direction"
    )]
    Opposed { first: usize, second: usize, at: [f64; 3] },
    #[error("the surface touches itself at the corner {at:.6?} of triangle {triangle}")]
    Pinched { triangle: usize, at: [f64; 3] },
}

/// Height over longest edge below which a triangle has no normal.
const FLAT: f64 = 1e-7;

impl Triangles {
    /// Triangles by their corners, counter-clockwise as seen from outside.
    ///
    /// # Errors
    /// No triangles; one without area; more than two at an edge, or two of opposite orientation;
    /// several fans at a vertex.
    ///
    /// # Panics
    /// If a corner is not among the points.
    pub fn new(points: Vec<[f64; 3]>, corners: Vec<[usize; 3]>) -> Result<Self, TrianglesError> {
        if corners.is_empty() {
            return Err(TrianglesError::Empty);
        }
        for (k, nodes) in corners.iter().enumerate() {
            let [a, b, c] = nodes.map(|n| points[n]);
            let area = length(cross(minus(b, a), minus(c, a)));
            let longest =
                [(a, b), (b, c), (c, a)].map(|(p, q)| length(minus(p, q))).into_iter().fold(0.0, f64::max);
            if area.is_nan() || area <= FLAT * longest * longest {
                return Err(TrianglesError::Flat { triangle: k + 1, at: a });
            }
        }
        // Triangles at the edge from its lower to its higher end, with the edge's place in each.
        let mut edges: HashMap<[usize; 2], Vec<(usize, usize)>> = HashMap::new();
        let mut across = vec![[None; 3]; corners.len()];
        for (k, nodes) in corners.iter().enumerate() {
            for edge in 0..3 {
                let [a, b] = [nodes[edge], nodes[(edge + 1) % 3]];
                let at = std::array::from_fn(|i| 0.5 * (points[a][i] + points[b][i]));
                let there = edges.entry([a.min(b), a.max(b)]).or_default();
                if let [(first, _), (second, _)] = there[..] {
                    let [first, second, third] = [first, second, k].map(|k| k + 1);
                    return Err(TrianglesError::Crowded { first, second, third, at });
                }
                if let [(other, place)] = there[..] {
                    if corners[other][place] == a {
                        return Err(TrianglesError::Opposed { first: other + 1, second: k + 1, at });
                    }
                    (across[k][edge], across[other][place]) = (Some(other), Some(k));
                }
                there.push((k, edge));
            }
        }
        let surface = Self { points, corners, across, inner: 0 };
        surface.pinched().map_or(Ok(surface), Err)
    }

    /// The same surface, from which so many triangles inside were left out.
    pub(crate) fn without(self, inner: usize) -> Self {
        Self { inner, ..self }
    }

    /// Triangles between touching solids, which were left out.
    pub fn inner(&self) -> usize {
        self.inner
    }

    /// A vertex at which several fans meet.
    fn pinched(&self) -> Option<TrianglesError> {
        let mut counts = vec![0_usize; self.points.len()];
        self.corners.iter().flatten().for_each(|&node| counts[node] += 1);
        let mut seen = vec![false; self.points.len()];
        for (k, nodes) in self.corners.iter().enumerate() {
            for &node in nodes {
                if !std::mem::replace(&mut seen[node], true) && self.fan(k, node).len() != counts[node] {
                    return Some(TrianglesError::Pinched { triangle: k + 1, at: self.points[node] });
                }
            }
        }
        None
    }

    /// The triangles around a corner of one of them: connected across edges.
    pub fn fan(&self, triangle: usize, node: usize) -> Vec<usize> {
        let mut fan = vec![triangle];
        let mut next = 0;
        while let Some(&k) = fan.get(next) {
            next += 1;
            for edge in (0..3).filter(|&edge| self.edge(k, edge).contains(&node)) {
                fan.extend(self.across[k][edge].filter(|other| !fan.contains(other)));
            }
        }
        fan
    }

    /// The vertices.
    pub fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// The corners of every triangle.
    pub fn corners(&self) -> &[[usize; 3]] {
        &self.corners
    }

    /// Vertices of an edge of a triangle: from its corner of this number to the next.
    pub fn edge(&self, triangle: usize, edge: usize) -> [usize; 2] {
        let nodes = self.corners[triangle];
        [nodes[edge], nodes[(edge + 1) % 3]]
    }

    /// The triangle across an edge; none at a rim.
    pub fn across(&self, triangle: usize, edge: usize) -> Option<usize> {
        self.across[triangle][edge]
    }

    /// Number of edges with a triangle on one side only.
    pub fn rim(&self) -> usize {
        self.across.iter().flatten().filter(|across| across.is_none()).count()
    }

    /// The edges that show the surface in a drawing, at most so many: its rim, then those at which
    /// it has the sharpest kinks. Edges within a plane are none of them.
    pub fn outline(&self, most: usize) -> Vec<[[f64; 3]; 2]> {
        let normal = |triangle: usize| {
            let [a, b, c] = self.corners[triangle].map(|node| self.points[node]);
            let n = cross(minus(b, a), minus(c, a));
            n.map(|x| x / length(n))
        };
        let mut found = Vec::new();
        for triangle in 0..self.corners.len() {
            for edge in 0..3 {
                let kink = match self.across(triangle, edge) {
                    None => f64::INFINITY,
                    // Each edge once.
                    Some(other) if other < triangle => continue,
                    Some(other) => length(minus(normal(triangle), normal(other))),
                };
                if kink > FLAT {
                    found.push((kink, self.edge(triangle, edge).map(|node| self.points[node])));
                }
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.into_iter().take(most).map(|(_, ends)| ends).collect()
    }

    /// The same surface with coordinates times a factor > 0, and with the other orientation if it
    /// is `reversed`.
    #[must_use]
    pub fn placed(mut self, factor: f64, reversed: bool) -> Self {
        self.points.iter_mut().flatten().for_each(|x| *x *= factor);
        if reversed {
            self.corners.iter_mut().for_each(|nodes| nodes.swap(1, 2));
            // The edges 0, 1, 2 are now 2, 1, 0.
            self.across.iter_mut().for_each(|across| across.swap(0, 2));
        }
        self
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn length(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}
