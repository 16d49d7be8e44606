//! Laws of the isochoric invariants Ī₁ = J^(−2/3) I₁ and Ī₂ = J^(−4/3) I₂ of C = FᵀF, with
//! Ψ = W(Ī₁, Ī₂) + K/2 (ln J)² (P. J. Flory, Trans. Faraday Soc. 57 (1961) 829–838; Holzapfel,
//! Nonlinear Solid Mechanics, §6.4):
//!
//! ```text
//! P = α A + β B + K ln J F⁻ᵀ,   α = 2 J^(−2/3) ∂W/∂Ī₁,   β = 2 J^(−4/3) ∂W/∂Ī₂
//! A = F − (I₁/3) F⁻ᵀ,   B = I₁ F − F C − (2 I₂/3) F⁻ᵀ,   dĪ₁ = 2 J^(−2/3) A:dF,   dĪ₂ = 2 J^(−4/3) B:dF
//! ```
//!
//! Without cancellation, with t = tr 2E, h₂ and h₃ the second and third invariants of 2E, a =
//! I₁/3 − 1 = t/3, c = I₂/3 − 1 = (2t + h₂)/3, b = J² − 1 = t + h₂ + h₃ and m(x) = x − ln(1 + x):
//!
//! ```text
//! ln(Ī₁/3) = −(h₂ + h₃)/3 − m(a) + m(b)/3,   ln(Ī₂/3) = −(h₂ + 2h₃)/3 − m(c) + 2m(b)/3
//! A = (F − F⁻ᵀ) − a F⁻ᵀ,   B = 2(F − F⁻ᵀ) + F (t I − 2E) − 2c F⁻ᵀ
//! ```

use carom_algebra::{Mat, Vector};

use super::hyperelastic::Material;
use super::kinematics::{excess_cofactor, ln_1p, valid_excess};
use super::plane_stress::stress_free;
use super::{NotPositive, Past, Thickness};

/// Energy W of the isochoric invariants.
pub trait OfInvariants: Clone + Send + Sync {
    /// W and its derivatives at Ī₁ − 3 and Ī₂ − 3.
    fn at(&self, excess: [f64; 2]) -> Slopes;
}

/// W and its derivatives; mixed ones and ∂²W/∂Ī₂² are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes {
    /// W.
    pub energy: f64,
    /// ∂W/∂Ī₁.
    pub first: f64,
    /// ∂W/∂Ī₂.
    pub second: f64,
    /// ∂²W/∂Ī₁².
    pub curvature: f64,
}

/// A law of the isochoric invariants with a bulk modulus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isochoric<W> {
    /// W.
    pub of: W,
    /// K.
    pub bulk: f64,
}

/// Kinematics at a point.
pub struct Point<const D: usize> {
    f: Mat<D>,
    inverse_transposed: Mat<D>,
    det_f: f64,
    ln_j: f64,
    /// 2E.
    strain: Mat<D>,
    /// I₁/3 − 1 and I₂/3 − 1.
    means: [f64; 2],
    /// A and B.
    directions: [Mat<D>; 2],
    /// α and β.
    factors: [f64; 2],
    /// 2 J^(−2/3) and 2 J^(−4/3).
    scales: [f64; 2],
    slopes: Slopes,
}

impl<W: OfInvariants, const D: usize> Material<D> for Isochoric<W> {
    type Point = Point<D>;

    #[inline(always)]
    fn after(&self, h: &Mat<D>, _: &Past) -> Result<Point<D>, NotPositive> {
        let excess = valid_excess(h)?;
        let det_f = 1.0 + excess;
        let f = Mat::identity() + *h;
        let cofactor = excess_cofactor(h);
        let inverse_transposed = (Mat::identity() + cofactor) * (1.0 / det_f);
        let difference = (*h - cofactor + f * excess) * (1.0 / det_f);
        let ln_j = ln_1p(excess)[0];
        let strain = *h + h.transposed() + h.transposed() * *h;
        let trace = strain.trace();
        let [second, third] = match D {
            1 => [0.0, 0.0],
            2 => [strain.det(), 0.0],
            _ => [strain.cofactor().trace(), strain.det()],
        };
        let means = [trace / 3.0, (2.0 * trace + second) / 3.0];
        let above = |x: f64| ln_1p(x)[1];
        let volume = above(trace + second + third) / 3.0;
        let logarithms = [
            volume - (second + third) / 3.0 - above(means[0]),
            2.0 * volume - (second + 2.0 * third) / 3.0 - above(means[1]),
        ];
        let slopes = self.of.at(logarithms.map(|logarithm| 3.0 * logarithm.exp_m1()));
        let scales = [-2.0, -4.0].map(|power| 2.0 * (power / 3.0 * ln_j).exp());
        let first = difference - inverse_transposed * means[0];
        let turned = f * (Mat::identity() * trace - strain);
        let directions = [first, difference * 2.0 + turned - inverse_transposed * (2.0 * means[1])];
        let factors = [scales[0] * slopes.first, scales[1] * slopes.second];
        Ok(Point { f, inverse_transposed, det_f, ln_j, strain, means, directions, factors, scales, slopes })
    }

    #[inline(always)]
    fn energy(&self, p: &Point<D>) -> f64 {
        p.slopes.energy + 0.5 * self.bulk * p.ln_j * p.ln_j
    }

    #[inline(always)]
    fn stress(&self, p: &Point<D>) -> Mat<D> {
        let [first, second] = p.directions;
        first * p.factors[0] + second * p.factors[1] + p.inverse_transposed * (self.bulk * p.ln_j)
    }

    #[inline(always)]
    fn tangent(&self, p: &Point<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let mut block = Mat::ZERO;
        for j in 0..D {
            let mut unit = Vector::ZERO;
            unit[j] = 1.0;
            let column = self.change(p, &unit.outer(b)).apply(a);
            for i in 0..D {
                block.0[i][j] = column[i];
            }
        }
        block
    }

    /// With G = F⁻ᵀ and dG = −G dFᵀ G.
    #[inline(always)]
    fn change(&self, p: &Point<D>, df: &Mat<D>) -> Mat<D> {
        let g = p.inverse_transposed;
        let [first, second] = p.directions;
        let [alpha, beta] = p.factors;
        let swells = g.double_dot(df);
        let turned = g * df.transposed() * g;
        let invariants = [1.0 + p.means[0], 1.0 + p.means[1]].map(|mean| 3.0 * mean);
        // I₁ F − F C, half the derivative of I₂.
        let of_second = p.f * (Mat::identity() * (2.0 + p.strain.trace()) - p.strain);
        let by_first = 2.0 * p.f.double_dot(df);
        let by_second = 2.0 * of_second.double_dot(df);
        let alpha_change = p.slopes.curvature * p.scales[0] * p.scales[0] * first.double_dot(df)
            - 2.0 / 3.0 * swells * alpha;
        let beta_change = -4.0 / 3.0 * swells * beta;
        let first_change = *df - g * (by_first / 3.0) + turned * (invariants[0] / 3.0);
        let cauchy_green = df.transposed() * p.f + p.f.transposed() * *df;
        let second_change = p.f * by_first + *df * invariants[0]
            - *df * (Mat::identity() + p.strain)
            - p.f * cauchy_green
            - g * (2.0 / 3.0 * by_second)
            + turned * (2.0 / 3.0 * invariants[1]);
        first * alpha_change
            + first_change * alpha
            + second * beta_change
            + second_change * beta
            + g * (self.bulk * swells)
            - turned * (self.bulk * p.ln_j)
    }

    /// From A₃₃ = −a and B₃₃ = t − 2c.
    fn lateral(&self, p: &Point<D>) -> f64 {
        if D == 3 {
            return 0.0;
        }
        let [first, second] = p.means;
        let isochoric = -p.factors[0] * first + p.factors[1] * (p.strain.trace() - 2.0 * second);
        (isochoric + self.bulk * p.ln_j) / p.det_f
    }
}

impl<W: OfInvariants> Thickness for Isochoric<W> {
    /// The search begins at the thickness that keeps the volume: beyond J = e, the stress of ln J
    /// falls with the thickness.
    fn excess_stretch(&self, h: &Mat<2>) -> Result<f64, NotPositive> {
        let excess = valid_excess(h)?;
        stress_free(self, h, -excess / (1.0 + excess), |h| self.at(h))
    }
}
