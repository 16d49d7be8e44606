//! Rigid shapes: the signed distance g of a point to their surface, its gradient n and its second
//! derivative.
//!
//! ```text
//! plane    g = (x − p)·n             ∇g = n              ∇²g = 0
//! circle, sphere
//!          g = |x − c| − r           ∇g = (x − c)/|x − c|   ∇²g = (1 − n nᵀ)/|x − c|        from inside all with the opposite sign
//! ```
//!
//! A polyline consists of such pieces. So ∇²g = h (1 − n nᵀ) with one number h for every piece.

mod near;
mod path;
mod polyline;

pub(super) use near::{Near, Point};
pub(super) use polyline::AtCorner;
pub use polyline::{Polyline, PolylineError};

use super::zero;
use near::round;

/// A rigid shape. All its data are in the coordinates of the body that carries it.
#[derive(Clone, Debug)]
pub enum Obstacle {
    /// A half-space, in any dimension.
    Plane {
        /// A point of its boundary.
        point: [f64; 3],
        /// Unit normal out of the rigid side.
        normal: [f64; 3],
    },
    /// A circle; in space a sphere.
    Circle {
        /// Its centre.
        center: [f64; 3],
        /// Its radius, > 0.
        radius: f64,
        /// Whether bodies are inside it.
        inside: bool,
    },
    /// A chain of segments and arcs in the plane.
    Polyline(Polyline),
}

impl Obstacle {
    /// A half-space: bodies are on the side of `point` to which `normal` (any length > 0) points.
    pub fn plane(point: &[f64], normal: &[f64]) -> Self {
        let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        Self::Plane { point: padded(point, 1.0), normal: padded(normal, length.recip()) }
    }

    /// A circle, with bodies outside or `inside` it.
    pub fn circle(center: &[f64], radius: f64, inside: bool) -> Self {
        Self::Circle { center: padded(center, 1.0), radius, inside }
    }

    /// Number of pieces of the surface.
    pub(crate) fn pieces(&self) -> usize {
        if let Self::Polyline(line) = self { line.pieces() } else { 1 }
    }

    /// Its convex round parts, as centres and radii: what can lie between the nodes of a body.
    pub(crate) fn tips(&self) -> Vec<(Point, f64)> {
        match self {
            Self::Circle { center, radius, inside: false } => vec![(*center, *radius)],
            Self::Polyline(line) => line.tips().collect(),
            _ => Vec::new(),
        }
    }

    /// The piece of the surface that is closest to a point.
    pub(crate) fn nearest(&self, at: Point) -> usize {
        if let Self::Polyline(line) = self { line.nearest(at) } else { 0 }
    }

    /// The first θ at which a point on a straight path from `before` to `now` meets the surface;
    /// none if it is outside at the end.
    pub(crate) fn met(&self, before: Point, now: Point) -> Option<f64> {
        let [from, to] = [before, now].map(|at| self.near(self.nearest(at), at));
        let (from, to) = (from?.gap, to?.gap);
        let linear = zero(from, to)?;
        match self {
            _ if from <= 0.0 => Some(0.0),
            Self::Plane { .. } => Some(linear),
            Self::Circle { center, radius, inside } => {
                // |b + θ d|² = r²: into a circle at the earlier root, out of it at the later one.
                let [arm, path] = [[before, *center], [now, before]].map(|[a, b]| minus(a, b));
                let (a, b, c) = (dot(path, path), dot(arm, path), dot(arm, arm) - radius * radius);
                let root = (b * b - a * c).max(0.0).sqrt();
                Some((-b + if *inside { root } else { -root }) / a)
            }
            Self::Polyline(line) => line.entered(before, now).map(|(theta, _)| theta),
        }
    }

    /// A piece of the surface as a point sees it; none from the centre of a circle, where every
    /// direction is the same, if the point has to leave it.
    pub(crate) fn near(&self, piece: usize, at: Point) -> Option<Near> {
        match self {
            Self::Plane { point, normal } => {
                let gap = (0..3).map(|i| (at[i] - point[i]) * normal[i]).sum();
                Some(Near { gap, normal: *normal, bend: 0.0 })
            }
            Self::Circle { center, radius, inside } => {
                round(at, *center, *radius, if *inside { -1.0 } else { 1.0 })
            }
            Self::Polyline(line) => line.near(piece, at),
        }
    }
}

fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn padded(x: &[f64], factor: f64) -> Point {
    std::array::from_fn(|i| x.get(i).map_or(0.0, |x| x * factor))
}
