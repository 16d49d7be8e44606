//! Linear systems of a model: matrices, and what solves with them.

pub mod direct;
pub mod iterative;
pub mod matrices;
pub mod preconditioner;
pub mod system;
pub(crate) mod tangents;
pub(crate) mod wholes;
