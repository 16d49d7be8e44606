//! The surface of an obstacle as a point sees it: on a straight piece, or around a centre.

/// A point of up to three components; unused ones are zero.
pub(crate) type Point = [f64; 3];

/// Signed distance from a piece of an obstacle to a point, with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Near {
    /// Signed distance g.
    pub(crate) gap: f64,
    /// Gradient ∇g of the distance, of length one.
    pub(crate) normal: Point,
    /// Curvature h in the second derivative ∇²g = h (1 − n nᵀ − a aᵀ) of the distance.
    pub(crate) bend: f64,
    /// Direction a, perpendicular to the normal, in which the surface is straight; zero if there is
    /// none.
    pub(crate) straight: Point,
}

/// A convex round part of a rigid obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// Centre of the circle or sphere.
    pub center: [f64; 3],
    /// Radius ≥ 0.
    pub radius: f64,
    /// Radius of curvature of the obstacle, seen from afar: that of the part, or of an arc that a
    /// blunt corner and others like it approximate.
    pub size: f64,
    /// Outward normals of the obstacle between which the part lies; none of a whole circle.
    pub normals: Option<[[f64; 3]; 2]>,
}

/// Where a point on a straight path enters an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Entry {
    /// Share of the path before the entry, 0 … 1.
    pub(crate) theta: f64,
    /// The piece of the surface that is crossed.
    pub(crate) piece: usize,
}

impl Near {
    /// Distance from a plane piece.
    pub(crate) fn flat(gap: f64, normal: Point) -> Self {
        Self { gap, normal, bend: 0.0, straight: [0.0; 3] }
    }

    /// Product ∇²g v of the second derivative with a vector v perpendicular to the normal.
    pub(crate) fn bent(&self, v: Point) -> Point {
        let along = dot(self.straight, v);
        std::array::from_fn(|i| self.bend * (v[i] - along * self.straight[i]))
    }
}

/// Distance from a circle or sphere around the origin, or from a cylinder around an axis of length
/// one through it, to the point `arm`, seen from outside (`side` = 1) or inside (−1).
pub(crate) fn around(arm: Point, axis: Point, radius: f64, side: f64) -> Option<Near> {
    let arm = across(arm, axis);
    let length = dot(arm, arm).sqrt();
    let gap = side * (length - radius);
    if length > 0.0 {
        return Some(Near {
            gap,
            normal: arm.map(|x| side * x / length),
            bend: side / length,
            straight: axis,
        });
    }
    // Any direction across the axis.
    let least = (1..3).fold(0, |least, i| if axis[i].abs() < axis[least].abs() { i } else { least });
    let normal = across(std::array::from_fn(|i| if i == least { 1.0 } else { 0.0 }), axis);
    let length = dot(normal, normal).sqrt();
    (gap > 0.0).then_some(Near { straight: axis, ..Near::flat(gap, normal.map(|n| n / length)) })
}

/// Part of v perpendicular to a direction of length one; v itself for the zero direction.
pub(crate) fn across(v: Point, axis: Point) -> Point {
    let along = dot(v, axis);
    std::array::from_fn(|i| v[i] - along * axis[i])
}

pub(crate) fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| a[i] - b[i])
}

pub(crate) fn cross(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt()
}
