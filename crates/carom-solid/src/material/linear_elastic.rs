//! Linear elasticity at small strain, Ψ = Λ/2 (tr ε)² + μ ε:ε, ε = (H + Hᵀ)/2:
//!
//!   P = σ = Λ tr ε I + 2μ ε,   K(a, b) = μ (a·b) I + Λ a⊗b + μ b⊗a.
//!
//! Reference and current configuration coincide: σ is both Piola–Kirchhoff and Cauchy stress, large
//! rotations strain the body, and every H is valid.

use carom_algebra::{Four, Mat, Real, Vector};

use super::hyperelastic::{AtFour, Material};
use super::{NotPositive, Past};

/// Linear elasticity with Lamé's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElastic {
    /// Λ.
    pub lambda: f64,
    /// μ.
    pub mu: f64,
}

/// Small strain ε.
pub struct Point<const D: usize>(Mat<D>);

impl LinearElastic {
    #[inline(always)]
    fn stress_of<const D: usize, T: Real>(&self, strain: &Mat<D, T>) -> Mat<D, T> {
        Mat::identity() * (T::of(self.lambda) * strain.trace()) + *strain * T::of(2.0 * self.mu)
    }
}

/// ε of H.
#[inline(always)]
fn strain_of<const D: usize, T: Real>(h: &Mat<D, T>) -> Mat<D, T> {
    (*h + h.transposed()) * T::of(0.5)
}

impl<const D: usize> Material<D> for LinearElastic {
    const ENERGY_DEGREE: usize = 2;
    const OBJECTIVE: bool = false;
    type Point = Point<D>;

    #[inline(always)]
    fn after(&self, h: &Mat<D>, _: &Past) -> Result<Point<D>, NotPositive> {
        Ok(Point(strain_of(h)))
    }

    #[inline(always)]
    fn energy(&self, p: &Point<D>) -> f64 {
        0.5 * self.stress(p).double_dot(&p.0)
    }

    #[inline(always)]
    fn stress(&self, p: &Point<D>) -> Mat<D> {
        self.stress_of(&p.0)
    }

    #[inline(always)]
    fn four(&self, h: &Mat<D, Four>, _: &Past, _: usize, _: &mut [f64]) -> Result<AtFour<D>, NotPositive> {
        let strain = strain_of(h);
        let stress = self.stress_of(&strain);
        Ok(AtFour::elastic(Four::of(0.5) * stress.double_dot(&strain), stress))
    }

    #[inline(always)]
    fn tangent(&self, _: &Point<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        Mat::identity() * (self.mu * a.dot(b)) + a.outer(b) * self.lambda + b.outer(a) * self.mu
    }

    #[inline(always)]
    fn cauchy(&self, p: &Point<D>, _: &Mat<D>) -> Mat<D> {
        self.stress_of(&p.0)
    }

    fn lateral(&self, p: &Point<D>) -> f64 {
        self.lambda * p.0.trace()
    }
}
