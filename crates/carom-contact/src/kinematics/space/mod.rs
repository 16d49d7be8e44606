//! Contact of curved facets in space: facets and their closest points, the boundary that they form,
//! gaps with their derivatives, and the pairs of secondary nodes with them; pairs of sharp edges.

mod boundary;
mod candidate;
mod crease;
mod crossing;
mod edge_crossing;
mod edge_gap;
mod edge_to_edge;
mod edges;
mod gap;
mod node_to_patch;
mod passed;
mod patch;
mod with_edges;

pub use boundary::{Boundary, ClosedSurface};
pub use edge_to_edge::EdgeToEdge;
pub use node_to_patch::NodeToPatch;
pub(super) use patch::cross;
pub use with_edges::WithEdges;
