//! Hyperelastic laws Ψ(H), H = F − I, with first Piola–Kirchhoff stress P = ∂Ψ/∂F and tangent ∂P/∂F.
//!
//! A law is written once for every dimension `D`: in the `3 − D` directions a body does not extend in there is no strain (H is padded with
//! zeros). `D = 2` is plane strain, or wrapped in [`PlaneStress`] plane stress; `D = 1` is uniaxial *strain*, so that a linear-elastic bar has the modulus Λ + 2μ, which is Young's
//! modulus when Poisson's ratio is 0 (Λ = 0, μ = E/2).
//!
//! Laws take H rather than F, and no formula subtracts nearly equal numbers when H is small: a motion of 1e-9 keeps its digits.

mod kinematics;
mod linear_elastic;
mod neo_hookean;
mod plane_stress;
mod saint_venant_kirchhoff;

use carom_algebra::{Mat, Vector};

use crate::points::{get, set};

pub use kinematics::{excess_cofactor, excess_det};
pub use linear_elastic::LinearElastic;
pub use neo_hookean::NeoHookean;
pub use plane_stress::{PlaneStress, Thickness};
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;

/// A determinant J of the deformation gradient that is not positive.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("J = {0:.3e} is not positive")]
pub struct NotPositive(pub f64);

/// A hyperelastic law. What several answers need is computed once by [`Material::at`]. `at`, `energy`, `stress` and `tangent` are `#[inline(always)]`: they are
/// compiled into the loop over quadrature points, for wide registers.
pub trait Material<const D: usize>: Send + Sync + 'static {
    /// Degree of Ψ as a polynomial in F that is to be integrated exactly; 0 if it is none.
    const ENERGY_DEGREE: usize;

    /// Whether Ψ depends on FᵀF alone; else it is quadratic in H.
    const OBJECTIVE: bool = true;

    /// Kinematics at a point.
    type Point;

    /// Kinematics at H = F − I.
    fn at(&self, h: &Mat<D>) -> Result<Self::Point, NotPositive>;

    /// Strain energy Ψ per reference volume.
    fn energy(&self, point: &Self::Point) -> f64;

    /// First Piola–Kirchhoff stress P.
    fn stress(&self, point: &Self::Point) -> Mat<D>;

    /// The block Kᵢⱼ = Σ ∂Pᵢᴶ/∂Fⱼᴸ aᴶ bᴸ, bilinear in the reference gradients a and b.
    fn tangent(&self, point: &Self::Point, a: &Vector<D>, b: &Vector<D>) -> Mat<D>;

    /// ∂P/∂F : dF.
    #[inline(always)]
    fn change(&self, point: &Self::Point, df: &Mat<D>) -> Mat<D> {
        let mut dp = Mat::ZERO;
        for j in 0..D {
            let mut unit = Vector::ZERO;
            unit[j] = 1.0;
            for l in 0..D {
                let mut other = Vector::ZERO;
                other[l] = 1.0;
                let block = self.tangent(point, &unit, &other);
                for i in 0..D {
                    for k in 0..D {
                        dp.0[i][j] += block.0[i][k] * df.0[k][l];
                    }
                }
            }
        }
        dp
    }

    /// ∂P/∂F : dF at the first `count` of four points side by side: `h`, `dh` and the result are `[i][j][point]`.
    #[inline(always)]
    fn changes(
        &self,
        h: &[[[f64; 4]; D]; D],
        dh: &[[[f64; 4]; D]; D],
        count: usize,
    ) -> Result<[[[f64; 4]; D]; D], NotPositive> {
        let mut changes = [[[0.0; 4]; D]; D];
        for l in 0..count {
            let point = self.at(&get(h, l))?;
            set(&mut changes, l, &self.change(&point, &get(dh, l)), 1.0);
        }
        Ok(changes)
    }

    /// Cauchy stress within the space of the body.
    fn cauchy(&self, point: &Self::Point) -> Mat<D>;

    /// Cauchy normal stress in the directions the body does not extend in.
    fn lateral(&self, point: &Self::Point) -> f64;

    /// Determinant J of the three-dimensional deformation gradient, positive or not.
    fn volume_ratio(&self, h: &Mat<D>) -> f64 {
        1.0 + excess_det(h)
    }
}

/// Choice of a law with Lamé's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Law {
    NeoHookean { lambda: f64, mu: f64 },
    SaintVenantKirchhoff { lambda: f64, mu: f64 },
    LinearElastic { lambda: f64, mu: f64 },
}

#[cfg(test)]
mod tests;
