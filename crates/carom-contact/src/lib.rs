//! Contact: surfaces, search, gaps and their derivatives, laws, active sets. A function of
//! positions, independent of time integration and matrices.

mod active_set;
pub mod interface;
pub mod kinematics;
mod pair;
mod places;
mod rows;

pub use active_set::{ActiveSet, Contender, Cycle};
pub use interface::{Answer, ConservingPenalty, Interface, Penalty, Point, Unilateral};
pub use kinematics::{ContactPoint, Detection, Kinematics, NodeToFacet, NodeToPlane, Surface};
pub use pair::{ContactError, Pair, PairEvent, Pairing};
pub use rows::{Row, Rows};
