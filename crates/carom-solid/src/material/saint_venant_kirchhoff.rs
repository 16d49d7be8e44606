//! St. Venant–Kirchhoff law Ψ = Λ/2 (tr E)² + μ E:E, E = (H + Hᵀ + HᵀH)/2 (Holzapfel, Nonlinear
//! Solid Mechanics, §6.5):
//!
//!   S = Λ tr E I + 2μE,   P = F S,   K(a, b) = (a·S b) I + Λ Fa⊗Fb + μ [Fb⊗Fa + (a·b) F Fᵀ].
//!
//! The law itself is defined for J ≤ 0, but such a point is an error all the same.

use carom_algebra::{Four, Mat, Real, Vector};

use super::hyperelastic::{AtFour, Material};
use super::kinematics::valid_excess;
use super::{NotPositive, Past};

/// St. Venant–Kirchhoff law with Lamé's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SaintVenantKirchhoff {
    /// Λ.
    pub lambda: f64,
    /// μ.
    pub mu: f64,
}

/// F, F Fᵀ, E, second Piola–Kirchhoff stress, J.
pub struct Point<const D: usize, T = f64> {
    f: Mat<D, T>,
    left: Mat<D, T>,
    e: Mat<D, T>,
    second: Mat<D, T>,
    det_f: T,
}

impl SaintVenantKirchhoff {
    #[inline(always)]
    fn kinematics<const D: usize, T: Real>(&self, h: &Mat<D, T>) -> Result<Point<D, T>, NotPositive> {
        let det_f = T::of(1.0) + valid_excess(h)?;
        let f = Mat::identity() + *h;
        let e = (*h + h.transposed() + h.transposed() * *h) * T::of(0.5);
        let second = Mat::identity() * (T::of(self.lambda) * e.trace()) + e * T::of(2.0 * self.mu);
        Ok(Point { f, left: f * f.transposed(), e, second, det_f })
    }
}

impl<const D: usize> Material<D> for SaintVenantKirchhoff {
    const ENERGY_DEGREE: usize = 4;
    type Point = Point<D>;

    #[inline(always)]
    fn after(&self, h: &Mat<D>, _: &Past) -> Result<Point<D>, NotPositive> {
        self.kinematics(h)
    }

    #[inline(always)]
    fn energy(&self, p: &Point<D>) -> f64 {
        0.5 * p.second.double_dot(&p.e)
    }

    #[inline(always)]
    fn stress(&self, p: &Point<D>) -> Mat<D> {
        p.f * p.second
    }

    #[inline(always)]
    fn four(&self, h: &Mat<D, Four>, _: &Past, _: usize, _: &mut [f64]) -> Result<AtFour<D>, NotPositive> {
        let point = self.kinematics(h)?;
        let energy = Four::of(0.5) * point.second.double_dot(&point.e);
        Ok(AtFour::elastic(energy, point.f * point.second))
    }

    #[inline(always)]
    fn tangent(&self, p: &Point<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let fa = p.f.apply(a);
        let fb = p.f.apply(b);
        Mat::identity() * a.dot(&p.second.apply(b))
            + fa.outer(&fb) * self.lambda
            + (fb.outer(&fa) + p.left * a.dot(b)) * self.mu
    }

    fn lateral(&self, p: &Point<D>) -> f64 {
        self.lambda * p.e.trace() / p.det_f
    }
}
