//! A law behind a pointer, evaluated at the points of a block at once.
//!
//! Cells of all shapes share the compiled code of a law: a call for four points costs little beside
//! what it computes, and compiling every law into the loops of every shape took two thirds of the
//! time for compiling this crate.

use carom_algebra::{Mat, Vector, wide};

use super::memory::Incremental;
use super::past::Past;
use super::{Material, NotPositive};
use crate::body::PointState;
use crate::discrete_gradient::{between, change_between};
use crate::points::{LANES, Lanes, Mats, four, get, lanes, set};
use crate::potential::{AtFour, Potential, Single};

/// ∂P/∂F at each of the points: `[J][L][i][j][point]` is ∂P_iJ/∂F_jL.
pub(crate) type ModuliMats<const D: usize> = [[Mats<D>; D]; D];

/// A step of points of a law with memory.
pub(crate) struct Evolution<'a, const D: usize> {
    /// H at the start of the step, for a discrete gradient.
    pub(crate) before: Option<Mats<D>>,
    pub(crate) h: Mats<D>,
    pub(crate) count: usize,
    /// Memory of the points, one after the other.
    pub(crate) past: Past<'a>,
    /// dF, where ∂P/∂F : dF is asked for in place of P.
    pub(crate) change: Option<Mats<D>>,
}

/// Results of a step of points of a law with memory.
pub(crate) struct Evolved<'a, const D: usize> {
    /// Ψ; not of an increment.
    pub(crate) stored: Lanes,
    /// [`Material::dissipated`]; not of an increment.
    pub(crate) dissipated: Lanes,
    /// P, its discrete gradient, or the increment of either.
    pub(crate) stress: Mats<D>,
    /// ∂P/∂F, if it is asked for.
    pub(crate) moduli: Option<&'a mut ModuliMats<D>>,
    /// Memory at the end of the step; not asked for if empty.
    pub(crate) memory: &'a mut [f64],
}

/// A [`Material`] at the first `count` of four points; H = 0 in the other lanes, whose results do
/// not count.
pub(crate) trait Pointwise<const D: usize>: Send + Sync {
    /// [`Material::ENERGY_DEGREE`].
    fn energy_degree(&self) -> usize;

    /// Ψ and P.
    fn stresses(&self, h: &Mats<D>, count: usize, stress: &mut Mats<D>) -> Result<Lanes, NotPositive>;

    /// Ψ, P and ∂P/∂F.
    fn tangents(
        &self,
        h: &Mats<D>,
        count: usize,
        stress: &mut Mats<D>,
        moduli: &mut ModuliMats<D>,
    ) -> Result<Lanes, NotPositive>;

    /// ∂P/∂F : dF.
    fn increments(&self, h: &Mats<D>, dh: &Mats<D>, count: usize) -> Result<Mats<D>, NotPositive>;

    /// Ψ at the end, and the discrete gradient between two configurations.
    fn between(&self, h: [&Mats<D>; 2], count: usize, stress: &mut Mats<D>) -> Result<Lanes, NotPositive>;

    /// Its derivative along an increment of the second.
    fn increments_between(
        &self,
        h: [&Mats<D>; 2],
        dh: &Mats<D>,
        count: usize,
    ) -> Result<Mats<D>, NotPositive>;

    /// [`Material::MEMORY`].
    fn memory(&self) -> usize;

    /// [`Material::plastic_strain`].
    fn plastic_strain_of(&self, memory: &[f64]) -> f64;

    /// A step of a law with memory.
    fn evolve(&self, step: &Evolution<D>, out: &mut Evolved<D>) -> Result<(), NotPositive>;

    /// Kinematics and stress.
    fn state_at(&self, h: &Mat<D>, past: &Past) -> Result<PointState, NotPositive>;

    /// [`Material::volume_ratio`].
    fn volume_ratio_at(&self, h: &Mat<D>, past: &Past) -> f64;

    /// [`Material::volume_ratio`] of a law without memory.
    fn volume_ratios(&self, h: &Mats<D>) -> Lanes;

    /// ∂Pᵢᴶ/∂Xᴶ = Σ ∂Pᵢᴶ/∂Fₖᴸ ∂²yₖ/∂Xᴶ∂Xᴸ from ∂²y/∂X∂X as `[k][J][L]`.
    fn divergence(&self, h: &Mat<D>, second: &[f64]) -> Result<Vector<D>, NotPositive>;
}

const fn none<const D: usize>() -> Mats<D> {
    [[[0.0; LANES]; D]; D]
}

impl<const D: usize, L: Material<D>> Pointwise<D> for L {
    fn energy_degree(&self) -> usize {
        L::ENERGY_DEGREE
    }

    fn stresses(&self, h: &Mats<D>, count: usize, stress: &mut Mats<D>) -> Result<Lanes, NotPositive> {
        wide(
            #[inline(always)]
            || {
                let (energies, stresses) = self.at_points(h, count)?;
                *stress = stresses;
                Ok(energies)
            },
        )
    }

    fn tangents(
        &self,
        h: &Mats<D>,
        count: usize,
        stress: &mut Mats<D>,
        moduli: &mut ModuliMats<D>,
    ) -> Result<Lanes, NotPositive> {
        wide(
            #[inline(always)]
            || {
                let mut energies = [0.0; LANES];
                let unit = Mat::<D>::identity().0.map(Vector);
                for l in 0..count {
                    let point = self.at(&get(h, l))?;
                    energies[l] = self.energy(&point);
                    set(stress, l, &self.stress(&point));
                    for (row, a) in moduli.iter_mut().zip(&unit) {
                        for (block, b) in row.iter_mut().zip(&unit) {
                            set(block, l, &self.tangent(&point, a, b));
                        }
                    }
                }
                Ok(energies)
            },
        )
    }

    fn increments(&self, h: &Mats<D>, dh: &Mats<D>, count: usize) -> Result<Mats<D>, NotPositive> {
        wide(
            #[inline(always)]
            || self.changes(h, dh, count),
        )
    }

    fn between(&self, h: [&Mats<D>; 2], count: usize, stress: &mut Mats<D>) -> Result<Lanes, NotPositive> {
        wide(
            #[inline(always)]
            || {
                if const { L::FOUR } {
                    let law = AtFour(self);
                    let found = between(&law, h.map(four).each_ref())?;
                    *stress = lanes(&found.stress);
                    return Ok(law.energy(&found.end).0);
                }
                let mut energies = [0.0; LANES];
                for l in 0..count {
                    let found = between(&Single(self), h.map(|h| get(h, l)).each_ref())?;
                    energies[l] = self.energy(&found.end);
                    set(stress, l, &found.stress);
                }
                Ok(energies)
            },
        )
    }

    fn increments_between(
        &self,
        h: [&Mats<D>; 2],
        dh: &Mats<D>,
        count: usize,
    ) -> Result<Mats<D>, NotPositive> {
        wide(
            #[inline(always)]
            || {
                if const { L::FOUR } {
                    return Ok(lanes(&change_between(&AtFour(self), h.map(four).each_ref(), &four(dh))?));
                }
                let mut changes = none();
                for l in 0..count {
                    let ends = h.map(|h| get(h, l));
                    set(&mut changes, l, &change_between(&Single(self), ends.each_ref(), &get(dh, l))?);
                }
                Ok(changes)
            },
        )
    }

    fn memory(&self) -> usize {
        L::MEMORY
    }

    fn plastic_strain_of(&self, memory: &[f64]) -> f64 {
        self.plastic_strain(memory)
    }

    fn evolve(&self, step: &Evolution<D>, out: &mut Evolved<D>) -> Result<(), NotPositive> {
        // A law without memory does not evolve: the body asks for its stresses instead.
        if const { L::MEMORY == 0 } {
            return Ok(());
        }
        wide(
            #[inline(always)]
            || {
                if evolve_at_once(self, step, out)? {
                    return Ok(());
                }
                for l in 0..step.count {
                    let law = Incremental { law: self, past: step.past.part(l, L::MEMORY) };
                    evolve_point(&law, step, l, out)?;
                }
                Ok(())
            },
        )
    }

    fn state_at(&self, h: &Mat<D>, past: &Past) -> Result<PointState, NotPositive> {
        // Without a memory it is the start of a run.
        let point = if past.memory.is_empty() { self.at(h)? } else { self.after(h, past)? };
        let across = self.lateral_excess(&point);
        let strain = (*h + h.transposed() + h.transposed() * *h) * 0.5;
        let plastic_strain = self.plastic_strain(past.memory);
        Ok(PointState {
            det_f: self.volume_ratio(h, past),
            cauchy: in_space(&self.cauchy(&point, h), self.lateral(&point)),
            strain: in_space(&strain, across + 0.5 * across * across),
            plastic_strain,
            yielded: if plastic_strain > 0.0 { 1.0 } else { 0.0 },
        })
    }

    fn volume_ratio_at(&self, h: &Mat<D>, past: &Past) -> f64 {
        self.volume_ratio(h, past)
    }

    fn volume_ratios(&self, h: &Mats<D>) -> Lanes {
        wide(
            #[inline(always)]
            || std::array::from_fn(|l| self.volume_ratio(&get(h, l), &Past::default())),
        )
    }

    fn divergence(&self, h: &Mat<D>, second: &[f64]) -> Result<Vector<D>, NotPositive> {
        let point = self.at(h)?;
        let unit = Mat::<D>::identity().0.map(Vector);
        let mut sum = Vector::<D>::ZERO;
        for j in 0..D {
            for l in 0..D {
                let bent = Vector(std::array::from_fn(|k| second[(k * D + j) * D + l]));
                sum += self.tangent(&point, &unit[j], &unit[l]).apply(&bent);
            }
        }
        Ok(sum)
    }
}

/// Increments of forces at all points of a block, or the forces of a law that is written for four
/// points; not of a discrete gradient, nor with a tangent. Returns whether it was done.
#[inline(always)]
fn evolve_at_once<const D: usize, L: Material<D>>(
    law: &L,
    step: &Evolution<D>,
    out: &mut Evolved<D>,
) -> Result<bool, NotPositive> {
    if step.before.is_some() || out.moduli.is_some() {
        return Ok(false);
    }
    if let Some(change) = &step.change {
        out.stress = law.changes_after(&step.h, change, &step.past, step.count)?;
        return Ok(true);
    }
    let Some(four) = law.after_four(&four(&step.h), &step.past, out.memory)? else {
        return Ok(false);
    };
    out.stored = four.stored.0;
    out.dissipated = four.dissipated.0;
    out.stress = lanes(&four.stress);
    Ok(true)
}

/// A step of one point of a law with memory. Of a discrete gradient everything is a function of the
/// strains at both ends, what the point remembers included.
#[inline(always)]
fn evolve_point<const D: usize, L: Material<D>>(
    law: &Incremental<L>,
    step: &Evolution<D>,
    l: usize,
    out: &mut Evolved<D>,
) -> Result<(), NotPositive> {
    let h = get(&step.h, l);
    let before = step.before.as_ref().map(|before| get(before, l));
    if let (Some(before), Some(change)) = (&before, &step.change) {
        set(&mut out.stress, l, &change_between(&Single(law), [before, &h], &get(change, l))?);
        return Ok(());
    }
    let end = if let Some(before) = &before {
        let found = between(&Single(law), [before, &h])?;
        set(&mut out.stress, l, &found.stress);
        found.end
    } else {
        let point = law.at(&h)?;
        set(&mut out.stress, l, &law.stress(&point));
        point
    };
    out.stored[l] = law.law.energy(&end);
    out.dissipated[l] = law.law.dissipated(&end);
    if !out.memory.is_empty() {
        law.law.remember(&end, &mut out.memory[l * L::MEMORY..(l + 1) * L::MEMORY]);
    }
    if let Some(moduli) = &mut out.moduli {
        let point = if before.is_some() { law.at(&h)? } else { end };
        let unit = Mat::<D>::identity().0.map(Vector);
        for (row, a) in moduli.iter_mut().zip(&unit) {
            for (block, b) in row.iter_mut().zip(&unit) {
                set(block, l, &law.tangent(&point, a, b));
            }
        }
    }
    Ok(())
}

/// The components within the dimensions of a body, and the normal one in the others.
fn in_space<const D: usize>(within: &Mat<D>, lateral: f64) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| match (i < D && j < D, i == j) {
            (true, _) => within.0[i][j],
            (false, true) => lateral,
            (false, false) => 0.0,
        })
    })
}
