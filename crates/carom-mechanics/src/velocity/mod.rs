//! Velocities and accelerations of a state under its closed contacts.

pub(crate) mod active_rows;
pub(crate) mod cone;
pub(crate) mod persistency;
pub(crate) mod restitution;
pub(crate) mod stick;
