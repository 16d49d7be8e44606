//! The largest depth of a node on its way through a body, between two instants of a step.
//!
//! With the distance s of the node to the boundary at one instant, and the speeds v relative to the
//! nearest point and V ≥ that relative to every point, at another instant
//!
//! ```text
//! inside     depth ≤ s + v |Δθ|      that point moves on a straight line
//! outside    depth ≤ V |Δθ| − s      the node must come to the boundary first
//! ```
//!
//! Where one facet is nearest at both ends of an interval, at ξ₀ and ξ₁, the depth is also at most
//! the distance to its point ξ₀ + t (ξ₁ − ξ₀), t the share of the interval that has passed: a
//! polynomial in t, which lies within the convex hull of its Bernstein coefficients. An interval in
//! which neither bound excludes more than 9/8 of the allowed depth is divided where the first two
//! meet (Piyavskii, USSR Comput. Math. Math. Phys. 12 (1972)). No greater depth is missed, up to
//! round-off.

use carom_algebra::Vector;
use carom_solid::FacetShape;

use crate::constants::SHALLOW;

/// Accuracy of the largest depth, as a ratio to the allowed depth or to the largest one found.
pub const KNOWN: f64 = 1.125;
/// Number of divisions after which an undecided interval counts as deep, for boundaries that no
/// longer have a size.
const MOST: usize = 10_000;
/// Smallest share of an interval on either side of its division.
const LEAST: f64 = 0.05;

/// A node relative to a boundary at an instant of its path.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// The instant.
    pub theta: f64,
    /// Facet nearest to the node.
    pub facet: usize,
    /// Coordinates of the nearest point on its facet.
    pub xi: [f64; 2],
    /// Depth of the node inside the boundary; negative outside.
    pub depth: f64,
    /// Speed of the node relative to the nearest point of the boundary, per step.
    pub speed: f64,
    /// Allowed depth of the node at that instant.
    pub limit: f64,
}

/// Where a node crosses the boundary: the instant, the facet and the coordinates ξ on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met<X = [f64; 2]> {
    pub theta: f64,
    pub facet: usize,
    pub xi: X,
}

/// Allowed depths on a path: a share of the length of a facet, or the depth that the node has at an
/// end of its path.
#[derive(Clone, Copy, Debug, Default)]
pub struct Allowed {
    /// The share.
    pub share: f64,
    /// The depth at an end.
    pub at_end: f64,
}

/// The path of a node, or of an edge, relative to a boundary.
pub trait Way {
    /// The node relative to the boundary at an instant.
    fn seen(&mut self, theta: f64) -> Option<Seen>;

    /// The node relative to the boundary at an instant at which the nearest point and the depth are
    /// known.
    fn on(&self, theta: f64, facet: usize, xi: [f64; 2], depth: f64) -> Seen;

    /// Bound of the distance of the node, between two instants, to the facet that is nearest at
    /// both.
    fn between(&self, from: &Seen, to: &Seen) -> f64;

    /// Outward normal of the boundary at the nearest point, at an instant.
    fn normal(&mut self, at: &Seen) -> Vector<3>;

    /// Sets the allowed depths.
    fn allow(&mut self, allowed: Allowed);
}

/// The instant at which a node exceeds the allowed depth most, if it does, between its first entry
/// and its last exit, or an end of the step at which it is inside; `bounce`: allowed depth,
/// relative to the length of a facet, if it leaves on the side on which it entered; `fastest`:
/// bound of the speed relative to every point of the boundary.
pub(super) fn through(
    way: &mut impl Way,
    [entry, exit]: [Option<Met>; 2],
    bounce: f64,
    fastest: f64,
) -> Option<Seen> {
    let first = entry.map_or(0.0, |met| met.theta);
    let last = exit.map_or(1.0, |met| met.theta);
    let known = entry.or(exit)?;
    if last <= first {
        return None;
    }
    // It is on the boundary at one end at least.
    way.allow(Allowed { share: SHALLOW, at_end: 0.0 });
    if fastest * (last - first) <= way.on(known.theta, known.facet, known.xi, 0.0).limit {
        return None;
    }
    let mut end = |met: Option<Met>, theta: f64| match met {
        Some(met) => Some(way.on(theta, met.facet, met.xi, 0.0)),
        None => way.seen(theta).filter(|seen| seen.depth > 0.0),
    };
    let ends = [end(entry, first)?, end(exit, last)?];
    let normals = ends.map(|end| way.normal(&end));
    way.allow(Allowed { share: share(normals, bounce), at_end: ends[0].depth.max(ends[1].depth) });
    let ends = ends.map(|end| way.on(end.theta, end.facet, end.xi, end.depth));
    deepest(way, ends, fastest)
}

/// The instant between the `ends` of a path at which the node exceeds the allowed depth most, if it
/// does; `fastest`: bound of the speed relative to every point of the boundary.
pub fn deepest(way: &mut impl Way, ends: [Seen; 2], fastest: f64) -> Option<Seen> {
    let mut worst: Option<Seen> = None;
    let mut open = vec![ends];
    for _ in 0..MOST {
        let [from, to] = open.pop()?;
        let least = from.limit.min(to.limit);
        let enough = KNOWN * worst.map_or(least, |worst| worst.depth.max(least));
        let (theta, bound) = bound(&from, &to, fastest);
        let is_open = bound > enough && !(from.facet == to.facet && way.between(&from, &to) <= enough);
        if is_open && let Some(seen) = way.seen(theta) {
            let excess = |seen: &Seen| seen.depth - seen.limit;
            if excess(&seen) > worst.as_ref().map_or(0.0, excess) {
                worst = Some(seen);
            }
            open.extend([[seen, to], [from, seen]]);
        }
        if open.is_empty() {
            return worst;
        }
    }
    let undecided = open.pop().map(|[from, to]| Seen { depth: bound(&from, &to, fastest).1, ..from });
    worst.or(undecided)
}

/// Instant at which the bounds of the depth from both ends of an interval meet, and the bound
/// there.
fn bound(from: &Seen, to: &Seen, fastest: f64) -> (f64, f64) {
    let slope = |seen: &Seen| if seen.depth < 0.0 { fastest } else { seen.speed };
    let length = to.theta - from.theta;
    let up = slope(from);
    let down = slope(to);
    let along = ((to.depth - from.depth + down * length) / (up + down)).clamp(0.0, length);
    let bound = (from.depth + up * along).min(to.depth + down * (length - along));
    (from.theta + along.clamp(LEAST * length, (1.0 - LEAST) * length), bound)
}

/// Largest ratio of the motion of a point of a facet to that of its nodes: the largest Σ |φᵃ|.
pub(crate) fn amplification(shape: FacetShape) -> f64 {
    match shape {
        FacetShape::L3 => 1.25,
        FacetShape::L4 => 1.6312,
        FacetShape::T6 => 5.0 / 3.0,
        FacetShape::Q9 => 1.5625,
        FacetShape::T10 => 2.28,
        FacetShape::Point | FacetShape::L2 | FacetShape::T3 | FacetShape::Q4 => 1.0,
    }
}

/// Bound of the distance between a node and a point that moves along a facet, from ξ₀ to ξ₁ of
/// `ends`, while all nodes move on straight lines; `offset(end, ξ)`: offset of the node from the
/// point at ξ, at either end of the interval.
pub fn most_between<const D: usize>(
    shape: FacetShape,
    ends: [[f64; 2]; 2],
    offset: impl Fn(usize, [f64; 2]) -> Vector<D>,
) -> f64 {
    // Of the product of both coordinates on a square.
    let degree = shape.degree() * if shape.corners() == 4 { 2 } else { 1 };
    let at = |k: usize| {
        let t = k as f64 / degree as f64;
        std::array::from_fn(|i| ends[0][i] + t * (ends[1][i] - ends[0][i]))
    };
    let control = [0, 1].map(|end| {
        let mut values = [Vector::ZERO; 5];
        values[..=degree].iter_mut().enumerate().for_each(|(k, value)| *value = offset(end, at(k)));
        bernstein(degree, &values)
    });
    let last = degree + 1;
    let mut most = 0.0_f64;
    for k in 0..=last {
        let late = k as f64 / last as f64;
        let mut point = Vector::ZERO;
        if k <= degree {
            point += control[0][k] * (1.0 - late);
        }
        if k > 0 {
            point += control[1][k - 1] * late;
        }
        let length = point.norm();
        // A NaN bounds nothing.
        most = if length > most || length.is_nan() { length } else { most };
    }
    most
}

/// Bernstein coefficients of a polynomial from its values at 0, 1/degree, …, 1.
fn bernstein<const D: usize>(degree: usize, f: &[Vector<D>; 5]) -> [Vector<D>; 5] {
    let mut c = *f;
    let sum = |weights: &[f64], over: f64| {
        weights.iter().zip(f).fold(Vector::ZERO, |sum, (&weight, &f)| sum + f * (weight / over))
    };
    match degree {
        2 => c[1] = sum(&[-1.0, 4.0, -1.0], 2.0),
        3 => {
            c[1] = sum(&[-5.0, 18.0, -9.0, 2.0], 6.0);
            c[2] = sum(&[2.0, -9.0, 18.0, -5.0], 6.0);
        }
        4 => {
            c[1] = sum(&[-13.0, 48.0, -36.0, 16.0, -3.0], 12.0);
            c[2] = sum(&[13.0, -64.0, 120.0, -64.0, 13.0], 18.0);
            c[3] = sum(&[-3.0, 16.0, -36.0, 48.0, -13.0], 12.0);
        }
        _ => {}
    }
    c
}

/// Positions between the ends of a step, on straight lines.
pub(super) struct Between<'a, const D: usize> {
    ends: [&'a [f64]; 2],
    /// Positions at the last instant asked for, valid for the nodes asked for only.
    y: Vec<f64>,
}

impl<'a, const D: usize> Between<'a, D> {
    pub(super) fn new([before, now]: [&'a [f64]; 2]) -> Self {
        Self { ends: [before, now], y: vec![0.0; now.len()] }
    }

    /// Position of a node at an instant.
    pub(super) fn at(&self, theta: f64, node: usize) -> Vector<D> {
        let [before, now] = self.ends;
        Vector(std::array::from_fn(|i| {
            let dof = D * node + i;
            before[dof] + theta * (now[dof] - before[dof])
        }))
    }

    /// Positions, flat over all nodes, in which the given nodes are at an instant.
    pub(super) fn with(&mut self, theta: f64, nodes: &[usize]) -> &[f64] {
        for &node in nodes {
            let at = self.at(theta, node);
            self.y[D * node..D * (node + 1)].copy_from_slice(&at.0);
        }
        &self.y
    }

    /// Positions, flat over all nodes, in which only the nodes asked for before are valid.
    pub(super) fn flat(&self) -> &[f64] {
        &self.y
    }

    /// Speed of a node relative to the point ξ of a facet, per step.
    pub(super) fn speed(&self, node: usize, shape: FacetShape, nodes: &[usize], xi: [f64; 2]) -> f64 {
        let moved = |node: usize| self.at(1.0, node) - self.at(0.0, node);
        let own = moved(node);
        let functions = shape.functions(xi);
        let each = nodes.iter().zip(functions.values);
        each.fold(Vector::ZERO, |sum, (&other, value)| sum + (own - moved(other)) * value).norm()
    }

    /// Bound of the distance of a node, between two instants, to the facet that is nearest at both.
    pub(super) fn most(
        &self,
        node: usize,
        shape: FacetShape,
        nodes: &[usize],
        from: &Seen,
        to: &Seen,
    ) -> f64 {
        let thetas = [from.theta, to.theta];
        most_between(shape, [from.xi, to.xi], |end, xi| {
            let own = self.at(thetas[end], node);
            let functions = shape.functions(xi);
            let each = nodes.iter().zip(functions.values);
            each.fold(Vector::ZERO, |sum: Vector<D>, (&other, value)| {
                sum + (own - self.at(thetas[end], other)) * value
            })
        })
    }
}

/// Allowed depth, relative to the length of a facet, from the normals where a node enters and
/// leaves: on the same side it has bounced, and may be as deep as at the end of a step.
pub(super) fn share<const D: usize>([entered, left]: [Vector<D>; 2], bounce: f64) -> f64 {
    if entered.dot(&left) > 0.0 { bounce.max(SHALLOW) } else { SHALLOW }
}
