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

use carom_algebra::{Mat, Real, wide};

use crate::material::{NotPositive, excess_det};
use crate::potential::Potential;

/// Largest ΔE:ΔE with which three Gauss points give W₁ − W₀ to round-off: their error is
/// W⁽⁷⁾ ‖ΔE‖⁷/2 016 000 (M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 25.4.30),
/// 2e-23 W″ at this bound for the logarithm of the neo-Hookean law.
const GAUSS: f64 = 1e-6;

/// Distance of the outer Gauss points from the middle, in ΔE: √(3/5)/2.
const OUTER: f64 = 0.387_298_334_620_741_7;

/// Weight of an outer Gauss point.
const WEIGHT: f64 = 5.0 / 18.0;

/// A discrete gradient.
pub(crate) struct Between<const D: usize, T, P> {
    /// The law at the end, of an objective one at F̂.
    pub(crate) end: P,
    /// P.
    pub(crate) stress: Mat<D, T>,
}

/// The discrete gradient.
#[inline(always)]
pub(crate) fn between<const D: usize, T: Real, L: Potential<D, T>>(
    law: &L,
    h: [&Mat<D, T>; 2],
) -> Result<Between<D, T, L::Point>, NotPositive> {
    if L::OBJECTIVE {
        let path = Path::new(law, h)?;
        let end = law_at(law, &path.ends[1])?.point;
        let s = path.middle.stress + path.change * path.phi(law, &end)?;
        return Ok(Between { end, stress: path.f * s });
    }
    let end = law.at(h[1])?;
    let middle = law.at(&((*h[0] + *h[1]) * T::of(0.5)))?;
    Ok(Between { end, stress: law.stress(&middle) })
}

/// ∂P/∂F₁ : dF₁. It is not symmetric: F_m multiplies from the left, F₁ from the right.
#[inline(always)]
pub(crate) fn change_between<const D: usize, T: Real, L: Potential<D, T>>(
    law: &L,
    h: [&Mat<D, T>; 2],
    dh: &Mat<D, T>,
) -> Result<Mat<D, T>, NotPositive> {
    let half = T::of(0.5);
    if !L::OBJECTIVE {
        let point = law.at(&((*h[0] + *h[1]) * half))?;
        return law.change(&point, &(*dh * half));
    }
    let path = Path::new(law, h)?;
    let de = symmetric(&((Mat::identity() + *h[1]).transposed() * *dh));
    let [phi, dphi] = path.phi_and_change(law, &de)?;
    let s = path.middle.stress + path.change * phi;
    let ds = path.middle.change(law, &(de * half))? + path.change * dphi + de * phi;
    Ok(*dh * s * half + path.f * ds)
}

/// W at a strain. This, [`law_at`], [`smooth_at`] and [`AtStrain::change`] are compiled once for a
/// law, not wherever they are called.
#[inline(never)]
fn energy_at<const D: usize, T: Real, L: Potential<D, T>>(
    law: &L,
    strain: &Mat<D, T>,
) -> Result<T, NotPositive> {
    wide(
        #[inline(always)]
        || Ok(law.energy(&law.at(&root(strain)?)?)),
    )
}

/// The law at a strain.
#[inline(never)]
fn law_at<const D: usize, T: Real, L: Potential<D, T>>(
    law: &L,
    strain: &Mat<D, T>,
) -> Result<AtStrain<D, T, L::Point>, NotPositive> {
    wide(
        #[inline(always)]
        || {
            let excess = root(strain)?;
            Ok(AtStrain::of(law, law.at(&excess)?, &excess))
        },
    )
}

/// S* at a strain, of a law without flow in the step.
#[inline(never)]
fn smooth_at<const D: usize, T: Real, L: Potential<D, T>>(
    law: &L,
    strain: &Mat<D, T>,
) -> Result<AtStrain<D, T, L::Point>, NotPositive> {
    let at = law_at(law, strain)?;
    let unevolved = law.unevolved(&at.point).map(|point| at.replaced(law, point));
    Ok(unevolved.unwrap_or(at))
}

/// A law at a strain.
struct AtStrain<const D: usize, T, P> {
    /// The law at F̂.
    point: P,
    /// F̂⁻¹.
    inverse: Mat<D, T>,
    /// S.
    stress: Mat<D, T>,
}

impl<const D: usize, T: Real, P> AtStrain<D, T, P> {
    #[inline(always)]
    fn of<L: Potential<D, T, Point = P>>(law: &L, point: P, excess: &Mat<D, T>) -> Self {
        let inverse = (Mat::identity() + *excess).inverse();
        let stress = symmetric(&(inverse * law.stress(&point)));
        Self { point, inverse, stress }
    }

    /// S of another point at the same strain.
    #[inline(always)]
    fn replaced<L: Potential<D, T, Point = P>>(&self, law: &L, point: P) -> Self {
        let stress = symmetric(&(self.inverse * law.stress(&point)));
        Self { point, inverse: self.inverse, stress }
    }

    /// ∂S/∂E : dE.
    #[inline(never)]
    fn change<L: Potential<D, T, Point = P>>(
        &self,
        law: &L,
        de: &Mat<D, T>,
    ) -> Result<Mat<D, T>, NotPositive> {
        wide(
            #[inline(always)]
            || {
                let df = self.inverse.transposed() * *de;
                Ok(self.inverse * (law.change(&self.point, &df)? - df * self.stress))
            },
        )
    }
}

/// The straight path between two strains.
struct Path<const D: usize, T, P> {
    /// E₀ and E₁.
    ends: [Mat<D, T>; 2],
    /// The law at E_m.
    middle: AtStrain<D, T, P>,
    /// The smooth part of the potential, of a law that yields.
    unevolved: Option<AtStrain<D, T, P>>,
    /// F_m.
    f: Mat<D, T>,
    /// ΔE.
    change: Mat<D, T>,
    /// ΔE:ΔE where the correction φ ΔE is above the round-off of S(E_m), and 0 elsewhere. It is of
    /// the size ‖ΔE‖² W‴, S(E_m) of the size ‖E_m‖ W″.
    square: T,
}

impl<const D: usize, T: Real, P> Path<D, T, P> {
    #[inline(always)]
    fn new<L: Potential<D, T, Point = P>>(law: &L, h: [&Mat<D, T>; 2]) -> Result<Self, NotPositive> {
        for h in h {
            // Strains do not tell a reflection.
            let det_f = T::of(1.0) + excess_det(h);
            if let Some(det_f) = det_f.find(|det_f| det_f.is_nan() || det_f <= 0.0) {
                return Err(NotPositive(det_f));
            }
        }
        let half = T::of(0.5);
        let ends = h.map(strain);
        let middle_strain = (ends[0] + ends[1]) * half;
        let f = Mat::identity() + (*h[0] + *h[1]) * half;
        let change = symmetric(&(f.transposed() * (*h[1] - *h[0])));
        let square = change.double_dot(&change).zip(
            middle_strain.double_dot(&middle_strain),
            #[inline(always)]
            |square, middle| if square > f64::EPSILON * middle { square } else { 0.0 },
        );
        let middle = law_at(law, &middle_strain)?;
        let unevolved = law.unevolved(&middle.point).map(|point| middle.replaced(law, point));
        Ok(Self { ends, middle, unevolved, f, change, square })
    }

    /// The smooth part at E_m.
    #[inline(always)]
    fn smooth(&self) -> &AtStrain<D, T, P> {
        self.unevolved.as_ref().unwrap_or(&self.middle)
    }

    /// The smooth part at E₊ and E₋.
    #[inline(always)]
    fn outer<L: Potential<D, T, Point = P>>(&self, law: &L) -> Result<[AtStrain<D, T, P>; 2], NotPositive> {
        let middle = (self.ends[0] + self.ends[1]) * T::of(0.5);
        let offset = self.change * T::of(OUTER);
        Ok([smooth_at(law, &(middle + offset))?, smooth_at(law, &(middle - offset))?])
    }

    /// S*(E₊) + S*(E₋) − 2 S*(E_m), times the weight.
    #[inline(always)]
    fn curvature(&self, outer: &[AtStrain<D, T, P>; 2]) -> Mat<D, T> {
        let smooth = self.smooth().stress;
        let above = outer[0].stress - smooth;
        let below = outer[1].stress - smooth;
        (above + below) * T::of(WEIGHT)
    }

    /// Whether there are points without a correction alone.
    #[inline(always)]
    fn is_plain(&self) -> bool {
        self.square.find(|square| square > 0.0).is_none()
    }

    /// The way in which the work is computed at a point: by the difference of the energies in long
    /// steps, and where flow begins of which ψ is not known; by Gauss points elsewhere.
    #[inline(always)]
    fn ways<L: Potential<D, T, Point = P>>(&self, law: &L, end: Option<&P>) -> Ways<T> {
        let flows = |point: &P| law.released(point).find(|released| released > 0.0).is_some();
        let is_unknown =
            L::YIELDS && self.unevolved.is_none() && (flows(&self.middle.point) || end.is_some_and(flows));
        let is_long = |square: f64| square > GAUSS || is_unknown;
        Ways {
            long: self.square.map(
                #[inline(always)]
                |square| f64::from(is_long(square)),
            ),
            has_long: self.square.find(is_long).is_some(),
            has_short: self.square.find(|square| !is_long(square)).is_some(),
        }
    }

    /// −(ψ₁ − ψ₀) − [S(E_m) − S*(E_m)]:ΔE.
    #[inline(always)]
    fn released<L: Potential<D, T, Point = P>>(&self, law: &L, end: &P) -> Result<T, NotPositive> {
        let Some(unevolved) = &self.unevolved else { return Ok(T::ZERO) };
        let start = law.released(&law_at(law, &self.ends[0])?.point);
        let flown = self.middle.stress - unevolved.stress;
        Ok(start - law.released(end) - flown.double_dot(&self.change))
    }

    /// The derivative of [`Self::released`] along dE.
    #[inline(always)]
    fn released_change<L: Potential<D, T, Point = P>>(
        &self,
        law: &L,
        end: &AtStrain<D, T, P>,
        de: &Mat<D, T>,
    ) -> Result<T, NotPositive> {
        let Some(unevolved) = &self.unevolved else { return Ok(T::ZERO) };
        let Some(end_unevolved) = law.unevolved(&end.point) else { return Ok(T::ZERO) };
        let half = *de * T::of(0.5);
        let end_flown = end.stress - end.replaced(law, end_unevolved).stress;
        let flown = end_flown - (self.middle.stress - unevolved.stress);
        let change = self.middle.change(law, &half)? - unevolved.change(law, &half)?;
        Ok(flown.double_dot(de) - change.double_dot(&self.change))
    }

    /// W₁ − W₀ − S(E_m):ΔE as the difference of the energies.
    #[inline(always)]
    fn difference<L: Potential<D, T, Point = P>>(&self, law: &L, end: &P) -> Result<T, NotPositive> {
        let by_middle = self.middle.stress.double_dot(&self.change);
        Ok(law.energy(end) - energy_at(law, &self.ends[0])? - by_middle)
    }

    /// x/(ΔE:ΔE) where there is a correction, and 0 elsewhere.
    #[inline(always)]
    fn over_square(&self, x: T) -> T {
        (x / self.square).zip(
            self.square,
            #[inline(always)]
            |quotient, square| if square > 0.0 { quotient } else { 0.0 },
        )
    }

    /// φ.
    #[inline(always)]
    fn phi<L: Potential<D, T, Point = P>>(&self, law: &L, end: &P) -> Result<T, NotPositive> {
        if self.is_plain() {
            return Ok(T::ZERO);
        }
        let ways = self.ways(law, Some(end));
        let long = if ways.has_long { self.difference(law, end)? } else { T::ZERO };
        let short = if ways.has_short {
            self.curvature(&self.outer(law)?).double_dot(&self.change) + self.released(law, end)?
        } else {
            T::ZERO
        };
        Ok(self.over_square(ways.choose(long, short)))
    }

    /// φ and its derivative in the direction of a change dE of E₁.
    #[inline(always)]
    fn phi_and_change<L: Potential<D, T, Point = P>>(
        &self,
        law: &L,
        de: &Mat<D, T>,
    ) -> Result<[T; 2], NotPositive> {
        if self.is_plain() {
            return Ok([T::ZERO, T::ZERO]);
        }
        let half = *de * T::of(0.5);
        let needs_end = L::YIELDS || self.ways(law, None).has_long;
        let end = if needs_end { Some(law_at(law, &self.ends[1])?) } else { None };
        let ways = self.ways(law, end.as_ref().map(|end| &end.point));
        let long = match &end {
            Some(end) if ways.has_long => {
                let by_stress = (end.stress - self.middle.stress).double_dot(de);
                let middle_change = self.middle.change(law, &half)?;
                [self.difference(law, &end.point)?, by_stress - middle_change.double_dot(&self.change)]
            }
            _ => [T::ZERO, T::ZERO],
        };
        let short = if ways.has_short {
            let outer = self.outer(law)?;
            let curvature = self.curvature(&outer);
            let middle = self.smooth().change(law, &half)?;
            let above = outer[0].change(law, &(*de * T::of(0.5 + OUTER)))? - middle;
            let below = outer[1].change(law, &(*de * T::of(0.5 - OUTER)))? - middle;
            let curvature_change = (above + below) * T::of(WEIGHT);
            let mut work = curvature.double_dot(&self.change);
            let mut change = curvature_change.double_dot(&self.change) + curvature.double_dot(de);
            if let Some(end) = &end {
                work = work + self.released(law, &end.point)?;
                change = change + self.released_change(law, end, de)?;
            }
            [work, change]
        } else {
            [T::ZERO, T::ZERO]
        };
        let phi = self.over_square(ways.choose(long[0], short[0]));
        let excess_change = ways.choose(long[1], short[1]);
        let change = excess_change - T::of(2.0) * phi * self.change.double_dot(de);
        Ok([phi, self.over_square(change)])
    }
}

/// Which points have long steps.
struct Ways<T> {
    /// 1 in long steps, and 0 in short ones.
    long: T,
    has_long: bool,
    has_short: bool,
}

impl<T: Real> Ways<T> {
    /// The first number in long steps, the second one in short ones.
    #[inline(always)]
    fn choose(&self, long: T, short: T) -> T {
        let long = self.long.zip(
            long,
            #[inline(always)]
            |is_long, x| if is_long > 0.0 { x } else { 0.0 },
        );
        let short = self.long.zip(
            short,
            #[inline(always)]
            |is_long, x| if is_long > 0.0 { 0.0 } else { x },
        );
        long + short
    }
}

#[inline(always)]
fn symmetric<const D: usize, T: Real>(a: &Mat<D, T>) -> Mat<D, T> {
    (*a + a.transposed()) * T::of(0.5)
}

/// E = (H + Hᵀ + HᵀH)/2.
#[inline(always)]
fn strain<const D: usize, T: Real>(h: &Mat<D, T>) -> Mat<D, T> {
    (*h + h.transposed() + h.transposed() * *h) * T::of(0.5)
}

/// F̂ − I with F̂ upper triangular and F̂ᵀF̂ = I + 2E (Cholesky); √(1 + x) − 1 = x/(1 + √(1 + x))
/// avoids cancellation for small E.
#[inline(always)]
pub fn root<const D: usize, T: Real>(e: &Mat<D, T>) -> Result<Mat<D, T>, NotPositive> {
    let mut h = Mat::ZERO;
    for i in 0..D {
        for j in i..D {
            let mut known = T::ZERO;
            for k in 0..i {
                known = known + h.0[k][i] * h.0[k][j];
            }
            let remainder = T::of(2.0) * e.0[i][j] - known;
            if i == j {
                let diagonal = (T::of(1.0) + remainder).map(f64::sqrt);
                if diagonal.find(|diagonal| diagonal.is_nan() || diagonal <= 0.0).is_some() {
                    return Err(NotPositive(0.0));
                }
                h.0[i][i] = remainder / (T::of(1.0) + diagonal);
            } else {
                h.0[i][j] = remainder / (T::of(1.0) + h.0[i][i]);
            }
        }
    }
    Ok(h)
}
