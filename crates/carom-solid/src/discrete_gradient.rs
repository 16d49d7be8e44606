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
//! releases, ψ, is known in closed form, and so is its stress S_ψ = ∂ψ/∂E = S* − S. At E₀ nothing
//! has flowed in the step, ψ₀ = 0:
//!
//! ```text
//! W₁ − W₀ − S(E_m):ΔE = 5/18 [S*(E₊) + S*(E₋) − 2 S*(E_m)]:ΔE − ψ₁ + S_ψ(E_m):ΔE
//! ```
//!
//! In plane stress, where the thickness without flow is another one, the work of a step with flow
//! is the difference of the energies.
//!
//! Laws are called behind a pointer, for four points at once: this code is compiled once for a
//! dimension, not for every law.

use carom_algebra::{Four, Mat, Real, wide};

use crate::material::{Along, AtFour, NotPositive, excess_det};
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
            let path = Path::new(&h)?;
            let middle = AtStrain::new(law, &path.middle, None)?;
            let end = law.at(&root(&path.ends[1])?, memory)?;
            let s = middle.stress + path.change * path.phi(law, &middle, &end)?;
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
                let middle = (h[0] + h[1]) * half;
                return Ok(lanes(&law.along(&middle, Some(&(dh * half)))?.change));
            }
            let path = Path::new(&h)?;
            let de = symmetric(&((Mat::identity() + h[1]).transposed() * dh));
            let middle = AtStrain::new(law, &path.middle, Some(&(de * half)))?;
            let [phi, dphi] = path.phi_and_change(law, &middle, &de)?;
            let s = middle.stress + path.change * phi;
            let ds = middle.change + path.change * dphi + de * phi;
            Ok(lanes(&(dh * s * half + path.f * ds)))
        },
    )
}

/// A law at a strain, and its change with dE, zero without one.
struct AtStrain<const D: usize> {
    /// W.
    energy: Four,
    /// S.
    stress: Mat<D, Four>,
    /// dS.
    change: Mat<D, Four>,
    /// ψ.
    released: Four,
    /// S_ψ.
    released_stress: Mat<D, Four>,
    /// dS_ψ.
    released_change: Mat<D, Four>,
}

impl<const D: usize> AtStrain<D> {
    #[inline(always)]
    fn new(
        law: &Potential<D>,
        strain: &Mat<D, Four>,
        de: Option<&Mat<D, Four>>,
    ) -> Result<Self, NotPositive> {
        let h = root(strain)?;
        let inverse = (Mat::identity() + h).inverse();
        let df = de.map(|de| inverse.transposed() * *de);
        let Along { at, change, released_stress, released_change } = law.along(&h, df.as_ref())?;
        let stress = symmetric(&(inverse * at.stress));
        let released_stress = symmetric(&(inverse * released_stress));
        let turned = |change: Mat<D, Four>, stress: &Mat<D, Four>| match &df {
            Some(df) => inverse * (change - *df * *stress),
            None => Mat::ZERO,
        };
        Ok(Self {
            energy: at.stored + at.dissipated,
            stress,
            change: turned(change, &stress),
            released: at.released,
            released_stress,
            released_change: turned(released_change, &released_stress),
        })
    }

    /// S*.
    #[inline(always)]
    fn smooth(&self) -> Mat<D, Four> {
        self.stress + self.released_stress
    }

    /// dS*.
    #[inline(always)]
    fn smooth_change(&self) -> Mat<D, Four> {
        self.change + self.released_change
    }
}

/// The straight path between two strains.
struct Path<const D: usize> {
    /// E₀ and E₁.
    ends: [Mat<D, Four>; 2],
    /// E_m.
    middle: Mat<D, Four>,
    /// F_m.
    f: Mat<D, Four>,
    /// ΔE.
    change: Mat<D, Four>,
    /// ΔE:ΔE where the correction φ ΔE is above the round-off of S(E_m), and 0 elsewhere. It is of
    /// the size ‖ΔE‖² W‴, S(E_m) of the size ‖E_m‖ W″.
    square: Four,
}

impl<const D: usize> Path<D> {
    #[inline(always)]
    fn new(h: &[Mat<D, Four>; 2]) -> Result<Self, NotPositive> {
        for h in h {
            // Strains do not tell a reflection.
            let det_f = Four::of(1.0) + excess_det(h);
            if let Some(det_f) = det_f.find(|det_f| det_f.is_nan() || det_f <= 0.0) {
                return Err(NotPositive(det_f));
            }
        }
        let half = Four::of(0.5);
        let ends = [strain(&h[0]), strain(&h[1])];
        let middle = (ends[0] + ends[1]) * half;
        let f = Mat::identity() + (h[0] + h[1]) * half;
        let change = symmetric(&(f.transposed() * (h[1] - h[0])));
        let square = change.double_dot(&change).zip(
            middle.double_dot(&middle),
            #[inline(always)]
            |square, middle| if square > f64::EPSILON * middle { square } else { 0.0 },
        );
        Ok(Self { ends, middle, f, change, square })
    }

    /// The law at E₊ and E₋, and its change with dE₁ = dE.
    #[inline(always)]
    fn outer(&self, law: &Potential<D>, de: Option<&Mat<D, Four>>) -> Result<[AtStrain<D>; 2], NotPositive> {
        let offset = self.change * Four::of(OUTER);
        let by_end = |share: f64| de.map(|de| *de * Four::of(share));
        Ok([
            AtStrain::new(law, &(self.middle + offset), by_end(0.5 + OUTER).as_ref())?,
            AtStrain::new(law, &(self.middle - offset), by_end(0.5 - OUTER).as_ref())?,
        ])
    }

    /// Whether there are points without a correction alone.
    #[inline(always)]
    fn is_plain(&self) -> bool {
        self.square.find(|square| square > 0.0).is_none()
    }

    /// The way in which the work is computed at a point: by the difference of the energies in long
    /// steps, and where flow begins of which S_ψ is not known; by Gauss points elsewhere.
    #[inline(always)]
    fn ways(&self, law: &Potential<D>, released: Four) -> Ways {
        let traits = law.law.traits();
        let is_unknown = if traits.yields && !traits.splits {
            released.map(|released| f64::from(released > 0.0))
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

    /// W₁ − W₀ − S(E_m):ΔE as the difference of the energies, where it is W₁ at the end.
    #[inline(always)]
    fn difference(&self, law: &Potential<D>, middle: &AtStrain<D>, end: Four) -> Result<Four, NotPositive> {
        let start = law.at(&root(&self.ends[0])?, &mut [])?;
        Ok(end - (start.stored + start.dissipated) - middle.stress.double_dot(&self.change))
    }

    /// W₁ − W₀ − S(E_m):ΔE by Gauss points, with ψ₁.
    #[inline(always)]
    fn integral(&self, middle: &AtStrain<D>, outer: &[AtStrain<D>; 2], released: Four) -> Four {
        let work = curvature(&middle.smooth(), &outer.each_ref().map(AtStrain::smooth));
        (work + middle.released_stress).double_dot(&self.change) - released
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
    fn phi(&self, law: &Potential<D>, middle: &AtStrain<D>, end: &AtFour<D>) -> Result<Four, NotPositive> {
        if self.is_plain() {
            return Ok(Four::ZERO);
        }
        let ways = self.ways(law, middle.released + end.released);
        let mut long = Four::ZERO;
        if ways.has_long {
            long = self.difference(law, middle, end.stored + end.dissipated)?;
        }
        let mut short = Four::ZERO;
        if ways.has_short {
            short = self.integral(middle, &self.outer(law, None)?, end.released);
        }
        Ok(self.over_square(ways.choose(long, short)))
    }

    /// φ and its derivative in the direction of a change dE of E₁.
    #[inline(always)]
    fn phi_and_change(
        &self,
        law: &Potential<D>,
        middle: &AtStrain<D>,
        de: &Mat<D, Four>,
    ) -> Result<[Four; 2], NotPositive> {
        if self.is_plain() {
            return Ok([Four::ZERO, Four::ZERO]);
        }
        let needs_end = law.law.traits().yields || self.ways(law, Four::ZERO).has_long;
        let end = if needs_end { Some(AtStrain::new(law, &self.ends[1], None)?) } else { None };
        let released = end.as_ref().map_or(Four::ZERO, |end| end.released);
        let ways = self.ways(law, middle.released + released);
        let mut long = [Four::ZERO, Four::ZERO];
        if let Some(end) = &end
            && ways.has_long
        {
            let by_stress = (end.stress - middle.stress).double_dot(de);
            long[0] = self.difference(law, middle, end.energy)?;
            long[1] = by_stress - middle.change.double_dot(&self.change);
        }
        let mut short = [Four::ZERO, Four::ZERO];
        if ways.has_short {
            let outer = self.outer(law, Some(de))?;
            let changes = outer.each_ref().map(AtStrain::smooth_change);
            let by_work = curvature(&middle.smooth(), &outer.each_ref().map(AtStrain::smooth));
            let change = curvature(&middle.smooth_change(), &changes) + middle.released_change;
            let end_stress = end.as_ref().map_or(Mat::ZERO, |end| end.released_stress);
            short[0] = self.integral(middle, &outer, released);
            short[1] = change.double_dot(&self.change)
                + (by_work + middle.released_stress - end_stress).double_dot(de);
        }
        let phi = self.over_square(ways.choose(long[0], short[0]));
        let excess_change = ways.choose(long[1], short[1]);
        let change = excess_change - Four::of(2.0) * phi * self.change.double_dot(de);
        Ok([phi, self.over_square(change)])
    }
}

/// x(E₊) + x(E₋) − 2 x(E_m), times the weight.
#[inline(always)]
fn curvature<const D: usize>(middle: &Mat<D, Four>, outer: &[Mat<D, Four>; 2]) -> Mat<D, Four> {
    let above = outer[0] - *middle;
    let below = outer[1] - *middle;
    (above + below) * Four::of(WEIGHT)
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
