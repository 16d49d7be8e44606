//! Bodies and meshes from outside: one program, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod body;
mod gmsh;
mod gmsh_faults;
mod manufactured;
mod plane_stress;
