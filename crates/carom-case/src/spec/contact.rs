//! Contacts: pairs of sides, with their laws.

use serde::{Deserialize, Serialize};

use super::formula::FormulaSpec;
use super::obstacle::{ObstacleMotion, SurfaceSpec};

/// A contact pair: two sides that may come into contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactSpec {
    /// Name used in records and messages.
    pub name: String,
    /// Number of its table in the case.
    #[serde(default)]
    pub entry: usize,
    /// Whether it is one of the contacts that the key `between` of its table stands for.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub between: bool,
    /// Secondary (slave) side: its nodes must not penetrate the primary.
    pub secondary: String,
    /// Primary (master) side, which may be the secondary one, or a rigid obstacle.
    pub primary: PrimarySpec,
    /// Motion of a rigid obstacle.
    #[serde(default, skip_serializing_if = "ObstacleMotion::is_fixed")]
    pub motion: ObstacleMotion,
    /// How the constraint is enforced.
    pub enforcement: Enforcement,
    /// Stiffness of springs: of a penalty, as a multiple of the reference stiffness of the
    /// secondary node; of an augmented Lagrangian, of the diagonal of the step's tangent there.
    pub stiffness: f64,
    /// When the contact force acts in a step.
    pub force: ForceTime,
    /// What happens to velocities and accelerations at activation.
    pub persistency: Persistency,
    /// When the active set is updated.
    pub active_set: ActiveSetRule,
    /// Which gap decides about activation.
    pub detection: Detection,
    /// Where the gap is measured during a step; the closest point in records written before this
    /// key existed.
    #[serde(default)]
    pub xi: ContactPoint,
    /// What contact constrains; once resolved, the default is the law of the scheme.
    pub law: Option<ContactLaw>,
    /// What happens to an overlap of the bodies at the start.
    #[serde(default)]
    pub overlap: Overlap,
    /// Friction.
    #[serde(default)]
    pub friction: FrictionSpec,
    /// Coefficient of restitution e, 0 … 1: Newton's, for laws on velocities; for a constraint that
    /// conserves, e² is the share of the energy taken that is returned.
    pub restitution: f64,
}

/// The law of friction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrictionSpec {
    /// μ, in stick if `mu_dynamic` is given; zero: no friction; none: that of `shear` alone.
    pub mu: Option<FormulaSpec>,
    /// μ in slip.
    pub mu_dynamic: Option<f64>,
    /// Rate of the transition between them, time per length.
    pub decay: Option<f64>,
    /// Largest tangential stress.
    pub shear: Option<f64>,
    /// Stiffness of tangential springs, as a multiple of the reference stiffness.
    pub stick_stiffness: Option<f64>,
}

impl FrictionSpec {
    /// Whether there is friction.
    pub fn exists(&self) -> bool {
        self.mu.as_ref().map_or(self.shear.is_some(), |mu| !mu.is_zero())
    }
}

impl ContactSpec {
    /// Path of a key of its table, of `between` for the sides that this stands for.
    pub fn path(&self, key: &str) -> String {
        let of_side = key == "secondary" || key == "primary";
        format!("contact[{}].{}", self.entry, if self.between && of_side { "between" } else { key })
    }

    /// Whether a side is in contact with itself.
    pub fn is_of_itself(&self) -> bool {
        self.primary.side() == Some(&self.secondary)
    }

    /// Names of the bodies of its sides, the secondary one first.
    pub fn bodies(&self) -> impl Iterator<Item = &str> {
        let sides = [Some(self.secondary.as_str()), self.primary.side()];
        sides.into_iter().flatten().filter_map(|side| Some(side.split_once('.')?.0))
    }
}

/// Primary side of a contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PrimarySpec {
    /// A side of a body, `body.side`.
    Side(String),
    /// A rigid half-space.
    Plane {
        /// A point on its boundary.
        point: Vec<f64>,
        /// Outward normal, of any length > 0.
        normal: Vec<f64>,
    },
    /// A rigid circle; in space a sphere.
    Circle {
        /// Its centre.
        center: Vec<f64>,
        /// Its radius, > 0.
        radius: f64,
        /// Whether bodies are inside it.
        inside: bool,
    },
    /// A rigid infinite cylinder.
    Cylinder {
        /// A point of its axis.
        point: Vec<f64>,
        /// Direction of its axis, of any length > 0.
        axis: Vec<f64>,
        /// Its radius, > 0.
        radius: f64,
        /// Whether bodies are inside it.
        inside: bool,
    },
    /// A rigid triangulated surface.
    Surface(SurfaceSpec),
    /// A rigid chain of segments with the material to the left of the direction of travel.
    Polyline {
        /// Its points; closed if the last one repeats the first.
        points: Vec<[f64; 2]>,
        /// Radius of its corners, ≥ 0.
        radius: f64,
    },
}

impl PrimarySpec {
    /// The side of a body; none of a rigid obstacle.
    pub fn side(&self) -> Option<&str> {
        if let Self::Side(side) = self { Some(side) } else { None }
    }
}

/// How the contact constraint is enforced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Enforcement {
    /// Exactly, by a Lagrange multiplier.
    Multiplier,
    /// By penalty springs of potential k/2 min(g, 0)².
    Penalty,
    /// To a tolerance, by springs on multipliers that are renewed until gaps are closed.
    Augmented,
}

impl Enforcement {
    /// Whether closed gaps are zero.
    pub fn is_exact(self) -> bool {
        self != Self::Penalty
    }
}

/// What a contact constrains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactLaw {
    /// Positions at the end of the step.
    Position,
    /// The predictor y + Δt v, and positions at the end of the step.
    Predictor,
    /// Velocities, by impulses: 0 ≤ G v_{n+1} + e G v_n ⊥ P ≥ 0 where the predicted gap is closed.
    Velocity,
}

/// When the contact force acts in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ForceTime {
    /// Averaged with α_f, eq. (15).
    AlphaF,
    /// At the end of the step.
    End,
}

/// What happens to velocities and accelerations at activation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Persistency {
    /// v and a are projected onto the active constraints.
    Project,
    /// They are left unchanged, as in the paper.
    None,
}

/// When the active set is updated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ActiveSetRule {
    /// In every Newton iteration (primal–dual).
    Within,
    /// After Newton's method has converged, as in the paper.
    After,
}

/// Which gap decides about activation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Detection {
    /// The gap at the closest point; trajectories only find candidates.
    ClosestPoint,
    /// The gap at the ξ of the trajectory crossing, eq. (8) as printed.
    Trajectory,
}

/// The point of the primary facet at which the gap is measured during a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactPoint {
    /// The closest point of the iterate.
    #[default]
    Closest,
    /// The crossing of the paths, then the closest point at the start of the step, as in the paper.
    Frozen,
}

/// What happens to an overlap of the bodies at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Overlap {
    /// It is an error.
    #[default]
    Refuse,
    /// It is closed before the start: the bodies begin in equilibrium with the pressure that closes
    /// it.
    Relax,
    /// The gap of every node is larger by its depth at the start, to the end of the run.
    KeepGap,
}
