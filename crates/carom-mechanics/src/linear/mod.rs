//! Linear systems of a model: matrices, and what solves with them.

pub(crate) mod direct;
pub(crate) mod iterative;
pub(crate) mod matrices;
pub(crate) mod preconditioner;
pub(crate) mod system;
pub(crate) mod tangents;
pub(crate) mod wholes;
