//! Compressible neo-Hookean law Ψ = μ(tr E − ln J) + Λ/2 (ln J)², E = (FᵀF − I)/2 (Simo, Hughes,
//! Computational Inelasticity, §9.2.1; the paper's eq. (3)):
//!
//!   P = μ(F − F⁻ᵀ) + Λ ln J F⁻ᵀ,   K(a, b) = μ (a·b) I + (μ − Λ ln J) b̃⊗ã + Λ ã⊗b̃,   ã = F⁻ᵀa.
//!
//! Without cancellation, with d = J − 1 and C = cof F − I: F⁻ᵀ = (I + C)/J, F − F⁻ᵀ = (H − C + d
//! F)/J, tr E − ln J = (tr H − d) + H:H/2 + (d − ln(1 + d)), and tr H − d contains only terms of
//! second and third order.

use carom_algebra::{Mat, Real, Vector};

use super::hyperelastic::{Material, NotPositive, changes_one_by_one};
use super::kinematics::{excess_cofactor, excess_det, ln_1p, ln_1p_lanes};
use crate::points::{LANES, four, lanes};

/// Compressible neo-Hookean law with Lamé's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    /// Λ.
    pub lambda: f64,
    /// μ.
    pub mu: f64,
}

/// F − I, F, F⁻ᵀ, F − F⁻ᵀ, J − 1, ln J, J − 1 − ln J.
pub struct Point<const D: usize, T = f64> {
    h: Mat<D, T>,
    f: Mat<D, T>,
    inverse_transposed: Mat<D, T>,
    difference: Mat<D, T>,
    excess: T,
    ln_j: T,
    minus_ln: T,
}

impl NeoHookean {
    #[inline(always)]
    fn kinematics<const D: usize, T: Real>(h: &Mat<D, T>) -> Result<Point<D, T>, NotPositive> {
        let excess = excess_det(h);
        if let Some(excess) = excess.find(|excess| excess <= -1.0 || excess.is_nan()) {
            return Err(NotPositive(1.0 + excess));
        }
        let c = excess_cofactor(h);
        let f = Mat::identity() + *h;
        let inverse = T::of(1.0) / (T::of(1.0) + excess);
        let [ln_j, minus_ln] = ln_1p(excess);
        Ok(Point {
            h: *h,
            f,
            inverse_transposed: (Mat::identity() + c) * inverse,
            difference: (*h - c + f * excess) * inverse,
            excess,
            ln_j,
            minus_ln,
        })
    }

    #[inline(always)]
    fn energy_of<const D: usize, T: Real>(&self, p: &Point<D, T>) -> T {
        // tr H − d without cancellation: the terms of d beyond the trace.
        let higher = match D {
            1 => T::ZERO,
            2 => p.h.det(),
            _ => p.h.cofactor().trace() + p.h.det(),
        };
        let isochoric = T::of(0.5) * p.h.double_dot(&p.h) - higher + p.minus_ln;
        T::of(self.mu) * isochoric + T::of(0.5 * self.lambda) * p.ln_j * p.ln_j
    }

    #[inline(always)]
    fn stress_of<const D: usize, T: Real>(&self, p: &Point<D, T>) -> Mat<D, T> {
        p.difference * T::of(self.mu) + p.inverse_transposed * (T::of(self.lambda) * p.ln_j)
    }
}

impl<const D: usize> Material<D> for NeoHookean {
    const ENERGY_DEGREE: usize = 0;
    type Point = Point<D>;

    #[inline(always)]
    fn at(&self, h: &Mat<D>) -> Result<Point<D>, NotPositive> {
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
    fn at_points(
        &self,
        h: &[[[f64; LANES]; D]; D],
        _: usize,
    ) -> Result<([f64; LANES], [[[f64; LANES]; D]; D]), NotPositive> {
        let point = Self::kinematics(&four(h))?;
        Ok((self.energy_of(&point).0, lanes(&self.stress_of(&point))))
    }

    #[inline(always)]
    fn tangent(&self, p: &Point<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let (a_tilde, b_tilde) = (p.inverse_transposed.apply(a), p.inverse_transposed.apply(b));
        Mat::identity() * (self.mu * a.dot(b))
            + b_tilde.outer(&a_tilde) * (self.mu - self.lambda * p.ln_j)
            + a_tilde.outer(&b_tilde) * self.lambda
    }

    /// ∂P/∂F : dF = μ dF + Λ (F⁻ᵀ:dF) F⁻ᵀ + (μ − Λ ln J) F⁻ᵀ dFᵀ F⁻ᵀ; vectorised over the points in
    /// the plane.
    #[inline(always)]
    fn changes(
        &self,
        h: &[[[f64; LANES]; D]; D],
        dh: &[[[f64; LANES]; D]; D],
        count: usize,
    ) -> Result<[[[f64; LANES]; D]; D], NotPositive> {
        if D != 2 {
            return changes_one_by_one(self, h, dh, count);
        }
        let mut changes = [[[0.0; LANES]; D]; D];
        let mut excess = [0.0; LANES];
        for l in 0..LANES {
            excess[l] = h[0][0][l] + h[1][1][l] + (h[0][0][l] * h[1][1][l] - h[0][1][l] * h[1][0][l]);
        }
        if let Some(x) = excess.iter().find(|x| **x <= -1.0 || x.is_nan()) {
            return Err(NotPositive(1.0 + x));
        }
        let logarithm = ln_1p_lanes(&excess);
        for l in 0..LANES {
            let inverse = 1.0 / (1.0 + excess[l]);
            let g = [
                [(1.0 + h[1][1][l]) * inverse, -h[1][0][l] * inverse],
                [-h[0][1][l] * inverse, (1.0 + h[0][0][l]) * inverse],
            ];
            let d = [[dh[0][0][l], dh[0][1][l]], [dh[1][0][l], dh[1][1][l]]];
            let trace =
                self.lambda * (g[0][0] * d[0][0] + g[0][1] * d[0][1] + g[1][0] * d[1][0] + g[1][1] * d[1][1]);
            let coefficient = self.mu - self.lambda * logarithm[l];
            // dFᵀ F⁻ᵀ.
            let m = [
                [d[0][0] * g[0][0] + d[1][0] * g[1][0], d[0][0] * g[0][1] + d[1][0] * g[1][1]],
                [d[0][1] * g[0][0] + d[1][1] * g[1][0], d[0][1] * g[0][1] + d[1][1] * g[1][1]],
            ];
            for i in 0..2 {
                for j in 0..2 {
                    let turned = g[i][0] * m[0][j] + g[i][1] * m[1][j];
                    changes[i][j][l] = self.mu * d[i][j] + trace * g[i][j] + coefficient * turned;
                }
            }
        }
        Ok(changes)
    }

    fn cauchy(&self, p: &Point<D>) -> Mat<D> {
        self.stress(p) * p.f.transposed() * (1.0 / (1.0 + p.excess))
    }

    fn lateral(&self, p: &Point<D>) -> f64 {
        self.lambda * p.ln_j / (1.0 + p.excess)
    }
}
