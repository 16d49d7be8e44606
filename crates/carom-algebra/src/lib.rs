//! The algebra under Carom: small tensors, sparse symmetric systems, Newton's method and the checks by differences.

mod small;

pub use small::{Mat, Vector};
