//! Rigid shapes: the signed distance g of a point to their surface, its gradient n and its second
//! derivative.
//!
//! ```text
//! plane    g = (x − p)·n             ∇g = n              ∇²g = 0
//! circle, sphere: s = x − c; from inside all with the opposite sign
//!          g = |s| − r               ∇g = s/|s|             ∇²g = (1 − n nᵀ)/|s|
//! cylinder with the axis a: s = (1 − a aᵀ)(x − c)
//!          g = |s| − r               ∇g = s/|s|             ∇²g = (1 − n nᵀ − a aᵀ)/|s|
//! ```
//!
//! Polylines and triangulated surfaces consist of such pieces. So ∇²g = h (1 − n nᵀ − a aᵀ) with
//! one number h for every piece, and a direction a, which may be zero.

mod corner;
mod faceted;
mod gap;
mod near;
mod path;
mod polyline;

pub(super) use corner::AtCorner;
pub use faceted::Faceted;
pub(super) use gap::ObstacleGap;
use near::Entry;
pub use near::Tip;
pub(super) use near::{Near, Point, dot};
pub(super) use path::Through;
pub use polyline::{Polyline, PolylineError};

use super::zero;
use near::{across, around, minus};

/// Shape of a rigid obstacle, in the coordinates of the body that carries it.
#[derive(Clone, Debug)]
pub enum Obstacle {
    /// A half-space, in any dimension.
    Plane {
        /// A point of the bounding plane.
        point: [f64; 3],
        /// Unit normal of the bounding plane, out of the rigid half-space.
        normal: [f64; 3],
    },
    /// A circle; in space a sphere or a cylinder.
    Circle {
        /// Centre of the circle or sphere; a point on the axis of a cylinder.
        center: [f64; 3],
        /// The axis of a cylinder, of length one; zero for a circle or a sphere.
        axis: [f64; 3],
        /// Radius > 0 of the circle, sphere or cylinder.
        radius: f64,
        /// Whether bodies are inside the circle, sphere or cylinder.
        inside: bool,
    },
    /// A chain of segments and arcs in the plane.
    Polyline(Polyline),
    /// A triangulated surface in space.
    Faceted(Faceted),
}

impl Obstacle {
    /// A half-space: bodies are on the side of `point` to which `normal` (any length > 0) points.
    pub fn plane(point: &[f64], normal: &[f64]) -> Self {
        Self::Plane { point: padded(point), normal: unit(normal) }
    }

    /// A circle, with bodies outside or `inside` it.
    pub fn circle(center: &[f64], radius: f64, inside: bool) -> Self {
        Self::Circle { center: padded(center), axis: [0.0; 3], radius, inside }
    }

    /// An infinite cylinder, around a line through `point` along `axis` (any length > 0), with
    /// bodies outside or `inside` it.
    pub fn cylinder(point: &[f64], axis: &[f64], radius: f64, inside: bool) -> Self {
        Self::Circle { center: padded(point), axis: unit(axis), radius, inside }
    }

    /// Number of pieces of the surface of the obstacle.
    pub(crate) fn pieces(&self) -> usize {
        match self {
            Self::Polyline(line) => line.pieces(),
            Self::Faceted(surface) => surface.pieces(),
            _ => 1,
        }
    }

    /// The convex round parts of the obstacle, which can lie between the nodes of a body; points of
    /// sharp edges of a triangulated surface at most at the distance `spacing`.
    pub(crate) fn tips(&self, spacing: f64) -> Vec<Tip> {
        match self {
            Self::Circle { center, radius, inside: false, .. } => {
                vec![Tip { center: *center, radius: *radius, size: *radius, normals: None }]
            }
            Self::Polyline(line) => line.tips().collect(),
            Self::Faceted(surface) => surface.tips(spacing),
            _ => Vec::new(),
        }
    }

    /// The piece of the obstacle that is closest to a point, searched from a piece near it if one
    /// is known.
    pub(crate) fn nearest(&self, at: Point, from: Option<usize>) -> usize {
        match self {
            Self::Polyline(line) => line.nearest(at),
            Self::Faceted(surface) => surface.nearest(at, from),
            _ => 0,
        }
    }

    /// The piece that is closest to a point and has a normal for it: none has the vertex of a
    /// concave corner.
    pub(super) fn facing(&self, at: Point, from: usize) -> usize {
        match self {
            Self::Polyline(line) => line.with_normal(line.nearest(at), at),
            _ => self.nearest(at, Some(from)),
        }
    }

    /// The flat pieces of a polyline or a triangulated surface within a distance of a point over or
    /// under which it lies, to within a distance `past` their ends.
    pub(super) fn over(&self, at: Point, within: f64, past: f64) -> Vec<usize> {
        let is_within = |piece: &usize| self.near(*piece, at).is_some_and(|near| near.gap.abs() <= within);
        let over = match self {
            Self::Polyline(line) => line.over(at, past),
            Self::Faceted(surface) => surface.over(at, within, past),
            _ => Vec::new(),
        };
        over.into_iter().filter(is_within).collect()
    }

    /// Where a point on a straight path enters a polyline or a triangulated surface, if it does.
    pub(super) fn entered(&self, before: Point, now: Point) -> Option<Entry> {
        match self {
            Self::Polyline(line) => line.entered(before, now),
            Self::Faceted(surface) => surface.entered(before, now),
            _ => None,
        }
    }

    /// The piece of the obstacle on which the gap of a node in contact with a piece is measured.
    pub(super) fn followed(&self, piece: usize, at: Point) -> usize {
        match self {
            Self::Polyline(line) => line.followed(piece, at),
            Self::Faceted(surface) => surface.followed(piece, at),
            _ => 0,
        }
    }

    /// The flat pieces that rise in front of another one at a sharp concave corner, and behind
    /// which a point lies, too.
    pub(super) fn walls(&self, piece: usize, at: Point) -> Vec<usize> {
        match self {
            Self::Polyline(line) => line.walls(piece, at),
            Self::Faceted(surface) => surface.walls(piece, at),
            _ => Vec::new(),
        }
    }

    /// The next piece of a node in contact, which may have slid past the end of its piece of the
    /// obstacle.
    pub(super) fn at_corner(&self, piece: usize, at: Point) -> AtCorner {
        match self {
            Self::Polyline(line) => line.at_corner(piece, at),
            Self::Faceted(surface) => surface.at_corner(piece, at),
            _ => AtCorner::Stays,
        }
    }

    /// First instant θ at which a point on a straight path from `before`, θ = 0, to `now`, θ = 1,
    /// meets the obstacle; none if it is outside at the end.
    pub(crate) fn met(&self, before: Point, now: Point) -> Option<f64> {
        let [from, to] = [before, now].map(|at| self.near(self.nearest(at, None), at));
        let from = from?.gap;
        let to = to?.gap;
        let linear = zero(from, to)?;
        match self {
            _ if from <= 0.0 => Some(0.0),
            Self::Plane { .. } => Some(linear),
            Self::Circle { center, axis, radius, inside } => {
                // |b + θ d|² = r²: into a circle at the earlier root, out of it at the later one.
                let [arm, path] = [[before, *center], [now, before]].map(|[a, b]| across(minus(a, b), *axis));
                let a = dot(path, path);
                let b = dot(arm, path);
                let c = dot(arm, arm) - radius * radius;
                let root = (b * b - a * c).max(0.0).sqrt();
                Some((-b + if *inside { root } else { -root }) / a)
            }
            Self::Polyline(_) | Self::Faceted(_) => self.entered(before, now).map(|entry| entry.theta),
        }
    }

    /// Signed distance from a piece of the obstacle to a point, with its derivatives; none at the
    /// centre of a circle or sphere that the point has to leave, where no direction is
    /// distinguished.
    pub(crate) fn near(&self, piece: usize, at: Point) -> Option<Near> {
        match self {
            Self::Plane { point, normal } => {
                let gap = (0..3).map(|i| (at[i] - point[i]) * normal[i]).sum();
                Some(Near::flat(gap, *normal))
            }
            Self::Circle { center, axis, radius, inside } => {
                around(minus(at, *center), *axis, *radius, if *inside { -1.0 } else { 1.0 })
            }
            Self::Polyline(line) => line.near(piece, at),
            Self::Faceted(surface) => surface.near(piece, at),
        }
    }
}

/// A vector scaled to length one.
fn unit(x: &[f64]) -> Point {
    let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
    padded(x).map(|x| x * length.recip())
}

fn padded(x: &[f64]) -> Point {
    std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}
