//! Contact of curved facets in space: facets and their closest points, the boundary that they form,
//! gaps with their derivatives, and the pairs of secondary nodes with them; pairs of sharp edges;
//! where a boundary can meet itself.

mod boundary;
mod candidate;
mod clear;
mod closed_surface;
mod crease;
mod crosses;
mod crossing;
mod edge_crossing;
mod edge_gap;
mod edge_joint;
mod edge_points;
mod edge_to_edge;
mod edges;
#[doc(hidden)]
pub mod folds;
mod gap;
mod itself;
mod node_to_patch;
mod passed;
#[doc(hidden)]
pub mod patch;
mod patch_rows;
mod paths;

pub use boundary::Boundary;
pub use closed_surface::ClosedSurface;
pub use edge_points::EdgePoints;
pub use edge_to_edge::EdgeToEdge;
pub use node_to_patch::NodeToPatch;
pub(crate) use patch::{Feature, cross};
