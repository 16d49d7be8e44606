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

/// A discrete gradient.
pub(crate) struct Between<const D: usize, P> {
    /// The law at the end, of an objective one at F̂.
    pub(crate) end: P,
    /// P.
    pub(crate) stress: Mat<D>,
}

/// The discrete gradient. Not inlined: the cost of a call is small in comparison.
#[inline(never)]
pub(crate) fn between<const D: usize, L: Material<D>>(
    law: &L,
    h: [&Mat<D>; 2],
) -> Result<Between<D, L::Point>, NotPositive> {
    if L::OBJECTIVE {
        let path = Path::new(law, h)?;
        let end = law.at(&root(&path.ends[1])?)?;
        let s = path.middle.stress + path.change * path.phi(law, &end)?;
        return Ok(Between { end, stress: path.f * s });
    }
    let end = law.at(h[1])?;
    let middle = law.at(&((*h[0] + *h[1]) * 0.5))?;
    Ok(Between { end, stress: law.stress(&middle) })
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
#[inline(never)]
fn energy_at<const D: usize, L: Material<D>>(law: &L, strain: &Mat<D>) -> Result<f64, NotPositive> {
    Ok(law.energy(&law.at(&root(strain)?)?))
}

/// S* at a strain, of a law without flow in the step.
#[inline(never)]
fn smooth_at<const D: usize, L: Material<D>>(
    law: &L,
    strain: &Mat<D>,
) -> Result<AtStrain<D, L::Point>, NotPositive> {
    let excess = root(strain)?;
    let point = law.at(&excess)?;
    let point = law.unevolved(&point).unwrap_or(point);
    Ok(AtStrain::of(law, point, &excess))
}

/// A law at a strain.
struct AtStrain<const D: usize, P> {
    /// The law at F̂.
    point: P,
    /// F̂⁻¹.
    inverse: Mat<D>,
    /// S.
    stress: Mat<D>,
}

impl<const D: usize, P> AtStrain<D, P> {
    #[inline(always)]
    fn of<L: Material<D, Point = P>>(law: &L, point: P, excess: &Mat<D>) -> Self {
        let inverse = (Mat::identity() + *excess).inverse();
        let stress = symmetric(&(inverse * law.stress(&point)));
        Self { point, inverse, stress }
    }

    /// S of another point at the same strain.
    #[inline(always)]
    fn replaced<L: Material<D, Point = P>>(&self, law: &L, point: P) -> Self {
        let stress = symmetric(&(self.inverse * law.stress(&point)));
        Self { point, inverse: self.inverse, stress }
    }

    /// ∂S/∂E : dE.
    #[inline(always)]
    fn change<L: Material<D, Point = P>>(&self, law: &L, de: &Mat<D>) -> Mat<D> {
        let df = self.inverse.transposed() * *de;
        self.inverse * (law.change(&self.point, &df) - df * self.stress)
    }
}

/// The law at a strain.
#[inline(always)]
fn law_at<const D: usize, L: Material<D>>(
    law: &L,
    strain: &Mat<D>,
) -> Result<AtStrain<D, L::Point>, NotPositive> {
    let excess = root(strain)?;
    Ok(AtStrain::of(law, law.at(&excess)?, &excess))
}

/// The straight path between two strains.
struct Path<const D: usize, P> {
    /// E₀ and E₁.
    ends: [Mat<D>; 2],
    /// The law at E_m.
    middle: AtStrain<D, P>,
    /// The smooth part of the potential, of a law that yields.
    unevolved: Option<AtStrain<D, P>>,
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
        let middle = law_at(law, &middle_strain)?;
        let unevolved = law.unevolved(&middle.point).map(|point| middle.replaced(law, point));
        Ok(Self { ends, middle, unevolved, f, change, square, corrected })
    }

    /// The smooth part at E_m.
    #[inline(always)]
    fn smooth(&self) -> &AtStrain<D, P> {
        self.unevolved.as_ref().unwrap_or(&self.middle)
    }

    /// The smooth part at E₊ and E₋.
    #[inline(always)]
    fn outer<L: Material<D, Point = P>>(&self, law: &L) -> Result<[AtStrain<D, P>; 2], NotPositive> {
        let middle = (self.ends[0] + self.ends[1]) * 0.5;
        let offset = self.change * OUTER;
        Ok([smooth_at(law, &(middle + offset))?, smooth_at(law, &(middle - offset))?])
    }

    /// S*(E₊) + S*(E₋) − 2 S*(E_m), times the weight.
    #[inline(always)]
    fn curvature(&self, outer: &[AtStrain<D, P>; 2]) -> Mat<D> {
        let smooth = self.smooth().stress;
        let above = outer[0].stress - smooth;
        let below = outer[1].stress - smooth;
        (above + below) * WEIGHT
    }

    /// Whether the work is the difference of the energies: in long steps, and where flow begins of
    /// which ψ is not known.
    #[inline(always)]
    fn by_difference<L: Material<D, Point = P>>(&self, law: &L, end: &P) -> bool {
        let flows = |point: &P| law.released(point) > 0.0;
        let is_unknown = L::YIELDS && self.unevolved.is_none();
        self.square > GAUSS || is_unknown && (flows(&self.middle.point) || flows(end))
    }

    /// −(ψ₁ − ψ₀) − [S(E_m) − S*(E_m)]:ΔE.
    #[inline(always)]
    fn released<L: Material<D, Point = P>>(&self, law: &L, end: &P) -> Result<f64, NotPositive> {
        let Some(unevolved) = &self.unevolved else { return Ok(0.0) };
        let start = law.released(&law.at(&root(&self.ends[0])?)?);
        let flown = self.middle.stress - unevolved.stress;
        Ok(start - law.released(end) - flown.double_dot(&self.change))
    }

    /// The derivative of [`Self::released`] along dE.
    #[inline(always)]
    fn released_change<L: Material<D, Point = P>>(&self, law: &L, end: &AtStrain<D, P>, de: &Mat<D>) -> f64 {
        let Some(unevolved) = &self.unevolved else { return 0.0 };
        let Some(end_unevolved) = law.unevolved(&end.point) else { return 0.0 };
        let half = *de * 0.5;
        let end_flown = end.stress - end.replaced(law, end_unevolved).stress;
        let flown = end_flown - (self.middle.stress - unevolved.stress);
        let change = self.middle.change(law, &half) - unevolved.change(law, &half);
        flown.double_dot(de) - change.double_dot(&self.change)
    }

    /// φ.
    #[inline(always)]
    fn phi<L: Material<D, Point = P>>(&self, law: &L, end: &P) -> Result<f64, NotPositive> {
        if !self.corrected {
            return Ok(0.0);
        }
        let excess_work = if self.by_difference(law, end) {
            law.energy(end) - energy_at(law, &self.ends[0])? - self.middle.stress.double_dot(&self.change)
        } else {
            self.curvature(&self.outer(law)?).double_dot(&self.change) + self.released(law, end)?
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
        let needs_end = L::YIELDS || self.square > GAUSS;
        let end = if needs_end { Some(law_at(law, &self.ends[1])?) } else { None };
        let [phi, excess_change] = match end {
            Some(end) if self.by_difference(law, &end.point) => {
                let phi = self.phi(law, &end.point)?;
                let by_stress = (end.stress - self.middle.stress).double_dot(de);
                let middle_change = self.middle.change(law, &(*de * 0.5));
                [phi, by_stress - middle_change.double_dot(&self.change)]
            }
            end => {
                let outer = self.outer(law)?;
                let curvature = self.curvature(&outer);
                let middle = self.smooth().change(law, &(*de * 0.5));
                let above = outer[0].change(law, &(*de * (0.5 + OUTER))) - middle;
                let below = outer[1].change(law, &(*de * (0.5 - OUTER))) - middle;
                let curvature_change = (above + below) * WEIGHT;
                let mut work = curvature.double_dot(&self.change);
                let mut change = curvature_change.double_dot(&self.change) + curvature.double_dot(de);
                if let Some(end) = &end {
                    work += self.released(law, &end.point)?;
                    change += self.released_change(law, end, de);
                }
                [work / self.square, change]
            }
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
pub fn root<const D: usize>(e: &Mat<D>) -> Result<Mat<D>, NotPositive> {
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
