//! Linear elasticity at small strain, Ψ = Λ/2 (tr ε)² + μ ε:ε, ε = (H + Hᵀ)/2:
//!
//!   P = σ = Λ tr ε I + 2μ ε,   K(a, b) = μ (a·b) I + Λ a⊗b + μ b⊗a.
//!
//! Reference and current configuration coincide: σ is both Piola–Kirchhoff and Cauchy stress, large
//! rotations strain the body, and every H is valid.

use carom_algebra::{Mat, Vector};

use super::hyperelastic::{Material, NotPositive};

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

impl<const D: usize> Material<D> for LinearElastic {
    const ENERGY_DEGREE: usize = 2;
    const OBJECTIVE: bool = false;
    type Point = Point<D>;

    #[inline(always)]
    fn at(&self, h: &Mat<D>) -> Result<Point<D>, NotPositive> {
        Ok(Point((*h + h.transposed()) * 0.5))
    }

    #[inline(always)]
    fn energy(&self, p: &Point<D>) -> f64 {
        0.5 * self.cauchy(p).double_dot(&p.0)
    }

    #[inline(always)]
    fn stress(&self, p: &Point<D>) -> Mat<D> {
        self.cauchy(p)
    }

    #[inline(always)]
    fn tangent(&self, _: &Point<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        Mat::identity() * (self.mu * a.dot(b)) + a.outer(b) * self.lambda + b.outer(a) * self.mu
    }

    #[inline(always)]
    fn cauchy(&self, p: &Point<D>) -> Mat<D> {
        Mat::identity() * (self.lambda * p.0.trace()) + p.0 * (2.0 * self.mu)
    }

    fn lateral(&self, p: &Point<D>) -> f64 {
        self.lambda * p.0.trace()
    }
}
