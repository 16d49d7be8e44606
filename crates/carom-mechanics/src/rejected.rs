//! Reasons for rejecting a step, with names, for the log and its readers.
//!
//! A quantity has its dimension in brackets, `0.1 [length]`: whoever knows the units of the case
//! puts their labels there.

use carom_algebra::LinearError;
use carom_contact::ContactError;
use carom_solid::Inverted;

use crate::model::{NoValue, Unconstrained};

/// Relative singular value of the interface below which stick and slip count as not unique.
pub(crate) const SINGULAR: f64 = 1e-6;

/// A rejected step; it is bisected, or ends the run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Rejected {
    /// A cell is inverted.
    #[error("body \"{body}\": {inverted}")]
    Inverted {
        /// Body.
        body: String,
        /// Cell and J.
        inverted: Inverted,
    },
    /// A cell is inverted within the step, while its nodes move on straight lines.
    #[error(
        "body \"{body}\": cell {cell} is inverted within the step, at {theta:.4} of it, while its nodes move on straight lines"
    )]
    InvertedOnTheWay {
        /// Body.
        body: String,
        /// The cell.
        cell: usize,
        /// Share of the step that has passed.
        theta: f64,
    },
    /// A gap is not usable.
    #[error("contact \"{contact}\": {error}")]
    Contact {
        /// Contact.
        contact: String,
        /// The error of the pair.
        error: ContactError,
    },
    /// Newton did not converge.
    #[error(
        "Newton's method did not converge in {iterations} iterations: last correction {:.2e} L (allowed: {:.1e}), residual {:.2e} of the sum of forces (allowed: {:.1e}){}{}{}",
        step[0], step[1], residual[0], residual[1], open(*gap),
        if *unbalanced && residual[0] <= residual[1] { "; the forces on a body with friction do not balance as a whole" } else { "" },
        if *changing { "; contacts still opened, closed or changed" } else { "" }
    )]
    NoConvergence {
        /// Number of iterations.
        iterations: u32,
        /// ‖Δy‖∞/L, and what is allowed.
        step: [f64; 2],
        /// ‖r‖/Σ‖f‖, and what is allowed.
        residual: [f64; 2],
        /// Largest |g|/L of an active constraint, and what is allowed; none without contact.
        gap: Option<[f64; 2]>,
        /// Whether the resultants of the forces do not balance, which friction requires.
        unbalanced: bool,
        /// Whether a contact opened or closed, or changed its facet or its stick or slip, in the
        /// last iteration.
        changing: bool,
    },
    /// The multipliers of an augmented Lagrangian were not found.
    #[error(
        "the augmented Lagrangian did not close its contacts in {rounds} rounds (Uzawa iterations): the largest gap or slip is {:.2e} L (allowed: {:.0e}); supports may prevent a node from moving out",
        gap[0], gap[1]
    )]
    NoMultipliers {
        /// Number of rounds.
        rounds: u32,
        /// Largest gap of a closed pair, or slip of a sticking one, over L, and what is allowed.
        gap: [f64; 2],
    },
    /// The active set returns to one visited before.
    #[error(
        "contact \"{contact}\": the active set does not converge: nodes {nodes:?} alternate between open \
        and closed"
    )]
    Cycle {
        /// Contact.
        contact: String,
        /// Global numbers of the nodes.
        nodes: Vec<usize>,
    },
    /// The states of friction return to those visited before.
    #[error(
        "contact \"{contact}\": the stick and slip states do not converge: nodes {nodes:?} alternate between stick and slip{}",
        if *regularity < SINGULAR {
            format!(
                "; μ is so large that stick and slip are not unique (relative singular value {regularity:.3}, negative where the determinant is)"
            )
        } else {
            String::new()
        }
    )]
    StickSlipCycle {
        /// Contact.
        contact: String,
        /// Global numbers of the nodes.
        nodes: Vec<usize>,
        /// The smallest relative singular value of the interface, with the sign of its determinant.
        regularity: f64,
    },
    /// Tractions of friction and multipliers at a start or a projection do not converge.
    #[error(
        "friction at the start or at a projection does not converge: it is too large for the mass near the contact"
    )]
    NoFrictionBalance,
    /// The linear system could not be solved.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// An active constraint cannot be satisfied: its row has no independent free dofs.
    #[error(
        "contact \"{contact}\": node {node} penetrates by {depth:.3e} [length], and supports, ties or other contacts prevent it from moving out"
    )]
    Overconstrained {
        /// Contact.
        contact: String,
        /// Global number of the secondary node.
        node: usize,
        /// Penetration.
        depth: f64,
    },
    /// The mass matrix is not positive definite.
    #[error(
        "the mass matrix is not positive definite: redistributed mass needs more nodes behind the contact"
    )]
    NegativeMass,
    /// A load or a motion has no value.
    #[error(transparent)]
    NoValue(#[from] NoValue),
    /// Without inertia, a body is unconstrained.
    #[error(transparent)]
    Unconstrained(#[from] Unconstrained),
    /// A moving support does not start at the position of its formula.
    #[error(
        "a moved support would jump: node {node} is {distance:.3e} [length] from its prescribed position at t = 0; let the motion begin where the node is"
    )]
    Jump {
        /// Global number of the node.
        node: usize,
        /// Distance along the moved direction.
        distance: f64,
    },
    /// The contact forces of an explicit step do not converge.
    #[error(
        "the contact forces of an explicit step did not converge in {rounds} iterations: the error of a gap is still {gap:.3e} [length]"
    )]
    Unsettled {
        /// Number of linearisations.
        rounds: u32,
        /// Largest error of a gap.
        gap: f64,
    },
    /// Penetration deeper than the scheme's law allows in one step.
    #[error(
        "a node penetrates by {} [length], more than the {} [length] that the contact law allows in this step",
        apart(*depth, *bound)[0], apart(*depth, *bound)[1]
    )]
    Deep {
        /// Depth of the deepest node.
        depth: f64,
        /// The bound of the law.
        bound: f64,
    },
    /// A node, a point of a sharp edge, or a rigid obstacle lies deeper in a body than the contact
    /// allows.
    #[error(
        "contact \"{contact}\": {what} {node} lies {} [length] deep in body \"{body}\", more than the allowed {} [length]",
        apart(*depth, *limit)[0], apart(*depth, *limit)[1]
    )]
    Penetration {
        /// Contact.
        contact: String,
        /// What lies there, in words that the node's number follows.
        what: &'static str,
        /// Global number of the node.
        node: usize,
        /// The body that it has entered.
        body: String,
        /// Distance to the boundary of that body.
        depth: f64,
        /// Allowed depth.
        limit: f64,
    },
    /// A node, or a sharp edge, enters the other body and leaves it within the step.
    #[error(
        "contact \"{contact}\": {what} {node} passes through the other body within the step, {} [length] deep, more than the allowed {} [length]",
        apart(*depth, *limit)[0], apart(*depth, *limit)[1]
    )]
    Passed {
        /// Contact.
        contact: String,
        /// What passes, in words that the node's number follows.
        what: &'static str,
        /// Global number of the node.
        node: usize,
        /// Its largest depth on the way.
        depth: f64,
        /// Allowed depth.
        limit: f64,
    },
    /// A step created energy.
    #[error(
        "the step created energy: {created:.3e} [energy], more than the {allowed:.3e} [energy] that the energy guard allows one step"
    )]
    Energy {
        /// Rise of total − external work above its running minimum in this step.
        created: f64,
        /// Allowed rise.
        allowed: f64,
    },
    /// An explicit step exceeds what is stable for the deformed bodies.
    #[error(
        "it exceeds the largest stable step of the bodies as they are deformed, which is at most {longest:.3e} [time]"
    )]
    Unstable {
        /// Bound of the stable step.
        longest: f64,
    },
    /// A number is not finite.
    #[error("{what} is not finite")]
    NotFinite {
        /// Which number.
        what: &'static str,
    },
}

/// A depth and the smaller one that is allowed, with four digits, or so many that they differ.
fn apart(depth: f64, limit: f64) -> [String; 2] {
    let written = |digits: usize| [depth, limit].map(|x| format!("{x:.digits$e}"));
    let differ = |texts: &[String; 2]| texts[0] != texts[1];
    (3..16).map(written).find(differ).unwrap_or_else(|| written(16))
}

/// The part of a message about a constraint that is not satisfied.
fn open(gap: Option<[f64; 2]>) -> String {
    let violated = gap.filter(|[gap, allowed]| gap > allowed);
    violated.map_or_else(String::new, |[gap, allowed]| format!(", gap {gap:.2e} L (allowed: {allowed:.1e})"))
}

impl Rejected {
    /// Whether no step to this time can be accepted, however short: a formula has no value there,
    /// or one that is not allowed.
    pub(crate) fn is_final(&self, end: f64) -> bool {
        matches!(self, Self::NoValue(NoValue { time, value, .. }) if value.is_finite() || *time == end)
    }

    /// Keyword for the log.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Inverted { .. } | Self::InvertedOnTheWay { .. } => "inverted-cell",
            Self::Contact { .. } => "contact-geometry",
            Self::NoConvergence { .. } | Self::NoMultipliers { .. } | Self::Unsettled { .. } => {
                "no-convergence"
            }
            Self::Cycle { .. } => "active-set-cycle",
            Self::StickSlipCycle { .. } => "stick-slip-cycle",
            Self::NoFrictionBalance => "friction-balance",
            Self::Linear(_) => "linear-solver",
            Self::Overconstrained { .. } => "overconstrained-contact",
            Self::NegativeMass => "negative-mass",
            Self::NoValue(_) => "no-value",
            Self::Unconstrained(_) => "unconstrained-body",
            Self::Jump { .. } => "jump",
            Self::Deep { .. } | Self::Penetration { .. } | Self::Passed { .. } => "penetration",
            Self::Energy { .. } => "energy-created",
            Self::Unstable { .. } => "unstable-step",
            Self::NotFinite { .. } => "not-finite",
        }
    }
}
