//! Bodies: meshes, shapes, quadrature, materials and cell forces of the positional finite element method.

mod body;
mod mesh;

pub use body::{Body, Inverted, PointState};
pub use mesh::{Element, Facet, Mesh};
