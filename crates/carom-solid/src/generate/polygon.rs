//! Polygon, convex or not, of nearly equilateral triangles. Its sides are divided into edges of the
//! requested length; `delaunay` fills it.
//!
//! Around a refined point edges have its size s; beyond its radius r they grow by 3/10 of the
//! distance, h(x) = min(size, s + 0.3 max(0, |x − near| − r)). A side is divided where ∫ ds/h is an
//! integer.

use super::delaunay::{Outline, fill};
use super::elevate::elevate;
use super::{MeshError, lerp, positive, triangles};
use crate::mesh::{Element, Mesh};

/// Growth of edges away from a refined point.
const GROWTH: f64 = 0.3;

/// A point with finer cells around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Its centre.
    pub near: [f64; 2],
    /// Edges have the size up to this distance, ≥ 0.
    pub radius: f64,
    /// Length of edges there, > 0.
    pub size: f64,
}

/// Polygon through `points`, in either orientation, with edges of about `size`. Side `side1` joins
/// the first two points, `side2` the second and third, and the last one closes it. Each is
/// traversed with the body on its left.
///
/// # Errors
/// If there are fewer than 3 points, sides meet elsewhere than at their ends, or a number is out of
/// range.
///
/// ```
/// use carom_solid::{Element, generate};
/// let cook = generate::polygon(Element::T6, &[[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]], 5.0, &[])?;
/// assert!(cook.side_nodes("side2").unwrap().iter().all(|&n| cook.nodes[n][0] == 48.0));
/// # Ok::<(), carom_solid::generate::MeshError>(())
/// ```
pub fn polygon(
    element: Element,
    points: &[[f64; 2]],
    size: f64,
    refine: &[Refinement],
) -> Result<Mesh, MeshError> {
    triangles(element)?;
    outline(points)?;
    positive(&[("size", size)])?;
    for place in refine {
        positive(&[("refine.size", place.size)])?;
        let Refinement { near, radius, .. } = *place;
        if !(radius.is_finite() && radius >= 0.0 && near.iter().all(|c| c.is_finite())) {
            return Err(MeshError::Place { near, radius });
        }
    }
    let length = |x: &[f64; 2]| {
        let near = |p: &Refinement| {
            p.size + GROWTH * ((x[0] - p.near[0]).hypot(x[1] - p.near[1]) - p.radius).max(0.0)
        };
        refine.iter().map(near).fold(size, f64::min)
    };
    let n = points.len();
    let sides = (0..n).map(|k| cut(points[k], points[(k + 1) % n], &length)).collect();
    let clockwise = twice_the_area(points) < 0.0;
    let skeleton = fill(&Outline { corners: points.to_vec(), sides, clockwise }, &length)?;
    Ok(elevate(skeleton, element))
}

/// Σ x × y: positive counter-clockwise.
fn twice_the_area(points: &[[f64; 2]]) -> f64 {
    let o = points[0];
    points.windows(2).map(|w| cross(minus(w[0], o), minus(w[1], o))).sum()
}

/// Interior points of a side, from its start to its end.
fn cut(a: [f64; 2], b: [f64; 2], length: &dyn Fn(&[f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let whole = (b[0] - a[0]).hypot(b[1] - a[1]);
    let at = |t: f64| [lerp(a[0], b[0], t), lerp(a[1], b[1], t)];
    // ∫ ds/h up to the ends of steps no longer than a quarter of the edge at their start (h is
    // Lipschitz: no step can miss it).
    let mut places = vec![0.0];
    let mut edges = vec![0.0];
    let mut t = 0.0;
    let mut sum = 0.0;
    while t < 1.0 {
        let next = (t + 0.25 * length(&at(t)) / whole).min(1.0);
        sum += whole * (next - t) / length(&at(0.5 * (t + next)));
        t = next;
        places.push(t);
        edges.push(sum);
    }
    let count = (sum - 1e-9).ceil().max(1.0);
    let place = |k: usize| {
        let wanted = sum * k as f64 / count;
        let i = edges.partition_point(|e| *e < wanted).clamp(1, edges.len() - 1);
        lerp(places[i - 1], places[i], (wanted - edges[i - 1]) / (edges[i] - edges[i - 1]))
    };
    (1..count as usize).map(|k| at(place(k))).collect()
}

/// Checks that points are the corners of a simple polygon: finite, and sides meet only at their
/// ends.
///
/// # Errors
/// The first invalid point or pair of sides, counted from 1.
pub fn outline(points: &[[f64; 2]]) -> Result<(), MeshError> {
    let n = points.len();
    if n < 3 {
        return Err(MeshError::Points { count: n });
    }
    let side = |k: usize| [points[k], points[(k + 1) % n]];
    let extent = points.iter().flatten().fold(0.0_f64, |m, c| m.max(c.abs()));
    for (k, point) in points.iter().enumerate() {
        let [a, b] = side((k + n - 1) % n);
        // Rejects NaN as well.
        let apart = (a[0] - b[0]).hypot(a[1] - b[1]) > 1e-9 * extent;
        if !(point.iter().all(|c| c.is_finite()) && apart) {
            return Err(MeshError::Point { point: k + 1 });
        }
    }
    for i in 0..n {
        for j in i + 1..n {
            let s = side(i);
            let t = side(j);
            let meet = if j == i + 1 || (i == 0 && j == n - 1) {
                // Neighbours share a point; their free ends must not lie on the other side.
                let [a, b, c] = if j == i + 1 { [s[0], s[1], t[1]] } else { [t[0], t[1], s[1]] };
                distance(a, [b, c]).min(distance(c, [a, b]))
            } else if crosses(s, t) {
                0.0
            } else {
                let ends = [distance(s[0], t), distance(s[1], t), distance(t[0], s), distance(t[1], s)];
                ends.into_iter().fold(f64::INFINITY, f64::min)
            };
            if meet <= 1e-9 * extent {
                return Err(MeshError::Crossing { first: i + 1, second: j + 1 });
            }
        }
    }
    Ok(())
}

fn cross(u: [f64; 2], v: [f64; 2]) -> f64 {
    u[0] * v[1] - u[1] * v[0]
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn crosses(s: [[f64; 2]; 2], t: [[f64; 2]; 2]) -> bool {
    let apart = |s: [[f64; 2]; 2], t: [[f64; 2]; 2]| {
        let side = |p| cross(minus(s[1], s[0]), minus(p, s[0]));
        side(t[0]) * side(t[1]) > 0.0
    };
    // Parallel sides are checked by their ends.
    cross(minus(s[1], s[0]), minus(t[1], t[0])) != 0.0 && !apart(s, t) && !apart(t, s)
}

/// Distance of a point from a segment.
fn distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let u = minus(b, a);
    let v = minus(p, a);
    let t = ((u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1])).clamp(0.0, 1.0);
    (v[0] - t * u[0]).hypot(v[1] - t * u[1])
}
