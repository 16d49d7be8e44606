//! A stage: a system of equations, and its solution by Newton's method.

pub mod balance;
pub mod equations;
pub mod evaluation;
pub(crate) mod grip;
pub mod linear_problem;
pub(crate) mod newton;
pub mod renewal;
pub(crate) mod resultants;
