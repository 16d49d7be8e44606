//! The volumetric part of the laws, Ψ = Ψ₀ + W(q): Λ, or the bulk modulus K, enters in W alone, and
//! q measures the change of volume,
//!
//! ```text
//! neo-Hookean             q = J − 1    ∂q/∂F = cof F    W = Λ/2 (ln (1 + q))²
//! St. Venant–Kirchhoff    q = tr E     ∂q/∂F = F        W = Λ/2 q²
//! linear elastic          q = tr ε     ∂q/∂F = I        W = Λ/2 q²
//! Hencky, plastic         q = J − 1    ∂q/∂F = cof F    W = K/2 (ln (1 + q))²,   K = Λ + 2μ/3
//! Mooney–Rivlin, Yeoh     q = J − 1    ∂q/∂F = cof F    W = K/2 (ln (1 + q))²
//! ```
//!
//! Measures are laws themselves, with q as their energy, so that the kernels of forces, tangents
//! and discrete gradients serve them too.

use carom_algebra::{Four, Mat, Real, Vector};

use super::kinematics::{excess_cofactor, ln_1p, valid_excess};
use super::{AtFour, Hencky, Isochoric, J2, Law, Material, NotPositive, Past, Pointwise};

/// What mean dilatation needs of a law.
pub(crate) struct Mean<const D: usize> {
    /// Ψ.
    pub(crate) law: Box<dyn Pointwise<D>>,
    /// q as a law.
    pub(crate) measure: Box<dyn Pointwise<D>>,
    pub(crate) volumetric: Volumetric,
}

impl Law {
    /// Ψ₀, the law with Λ = 0 or K = 0, and what mean dilatation adds.
    pub(crate) fn averaged<const D: usize>(self) -> (Self, Mean<D>) {
        let (rest, measure, volumetric): (_, Box<dyn Pointwise<D>>, _) = match self {
            Self::NeoHookean { lambda, mu } => {
                (Self::NeoHookean { lambda: 0.0, mu }, Box::new(Swelling), Volumetric::Logarithmic(lambda))
            }
            Self::SaintVenantKirchhoff { lambda, mu } => {
                let rest = Self::SaintVenantKirchhoff { lambda: 0.0, mu };
                (rest, Box::new(TraceOfStrain), Volumetric::Quadratic(lambda))
            }
            Self::LinearElastic { lambda, mu } => {
                let rest = Self::LinearElastic { lambda: 0.0, mu };
                (rest, Box::new(SmallSwelling), Volumetric::Quadratic(lambda))
            }
            // The whole resistance to changes of volume is averaged: plastic flow is isochoric,
            // and any of it at the points of a cell would lock the cell.
            Self::Hencky { lambda, mu } => {
                let law = Hencky { lambda, mu };
                let rest = Self::Hencky { lambda: law.without_bulk().lambda, mu };
                (rest, Box::new(Swelling), Volumetric::Logarithmic(law.bulk()))
            }
            Self::MooneyRivlin(Isochoric { of, bulk }) => {
                let rest = Self::MooneyRivlin(Isochoric { of, bulk: 0.0 });
                (rest, Box::new(Swelling), Volumetric::Logarithmic(bulk))
            }
            Self::Yeoh(Isochoric { of, bulk }) => {
                let rest = Self::Yeoh(Isochoric { of, bulk: 0.0 });
                (rest, Box::new(Swelling), Volumetric::Logarithmic(bulk))
            }
        };
        (rest, Mean { law: self.pointwise(), measure, volumetric })
    }
}

impl J2 {
    /// The law without resistance to changes of volume, and what mean dilatation adds.
    pub(crate) fn averaged<const D: usize>(&self) -> (Self, Mean<D>) {
        let rest = Self { elastic: self.elastic.without_bulk(), hardening: self.hardening.clone() };
        let volumetric = Volumetric::Logarithmic(self.elastic.bulk());
        (rest, Mean { law: Box::new(self.clone()), measure: Box::new(Swelling), volumetric })
    }
}

/// W, with its Λ.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Volumetric {
    /// Λ/2 (ln (1 + m))².
    Logarithmic(f64),
    /// Λ/2 m².
    Quadratic(f64),
}

impl Volumetric {
    /// W, W′ and W″ at m.
    pub(crate) fn at(self, m: f64) -> [f64; 3] {
        match self {
            Self::Logarithmic(lambda) => {
                let logarithm = ln_1p(m)[0];
                let ratio = 1.0 + m;
                let [energy, pressure] = [0.5 * logarithm * logarithm, logarithm / ratio];
                [energy, pressure, (1.0 - logarithm) / (ratio * ratio)].map(|part| lambda * part)
            }
            Self::Quadratic(lambda) => [0.5 * lambda * m * m, lambda * m, lambda],
        }
    }

    /// ΔW/Δm between two values of m, and its derivative with respect to the second; without
    /// cancellation.
    ///
    /// With x = (m₁ − m₀)/(1 + m₀) and q(x) = ln(1 + x)/x the logarithmic one is
    /// Λ (ln(1 + m₀) + ln(1 + m₁)) q(x)/(2 (1 + m₀)).
    pub(crate) fn between(self, [start, end]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Logarithmic(lambda) => {
                let ratio = 1.0 + start;
                let [quotient, slope] = logarithmic_quotient((end - start) / ratio);
                let sum = ln_1p(start)[0] + ln_1p(end)[0];
                let by_end = quotient / (1.0 + end) + sum * slope / ratio;
                [sum * quotient, by_end].map(|part| 0.5 * lambda * part / ratio)
            }
            Self::Quadratic(lambda) => [0.5 * lambda * (start + end), 0.5 * lambda],
        }
    }
}

/// q = J − 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swelling;

/// cof F and J − 1.
pub(super) struct OfSwelling<const D: usize, T = f64> {
    cofactor: Mat<D, T>,
    excess: T,
}

impl<const D: usize, T: Real> OfSwelling<D, T> {
    #[inline(always)]
    fn at(h: &Mat<D, T>) -> Result<Self, NotPositive> {
        let excess = valid_excess(h)?;
        Ok(Self { cofactor: Mat::identity() + excess_cofactor(h), excess })
    }
}

impl<const D: usize> Material<D> for Swelling {
    const ENERGY_DEGREE: usize = D;
    type Point = OfSwelling<D>;

    #[inline(always)]
    fn after(&self, h: &Mat<D>, _: &Past) -> Result<OfSwelling<D>, NotPositive> {
        OfSwelling::at(h)
    }

    #[inline(always)]
    fn energy(&self, p: &OfSwelling<D>) -> f64 {
        p.excess
    }

    #[inline(always)]
    fn stress(&self, p: &OfSwelling<D>) -> Mat<D> {
        p.cofactor
    }

    #[inline(always)]
    fn four(&self, h: &Mat<D, Four>, _: &Past, _: usize, _: &mut [f64]) -> Result<AtFour<D>, NotPositive> {
        let point = OfSwelling::at(h)?;
        Ok(AtFour::elastic(point.excess, point.cofactor))
    }

    /// J (ã⊗b̃ − b̃⊗ã), ã = F⁻ᵀa.
    #[inline(always)]
    fn tangent(&self, p: &OfSwelling<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let a = p.cofactor.apply(a);
        let b = p.cofactor.apply(b);
        (a.outer(&b) - b.outer(&a)) * (1.0 / (1.0 + p.excess))
    }

    fn cauchy(&self, _: &OfSwelling<D>, _: &Mat<D>) -> Mat<D> {
        Mat::identity()
    }

    fn lateral(&self, _: &OfSwelling<D>) -> f64 {
        1.0
    }
}

/// q = tr E, E = (H + Hᵀ + HᵀH)/2; it is defined for J ≤ 0, which is an error as in the law.
#[derive(Clone, Copy, Debug)]
pub(super) struct TraceOfStrain;

/// H and J.
pub(super) struct OfStrain<const D: usize, T = f64> {
    h: Mat<D, T>,
    det_f: T,
}

impl<const D: usize, T: Real> OfStrain<D, T> {
    #[inline(always)]
    fn at(h: &Mat<D, T>) -> Result<Self, NotPositive> {
        let det_f = T::of(1.0) + valid_excess(h)?;
        Ok(Self { h: *h, det_f })
    }

    #[inline(always)]
    fn trace(&self) -> T {
        self.h.trace() + T::of(0.5) * self.h.double_dot(&self.h)
    }
}

impl<const D: usize> Material<D> for TraceOfStrain {
    const ENERGY_DEGREE: usize = 2;
    type Point = OfStrain<D>;

    #[inline(always)]
    fn after(&self, h: &Mat<D>, _: &Past) -> Result<OfStrain<D>, NotPositive> {
        OfStrain::at(h)
    }

    #[inline(always)]
    fn energy(&self, p: &OfStrain<D>) -> f64 {
        p.trace()
    }

    #[inline(always)]
    fn stress(&self, p: &OfStrain<D>) -> Mat<D> {
        Mat::identity() + p.h
    }

    #[inline(always)]
    fn four(&self, h: &Mat<D, Four>, _: &Past, _: usize, _: &mut [f64]) -> Result<AtFour<D>, NotPositive> {
        let point = OfStrain::at(h)?;
        Ok(AtFour::elastic(point.trace(), Mat::identity() + point.h))
    }

    #[inline(always)]
    fn tangent(&self, _: &OfStrain<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        Mat::identity() * a.dot(b)
    }

    fn cauchy(&self, p: &OfStrain<D>, h: &Mat<D>) -> Mat<D> {
        let f = Mat::identity() + *h;
        f * f.transposed() * (1.0 / p.det_f)
    }

    fn lateral(&self, p: &OfStrain<D>) -> f64 {
        1.0 / p.det_f
    }
}

/// q = tr ε = tr H.
#[derive(Clone, Copy, Debug)]
pub(super) struct SmallSwelling;

impl<const D: usize> Material<D> for SmallSwelling {
    const ENERGY_DEGREE: usize = 1;
    const OBJECTIVE: bool = false;
    type Point = f64;

    #[inline(always)]
    fn after(&self, h: &Mat<D>, _: &Past) -> Result<f64, NotPositive> {
        Ok(h.trace())
    }

    #[inline(always)]
    fn energy(&self, trace: &f64) -> f64 {
        *trace
    }

    #[inline(always)]
    fn stress(&self, _: &f64) -> Mat<D> {
        Mat::identity()
    }

    #[inline(always)]
    fn tangent(&self, _: &f64, _: &Vector<D>, _: &Vector<D>) -> Mat<D> {
        Mat::ZERO
    }

    fn cauchy(&self, _: &f64, _: &Mat<D>) -> Mat<D> {
        Mat::identity()
    }

    fn lateral(&self, _: &f64) -> f64 {
        1.0
    }
}

/// ln(1 + x)/x and its derivative.
fn logarithmic_quotient(x: f64) -> [f64; 2] {
    // The terms omitted are below x⁸: round-off.
    if x.abs() < 0.01 {
        let mut value = 0.0;
        let mut slope = 0.0;
        for k in (0..8_i32).rev() {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            slope = slope * x + value;
            value = value * x + sign / f64::from(k + 1);
        }
        return [value, slope];
    }
    let value = x.ln_1p() / x;
    [value, (1.0 / (1.0 + x) - value) / x]
}
