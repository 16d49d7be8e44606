//! Contact: surfaces, search, gaps and their derivatives, laws, active sets. A function of
//! positions, independent of time integration and matrices.

mod active_set;
mod angle;
pub mod constants;
mod depth;
mod discrete_gradient;
mod friction;
mod inside_itself;
pub mod interface;
pub mod kinematics;
mod pair;
#[doc(hidden)]
pub mod places;
mod rows;
mod skin;
mod solid_angle;
mod visited;

pub use active_set::{ActiveSet, Contender, Cycle};
pub use discrete_gradient::DiscreteGradient;
pub use friction::{
    Along, Coefficient, FrictionPair, FrictionState, Law, Radius, StateChange, StickSlip, Tangential, inner,
    length,
};
pub use inside_itself::InsideItself;
pub use interface::{
    Answer, Augmented, ConservingPenalty, ConservingUnilateral, Direction, Interface, Penalty, Point,
    Unilateral,
};
pub use kinematics::{
    AtJoints, BetweenNodes, Boundary, Carrier, ClosedSurface, Combined, ContactPoint, Crossings, Depth,
    Detection, EdgePoints, EdgeToEdge, Faceted, InPlane, Kinematics, Mortar, NodalPressure, NodeToFacet,
    NodeToObstacle, NodeToPatch, NodesWithDepth, Obstacle, OnFacet, Outward, Passed, Polyline, PolylineError,
    Quadrature, Side, SpaceHit, Surface, Swept, SweptEdges, SweptPatch, SweptTest, Tip, TipToFacet,
};
pub use pair::{ContactError, Pair, PairEvent, Pairing};
pub use rows::{Row, Rows};
pub use skin::Skin;
pub use solid_angle::solid_angle;
