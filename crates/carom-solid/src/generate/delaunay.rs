//! Delaunay triangulation of given size inside an outline.
//!
//! Ruppert's refinement (J. Algorithms 18 (1995) 548–585; the crate `spade`) makes the outline's
//! features at angles of at least 26°: it may divide sides further. Triangles whose circumcircle is
//! too large for h then get its centre as a node, worst first (S. Rebay, J. Comput. Phys. 106
//! (1993) 125–138), and inner nodes move to the mean of their neighbours while the smallest angle
//! grows. Nothing iterates over a hash: the same outline gives the same mesh.

use spade::handles::FixedFaceHandle;
use spade::handles::InnerTag;
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, Point2, PositionInTriangulation, RefinementParameters,
};
use spade::{InsertionError, Triangulation};

use super::MeshError;
use super::elevate::{Side, Skeleton};

type Cdt = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// Smallest angle requested, in degrees, where the outline's own angles allow it.
const ANGLE: f64 = 26.0;
/// Circumradius over h above which a triangle is divided; 0.577 for an equilateral one with edges
/// h.
const LARGE: f64 = 0.72;
/// Rounds of smoothing.
const ROUNDS: usize = 12;

/// Corners of a polygon and the points between them on each side.
pub(super) struct Outline {
    pub(super) corners: Vec<[f64; 2]>,
    pub(super) sides: Vec<Vec<[f64; 2]>>,
    pub(super) clockwise: bool,
}

/// Triangulates an outline with edges of about `length`; sides are `side1` and so on.
pub(super) fn fill(outline: &Outline, length: &dyn Fn(&[f64; 2]) -> f64) -> Result<Skeleton, MeshError> {
    let failed = |_: InsertionError| MeshError::Angles { angle: ANGLE };
    let mut cdt = outline.triangulated().map_err(failed)?;
    let limit = RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(ANGLE))
        .with_max_additional_vertices(1000 + 100 * cdt.num_vertices());
    if !cdt.refine(limit).refinement_complete {
        return Err(MeshError::Angles { angle: ANGLE });
    }
    divide(&mut cdt, length).map_err(failed)?;
    let sides = outline.walks(&cdt);
    let mut points = positions(&cdt);
    let mut triangles = inside(&cdt);
    let mut best = smallest_angle(&points, &triangles);
    let fixed: Vec<usize> = sides.iter().flatten().flatten().copied().collect();
    let mut moved = points.clone();
    let mut around = triangles.clone();
    for _ in 0..ROUNDS {
        smooth(&mut moved, &around, &fixed);
        cdt = triangulated(&moved, &sides).map_err(failed)?;
        around = inside(&cdt);
        let angle = smallest_angle(&moved, &around);
        if angle > best {
            (best, points, triangles) = (angle, moved.clone(), around.clone());
        }
    }
    Ok(used(points, triangles, sides))
}

impl Outline {
    /// The outline's points, corners first, with its edges as constraints.
    fn triangulated(&self) -> Result<Cdt, InsertionError> {
        let n = self.corners.len();
        let mut points = self.corners.clone();
        let mut edges = Vec::new();
        for (k, side) in self.sides.iter().enumerate() {
            let first = points.len();
            points.extend(side);
            let chain: Vec<usize> =
                std::iter::once(k).chain(first..points.len()).chain(std::iter::once((k + 1) % n)).collect();
            edges.push(chain.windows(2).map(|w| [w[0], w[1]]).collect());
        }
        triangulated(&points, &edges)
    }

    /// Edges of each side, from corner to corner along the constraints, with the body on the left.
    fn walks(&self, cdt: &Cdt) -> Vec<Vec<[usize; 2]>> {
        let n = self.corners.len();
        let within = faces_inside(cdt);
        let next = |from: usize| {
            let out = cdt.fixed_vertices().nth(from).map(|v| cdt.vertex(v));
            out.and_then(|v| {
                let on = v.out_edges().find(|e| {
                    e.is_constraint_edge() && e.face().as_inner().is_some_and(|f| within[f.fix().index()])
                });
                on.map(|e| e.to().fix().index())
            })
        };
        let mut sides = vec![Vec::new(); n];
        let mut at = 0;
        for k in 0..n {
            // Clockwise outlines are traversed backwards: the last side first.
            let (side, end) = if self.clockwise { (n - 1 - k, (n - 1 - k) % n) } else { (k, (k + 1) % n) };
            while let Some(to) = next(at) {
                sides[side].push([at, to]);
                at = to;
                if at == end {
                    break;
                }
            }
        }
        sides
    }
}

fn triangulated(points: &[[f64; 2]], sides: &[Vec<[usize; 2]>]) -> Result<Cdt, InsertionError> {
    let mut cdt = Cdt::new();
    let mut handles = Vec::with_capacity(points.len());
    for p in points {
        handles.push(cdt.insert(Point2::new(p[0], p[1]))?);
    }
    for &[a, b] in sides.iter().flatten() {
        cdt.add_constraint(handles[a], handles[b]);
    }
    Ok(cdt)
}

/// Inserts the circumcentre of every triangle that is too large, the worst first.
fn divide(cdt: &mut Cdt, length: &dyn Fn(&[f64; 2]) -> f64) -> Result<(), InsertionError> {
    loop {
        let within = faces_inside(cdt);
        let mut large: Vec<(f64, [f64; 2], f64)> = Vec::new();
        for face in cdt.inner_faces().filter(|f| within[f.fix().index()]) {
            let (center, square) = face.circumcircle();
            let center = [center.x, center.y];
            let excess = square.sqrt() / (LARGE * length(&center));
            if excess > 1.0 && is_free(cdt, &within, center) {
                large.push((excess, center, square.sqrt()));
            }
        }
        large.sort_by(|a, b| {
            b.0.total_cmp(&a.0).then(a.1[0].total_cmp(&b.1[0])).then(a.1[1].total_cmp(&b.1[1]))
        });
        // One round takes centres no nearer to each other than to the nodes around them.
        let mut taken = Buckets::default();
        let before = cdt.num_vertices();
        for (_, center, radius) in large {
            if taken.take(center, radius) {
                cdt.insert(Point2::new(center[0], center[1]))?;
            }
        }
        if cdt.num_vertices() == before {
            return Ok(());
        }
    }
}

/// Whether a point lies inside the outline and outside the diametral circles of the boundary edges
/// near it.
fn is_free(cdt: &Cdt, within: &[bool], p: [f64; 2]) -> bool {
    let PositionInTriangulation::OnFace(face) = cdt.locate(Point2::new(p[0], p[1])) else { return false };
    let sees = |face: FixedFaceHandle<InnerTag>| {
        cdt.face(face).adjacent_edges().into_iter().all(|e| {
            let [a, b] = e.positions();
            !e.is_constraint_edge() || (a.x - p[0]) * (b.x - p[0]) + (a.y - p[1]) * (b.y - p[1]) > 0.0
        })
    };
    let around = cdt.face(face).adjacent_edges().into_iter().filter(|e| !e.is_constraint_edge());
    within[face.index()]
        && sees(face)
        && around.filter_map(|e| e.rev().face().as_inner()).all(|f| sees(f.fix()))
}

/// Points of a round, sorted by their first coordinate.
#[derive(Default)]
struct Buckets(std::collections::BTreeMap<u64, Vec<[f64; 2]>>);

impl Buckets {
    /// Takes a point unless another was taken within `radius`.
    fn take(&mut self, p: [f64; 2], radius: f64) -> bool {
        // The bits of a number are ordered as the number once the sign is handled.
        let key = |x: f64| {
            let bits = x.to_bits();
            if x.is_sign_negative() { !bits } else { bits | 1 << 63 }
        };
        let near = self.0.range(key(p[0] - radius)..=key(p[0] + radius)).flat_map(|(_, points)| points);
        let free = near.into_iter().all(|q| (q[0] - p[0]).hypot(q[1] - p[1]) > radius);
        if free {
            self.0.entry(key(p[0])).or_default().push(p);
        }
        free
    }
}

/// Which faces lie inside: those not reached from the outer face without crossing the outline.
fn faces_inside(cdt: &Cdt) -> Vec<bool> {
    let mut inside = vec![true; cdt.num_all_faces()];
    let outer = cdt.outer_face();
    inside[outer.fix().index()] = false;
    let beyond = |e: spade::handles::DirectedEdgeHandle<'_, _, (), spade::CdtEdge<()>, ()>| {
        (!e.is_constraint_edge()).then(|| e.rev().face().as_inner()).flatten().map(|f| f.fix())
    };
    let mut queue: Vec<FixedFaceHandle<InnerTag>> = outer.adjacent_edge().map_or(Vec::new(), |first| {
        let mut hull = vec![first];
        while let Some(next) =
            hull.last().map(spade::handles::DirectedEdgeHandle::next).filter(|e| *e != first)
        {
            hull.push(next);
        }
        hull.into_iter().filter_map(beyond).collect()
    });
    while let Some(face) = queue.pop() {
        if std::mem::replace(&mut inside[face.index()], false) {
            queue.extend(cdt.face(face).adjacent_edges().into_iter().filter_map(beyond));
        }
    }
    inside
}

fn positions(cdt: &Cdt) -> Vec<[f64; 2]> {
    cdt.vertices().map(|v| [v.position().x, v.position().y]).collect()
}

/// Corners of the faces inside, counter-clockwise.
fn inside(cdt: &Cdt) -> Vec<[usize; 3]> {
    let within = faces_inside(cdt);
    cdt.inner_faces()
        .filter(|f| within[f.fix().index()])
        .map(|f| f.vertices().map(|v| v.fix().index()))
        .collect()
}

/// Moves every free node to the mean of its neighbours, unless a triangle would be inverted.
fn smooth(points: &mut [[f64; 2]], triangles: &[[usize; 3]], fixed: &[usize]) {
    let mut around = vec![Vec::new(); points.len()];
    for t in triangles {
        for k in 0..3 {
            around[t[k]].push([t[(k + 1) % 3], t[(k + 2) % 3]]);
        }
    }
    fixed.iter().for_each(|&n| around[n].clear());
    for node in 0..points.len() {
        let star = &around[node];
        if star.is_empty() {
            continue;
        }
        // Around an inner node each neighbour begins one triangle.
        let mean = |i: usize| star.iter().map(|[a, _]| points[*a][i]).sum::<f64>() / star.len() as f64;
        let to = [mean(0), mean(1)];
        if star.iter().all(|&[a, b]| twice_area(to, points[a], points[b]) > 0.0) {
            points[node] = to;
        }
    }
}

fn twice_area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Smallest angle in radians.
fn smallest_angle(points: &[[f64; 2]], triangles: &[[usize; 3]]) -> f64 {
    let angle = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        twice_area(a, b, c).atan2((b[0] - a[0]) * (c[0] - a[0]) + (b[1] - a[1]) * (c[1] - a[1]))
    };
    let of = |t: &[usize; 3]| {
        let [a, b, c] = t.map(|n| points[n]);
        angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
    };
    triangles.iter().map(of).fold(f64::INFINITY, f64::min)
}

/// The skeleton without nodes used by outer triangles only.
fn used(points: Vec<[f64; 2]>, mut triangles: Vec<[usize; 3]>, mut sides: Vec<Vec<[usize; 2]>>) -> Skeleton {
    let mut number = vec![usize::MAX; points.len()];
    triangles.iter().flatten().for_each(|&n| number[n] = 0);
    let mut count = 0;
    for n in number.iter_mut().filter(|n| **n == 0) {
        (*n, count) = (count, count + 1);
    }
    triangles.iter_mut().flatten().for_each(|n| *n = number[*n]);
    sides.iter_mut().flatten().flatten().for_each(|n| *n = number[*n]);
    let in_use = points.into_iter().zip(&number).filter(|(_, n)| **n < usize::MAX).map(|(p, _)| p).collect();
    let named = |(k, edges)| Side { name: format!("side{}", k + 1), edges, circle: None };
    Skeleton { points: in_use, triangles, sides: sides.into_iter().enumerate().map(named).collect() }
}
