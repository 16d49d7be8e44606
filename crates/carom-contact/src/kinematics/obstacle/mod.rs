//! Rigid shapes: the signed distance g of a point to their surface, its gradient n and its second
//! derivative.
//!
//! ```text
//! plane    g = (x − p)·n             ∇g = n              ∇²g = 0
//! circle   g = |x − c| − r           ∇g = (x − c)/|x − c|   ∇²g = (1 − n nᵀ)/|x − c|        from inside all with the opposite sign
//! ```
//!
//! A polyline consists of such pieces. So ∇²g = h (1 − n nᵀ) with one number h for every piece.

mod polyline;

pub(super) use polyline::AtCorner;
pub use polyline::{Polyline, PolylineError};

/// A point of up to three components; unused ones are zero.
pub(crate) type Point = [f64; 3];

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
    /// A circle.
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

/// The surface as a point sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Near {
    /// Signed distance g.
    pub(crate) gap: f64,
    /// ∇g, of unit length.
    pub(crate) normal: Point,
    /// h of ∇²g = h (1 − n nᵀ).
    pub(crate) bend: f64,
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

    /// A length of the shape about a point, for angles expressed as lengths.
    pub fn reach(&self, about: &[f64]) -> f64 {
        let about = padded(about, 1.0);
        match self {
            Self::Plane { point, .. } => distance(*point, about),
            Self::Circle { center, radius, .. } => distance(*center, about) + radius,
            Self::Polyline(line) => line.reach(about),
        }
    }

    /// The piece of the surface that is closest to a point.
    pub(crate) fn nearest(&self, at: Point) -> usize {
        if let Self::Polyline(line) = self { line.nearest(at) } else { 0 }
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

/// A circle seen from outside (`side` = 1) or inside (−1).
pub(crate) fn round(at: Point, center: Point, radius: f64, side: f64) -> Option<Near> {
    let length = distance(at, center);
    let gap = side * (length - radius);
    if length > 0.0 {
        let normal = std::array::from_fn(|i| side * (at[i] - center[i]) / length);
        Some(Near { gap, normal, bend: side / length })
    } else {
        (gap > 0.0).then_some(Near { gap, normal: [1.0, 0.0, 0.0], bend: 0.0 })
    }
}

fn padded(x: &[f64], factor: f64) -> Point {
    std::array::from_fn(|i| x.get(i).map_or(0.0, |x| x * factor))
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt()
}
