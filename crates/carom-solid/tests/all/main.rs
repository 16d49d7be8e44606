//! Bodies and meshes through their interface, in one binary, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod body;
mod gmsh;
mod gmsh_faults;
mod gmsh_volume;
mod manufactured;
mod mean_dilatation;
mod plane_stress;
mod space;
mod subdivided;
mod together;
