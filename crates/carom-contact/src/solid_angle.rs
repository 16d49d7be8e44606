//! The solid angle Ω under which a triangle with corners a, b, c is seen from the origin (Van
//! Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983)):
//!
//! ```text
//! tan(Ω/2) = a·(b × c) / (|a||b||c| + (a·b)|c| + (b·c)|a| + (c·a)|b|)
//! ```

use carom_algebra::Vector;

use crate::kinematics::cross;

/// Solid angle under which a triangle is seen from the origin; negative from its outer side.
pub fn solid_angle([a, b, c]: [Vector<3>; 3]) -> f64 {
    let [p, q, r] = [a.norm(), b.norm(), c.norm()];
    let across = p * q * r + a.dot(&b) * r + b.dot(&c) * p + c.dot(&a) * q;
    2.0 * a.dot(&cross(b, c)).atan2(across)
}
