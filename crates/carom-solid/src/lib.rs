//! Bodies: meshes, shapes, quadrature, materials and cell forces of the positional finite element
//! method.

mod bernstein;
mod body;
mod bounds;
#[doc(hidden)]
pub mod discrete_gradient;
mod earliest;
mod element_shape;
mod facet;
mod facet_bernstein;
mod facet_length;
mod facet_point;
mod factory;
pub mod generate;
pub mod gmsh;
mod loaded_side;
mod lumping;
pub mod material;
mod mesh;
mod net;
mod point_locator;
mod points;
mod positions;
mod potential;
pub mod quadrature;
mod quality;
#[doc(hidden)]
pub mod reference;
pub mod shape;
#[doc(hidden)]
pub mod solid;
pub mod stl;
mod subdivide;
mod tree;
mod triangles;
mod validity;

pub use bernstein::Direction;
pub use body::{Ask, Body, Configuration, Geometry, Inverted, PointState, Response};
pub use bounds::Bounds;
pub use earliest::{Earliest, Piece};
pub use facet::{FacetFunctions, FacetShape};
pub use facet_length::{longest_edge, shortest_edge};
pub use facet_point::FacetPoint;
pub use factory::{
    AveragedAtPoints, Constitutive, LawAtPoints, PlaneState, RegionMaterial, VolumeAveraged, body,
    body_of_regions, mean_dilatation_body, plane_stress_body,
};
pub use loaded_side::LoadedSide;
pub use lumping::cell_lumped_mass;
pub use material::{Law, Past};
pub use mesh::{Element, Facet, Mesh};
pub use net::Net;
pub use point_locator::PointLocator;
pub use points::LANES;
pub use positions::Positions;
pub use quality::WorstCell;
pub use shape::{Hull, LineShape, line_powers, line_shape};
pub use solid::{Solid, SolidError};
pub use tree::{REBUILT, Tree};
pub use triangles::{Triangles, TrianglesError};
pub use validity::{Loss, Validity};
