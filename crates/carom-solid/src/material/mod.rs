//! Hyperelastic laws Ψ(H), H = F − I, with first Piola–Kirchhoff stress P = ∂Ψ/∂F and tangent
//! ∂P/∂F.
//!
//! A law is written once for every dimension `D`: there is no strain in the `3 − D` directions in
//! which a body does not extend (H is padded with zeros). `D = 2` is plane strain or, wrapped in
//! [`PlaneStress`], plane stress. `D = 1` is uniaxial *strain*: a linear-elastic bar has the
//! modulus Λ + 2μ, which is Young's modulus if Poisson's ratio is 0 (Λ = 0, μ = E/2).
//!
//! Laws take H rather than F, and no formula subtracts nearly equal numbers for small H:
//! displacements of 1e-9 keep their accuracy.

mod hardening;
mod hencky;
mod hyperelastic;
mod isochoric;
mod j2;
#[doc(hidden)]
pub mod kinematics;
mod law;
mod linear_elastic;
mod mooney_rivlin;
mod neo_hookean;
mod past;
mod plane_stress;
mod pointwise;
mod principal_frame;
mod saint_venant_kirchhoff;
mod volumetric;
mod yeoh;

pub use hardening::{Hardening, Table};
pub use hencky::Hencky;
pub use hyperelastic::{Along, AtFour, Material, Moduli};
pub use isochoric::{Isochoric, OfInvariants, Slopes};
pub use j2::J2;
pub use kinematics::NotPositive;
pub use kinematics::{excess_cofactor, excess_det};
pub use law::Law;
pub use linear_elastic::LinearElastic;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hookean::NeoHookean;
pub use past::Past;
pub use plane_stress::{PlaneStress, Thickness};
pub(crate) use pointwise::Pointwise;
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;
pub(crate) use volumetric::Mean;
pub use yeoh::Yeoh;
