//! Hencky's law, quadratic in the logarithmic strain ε = ½ ln b (H. Hencky, Z. techn. Phys. 9
//! (1928) 215–220):
//!
//!   Ψ = Λ/2 (tr ε)² + μ ε : ε,   τ = Λ tr ε I + 2μ ε.

use carom_algebra::{Four, Mat, Real};

use super::hyperelastic::{Along, AtFour, Material};
use super::principal_frame::{PrincipalFrame, PrincipalStress, by_principal_stress, store_moduli};
use super::{Moduli, NotPositive, Past, Thickness};

/// Hencky's law with Lamé's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hencky {
    /// Λ.
    pub lambda: f64,
    /// μ.
    pub mu: f64,
}

/// Ψ and the principal stresses.
pub struct Point<const D: usize, T = f64> {
    energy: T,
    of: PrincipalStress<D, T>,
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

    #[inline(always)]
    fn kinematics<const D: usize, T: Real>(&self, h: &Mat<D, T>) -> Result<Point<D, T>, NotPositive> {
        let frame = PrincipalFrame::new(h, None, T::ZERO)?;
        let deviator = frame.deviator();
        let mean = T::of(self.bulk()) * frame.trace();
        let shear = T::of(2.0 * self.mu);
        let mut kirchhoff = deviator;
        for a in 0..3 {
            kirchhoff[a] = mean + shear * deviator[a];
        }
        let energy = self.energy_of(frame.trace(), &deviator);
        let volumetric = T::of(self.lambda);
        let softening = T::ZERO;
        let direction = [T::ZERO; 3];
        Ok(Point {
            energy,
            of: PrincipalStress { frame, kirchhoff, volumetric, shear, softening, direction },
        })
    }

    /// Energy of the change of volume tr ε, and of the deviator of ε.
    #[inline(always)]
    pub(super) fn energy_of<T: Real>(&self, trace: T, deviator: &[T; 3]) -> T {
        let [x, y, z] = *deviator;
        T::of(0.5 * self.bulk()) * trace * trace + T::of(self.mu) * (x * x + y * y + z * z)
    }
}

impl<const D: usize> Material<D> for Hencky {
    type Point = Point<D>;

    #[inline(always)]
    fn after(&self, h: &Mat<D>, _: &Past) -> Result<Point<D>, NotPositive> {
        self.kinematics(h)
    }

    #[inline(always)]
    fn energy(&self, p: &Point<D>) -> f64 {
        p.energy
    }

    #[inline(always)]
    fn four(&self, h: &Mat<D, Four>, _: &Past, _: usize, _: &mut [f64]) -> Result<AtFour<D>, NotPositive> {
        let point = self.kinematics(h)?;
        Ok(AtFour::elastic(point.energy, point.of.stress()))
    }

    #[inline(always)]
    fn four_along(
        &self,
        h: &Mat<D, Four>,
        df: Option<&Mat<D, Four>>,
        _: &Past,
        _: usize,
    ) -> Result<Along<D>, NotPositive> {
        let point = self.kinematics(h)?;
        let at = AtFour::elastic(point.energy, point.of.stress());
        Ok(Along::elastic(at, df.map_or(Mat::ZERO, |df| point.of.change(df))))
    }

    #[inline(always)]
    fn moduli(
        &self,
        h: &Mat<D, Four>,
        _: &Past,
        _: usize,
        _: &mut [f64],
        moduli: &mut Moduli<D>,
    ) -> Result<AtFour<D>, NotPositive> {
        let point = self.kinematics(h)?;
        store_moduli(&point.of, moduli);
        Ok(AtFour::elastic(point.energy, point.of.stress()))
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
