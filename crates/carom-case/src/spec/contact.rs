//! Contacts: which sides may touch, and by what rules.

use serde::{Deserialize, Serialize};

/// Two sides that may touch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactSpec {
    /// Name in records and messages.
    pub name: String,
    /// Side whose nodes are kept out of the primary.
    pub secondary: String,
    /// What they are kept out of.
    pub primary: PrimarySpec,
    /// How the constraint is kept.
    pub enforcement: Enforcement,
    /// Stiffness of a penalty, in units of the secondary node's own.
    pub stiffness: f64,
    /// When during a step the contact force acts.
    pub force: ForceTime,
    /// What happens to velocities where contact begins.
    pub persistency: Persistency,
    /// When the active set may change.
    pub active_set: ActiveSetRule,
    /// Which gap decides activation.
    pub detection: Detection,
    /// What contact holds: that of the scheme once resolved.
    pub law: Option<ContactLaw>,
    /// Newton's e, 0 … 1.
    pub restitution: f64,
}

/// Primary side of a contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PrimarySpec {
    /// A side of a body, `body.side`.
    Side(String),
    /// A rigid half-space.
    Plane {
        /// A point of its boundary.
        point: Vec<f64>,
        /// Direction out of the half-space, of any length > 0.
        normal: Vec<f64>,
    },
}

/// How a contact's constraint is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Enforcement {
    /// Exactly, by a Lagrange multiplier.
    Multiplier,
    /// By springs of potential k/2 min(g, 0)².
    Penalty,
}

/// What a contact constrains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactLaw {
    /// Positions at the end of the step.
    Position,
    /// The predictor y + Δt v, and positions at the end of the step.
    Predictor,
    /// Velocities, by impulses: 0 ≤ G v_{n+1} + e G v_n ⊥ P ≥ 0 where the gap is predicted closed.
    Velocity,
}

/// When during a step the contact force acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ForceTime {
    /// Averaged with α_f, eq. (15).
    AlphaF,
    /// At the end of the step.
    End,
}

/// What happens to velocities and accelerations where contact begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Persistency {
    /// v and a are projected on the active constraints.
    Project,
    /// Nothing, as in the paper.
    None,
}

/// When the active set may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ActiveSetRule {
    /// In every Newton iteration (primal–dual).
    Within,
    /// After Newton converged, as in the paper.
    After,
}

/// Which gap decides activation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Detection {
    /// The gap at the closest point; trajectories give candidates.
    ClosestPoint,
    /// The gap at the trajectory's ξ, eq. (8) as printed.
    Trajectory,
}
