//! A case file read, checked and resolved: text to numbers, every default filled in, every name still a name, every mistake with its
//! place. What `manifest.json` records and `resume` reads back. Knows nothing of mechanics.

mod check;
mod columns;
mod conform;
mod document;
mod draft;
mod expect;
pub mod keys;
mod load;
mod load_table;
mod make;
mod mesh;
mod mesh_file;
mod overrides;
mod place;
mod problem;
mod read;
mod schema;
mod scheme;
mod suggest;
#[cfg(test)]
mod tests;
mod tree;
mod view;
mod warnings;

use std::collections::BTreeMap;
use std::path::PathBuf;

use carom_record::FieldFormat;
use serde::{Deserialize, Serialize};

pub use carom_record::{Bound, Expect as ExpectSpec};
pub use columns::history_columns;
pub use document::Document;
pub use expect::{Asked, read_expects};
pub use load::{FormulaSpec, InitialSpec, LoadKind, LoadSpec, TableSpec, Velocities, load_variables};
pub use problem::{CaseError, Diagnostic, Problem};
pub use read::{read, read_scheme};
pub use schema::{changes, expectation, schema};

/// One simulation, fully resolved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Title for figures and pages.
    pub title: String,
    /// Space dimension: 1 or 2.
    pub dimension: usize,
    /// Plane strain or plane stress; dimension 2.
    pub plane: Plane,
    /// Out-of-plane thickness; in dimension 1 the area of the cross-section.
    pub thickness: f64,
    /// Labels for figures and columns; nothing is converted.
    pub units: Units,
    /// Set of defaults the case was resolved with.
    pub preset: Preset,
    /// Materials by name.
    pub materials: Vec<MaterialSpec>,
    /// Deformable bodies.
    pub bodies: Vec<BodySpec>,
    /// Sides held or moved.
    pub supports: Vec<SupportSpec>,
    /// Forces on sides and in bodies.
    #[serde(default)]
    pub loads: Vec<LoadSpec>,
    /// The run whose end is the start; none: the reference positions.
    #[serde(default)]
    pub initial: Option<InitialSpec>,
    /// The motion that loads, boundary and start are derived from: positions, formulas in X, Y, t.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manufactured: Option<Vec<FormulaSpec>>,
    /// Contact pairs of sides.
    pub contacts: Vec<ContactSpec>,
    /// Time interval, step and scheme.
    pub time: TimeSpec,
    /// Newton's method.
    pub newton: NewtonSpec,
    /// Points whose quantities become columns.
    pub probes: Vec<ProbeSpec>,
    /// What is written, and when.
    pub output: OutputSpec,
    /// What columns should be, as formulas in t.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub exact: BTreeMap<String, String>,
    /// Expected values that make the case a test.
    pub expects: Vec<ExpectSpec>,
}

impl Case {
    /// A measure of the work it is, to put long runs before short ones: steps × nodes.
    pub fn work(&self) -> f64 {
        let nodes: f64 = self.bodies.iter().map(|body| body.mesh.estimate(body.element).1).sum();
        self.time.steps() as f64 * nodes
    }
}

/// Plane state of a two-dimensional body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Plane {
    /// No strain out of the plane.
    Strain,
    /// No stress out of the plane.
    Stress,
}

/// Labels of the units the case's numbers are in.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Units {
    /// Length, `m` by default.
    pub length: String,
    /// Time, `s` by default.
    pub time: String,
    /// Mass, `kg` by default.
    pub mass: String,
}

/// Which column of the table of defaults a case starts from (explicit keys win).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Carom's defaults.
    Default,
    /// The paper as printed, where a switch exists for it.
    Paper,
}

/// A hyperelastic material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaterialSpec {
    /// Name bodies refer to.
    pub name: String,
    /// Law.
    pub law: Law,
    /// Mass per reference volume, ≥ 0.
    pub density: f64,
    /// First Lamé constant Λ.
    pub lambda: f64,
    /// Second Lamé constant μ.
    pub mu: f64,
}

/// Constitutive law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// Ψ = μ(tr E − ln J) + Λ/2 (ln J)².
    NeoHookean,
    /// Ψ = Λ/2 (tr E)² + μ E : E.
    SaintVenantKirchhoff,
    /// Small strain, Ψ = Λ/2 (tr ε)² + μ ε : ε.
    LinearElastic,
}

/// A deformable body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodySpec {
    /// Name; sides are `name.side`.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// Cell type.
    pub element: carom_solid::Element,
    /// Where its mesh comes from.
    pub mesh: MeshSpec,
    /// Where the mesh is put; as it is made, if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<PlaceSpec>,
    /// Positions at t = 0, formulas in X, Y; the reference positions, if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<Vec<FormulaSpec>>,
    /// Acceleration by gravity, one component per dimension.
    pub gravity: Vec<f64>,
    /// Initial velocity, formulas in X, Y.
    pub velocity: Vec<FormulaSpec>,
    /// Mass matrix.
    pub mass: MassKind,
}

/// A rigid motion of a mesh: x ↦ about + R(rotate)(x − about) + shift.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaceSpec {
    /// Angle in degrees, counter-clockwise; 0 in dimension 1.
    pub rotate: f64,
    /// Point it turns about.
    pub about: Vec<f64>,
    /// Distance it is moved by.
    pub shift: Vec<f64>,
}

/// How inertia is distributed over the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MassKind {
    /// ∫ρ₀ NᵀN.
    Consistent,
    /// Diagonal scaling (HRZ).
    Lumped,
    /// None on the nodes of contacts; total, centre and second moments kept by the least change of the others.
    Redistributed,
    /// None on the nodes of contacts; what they lose goes to the next nodes, and the centre is not kept.
    RedistributedNearest,
}

impl MassKind {
    /// Whether nodes of contacts carry no mass.
    pub fn is_redistributed(self) -> bool {
        matches!(self, Self::Redistributed | Self::RedistributedNearest)
    }
}

/// Source of a mesh: a built-in shape, or a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "shape", rename_all = "kebab-case")]
pub enum MeshSpec {
    /// Dimension 1: `left`, `right`.
    Interval {
        /// Left end.
        min: f64,
        /// Right end.
        max: f64,
        /// Number of cells.
        cells: usize,
    },
    /// `bottom right top left`.
    Rectangle {
        /// Lower left corner.
        min: [f64; 2],
        /// Upper right corner.
        max: [f64; 2],
        /// Squares along x and y, each cut into two triangles.
        cells: [usize; 2],
    },
    /// Whole disc, side `arc`.
    Disc {
        /// Radius.
        radius: f64,
        /// Centre.
        center: [f64; 2],
        /// Length of a cell's edge.
        size: f64,
    },
    /// The half x ≥ centre of a disc, sides `arc axis`.
    HalfDisc {
        /// Radius.
        radius: f64,
        /// Centre.
        center: [f64; 2],
        /// Length of a cell's edge.
        size: f64,
    },
    /// Between two circles, sides `inner outer`.
    Ring {
        /// Radius of the inner circle.
        inner: f64,
        /// Radius of the outer circle.
        outer: f64,
        /// Centre.
        center: [f64; 2],
        /// Length of a cell's edge.
        size: f64,
    },
    /// Any simple polygon, sides `side1`, `side2`, ….
    Polygon {
        /// Corners in order, either way round.
        points: Vec<[f64; 2]>,
        /// Length of a cell's edge.
        size: f64,
        /// Places with finer cells.
        refine: Vec<RefineSpec>,
    },
    /// A named physical surface (dimension 1: curve) of a .msh file; sides are its named physical curves (points).
    File {
        /// Absolute path.
        file: PathBuf,
        /// Name of the physical group.
        surface: String,
        /// BLAKE3 of the file when the case was read.
        hash: String,
        /// Nodes of the mesh.
        nodes: usize,
        /// Cells of the mesh.
        cells: usize,
        /// Sides of the mesh.
        sides: Vec<String>,
        /// What was put right when the mesh was read.
        repairs: Vec<String>,
    },
}

/// A place with finer cells.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RefineSpec {
    /// Its centre.
    pub near: [f64; 2],
    /// Edges have the size up to this distance.
    pub radius: f64,
    /// Length of a cell's edge there.
    pub size: f64,
}

/// Sides held or moved in some directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SupportSpec {
    /// A named support records its reactions.
    pub name: Option<String>,
    /// Sides, `body.side`.
    pub on: Vec<String>,
    /// Directions held: 0 is x, 1 is y.
    pub fix: Vec<usize>,
    /// Directions moved, with their displacements: formulas in X, Y, t.
    #[serde(rename = "move", default)]
    pub moves: Vec<(usize, FormulaSpec)>,
}

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

/// Time interval, step and scheme.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeSpec {
    /// End time.
    pub end: f64,
    /// Time step; the grid is n·step.
    pub step: f64,
    /// Time integrator as given.
    pub scheme: SchemeSpec,
    /// Fraction of the largest energy so far that may be created before the run stops; none: reported only.
    pub energy_guard: Option<f64>,
}

/// A time integrator by its published name: `{ kind = "chung-hulbert", rho_inf = 0.1 }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SchemeSpec {
    /// The `kind` key.
    pub kind: String,
    /// Its parameters by key, as given.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, f64>,
    /// `average-forces` or `average-state`.
    pub forces: carom_time::ForceRule,
}

/// Newton's method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonSpec {
    /// ‖Δy‖∞/L and ‖r‖/Σ‖f‖ at convergence.
    pub tolerance: f64,
    /// Iterations before a step is rejected.
    pub max_iterations: usize,
    /// Whether factors are kept over iterations and steps.
    #[serde(default)]
    pub tangent: TangentRule,
    /// Earlier iterations with the same factor that each correction is improved by. Runs of versions without this had none.
    #[serde(default)]
    pub mixing: usize,
}

/// When the tangent is formed and factored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TangentRule {
    /// When the kept one no longer pays; large factors in single precision.
    #[default]
    Kept,
    /// The same, every factor in double precision.
    KeptDouble,
    /// In every iteration.
    Full,
}

/// A point whose quantities become columns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProbeSpec {
    /// Name; columns are `name.quantity`.
    pub name: String,
    /// Reference point.
    pub at: Vec<f64>,
    /// Body it belongs to.
    pub body: String,
    /// Quantities.
    pub record: Vec<Quantity>,
}

/// What a probe may record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Quantity {
    Ux,
    Uy,
    Vx,
    Vy,
    Ax,
    Ay,
    SigmaXx,
    SigmaYy,
    SigmaXy,
    VonMises,
    DetF,
}

/// What is written, and when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutputSpec {
    /// Fields every so many steps; 0: none.
    pub fields_every: usize,
    /// How fields are written.
    #[serde(default)]
    pub format: FieldFormat,
    /// Fields at the steps nearest to these times, besides.
    pub at_times: Vec<f64>,
    /// History rows every so many steps.
    pub history_every: usize,
    /// Checkpoints every so many steps.
    pub checkpoint_every: usize,
}
