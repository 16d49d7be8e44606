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
//!
//! Laws are called behind a pointer, for four points at once: this code is compiled once for a
//! dimension, not for every law.

use carom_algebra::{Four, Mat, Real, wide};

use crate::material::{AtFour, NotPositive, excess_det};
use crate::points::{Mats, four, lanes};
use crate::potential::Potential;

/// Largest ΔE:ΔE with which three Gauss points give W₁ − W₀ to round-off: their error is
/// W⁽⁷⁾ ‖ΔE‖⁷/2 016 000 (M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 25.4.30),
/// 2e-23 W″ at this bound for the logarithm of the neo-Hookean law.
const GAUSS: f64 = 1e-6;

/// Distance of the outer Gauss points from the middle, in ΔE: √(3/5)/2.
const OUTER: f64 = 0.387_298_334_620_741_7;

/// Weight of an outer Gauss point.
const WEIGHT: f64 = 5.0 / 18.0;

/// The law at the end, with P in place of its stress; overwrites the memory with that at the end,
/// unless it is empty.
#[inline(never)]
pub(crate) fn between<const D: usize>(
    law: &Potential<D>,
    h: [&Mats<D>; 2],
    memory: &mut [f64],
) -> Result<AtFour<D>, NotPositive> {
    wide(
        #[inline(always)]
        || {
            let h = h.map(four);
            if !law.law.traits().objective {
                let end = law.at(&h[1], memory)?;
                let middle = law.at(&((h[0] + h[1]) * Four::of(0.5)), &mut [])?;
                return Ok(AtFour { stress: middle.stress, ..end });
            }
            let path = Path::new(law, &h)?;
            let end = law.at(&root(&path.ends[1])?, memory)?;
            let s = path.middle.stress + path.change * path.phi(&end)?;
            Ok(AtFour { stress: path.f * s, ..end })
        },
    )
}

/// ∂P/∂F₁ : dF₁. It is not symmetric: F_m multiplies from the left, F₁ from the right.
#[inline(never)]
pub(crate) fn change_between<const D: usize>(
    law: &Potential<D>,
    h: [&Mats<D>; 2],
    dh: &Mats<D>,
) -> Result<Mats<D>, NotPositive> {
    wide(
        #[inline(always)]
        || {
            let half = Four::of(0.5);
            let h = h.map(four);
            let dh = four(dh);
            if !law.law.traits().objective {
                return Ok(lanes(&law.change(&((h[0] + h[1]) * half), &(dh * half))?));
            }
            let path = Path::new(law, &h)?;
            let de = symmetric(&((Mat::identity() + h[1]).transposed() * dh));
            let [phi, dphi] = path.phi_and_change(&de)?;
            let s = path.middle.stress + path.change * phi;
            let ds = path.middle.change(law, &(de * half))? + path.change * dphi + de * phi;
            Ok(lanes(&(dh * s * half + path.f * ds)))
        },
    )
}

/// A law at a strain.
struct AtStrain<const D: usize> {
    /// F̂ − I.
    h: Mat<D, Four>,
    /// F̂⁻¹.
    inverse: Mat<D, Four>,
    /// W.
    energy: Four,
    /// S.
    stress: Mat<D, Four>,
    /// ψ.
    released: Four,
}

impl<const D: usize> AtStrain<D> {
    #[inline(always)]
    fn new(law: &Potential<D>, strain: &Mat<D, Four>) -> Result<Self, NotPositive> {
        let h = root(strain)?;
        let AtFour { stored, stress, dissipated, released } = law.at(&h, &mut [])?;
        let inverse = (Mat::identity() + h).inverse();
        let stress = symmetric(&(inverse * stress));
        Ok(Self { h, inverse, energy: stored + dissipated, stress, released })
    }

    /// Whether there is flow at a point.
    #[inline(always)]
    fn flows(&self) -> bool {
        self.released.find(|released| released != 0.0).is_some()
    }

    /// ∂S/∂E : dE, of the law of this point.
    #[inline(always)]
    fn change(&self, law: &Potential<D>, de: &Mat<D, Four>) -> Result<Mat<D, Four>, NotPositive> {
        let df = self.inverse.transposed() * *de;
        Ok(self.inverse * (law.change(&self.h, &df)? - df * self.stress))
    }
}

/// The straight path between two strains.
struct Path<'a, const D: usize> {
    law: &'a Potential<'a, D>,
    /// E₀ and E₁.
    ends: [Mat<D, Four>; 2],
    /// The law at E_m.
    middle: AtStrain<D>,
    /// The smooth part at E_m, where it differs at a point.
    unevolved: Option<AtStrain<D>>,
    /// F_m.
    f: Mat<D, Four>,
    /// ΔE.
    change: Mat<D, Four>,
    /// ΔE:ΔE where the correction φ ΔE is above the round-off of S(E_m), and 0 elsewhere. It is of
    /// the size ‖ΔE‖² W‴, S(E_m) of the size ‖E_m‖ W″.
    square: Four,
}

impl<'a, const D: usize> Path<'a, D> {
    #[inline(always)]
    fn new(law: &'a Potential<D>, h: &[Mat<D, Four>; 2]) -> Result<Self, NotPositive> {
        for h in h {
            // Strains do not tell a reflection.
            let det_f = Four::of(1.0) + excess_det(h);
            if let Some(det_f) = det_f.find(|det_f| det_f.is_nan() || det_f <= 0.0) {
                return Err(NotPositive(det_f));
            }
        }
        let half = Four::of(0.5);
        let ends = [strain(&h[0]), strain(&h[1])];
        let middle_strain = (ends[0] + ends[1]) * half;
        let f = Mat::identity() + (h[0] + h[1]) * half;
        let change = symmetric(&(f.transposed() * (h[1] - h[0])));
        let square = change.double_dot(&change).zip(
            middle_strain.double_dot(&middle_strain),
            #[inline(always)]
            |square, middle| if square > f64::EPSILON * middle { square } else { 0.0 },
        );
        let middle = AtStrain::new(law, &middle_strain)?;
        let unevolved = if law.law.traits().splits && middle.flows() {
            Some(AtStrain::new(&law.smooth(), &middle_strain)?)
        } else {
            None
        };
        Ok(Self { law, ends, middle, unevolved, f, change, square })
    }

    /// The smooth part at E_m.
    #[inline(always)]
    fn smooth(&self) -> &AtStrain<D> {
        self.unevolved.as_ref().unwrap_or(&self.middle)
    }

    /// The smooth part at E₊ and E₋.
    #[inline(always)]
    fn outer(&self) -> Result<[AtStrain<D>; 2], NotPositive> {
        let law = self.law.smooth();
        let middle = (self.ends[0] + self.ends[1]) * Four::of(0.5);
        let offset = self.change * Four::of(OUTER);
        Ok([AtStrain::new(&law, &(middle + offset))?, AtStrain::new(&law, &(middle - offset))?])
    }

    /// S*(E₊) + S*(E₋) − 2 S*(E_m), times the weight.
    #[inline(always)]
    fn curvature(&self, outer: &[AtStrain<D>; 2]) -> Mat<D, Four> {
        let smooth = self.smooth().stress;
        let above = outer[0].stress - smooth;
        let below = outer[1].stress - smooth;
        (above + below) * Four::of(WEIGHT)
    }

    /// Whether there are points without a correction alone.
    #[inline(always)]
    fn is_plain(&self) -> bool {
        self.square.find(|square| square > 0.0).is_none()
    }

    /// The way in which the work is computed at a point: by the difference of the energies in long
    /// steps, and where flow begins of which ψ is not known; by Gauss points elsewhere.
    #[inline(always)]
    fn ways(&self, end_released: Four) -> Ways {
        let traits = self.law.law.traits();
        let is_unknown = if traits.yields && !traits.splits {
            (self.middle.released + end_released).map(|released| f64::from(released > 0.0))
        } else {
            Four::ZERO
        };
        let long = self.square.zip(
            is_unknown,
            #[inline(always)]
            |square, is_unknown| f64::from(square > GAUSS || is_unknown > 0.0),
        );
        Ways {
            long,
            has_long: long.find(|is_long| is_long > 0.0).is_some(),
            has_short: long.find(|is_long| is_long == 0.0).is_some(),
        }
    }

    /// −(ψ₁ − ψ₀) − [S(E_m) − S*(E_m)]:ΔE.
    #[inline(always)]
    fn released(&self, end_released: Four) -> Result<Four, NotPositive> {
        if !self.law.law.traits().splits {
            return Ok(Four::ZERO);
        }
        let start = self.law.at(&root(&self.ends[0])?, &mut [])?.released;
        let flown = self.middle.stress - self.smooth().stress;
        Ok(start - end_released - flown.double_dot(&self.change))
    }

    /// The derivative of [`Self::released`] along dE.
    #[inline(always)]
    fn released_change(&self, end: &AtStrain<D>, de: &Mat<D, Four>) -> Result<Four, NotPositive> {
        let flows = end.flows() || self.unevolved.is_some();
        if !flows || !self.law.law.traits().splits {
            return Ok(Four::ZERO);
        }
        let smooth = self.law.smooth();
        let half = *de * Four::of(0.5);
        let end_flown = end.stress - AtStrain::new(&smooth, &self.ends[1])?.stress;
        let flown = end_flown - (self.middle.stress - self.smooth().stress);
        let change = self.middle.change(self.law, &half)? - self.smooth().change(&smooth, &half)?;
        Ok(flown.double_dot(de) - change.double_dot(&self.change))
    }

    /// W₁ − W₀ − S(E_m):ΔE as the difference of the energies.
    #[inline(always)]
    fn difference(&self, end: Four) -> Result<Four, NotPositive> {
        let start = self.law.at(&root(&self.ends[0])?, &mut [])?;
        let by_middle = self.middle.stress.double_dot(&self.change);
        Ok(end - (start.stored + start.dissipated) - by_middle)
    }

    /// x/(ΔE:ΔE) where there is a correction, and 0 elsewhere.
    #[inline(always)]
    fn over_square(&self, x: Four) -> Four {
        (x / self.square).zip(
            self.square,
            #[inline(always)]
            |quotient, square| if square > 0.0 { quotient } else { 0.0 },
        )
    }

    /// φ.
    #[inline(always)]
    fn phi(&self, end: &AtFour<D>) -> Result<Four, NotPositive> {
        if self.is_plain() {
            return Ok(Four::ZERO);
        }
        let ways = self.ways(end.released);
        let long = if ways.has_long { self.difference(end.stored + end.dissipated)? } else { Four::ZERO };
        let short = if ways.has_short {
            self.curvature(&self.outer()?).double_dot(&self.change) + self.released(end.released)?
        } else {
            Four::ZERO
        };
        Ok(self.over_square(ways.choose(long, short)))
    }

    /// φ and its derivative in the direction of a change dE of E₁.
    #[inline(always)]
    fn phi_and_change(&self, de: &Mat<D, Four>) -> Result<[Four; 2], NotPositive> {
        if self.is_plain() {
            return Ok([Four::ZERO, Four::ZERO]);
        }
        let half = *de * Four::of(0.5);
        let needs_end = self.law.law.traits().yields || self.ways(Four::ZERO).has_long;
        let end = if needs_end { Some(AtStrain::new(self.law, &self.ends[1])?) } else { None };
        let ways = self.ways(end.as_ref().map_or(Four::ZERO, |end| end.released));
        let long = match &end {
            Some(end) if ways.has_long => {
                let by_stress = (end.stress - self.middle.stress).double_dot(de);
                let middle_change = self.middle.change(self.law, &half)?;
                [self.difference(end.energy)?, by_stress - middle_change.double_dot(&self.change)]
            }
            _ => [Four::ZERO, Four::ZERO],
        };
        let short = if ways.has_short {
            let law = self.law.smooth();
            let outer = self.outer()?;
            let curvature = self.curvature(&outer);
            let middle = self.smooth().change(&law, &half)?;
            let above = outer[0].change(&law, &(*de * Four::of(0.5 + OUTER)))? - middle;
            let below = outer[1].change(&law, &(*de * Four::of(0.5 - OUTER)))? - middle;
            let curvature_change = (above + below) * Four::of(WEIGHT);
            let mut work = curvature.double_dot(&self.change);
            let mut change = curvature_change.double_dot(&self.change) + curvature.double_dot(de);
            if let Some(end) = &end {
                work = work + self.released(end.released)?;
                change = change + self.released_change(end, de)?;
            }
            [work, change]
        } else {
            [Four::ZERO, Four::ZERO]
        };
        let phi = self.over_square(ways.choose(long[0], short[0]));
        let excess_change = ways.choose(long[1], short[1]);
        let change = excess_change - Four::of(2.0) * phi * self.change.double_dot(de);
        Ok([phi, self.over_square(change)])
    }
}

/// Which points have long steps.
struct Ways {
    /// 1 in long steps, and 0 in short ones.
    long: Four,
    has_long: bool,
    has_short: bool,
}

impl Ways {
    /// The first number in long steps, the second one in short ones.
    #[inline(always)]
    fn choose(&self, long: Four, short: Four) -> Four {
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
fn symmetric<const D: usize>(a: &Mat<D, Four>) -> Mat<D, Four> {
    (*a + a.transposed()) * Four::of(0.5)
}

/// E = (H + Hᵀ + HᵀH)/2.
#[inline(always)]
fn strain<const D: usize>(h: &Mat<D, Four>) -> Mat<D, Four> {
    (*h + h.transposed() + h.transposed() * *h) * Four::of(0.5)
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
