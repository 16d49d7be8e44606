//! The laws of the unknowns of a problem of contact.

/// The law of an unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// P ≥ 0.
    Normal,
    /// Q. Two in a row with the same normal force are the components of a vector.
    Tangential {
        /// Index of P.
        of: usize,
        /// μ ≥ 0.
        coefficient: f64,
        /// Largest Q; may be infinite.
        limit: f64,
    },
}
