//! Velocities and accelerations of a state under its closed contacts.

pub mod active_rows;
pub(crate) mod cone;
pub(crate) mod persistency;
pub mod restitution;
pub(crate) mod stick;
