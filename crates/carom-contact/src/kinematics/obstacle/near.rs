//! The surface of an obstacle as a point sees it: on a straight piece, or around a centre.

/// A point of up to three components; unused ones are zero.
pub(crate) type Point = [f64; 3];

/// The surface as a point sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Near {
    /// Signed distance g.
    pub(crate) gap: f64,
    /// ∇g, of unit length.
    pub(crate) normal: Point,
    /// h of ∇²g = h (1 − n nᵀ − a aᵀ).
    pub(crate) bend: f64,
    /// a, a direction across n in which the surface is straight; zero: there is none.
    pub(crate) straight: Point,
}

impl Near {
    /// A straight piece.
    pub(crate) fn flat(gap: f64, normal: Point) -> Self {
        Self { gap, normal, bend: 0.0, straight: [0.0; 3] }
    }

    /// ∇²g v of a vector across n.
    pub(crate) fn bent(&self, v: Point) -> Point {
        let along = dot(self.straight, v);
        std::array::from_fn(|i| self.bend * (v[i] - along * self.straight[i]))
    }
}

/// A circle around the origin, or a line through it along a direction of length one, seen from
/// outside (`side` = 1) or inside (−1).
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

/// v without its part along a direction of length one, or zero.
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
