//! Contact: surfaces, search, gaps and their derivatives, active sets. A function of positions; time and matrices are elsewhere.

mod active_set;
mod node_to_node;
mod node_to_plane;
mod node_to_segment;
mod pair;
mod projection;
mod surface;
mod trajectory;

pub use active_set::{ActiveSet, Contender, Cycle};
pub use node_to_node::NodeToNode;
pub use node_to_plane::NodeToPlane;
pub use node_to_segment::{Detection, NodeToSegment};
pub use pair::{ContactError, ContactMethod, Linearised, Pair, PairEvent, STENCIL};
pub use surface::Surface;
