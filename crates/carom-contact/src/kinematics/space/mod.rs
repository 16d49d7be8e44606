//! Contact of curved facets in space: facets and their closest points, the boundary that they form,
//! gaps with their derivatives, and the pairs of secondary nodes with them.

mod boundary;
mod candidate;
mod crease;
mod crossing;
mod gap;
mod node_to_patch;
mod patch;

pub use boundary::{Boundary, ClosedSurface};
pub use node_to_patch::NodeToPatch;
pub(super) use patch::cross;
