//! The tangents of a pair in space: the first one is the last one of the pair, projected on the
//! tangent plane, and the second one is perpendicular to it. Any two would do, since the law is
//! that of a circular cone; but the components of what a pair keeps from step to step refer to
//! them.
//!
//! As long as the first one lies in the tangent plane, the derivative of a projected tangent is
//! ∂e = −(e·∂n) n: both turn with the normal and not about it.

use carom_algebra::Vector;

use super::space::cross;

/// Length of the projection of a unit vector below which another one is taken.
const SHORT: f64 = 0.1;

/// The tangents at a normal, from the last first one, which may be zero.
pub(super) fn tangents(normal: Vector<3>, last: [f64; 3]) -> [Vector<3>; 2] {
    let projected = |x: Vector<3>| x + normal * -normal.dot(&x);
    let mut first = projected(Vector(last));
    if first.norm() < SHORT {
        let axis = (1..3).fold(0, |least, i| if normal[i].abs() < normal[least].abs() { i } else { least });
        first = projected(Vector(std::array::from_fn(|i| f64::from(u8::from(i == axis)))));
    }
    let first = first * first.norm().recip();
    [first, cross(normal, first)]
}
