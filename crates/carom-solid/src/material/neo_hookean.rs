//! Compressible neo-Hookean law Ψ = μ(tr E − ln J) + Λ/2 (ln J)², E = (FᵀF − I)/2 (Simo, Hughes,
//! Computational Inelasticity, §9.2.1; the paper's eq. (3)):
//!
//!   P = μ(F − F⁻ᵀ) + Λ ln J F⁻ᵀ,   K(a, b) = μ (a·b) I + (μ − Λ ln J) b̃⊗ã + Λ ã⊗b̃,   ã = F⁻ᵀa.
//!
//! Without cancellation, with d = J − 1 and C = cof F − I: F⁻ᵀ = (I + C)/J, F − F⁻ᵀ = (H − C + d
//! F)/J. With det(I + 2E) = J² = 1 + 2 tr E + h(2E), h the terms of second and third order,
//!
//!   tr E − ln J = (d − ln(1 + d)) + d²/2 − h(2E)/2,
//!
//! whose terms are of second order in the strain: the energy of a body that turns has the round-off
//! of its strain, not that of its rotation.

use carom_algebra::{Four, Mat, Real, Vector};

use super::hyperelastic::{Along, AtFour, Material};
use super::kinematics::{excess_cofactor, ln_1p, valid_excess};
use super::{NotPositive, Past};

/// Compressible neo-Hookean law with Lamé's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    /// Λ.
    pub lambda: f64,
    /// μ.
    pub mu: f64,
}

/// F − I, F⁻ᵀ, F − F⁻ᵀ, J − 1, ln J, J − 1 − ln J.
pub struct Point<const D: usize, T = f64> {
    h: Mat<D, T>,
    inverse_transposed: Mat<D, T>,
    difference: Mat<D, T>,
    excess: T,
    ln_j: T,
    minus_ln: T,
}

impl NeoHookean {
    #[inline(always)]
    fn kinematics<const D: usize, T: Real>(h: &Mat<D, T>) -> Result<Point<D, T>, NotPositive> {
        let excess = valid_excess(h)?;
        let c = excess_cofactor(h);
        let f = Mat::identity() + *h;
        let inverse = T::of(1.0) / (T::of(1.0) + excess);
        let [ln_j, minus_ln] = ln_1p(excess);
        Ok(Point {
            h: *h,
            inverse_transposed: (Mat::identity() + c) * inverse,
            difference: (*h - c + f * excess) * inverse,
            excess,
            ln_j,
            minus_ln,
        })
    }

    #[inline(always)]
    fn energy_of<const D: usize, T: Real>(&self, p: &Point<D, T>) -> T {
        let twice_strain = p.h + p.h.transposed() + p.h.transposed() * p.h;
        let higher = match D {
            1 => T::ZERO,
            2 => twice_strain.det(),
            _ => twice_strain.cofactor().trace() + twice_strain.det(),
        };
        let isochoric = p.minus_ln + T::of(0.5) * (p.excess * p.excess - higher);
        T::of(self.mu) * isochoric + T::of(0.5 * self.lambda) * p.ln_j * p.ln_j
    }

    #[inline(always)]
    fn stress_of<const D: usize, T: Real>(&self, p: &Point<D, T>) -> Mat<D, T> {
        p.difference * T::of(self.mu) + p.inverse_transposed * (T::of(self.lambda) * p.ln_j)
    }

    /// ∂P/∂F : dF = μ dF + Λ (F⁻ᵀ:dF) F⁻ᵀ + (μ − Λ ln J) F⁻ᵀ dFᵀ F⁻ᵀ.
    #[inline(always)]
    fn change_of<const D: usize, T: Real>(&self, p: &Point<D, T>, df: &Mat<D, T>) -> Mat<D, T> {
        let g = p.inverse_transposed;
        let lambda = T::of(self.lambda);
        let mu = T::of(self.mu);
        *df * mu + g * (lambda * g.double_dot(df)) + g * df.transposed() * g * (mu - lambda * p.ln_j)
    }
}

impl<const D: usize> Material<D> for NeoHookean {
    type Point = Point<D>;

    #[inline(always)]
    fn after(&self, h: &Mat<D>, _: &Past) -> Result<Point<D>, NotPositive> {
        Self::kinematics(h)
    }

    #[inline(always)]
    fn energy(&self, p: &Point<D>) -> f64 {
        self.energy_of(p)
    }

    #[inline(always)]
    fn stress(&self, p: &Point<D>) -> Mat<D> {
        self.stress_of(p)
    }

    #[inline(always)]
    fn four(&self, h: &Mat<D, Four>, _: &Past, _: usize, _: &mut [f64]) -> Result<AtFour<D>, NotPositive> {
        let point = Self::kinematics(h)?;
        Ok(AtFour::elastic(self.energy_of(&point), self.stress_of(&point)))
    }

    #[inline(always)]
    fn tangent(&self, p: &Point<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let a_tilde = p.inverse_transposed.apply(a);
        let b_tilde = p.inverse_transposed.apply(b);
        Mat::identity() * (self.mu * a.dot(b))
            + b_tilde.outer(&a_tilde) * (self.mu - self.lambda * p.ln_j)
            + a_tilde.outer(&b_tilde) * self.lambda
    }

    #[inline(always)]
    fn change(&self, p: &Point<D>, df: &Mat<D>) -> Mat<D> {
        self.change_of(p, df)
    }

    #[inline(always)]
    fn four_along(
        &self,
        h: &Mat<D, Four>,
        df: Option<&Mat<D, Four>>,
        _: &Past,
        _: usize,
    ) -> Result<Along<D>, NotPositive> {
        let point = Self::kinematics(h)?;
        let at = AtFour::elastic(self.energy_of(&point), self.stress_of(&point));
        Ok(Along::elastic(at, df.map_or(Mat::ZERO, |df| self.change_of(&point, df))))
    }

    fn lateral(&self, p: &Point<D>) -> f64 {
        self.lambda * p.ln_j / (1.0 + p.excess)
    }
}
