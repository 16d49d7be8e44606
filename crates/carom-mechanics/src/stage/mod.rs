//! A stage: a system of equations, and its solution by Newton's method.

pub(crate) mod balance;
pub(crate) mod equations;
pub(crate) mod evaluation;
pub(crate) mod grip;
pub(crate) mod linear_problem;
pub(crate) mod newton;
pub(crate) mod renewal;
pub(crate) mod resultants;
#[cfg(test)]
pub(crate) mod tangent_tests;
