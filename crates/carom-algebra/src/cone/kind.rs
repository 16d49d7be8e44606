//! Laws of the forces of a contact problem.

/// Law that an unknown force obeys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A normal force P ≥ 0.
    Normal,
    /// A tangential force Q; two in a row with the same normal force are the components of a
    /// vector.
    Tangential {
        /// Index of the normal force P.
        of: usize,
        /// Coefficient of friction μ ≥ 0.
        coefficient: f64,
        /// Largest tangential force; may be infinite.
        limit: f64,
    },
}
