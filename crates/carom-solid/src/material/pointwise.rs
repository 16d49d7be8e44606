//! A law behind a pointer, evaluated at the points of a block at once.
//!
//! Cells of all shapes share the compiled code of a law: a call for four points costs little beside
//! what it computes, and compiling every law into the loops of every shape took two thirds of the
//! time for compiling this crate.

use carom_algebra::sums::max_or_nan;
use carom_algebra::{Mat, Vector, wide};

use super::hyperelastic::{Along, AtFour, Moduli};
use super::past::Past;
use super::{Material, NotPositive};
use crate::body::PointState;
use crate::points::{Lanes, Mats, four, lanes};

/// Properties of a law that discrete gradients depend on.
#[derive(Clone, Copy)]
pub(crate) struct Traits {
    /// [`Material::OBJECTIVE`].
    pub(crate) objective: bool,
    /// [`Material::YIELDS`].
    pub(crate) yields: bool,
    /// [`Material::SPLITS`].
    pub(crate) splits: bool,
}

/// A [`Material`] at the first `count` of four points; H = 0 in the other lanes, whose results do
/// not count. Memories of the points follow each other; those at the end of a step are not asked
/// for if that slice is empty. Of a law without memory, all memories are empty.
pub(crate) trait Pointwise<const D: usize>: Send + Sync {
    /// [`Material::ENERGY_DEGREE`].
    fn energy_degree(&self) -> usize;

    /// Properties of the law on which discrete gradients depend.
    fn traits(&self) -> Traits;

    /// Energies and P.
    fn stresses(
        &self,
        h: &Mats<D>,
        past: &Past,
        count: usize,
        memory: &mut [f64],
    ) -> Result<AtFour<D>, NotPositive>;

    /// Energies, P and ∂P/∂F.
    fn tangents(
        &self,
        h: &Mats<D>,
        past: &Past,
        count: usize,
        memory: &mut [f64],
        moduli: &mut Moduli<D>,
    ) -> Result<AtFour<D>, NotPositive>;

    /// ∂P/∂F : dF.
    fn increments(
        &self,
        h: &Mats<D>,
        dh: &Mats<D>,
        past: &Past,
        count: usize,
    ) -> Result<Mats<D>, NotPositive>;

    /// Energies and P, with flow and without, and their changes along dF.
    fn along(
        &self,
        h: &Mats<D>,
        dh: Option<&Mats<D>>,
        past: &Past,
        count: usize,
    ) -> Result<Along<D>, NotPositive>;

    /// [`Material::MEMORY`].
    fn memory(&self) -> usize;

    /// Largest [`Material::plastic_strain`] of points whose memories follow one another.
    fn largest_plastic_strain(&self, memory: &[f64]) -> f64;

    /// Kinematics and stress.
    fn state_at(&self, h: &Mat<D>, past: &Past) -> Result<PointState, NotPositive>;

    /// [`Material::volume_ratio`].
    fn volume_ratio_at(&self, h: &Mat<D>, past: &Past) -> f64;

    /// [`Material::volume_ratio`] of a law without memory.
    fn volume_ratios(&self, h: &Mats<D>) -> Lanes;

    /// ∂Pᵢᴶ/∂Xᴶ = Σ ∂Pᵢᴶ/∂Fₖᴸ ∂²yₖ/∂Xᴶ∂Xᴸ from ∂²y/∂X∂X as `[k][J][L]`.
    fn divergence(&self, h: &Mat<D>, second: &[f64]) -> Result<Vector<D>, NotPositive>;
}

impl<const D: usize, L: Material<D>> Pointwise<D> for L {
    fn energy_degree(&self) -> usize {
        L::ENERGY_DEGREE
    }

    fn traits(&self) -> Traits {
        Traits { objective: L::OBJECTIVE, yields: L::YIELDS, splits: L::SPLITS }
    }

    fn stresses(
        &self,
        h: &Mats<D>,
        past: &Past,
        count: usize,
        memory: &mut [f64],
    ) -> Result<AtFour<D>, NotPositive> {
        wide(
            #[inline(always)]
            || self.four(&four(h), past, count, memory),
        )
    }

    fn tangents(
        &self,
        h: &Mats<D>,
        past: &Past,
        count: usize,
        memory: &mut [f64],
        moduli: &mut Moduli<D>,
    ) -> Result<AtFour<D>, NotPositive> {
        wide(
            #[inline(always)]
            || self.moduli(&four(h), past, count, memory, moduli),
        )
    }

    fn increments(
        &self,
        h: &Mats<D>,
        dh: &Mats<D>,
        past: &Past,
        count: usize,
    ) -> Result<Mats<D>, NotPositive> {
        wide(
            #[inline(always)]
            || Ok(lanes(&self.four_along(&four(h), Some(&four(dh)), past, count)?.change)),
        )
    }

    fn along(
        &self,
        h: &Mats<D>,
        dh: Option<&Mats<D>>,
        past: &Past,
        count: usize,
    ) -> Result<Along<D>, NotPositive> {
        wide(
            #[inline(always)]
            || self.four_along(&four(h), dh.map(four).as_ref(), past, count),
        )
    }

    fn memory(&self) -> usize {
        L::MEMORY
    }

    fn largest_plastic_strain(&self, memory: &[f64]) -> f64 {
        let points = memory.chunks_exact(L::MEMORY.max(1));
        points.map(|point| self.plastic_strain(point)).fold(0.0, max_or_nan)
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
            || self.volume_ratio_of_four(&four(h)).0,
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
