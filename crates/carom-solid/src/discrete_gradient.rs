//! Discrete gradient of a strain energy between two deformations (O. Gonzalez, Comput. Methods
//! Appl. Mech. Engrg. 190 (2000) 1763–1783):
//!
//! ```text
//! P = F_m S,   S = S(E_m) + φ ΔE,   φ = [W₁ − W₀ − S(E_m):ΔE] / (ΔE:ΔE),   F_m = (F₀ + F₁)/2,   E_m = (E₀ + E₁)/2,   ΔE = E₁ − E₀ = sym(F_mᵀ ΔF)
//! ```
//!
//! so that P:ΔF = S:ΔE = W₁ − W₀ exactly, and S is symmetric (angular momentum) and objective.
//! Every term is a function of E₀ and E₁, never of the rotation: W(E) and S(E) come from the law at
//! the triangular F̂ with F̂ᵀF̂ = I + 2E, S = F̂⁻¹ P(F̂), and so does the derivative:
//! dF̂ = F̂⁻ᵀ dE has sym(F̂ᵀ dF̂) = dE, and dS = F̂⁻¹ (dP − dF̂ S). For small strains the energy is
//! quadratic in H, and the stress at the midpoint is a discrete gradient already.
//!
//! The numerator of φ is of third order in ΔE. As a difference of energies it would consist of
//! round-off where ΔE is small: an error ε W of it is one of ε W/‖ΔE‖ in S, which no correction of
//! the positions removes. It is then the integral of the stresses along the path, by three Gauss
//! points, in which the terms cancel before they are multiplied by ΔE:
//!
//! ```text
//! W₁ − W₀ − S(E_m):ΔE = 5/18 [S(E₊) + S(E₋) − 2 S(E_m)]:ΔE,   E± = E_m ± √(3/5) ΔE/2
//! ```
//!
//! Where flow begins within a step, the incremental potential W = W* − ψ of a law that yields has
//! no second derivative. The smooth part W*, without flow in the step, is integrated so; what flow
//! releases, ψ, is known in closed form:
//!
//! ```text
//! W₁ − W₀ − S(E_m):ΔE = 5/18 [S*(E₊) + S*(E₋) − 2 S*(E_m)]:ΔE − (ψ₁ − ψ₀) − [S(E_m) − S*(E_m)]:ΔE
//! ```
//!
//! In plane stress, where the thickness without flow is another one, the work of a step with flow
//! is the difference of the energies.

use carom_algebra::Mat;

use crate::material::{Material, NotPositive, excess_det};

/// Largest ΔE:ΔE with which three Gauss points give W₁ − W₀ to round-off: their error is
/// W⁽⁷⁾ ‖ΔE‖⁷/2 016 000 (M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 25.4.30),
/// 2e-23 W″ at this bound for the logarithm of the neo-Hookean law.
const GAUSS: f64 = 1e-6;

/// Distance of the outer Gauss points from the middle, in ΔE: √(3/5)/2.
const OUTER: f64 = 0.387_298_334_620_741_7;

/// Weight of an outer Gauss point.
const WEIGHT: f64 = 5.0 / 18.0;

/// W₁ and P. Not inlined: the cost of a call is small in comparison.
#[inline(never)]
pub(crate) fn between<const D: usize, L: Material<D>>(
    law: &L,
    h: [&Mat<D>; 2],
) -> Result<(f64, Mat<D>), NotPositive> {
    if L::OBJECTIVE {
        let path = Path::new(law, h)?;
        let energy = energy_at(law, &path.ends[1])?;
        let s = path.middle.stress + path.change * path.phi(law, energy)?;
        return Ok((energy, path.f * s));
    }
    let end = law.at(h[1])?;
    let middle = law.at(&((*h[0] + *h[1]) * 0.5))?;
    Ok((law.energy(&end), law.stress(&middle)))
}

/// ∂P/∂F₁ : dF₁. It is not symmetric: F_m multiplies from the left, F₁ from the right.
#[inline(never)]
pub(crate) fn change_between<const D: usize, L: Material<D>>(
    law: &L,
    h: [&Mat<D>; 2],
    dh: &Mat<D>,
) -> Result<Mat<D>, NotPositive> {
    if !L::OBJECTIVE {
        let point = law.at(&((*h[0] + *h[1]) * 0.5))?;
        return Ok(law.change(&point, &(*dh * 0.5)));
    }
    let path = Path::new(law, h)?;
    let de = symmetric(&((Mat::identity() + *h[1]).transposed() * *dh));
    let [phi, dphi] = path.phi_and_change(law, &de)?;
    let s = path.middle.stress + path.change * phi;
    let ds = path.middle.change(law, &(de * 0.5)) + path.change * dphi + de * phi;
    Ok(*dh * s * 0.5 + path.f * ds)
}

/// W at a strain.
#[inline(always)]
fn energy_at<const D: usize, L: Material<D>>(law: &L, strain: &Mat<D>) -> Result<f64, NotPositive> {
    Ok(law.energy(&law.at(&root(strain)?)?))
}

/// A law at a strain.
struct AtStrain<const D: usize, P> {
    /// The law at F̂.
    point: P,
    /// F̂⁻¹.
    inverse: Mat<D>,
    /// S.
    stress: Mat<D>,
    /// The smooth part of a law that yields.
    unevolved: Option<(P, Mat<D>)>,
}

impl<const D: usize, P> AtStrain<D, P> {
    #[inline(always)]
    fn new<L: Material<D, Point = P>>(law: &L, strain: &Mat<D>) -> Result<Self, NotPositive> {
        let excess = root(strain)?;
        let point = law.at(&excess)?;
        let inverse = (Mat::identity() + excess).inverse();
        let stress = symmetric(&(inverse * law.stress(&point)));
        let unevolved = law.unevolved(&point).map(|unevolved| {
            let stress = symmetric(&(inverse * law.stress(&unevolved)));
            (unevolved, stress)
        });
        Ok(Self { point, inverse, stress, unevolved })
    }

    /// The smooth part S* of S.
    #[inline(always)]
    fn smooth(&self) -> &Mat<D> {
        self.unevolved.as_ref().map_or(&self.stress, |(_, stress)| stress)
    }

    /// ∂S*/∂E : dE.
    #[inline(always)]
    fn smooth_change<L: Material<D, Point = P>>(&self, law: &L, de: &Mat<D>) -> Mat<D> {
        let Some((point, stress)) = &self.unevolved else { return self.change(law, de) };
        let df = self.inverse.transposed() * *de;
        self.inverse * (law.change(point, &df) - df * *stress)
    }

    /// ∂S/∂E : dE.
    #[inline(always)]
    fn change<L: Material<D, Point = P>>(&self, law: &L, de: &Mat<D>) -> Mat<D> {
        let df = self.inverse.transposed() * *de;
        self.inverse * (law.change(&self.point, &df) - df * self.stress)
    }
}

/// The straight path between two strains.
struct Path<const D: usize, P> {
    /// E₀ and E₁.
    ends: [Mat<D>; 2],
    /// The law at E_m.
    middle: AtStrain<D, P>,
    /// F_m.
    f: Mat<D>,
    /// ΔE.
    change: Mat<D>,
    /// ΔE:ΔE.
    square: f64,
    /// Whether the correction φ ΔE is above the round-off of S(E_m). It is of the size ‖ΔE‖² W‴,
    /// S(E_m) of the size ‖E_m‖ W″.
    corrected: bool,
}

impl<const D: usize, P> Path<D, P> {
    #[inline(always)]
    fn new<L: Material<D, Point = P>>(law: &L, h: [&Mat<D>; 2]) -> Result<Self, NotPositive> {
        for h in h {
            // Strains do not tell a reflection.
            let det_f = 1.0 + excess_det(h);
            if det_f.is_nan() || det_f <= 0.0 {
                return Err(NotPositive(det_f));
            }
        }
        let ends = h.map(strain);
        let middle_strain = (ends[0] + ends[1]) * 0.5;
        let f = Mat::identity() + (*h[0] + *h[1]) * 0.5;
        let change = symmetric(&(f.transposed() * (*h[1] - *h[0])));
        let square = change.double_dot(&change);
        let corrected = square > f64::EPSILON * middle_strain.double_dot(&middle_strain);
        Ok(Self { ends, middle: AtStrain::new(law, &middle_strain)?, f, change, square, corrected })
    }

    /// The law at E₊ and E₋.
    #[inline(always)]
    fn outer<L: Material<D, Point = P>>(&self, law: &L) -> Result<[AtStrain<D, P>; 2], NotPositive> {
        let middle = (self.ends[0] + self.ends[1]) * 0.5;
        let offset = self.change * OUTER;
        Ok([AtStrain::new(law, &(middle + offset))?, AtStrain::new(law, &(middle - offset))?])
    }

    /// S*(E₊) + S*(E₋) − 2 S*(E_m), times the weight.
    #[inline(always)]
    fn curvature(&self, outer: &[AtStrain<D, P>; 2]) -> Mat<D> {
        let above = *outer[0].smooth() - *self.middle.smooth();
        let below = *outer[1].smooth() - *self.middle.smooth();
        (above + below) * WEIGHT
    }

    /// Whether the work is the difference of the energies: in long steps, and where flow begins of
    /// which ψ is not known.
    #[inline(always)]
    fn by_difference<L: Material<D, Point = P>>(&self, law: &L) -> Result<bool, NotPositive> {
        if self.square > GAUSS || !L::YIELDS || self.middle.unevolved.is_some() {
            return Ok(self.square > GAUSS);
        }
        let flows = |point: &P| law.released(point) > 0.0;
        Ok(flows(&self.middle.point) || flows(&law.at(&root(&self.ends[1])?)?))
    }

    /// −(ψ₁ − ψ₀) − [S(E_m) − S*(E_m)]:ΔE.
    #[inline(always)]
    fn released<L: Material<D, Point = P>>(&self, law: &L) -> Result<f64, NotPositive> {
        if self.middle.unevolved.is_none() {
            return Ok(0.0);
        }
        let mut released = [0.0; 2];
        for (released, strain) in released.iter_mut().zip(&self.ends) {
            *released = law.released(&law.at(&root(strain)?)?);
        }
        let flown = self.middle.stress - *self.middle.smooth();
        Ok(released[0] - released[1] - flown.double_dot(&self.change))
    }

    /// The derivative of [`Self::released`] along dE.
    #[inline(always)]
    fn released_change<L: Material<D, Point = P>>(&self, law: &L, de: &Mat<D>) -> Result<f64, NotPositive> {
        if self.middle.unevolved.is_none() {
            return Ok(0.0);
        }
        let end = AtStrain::new(law, &self.ends[1])?;
        let half = *de * 0.5;
        let flown = (end.stress - *end.smooth()) - (self.middle.stress - *self.middle.smooth());
        let change = self.middle.change(law, &half) - self.middle.smooth_change(law, &half);
        Ok(flown.double_dot(de) - change.double_dot(&self.change))
    }

    /// φ, with W₁.
    #[inline(always)]
    fn phi<L: Material<D, Point = P>>(&self, law: &L, end: f64) -> Result<f64, NotPositive> {
        if !self.corrected {
            return Ok(0.0);
        }
        let excess_work = if self.by_difference(law)? {
            end - energy_at(law, &self.ends[0])? - self.middle.stress.double_dot(&self.change)
        } else {
            self.curvature(&self.outer(law)?).double_dot(&self.change) + self.released(law)?
        };
        Ok(excess_work / self.square)
    }

    /// φ and its derivative in the direction of a change dE of E₁.
    #[inline(always)]
    fn phi_and_change<L: Material<D, Point = P>>(
        &self,
        law: &L,
        de: &Mat<D>,
    ) -> Result<[f64; 2], NotPositive> {
        if !self.corrected {
            return Ok([0.0, 0.0]);
        }
        let [phi, excess_change] = if self.by_difference(law)? {
            let end = AtStrain::new(law, &self.ends[1])?;
            let phi = self.phi(law, law.energy(&end.point))?;
            let by_stress = (end.stress - self.middle.stress).double_dot(de);
            let middle_change = self.middle.change(law, &(*de * 0.5));
            [phi, by_stress - middle_change.double_dot(&self.change)]
        } else {
            let outer = self.outer(law)?;
            let curvature = self.curvature(&outer);
            let middle = self.middle.smooth_change(law, &(*de * 0.5));
            let above = outer[0].smooth_change(law, &(*de * (0.5 + OUTER))) - middle;
            let below = outer[1].smooth_change(law, &(*de * (0.5 - OUTER))) - middle;
            let curvature_change = (above + below) * WEIGHT;
            let phi = (curvature.double_dot(&self.change) + self.released(law)?) / self.square;
            let smooth = curvature_change.double_dot(&self.change) + curvature.double_dot(de);
            [phi, smooth + self.released_change(law, de)?]
        };
        Ok([phi, (excess_change - 2.0 * phi * self.change.double_dot(de)) / self.square])
    }
}

#[inline(always)]
fn symmetric<const D: usize>(a: &Mat<D>) -> Mat<D> {
    (*a + a.transposed()) * 0.5
}

/// E = (H + Hᵀ + HᵀH)/2.
#[inline(always)]
fn strain<const D: usize>(h: &Mat<D>) -> Mat<D> {
    (*h + h.transposed() + h.transposed() * *h) * 0.5
}

/// F̂ − I with F̂ upper triangular and F̂ᵀF̂ = I + 2E (Cholesky); √(1 + x) − 1 = x/(1 + √(1 + x))
/// avoids cancellation for small E.
#[inline(always)]
fn root<const D: usize>(e: &Mat<D>) -> Result<Mat<D>, NotPositive> {
    let mut h = Mat::ZERO;
    for i in 0..D {
        for j in i..D {
            let known: f64 = (0..i).map(|k| h.0[k][i] * h.0[k][j]).sum();
            let remainder = 2.0 * e.0[i][j] - known;
            if i == j {
                let diagonal = (1.0 + remainder).sqrt();
                if diagonal.is_nan() || diagonal <= 0.0 {
                    return Err(NotPositive(0.0));
                }
                h.0[i][i] = remainder / (1.0 + diagonal);
            } else {
                h.0[i][j] = remainder / (1.0 + h.0[i][i]);
            }
        }
    }
    Ok(h)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_a_root_in_three_dimensions() {
        let e = Mat([[0.2, -0.1, 0.05], [-0.1, -0.1, 0.15], [0.05, 0.15, 0.3]]);
        let f = Mat::identity() + root(&e).unwrap();
        let error = f.transposed() * f - Mat::identity() - e * 2.0;
        assert!(error.double_dot(&error) < 1e-30);
        assert!(root(&(Mat::<3>::identity() * -0.6)).is_err());
    }
}
