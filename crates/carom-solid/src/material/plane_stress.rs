//! Plane stress: the out-of-plane stretch makes the out-of-plane stress vanish, pointwise,
//!
//!   P₃₃(F, F₃₃) = 0,   Aᵢⱼ = Cᵢⱼ − Cᵢ₃ C₃ⱼ / C₃₃,
//!
//! (static condensation of the three-dimensional law; Klinkel, Govindjee, Engng. Comput. 19 (2002)
//! 341–354). Ψ is that of the law at the solved stretch, so that P = ∂Ψ/∂F: the derivative with
//! respect to the stretch is P₃₃ = 0. Cauchy stress is P Fᵀ/J with the three-dimensional J; the
//! force on the deformed sheet of changed thickness is that of P on the undeformed one.

use carom_algebra::{Four, Mat, Vector};

use super::kinematics::excess_det;
use super::past::Past;
use super::{LinearElastic, Material, NeoHookean, NotPositive, SaintVenantKirchhoff};
use crate::points::{get, lanes};

/// A law that admits plane stress.
pub trait Thickness: Material<3> {
    /// F₃₃ − 1 at which P₃₃ = 0, of a law without memory. A law that knows a formula replaces it.
    ///
    /// # Errors
    /// If J of the plane is not positive, or no positive stress-free stretch is found.
    fn excess_stretch(&self, h: &Mat<2>) -> Result<f64, NotPositive> {
        stress_free(self, h, 0.0, |h| self.at(h))
    }

    /// F₃₃ − 1 from which the search begins, of a law with memory.
    fn first_stretch(&self, _: &Past) -> f64 {
        0.0
    }

    /// F₃₃ − 1 at which P₃₃ = 0, from the memory at the start of a step.
    ///
    /// # Errors
    /// As [`Self::excess_stretch`].
    fn excess_stretch_after(&self, h: &Mat<2>, past: &Past) -> Result<f64, NotPositive> {
        if Self::MEMORY == 0 {
            return self.excess_stretch(h);
        }
        stress_free(self, h, self.first_stretch(past), |h| self.after(h, past))
    }
}

/// F₃₃ − 1 at which P₃₃ = 0: Newton's method on the law's own stress and tangent, its steps halved
/// where they would leave F₃₃ > 0 or make |P₃₃| larger.
pub(super) fn stress_free<L: Thickness + ?Sized>(
    law: &L,
    h: &Mat<2>,
    first: f64,
    at: impl Fn(&Mat<3>) -> Result<L::Point, NotPositive>,
) -> Result<f64, NotPositive> {
    let plane = 1.0 + excess_det(h);
    if plane <= 0.0 || plane.is_nan() {
        return Err(NotPositive(plane));
    }
    let at = |across: f64| at(&in_space(h, across));
    let mut across = first;
    let mut point = at(across)?;
    let mut last = f64::INFINITY;
    for _ in 0..100 {
        let stress = law.stress(&point).0[2][2];
        let stiffness = law.tangent(&point, &E3, &E3).0[2][2];
        let mut step = stress / stiffness;
        // Converged to round-off: steps no longer shrink.
        let rounded = step.abs() >= last && last < 1e-9;
        if step.abs() <= 2.0 * f64::EPSILON * (1.0 + across) || rounded {
            return Ok(across - step);
        }
        last = step.abs();
        if !(stiffness > 0.0 && step.is_finite()) {
            break;
        }
        let mut next = at(across - step);
        // The last digits need not make the stress smaller.
        while step.abs() > 1e-12
            && !next.as_ref().is_ok_and(|next| law.stress(next).0[2][2].abs() < stress.abs())
        {
            step *= 0.5;
            next = at(across - step);
        }
        across -= step;
        point = next?;
    }
    Err(NotPositive(0.0))
}

/// H of a sheet with a stretch across.
fn in_space(h: &Mat<2>, across: f64) -> Mat<3> {
    let [[a, b], [c, d]] = h.0;
    Mat([[a, b, 0.0], [c, d, 0.0], [0.0, 0.0, across]])
}

/// A point of a sheet.
pub struct SheetPoint<P> {
    of: P,
    /// F₃₃ − 1.
    across: f64,
}

/// A three-dimensional law in plane stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneStress<L>(pub L);

const E3: Vector<3> = Vector([0.0, 0.0, 1.0]);

impl<L: Thickness> Material<2> for PlaneStress<L> {
    const ENERGY_DEGREE: usize = <L as Material<3>>::ENERGY_DEGREE;
    const OBJECTIVE: bool = <L as Material<3>>::OBJECTIVE;
    const MEMORY: usize = <L as Material<3>>::MEMORY;
    const YIELDS: bool = <L as Material<3>>::YIELDS;
    type Point = SheetPoint<<L as Material<3>>::Point>;

    // Not inlined: a call costs little compared with the solution for the thickness.
    #[inline(never)]
    fn after(&self, h: &Mat<2>, past: &Past) -> Result<Self::Point, NotPositive> {
        let across = self.0.excess_stretch_after(h, past)?;
        Ok(SheetPoint { of: self.0.after(&in_space(h, across), past)?, across })
    }

    fn remember(&self, point: &Self::Point, memory: &mut [f64]) {
        self.0.remember(&point.of, memory);
    }

    fn dissipated(&self, point: &Self::Point) -> f64 {
        self.0.dissipated(&point.of)
    }

    fn plastic_strain(&self, memory: &[f64]) -> f64 {
        self.0.plastic_strain(memory)
    }

    fn released(&self, point: &Self::Point) -> f64 {
        self.0.released(&point.of)
    }

    #[inline(always)]
    fn energy(&self, point: &Self::Point) -> f64 {
        self.0.energy(&point.of)
    }

    #[inline(always)]
    fn stress(&self, point: &Self::Point) -> Mat<2> {
        within(&self.0.stress(&point.of))
    }

    #[inline(never)]
    fn tangent(&self, point: &Self::Point, a: &Vector<2>, b: &Vector<2>) -> Mat<2> {
        let [a, b] = [a, b].map(|v| Vector([v[0], v[1], 0.0]));
        let coupled = |v: &Vector<3>| self.0.tangent(&point.of, v, &E3).0.map(|row| row[2]);
        let left = coupled(&a);
        let right = coupled(&b);
        let across = self.0.tangent(&point.of, &E3, &E3).0[2][2];
        within(&self.0.tangent(&point.of, &a, &b))
            - Vector([left[0], left[1]]).outer(&Vector([right[0], right[1]])) * (1.0 / across)
    }

    fn cauchy(&self, point: &Self::Point, h: &Mat<2>) -> Mat<2> {
        within(&self.0.cauchy(&point.of, &in_space(h, point.across)))
    }

    fn lateral(&self, _: &Self::Point) -> f64 {
        0.0
    }

    fn lateral_excess(&self, point: &Self::Point) -> f64 {
        point.across
    }

    fn volume_ratio(&self, h: &Mat<2>, past: &Past) -> f64 {
        let plane = 1.0 + excess_det(h);
        // Without a memory it is the start of a run.
        let virgin = past.memory.is_empty();
        let across = if virgin { self.0.excess_stretch(h) } else { self.0.excess_stretch_after(h, past) };
        across.map_or(plane, |across| plane * (1.0 + across))
    }

    fn volume_ratio_of_four(&self, h: &Mat<2, Four>) -> Four {
        let points = lanes(h);
        Four(std::array::from_fn(|l| self.volume_ratio(&get(&points, l), &Past::default())))
    }
}

fn within(m: &Mat<3>) -> Mat<2> {
    Mat([[m.0[0][0], m.0[0][1]], [m.0[1][0], m.0[1][1]]])
}

impl Thickness for LinearElastic {
    /// ε₃₃ = −Λ tr ε/(Λ + 2μ).
    #[inline(always)]
    fn excess_stretch(&self, h: &Mat<2>) -> Result<f64, NotPositive> {
        Ok(-self.lambda * h.trace() / (self.lambda + 2.0 * self.mu))
    }
}

impl Thickness for SaintVenantKirchhoff {
    /// E₃₃ = −Λ(E₁₁ + E₂₂)/(Λ + 2μ), F₃₃ = √(1 + 2E₃₃).
    #[inline(always)]
    fn excess_stretch(&self, h: &Mat<2>) -> Result<f64, NotPositive> {
        let twice_trace = 2.0 * h.trace() + h.double_dot(h);
        let twice = -self.lambda * twice_trace / (self.lambda + 2.0 * self.mu);
        if twice > -1.0 {
            // √(1 + x) − 1 without cancellation.
            Ok(twice / (1.0 + (1.0 + twice).sqrt()))
        } else {
            Err(NotPositive(0.0))
        }
    }
}

impl Thickness for NeoHookean {
    /// With s = ln F₃₃: μ(e²ˢ − 1) + Λ(ln J₂ + s) = 0 by Newton's method. The left side is convex
    /// in s. For Λ ≥ 0 it increases everywhere, and from the second on the iterates descend to its
    /// only root. For Λ < 0 there is none if the plane is compressed too far.
    #[inline(always)]
    fn excess_stretch(&self, h: &Mat<2>) -> Result<f64, NotPositive> {
        let excess = excess_det(h);
        if excess <= -1.0 || excess.is_nan() {
            return Err(NotPositive(1.0 + excess));
        }
        let lambda = self.lambda;
        let mu = self.mu;
        let ln_j = excess.ln_1p();
        let mut s = -lambda * ln_j / (lambda + 2.0 * mu);
        let mut last = f64::INFINITY;
        for _ in 0..60 {
            let square = (2.0 * s).exp_m1();
            let slope = 2.0 * mu * (1.0 + square) + lambda;
            let step = (mu * square + lambda * (ln_j + s)) / slope;
            if !(slope > 0.0 && step.is_finite()) {
                break;
            }
            s -= step;
            // Converged to round-off: steps no longer shrink.
            if step.abs() <= 2.0 * f64::EPSILON * s.abs() || step.abs() >= last && last < 1e-9 {
                return Ok(s.exp_m1());
            }
            last = step.abs();
        }
        Err(NotPositive(0.0))
    }
}
