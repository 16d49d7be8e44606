//! Contact and friction in the equations of a stage.

pub(crate) mod augmented;
pub mod constraints;
pub(crate) mod depths;
pub(crate) mod forces;
pub(crate) mod friction;
pub(crate) mod friction_tangent;
pub(crate) mod independent;
pub(crate) mod loose;
pub(crate) mod prevented_slips;
pub(crate) mod rounds;
pub(crate) mod slip_derivatives;
pub(crate) mod update;
