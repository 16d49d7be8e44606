//! The tangents of a pair in space are the last ones of the pair, turned with the normal by the
//! smallest rotation,
//!
//! ```text
//! e ← e − (e·n)/(1 + n₀·n) (n₀ + n)
//! ```
//!
//! A vector is so carried from one tangent plane to the next without regard to its components. At
//! the last normal ∂e = −(e·∂n) n.

use carom_algebra::Vector;

use super::space::cross;
use crate::constants::BESIDE_KINK;

/// The unit tangents at a normal, turned from the last ones of the pair; chosen freely if those are
/// zero.
pub(super) fn tangents(normal: Vector<3>, last: [[f64; 3]; 2]) -> [Vector<3>; 2] {
    let [first, second] = last.map(Vector);
    let before = cross(first, second);
    let turn = 1.0 + before.dot(&normal);
    let first = if before.norm() > 0.5 && turn > BESIDE_KINK {
        first + (before + normal) * (-first.dot(&normal) / turn)
    } else {
        let axis = (1..3).fold(0, |least, i| if normal[i].abs() < normal[least].abs() { i } else { least });
        Vector(std::array::from_fn(|i| f64::from(u8::from(i == axis))))
    };
    let first = first + normal * -normal.dot(&first);
    let first = first * first.norm().recip();
    [first, cross(normal, first)]
}
