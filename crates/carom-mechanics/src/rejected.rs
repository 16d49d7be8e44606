//! Why a step was not accepted: with names, for the log and for the person who reads it.

use carom_algebra::LinearError;
use carom_contact::ContactError;
use carom_solid::Inverted;

use crate::model::{NoValue, Unconstrained};

/// A step that was not accepted; it is bisected, or ends the run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Rejected {
    /// A cell turned inside out.
    #[error("body \"{body}\": {inverted}")]
    Inverted {
        /// Body.
        body: String,
        /// Cell and J.
        inverted: Inverted,
    },
    /// A gap has no usable value.
    #[error("contact \"{contact}\": {error}")]
    Contact {
        /// Contact.
        contact: String,
        /// What is wrong with the pair.
        error: ContactError,
    },
    /// Newton did not converge.
    #[error(
        "Newton's method did not converge in {iterations} iterations: last step {step:.2e} L, residual {residual:.2e} of the forces"
    )]
    NoConvergence {
        /// Iterations made.
        iterations: u32,
        /// ‖Δy‖∞/L.
        step: f64,
        /// ‖r‖/Σ‖f‖.
        residual: f64,
    },
    /// The active set keeps returning to one visited before.
    #[error("contact \"{contact}\": nodes {nodes:?} open and close in turn")]
    Cycle {
        /// Contact.
        contact: String,
        /// Global numbers of the nodes.
        nodes: Vec<usize>,
    },
    /// The linear system could not be solved.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// An active pair could not be held: its row says nothing about free dofs.
    #[error("contact \"{contact}\": node {node} penetrates by {depth:.3e} and supports leave it no way out")]
    Stuck {
        /// Contact.
        contact: String,
        /// Global number of the secondary node.
        node: usize,
        /// Penetration.
        depth: f64,
    },
    /// The mass matrix does not make every motion cost energy.
    #[error(
        "the mass matrix is not positive definite: redistributed mass needs more nodes behind the contact"
    )]
    NegativeMass,
    /// A load or a motion has no value.
    #[error(transparent)]
    NoValue(#[from] NoValue),
    /// Without inertia, nothing holds a body.
    #[error(transparent)]
    Unconstrained(#[from] Unconstrained),
    /// A moved support is not where its formula has it at the start.
    #[error(
        "a moved support would jump: node {node} is {distance:.3e} away from where its `move` has it at t = 0; let the formula begin where the node is"
    )]
    Jump {
        /// Global number of the node.
        node: usize,
        /// Distance along the moved direction.
        distance: f64,
    },
    /// The contact forces of an explicit step do not settle.
    #[error(
        "the contact forces of an explicit step did not settle in {rounds} rounds: a gap is still off by {gap:.3e}"
    )]
    Unsettled {
        /// Linearisations made.
        rounds: u32,
        /// Largest error of a gap.
        gap: f64,
    },
    /// Deeper than the scheme's law allows in one step.
    #[error(
        "a node penetrates by {depth:.3e}, more than the {bound:.3e} that the contact law explains in this step"
    )]
    Deep {
        /// Deepest node.
        depth: f64,
        /// What the law allows.
        bound: f64,
    },
    /// A number is not finite.
    #[error("{what} is not finite")]
    NotFinite {
        /// Which number.
        what: &'static str,
    },
}

impl Rejected {
    /// One word for the log.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Inverted { .. } => "inverted-cell",
            Self::Contact { .. } => "contact-geometry",
            Self::NoConvergence { .. } | Self::Unsettled { .. } => "no-convergence",
            Self::Cycle { .. } => "active-set-cycle",
            Self::Linear(_) => "linear-solver",
            Self::Stuck { .. } => "stuck-contact",
            Self::NegativeMass => "negative-mass",
            Self::NoValue(_) => "no-value",
            Self::Unconstrained(_) => "unconstrained-body",
            Self::Jump { .. } => "jump",
            Self::Deep { .. } => "penetration",
            Self::NotFinite { .. } => "not-finite",
        }
    }
}
