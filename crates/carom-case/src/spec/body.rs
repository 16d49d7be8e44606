//! Bodies: material, mesh, placement, initial state.

use serde::{Deserialize, Serialize};

use super::formula::FormulaSpec;
use super::mesh::MeshSpec;

/// A hyperelastic material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaterialSpec {
    /// Name by which bodies refer to it.
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

impl MaterialSpec {
    /// Speed of pressure waves, √((Λ + 2μ)/ρ), with Λ replaced by 2Λμ/(Λ + 2μ) in plane stress;
    /// infinite without density.
    pub fn wave_speed(&self, plane: Plane) -> f64 {
        let Self { lambda, mu, density, .. } = *self;
        let lambda = match plane {
            Plane::Strain => lambda,
            Plane::Stress => 2.0 * lambda * mu / (lambda + 2.0 * mu),
        };
        ((lambda + 2.0 * mu) / density).sqrt()
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
    /// Volumetric energy of a cell.
    #[serde(default, skip_serializing_if = "Volumetric::is_pointwise")]
    pub volumetric: Volumetric,
    /// Where its mesh comes from.
    pub mesh: MeshSpec,
    /// Placement of the mesh; none: as generated or read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<PlaceSpec>,
    /// Positions at t = 0, formulas in X, Y, Z; none: the reference positions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<Vec<FormulaSpec>>,
    /// Gravitational acceleration, one component per dimension: formulas in t.
    pub gravity: Vec<FormulaSpec>,
    /// Initial velocity, formulas in X, Y, Z.
    pub velocity: Vec<FormulaSpec>,
    /// Mass matrix.
    pub mass: MassKind,
}

impl BodySpec {
    /// Whether it has an initial velocity.
    pub(crate) fn starts_moving(&self) -> bool {
        !self.velocity.iter().all(FormulaSpec::is_zero)
    }
}

/// On which change of volume the volumetric energy of a cell depends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Volumetric {
    /// That of each quadrature point.
    #[default]
    Pointwise,
    /// The mean of the cell.
    Mean,
}

impl Volumetric {
    #[allow(clippy::trivially_copy_pass_by_ref)] // as serde calls it
    fn is_pointwise(&self) -> bool {
        *self == Self::Pointwise
    }
}

/// A rigid motion of a mesh: x ↦ about + R(rotate)(x − about) + shift.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaceSpec {
    /// Angle in degrees, counter-clockwise; 0 in dimension 1.
    pub rotate: f64,
    /// Unit axis of the rotation, in dimension 3; empty if there is none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axis: Vec<f64>,
    /// Centre of rotation.
    pub about: Vec<f64>,
    /// Translation.
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
    /// No mass on contact nodes; the smallest change of the other nodes preserves total mass,
    /// centre of mass and second moments.
    Redistributed,
}

impl MassKind {
    /// Whether contact nodes have no mass.
    pub fn is_redistributed(self) -> bool {
        self == Self::Redistributed
    }
}
