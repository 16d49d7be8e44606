//! Contacts: pairs of sides, with their laws.

use serde::{Deserialize, Serialize};

use super::formula::FormulaSpec;
use super::obstacle::{Obstacle, ObstacleMotion, PrimarySpec, Rigid};
use crate::keys::Kind::{Between, Formula, Name, Number, Side, SideOr, Truth};
use crate::keys::{IN_SPACE_AND_TIME, Keys, NOT_NEGATIVE, POSITIVE, Range, View};

const RESTITUTION: Range = Range { low: Some((0.0, true)), high: Some((1.0, true)) };

/// A contact pair: two sides that may come into contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "[[contact]]", later = ["passes", "normals"])]
pub struct ContactSpec {
    /// Name used in records and messages.
    #[key(Name, example = "\"strike\"")]
    pub name: String,
    /// Number of its table in the case.
    #[serde(default)]
    pub entry: usize,
    /// Secondary (slave) side: its nodes must not penetrate the primary. `body.skin` is the whole
    /// boundary of a body.
    #[key(Side, example = "\"cylinder.arc\"", unless = "between", with = secondary)]
    pub secondary: String,
    /// Primary (master) side, or a rigid obstacle: a table with one of `plane`, `circle`, `sphere`,
    /// `cylinder`, `polyline` and `surface`. If it is the secondary side, this side is in contact
    /// with itself.
    #[key(SideOr(&Rigid::TABLE), example = "\"prism.top\"", unless = "between", with = primary)]
    pub primary: PrimarySpec,
    /// In place of `secondary` and `primary`: contact between all pairs of bodies and of each with
    /// itself, for "all" bodies or those listed, on their whole boundaries or on a side
    /// `body.side`. Of two bodies the softer one (smaller λ + 2μ) is secondary; if they are equal,
    /// the first. A pair of bodies with a contact or a
    /// tie of its own is excluded. Contacts are named
    /// NAME-BODY-BODY and NAME-BODY, or NAME if there is one.
    #[key(Between, optional = "\"all\"", given)]
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub between: bool,
    /// With `between`: whether bodies are in contact with themselves, where their boundary folds.
    #[key(Truth, name = "self", default = "true")]
    #[serde(skip)]
    pub of_itself: (),
    /// Motion of a rigid obstacle.
    #[serde(default, skip_serializing_if = "ObstacleMotion::is_fixed")]
    pub motion: ObstacleMotion,
    /// Discretisation of the contact. `mortar`: dimension 2, implicit schemes.
    #[key(default = "\"node-to-segment\"")]
    #[serde(default, skip_serializing_if = "Method::is_of_nodes")]
    pub method: Method,
    /// With method = "mortar": the points at which gaps are measured.
    #[key(default = "\"segments\"")]
    #[serde(default, skip_serializing_if = "Quadrature::is_of_segments")]
    pub quadrature: Quadrature,
    /// Enforcement of the constraint.
    #[key(default = "\"multiplier\"")]
    pub enforcement: Enforcement,
    /// Stiffness of the springs: of a penalty, as a multiple of the mean diagonal entry of the
    /// tangent in the reference configuration at the secondary node, between nodes of a mean of
    /// theirs, and with method = "mortar" of the mean per area over the side, whatever its
    /// materials; of an augmented Lagrangian, of the diagonal of the step's tangent at the node,
    /// which changes the number of rounds; far too soft springs may bisect a step.
    #[key(Number(POSITIVE), default = "10.0")]
    pub stiffness: f64,
    /// What contact constrains. Default: the law of the scheme.
    #[key(example = "\"position\"")]
    pub law: Option<ContactLaw>,
    /// Weight of the contact force in the balance of a step.
    #[key(default = "\"alpha_f\"")]
    pub force: ForceTime,
    /// Velocities and accelerations at activation.
    #[key(default = "\"project\"", paper = "\"none\"")]
    pub persistency: Persistency,
    /// When the active set is updated.
    #[key(default = "\"within\"", paper = "\"after\"")]
    pub active_set: ActiveSetRule,
    /// Gap that decides whether a pair becomes active.
    #[key(default = "\"closest-point\"", paper = "\"trajectory\"")]
    pub detection: Detection,
    /// Point of the primary facet at which the gap is measured during a step.
    #[key(default = "\"closest\"")]
    #[serde(default)]
    pub xi: ContactPoint,
    /// Overlap of the bodies at the start.
    #[key(default = "\"refuse\"")]
    #[serde(default)]
    pub overlap: Overlap,
    /// Friction.
    #[key(flatten)]
    #[serde(default)]
    pub friction: FrictionSpec,
    /// Coefficient of restitution e: Newton's, for contact laws on velocities; with energy-momentum
    /// and multipliers, e² is the fraction of the energy lost in contact that is returned where
    /// nodes close or open (1 elastic, 0 inelastic); with paoli-schatzman, the weight of the
    /// previous position.
    #[key(Number(RESTITUTION), default = "0.0")]
    pub restitution: f64,
}

fn secondary(v: &View) -> Option<String> {
    if v.has("between") { Some(String::new()) } else { v.get("secondary") }
}

/// Reads the side `primary`; an empty name where it is an obstacle or follows from `between`.
fn primary(v: &View) -> Option<PrimarySpec> {
    let is_side = v.table.get("primary").is_some_and(|node| node.table().is_none());
    let side = if is_side && !v.has("between") { v.get("primary")? } else { String::new() };
    Some(PrimarySpec::Side(side))
}

impl ContactSpec {
    /// Reads a `[[contact]]`, the one with this number.
    pub(crate) fn of(v: &View, entry: usize) -> Option<Self> {
        let contact = Self::read(v);
        let is_obstacle = !v.has("between") && v.get::<String>("primary").is_none();
        let obstacle = if is_obstacle { Some(Rigid::of(v)?) } else { None };
        let mut contact = contact?;
        contact.entry = entry;
        if let Some(Obstacle { shape, motion }) = obstacle {
            contact.primary = shape;
            contact.motion = motion;
        }
        Some(contact)
    }
}

/// Discretisation of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Nodes of the secondary side against facets of the primary one.
    #[default]
    NodeToSegment,
    /// Gaps weighted with the shape functions of a pressure field on the secondary side: a uniform
    /// pressure passes between meshes that do not match, and the pressure converges under
    /// refinement.
    Mortar,
}

impl Method {
    #[allow(clippy::trivially_copy_pass_by_ref)] // Serde passes a reference.
    fn is_of_nodes(&self) -> bool {
        *self == Self::NodeToSegment
    }
}

/// Points of quadrature of mortar contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Quadrature {
    /// On each part of a secondary facet that faces a single facet of the primary.
    #[default]
    Segments,
    /// Fixed points of the secondary facets, k + 2 on each quarter of a facet of degree k. A
    /// uniform pressure passes meshes that do not match to 1e-4 … 5e-3 of it; at the ends of the
    /// primary points come and go.
    Fixed,
}

impl Quadrature {
    #[allow(clippy::trivially_copy_pass_by_ref)] // Serde passes a reference.
    fn is_of_segments(&self) -> bool {
        *self == Self::Segments
    }
}

/// The law of friction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Keys)]
pub struct FrictionSpec {
    /// Coefficient of Coulomb friction μ, for the slip of the secondary side on the primary one: a
    /// node sticks while its tangential force is less than μ times its normal force, and otherwise
    /// slips against exactly this force. A number, or a formula of the node's reference position
    /// and time. 0: no friction. Default: no friction, or that of `shear`. Dimensions 2 and 3.
    #[key(Formula(IN_SPACE_AND_TIME), example = "0.3")]
    pub mu: Option<FormulaSpec>,
    /// Coefficient of friction of a node that slips, at most `mu`, which is then that of a node
    /// that sticks. Where a formula `mu` is smaller, it is used for both. Default: `mu`.
    #[key(Number(NOT_NEGATIVE), example = "0.2")]
    pub mu_dynamic: Option<f64>,
    /// Rate c of the transition to `mu_dynamic`: at a slip rate v, μ = mu_dynamic + (mu −
    /// mu_dynamic) exp(−c v). In load steps, v is the rate in the time of their formulas. Default:
    /// an immediate transition.
    #[key(Number(POSITIVE), unit = "time/length", example = "10.0")]
    pub decay: Option<f64>,
    /// Largest tangential stress (Tresca friction): a node slips against this stress times its area
    /// in the reference configuration if μ times its normal force is larger, or if `mu` is not
    /// given. The secondary side must not have sharp edges, except in mortar contact.
    #[key(Number(POSITIVE), unit = "stress", example = "1e3")]
    pub shear: Option<f64>,
    /// Stiffness of the tangential spring of a node that sticks, as `stiffness`. With enforcement =
    /// "penalty" its energy counts as strain energy. Default: `stiffness`.
    #[key(Number(POSITIVE), example = "10.0")]
    pub stick_stiffness: Option<f64>,
}

impl FrictionSpec {
    /// Whether there is friction.
    pub fn exists(&self) -> bool {
        self.mu.as_ref().map_or(self.shear.is_some(), |mu| !mu.is_zero())
    }
}

impl ContactSpec {
    /// Path of a key in the table of the contact; that of `between` for sides that follow from it.
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

/// How the contact constraint is enforced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Enforcement {
    /// Exact, by a Lagrange multiplier.
    Multiplier,
    /// Springs of potential k/2 min(g, 0)², whose energy counts as strain energy.
    Penalty,
    /// An augmented Lagrangian: springs on multipliers that are updated in rounds (Uzawa
    /// iterations) until gaps of closed nodes and slips of sticking ones are below 1e-10 of the
    /// size of the model.
    Augmented,
}

impl Enforcement {
    /// Whether closed gaps are zero.
    pub fn is_exact(self) -> bool {
        self != Self::Penalty
    }
}

/// What a contact constrains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum ContactLaw {
    /// Positions at the end of the step.
    Position,
    /// The predictor y + Δt v, and positions at the end of the step (contact-stabilised).
    Predictor,
    /// Velocities, by impulses: 0 ≤ G v_{n+1} + e G v_n ⊥ P ≥ 0 where the predicted gap is closed.
    Velocity,
}

/// When the contact force acts in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "snake_case")]
pub enum ForceTime {
    /// Averaged with α_f, eq. (15).
    AlphaF,
    /// At the end of the step.
    End,
}

/// What happens to velocities and accelerations at activation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Persistency {
    /// Projected onto the constraints, so that they are compatible with them.
    Project,
    /// Left unchanged, as in the paper.
    None,
}

/// When the active set is updated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum ActiveSetRule {
    /// In every Newton iteration (primal–dual).
    Within,
    /// After Newton's method has converged, as in the paper.
    After,
}

/// Which gap decides about activation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Detection {
    /// The gap at the closest point; trajectories only find candidates.
    ClosestPoint,
    /// The gap at the ξ of the trajectory crossing, eq. (8) as printed.
    Trajectory,
}

/// The point of the primary facet at which the gap is measured during a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum ContactPoint {
    /// The closest point, recomputed in every iteration.
    #[default]
    Closest,
    /// As printed in the paper: that of the trajectory crossing in the first step of a contact, and
    /// the closest point at the start of the step in later ones.
    Frozen,
}

/// What happens to an overlap of the bodies at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Overlap {
    /// An error.
    #[default]
    Refuse,
    /// Closed before the start, which leaves the bodies in equilibrium under the pressure of an
    /// interference fit.
    Relax,
    /// Allowed: the gap of every node is larger by its depth at the start, to the end of the run.
    KeepGap,
    /// The sides touch all over at the start: gaps and overlaps between their meshes, as those of
    /// chords of one curve, count as zero to the end of the run.
    Touch,
}
