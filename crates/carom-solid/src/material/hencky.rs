//! Hencky's law, quadratic in the logarithmic strain ε = ½ ln b (H. Hencky, Z. techn. Phys. 9
//! (1928) 215–220):
//!
//!   Ψ = Λ/2 (tr ε)² + μ ε : ε,   τ = Λ tr ε I + 2μ ε.

use carom_algebra::Mat;

use super::hyperelastic::Material;
use super::principal_frame::{PrincipalFrame, PrincipalStress, by_principal_stress};
use super::{NotPositive, Thickness};

/// Hencky's law with Lamé's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hencky {
    /// Λ.
    pub lambda: f64,
    /// μ.
    pub mu: f64,
}

/// Ψ and the principal stresses.
pub struct Point<const D: usize> {
    energy: f64,
    of: PrincipalStress<D>,
}

impl Hencky {
    /// Bulk modulus.
    pub(super) fn bulk(&self) -> f64 {
        self.lambda + 2.0 * self.mu / 3.0
    }

    /// The law without resistance to changes of volume.
    pub(super) fn without_bulk(&self) -> Self {
        Self { lambda: -2.0 * self.mu / 3.0, mu: self.mu }
    }

    /// The law at strains.
    #[inline(always)]
    pub(super) fn stress_at<const D: usize>(&self, frame: PrincipalFrame<D>) -> PrincipalStress<D> {
        let mean = self.bulk() * frame.trace();
        PrincipalStress {
            kirchhoff: frame.deviator().map(|strain| mean + 2.0 * self.mu * strain),
            frame,
            volumetric: self.lambda,
            shear: 2.0 * self.mu,
            softening: 0.0,
            direction: [0.0; 3],
        }
    }

    /// Energy of the change of volume tr ε, and of the deviator of ε.
    #[inline(always)]
    pub(super) fn energy_of(&self, trace: f64, deviator: &[f64; 3]) -> f64 {
        let square: f64 = deviator.iter().map(|strain| strain * strain).sum();
        0.5 * self.bulk() * trace * trace + self.mu * square
    }
}

impl<const D: usize> Material<D> for Hencky {
    type Point = Point<D>;

    #[inline(always)]
    fn at(&self, h: &Mat<D>) -> Result<Point<D>, NotPositive> {
        let frame = PrincipalFrame::new(h, None, 0.0)?;
        Ok(Point { energy: self.energy_of(frame.trace(), &frame.deviator()), of: self.stress_at(frame) })
    }

    #[inline(always)]
    fn energy(&self, p: &Point<D>) -> f64 {
        p.energy
    }

    by_principal_stress!(D);
}

impl Thickness for Hencky {
    /// Λ (ln J₂ + ε₃₃) + 2μ ε₃₃ = 0 with ε₃₃ = ln F₃₃ and the plane's J₂.
    #[inline(always)]
    fn excess_stretch(&self, h: &Mat<2>) -> Result<f64, NotPositive> {
        let excess = super::kinematics::valid_excess(h)?;
        let strain = -self.lambda * super::kinematics::ln_1p(excess)[0] / (self.lambda + 2.0 * self.mu);
        Ok(strain.exp_m1())
    }
}
