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
    /// h of ∇²g = h (1 − n nᵀ).
    pub(crate) bend: f64,
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

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt()
}
