//! Bodies and meshes through their interface, in one binary, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod body;
mod bounds;
mod discrete_gradient;
mod facet;
mod facet_point;
mod generate;
mod gmsh;
mod gmsh_faults;
mod gmsh_volume;
mod hull;
mod laws;
mod loaded_side;
mod manufactured;
mod material;
mod mean_dilatation;
mod memory;
mod plane_stress;
mod quadrature;
mod random;
mod rules;
mod shapes;
mod solid;
mod space;
mod stl;
mod subdivided;
mod tetrahedron;
mod together;
mod tree;
mod triangles;
mod turn;
mod validity;
