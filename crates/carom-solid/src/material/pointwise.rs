//! A law behind a pointer, evaluated at the points of a block at once.
//!
//! Cells of all shapes share the compiled code of a law: a call for four points costs little beside
//! what it computes, and compiling every law into the loops of every shape took two thirds of the
//! time for compiling this crate.

use carom_algebra::{Mat, Vector, wide};

use super::{Material, NotPositive};
use crate::body::PointState;
use crate::discrete_gradient::{between, change_between};
use crate::points::{LANES, Lanes, Mats, get, set};

/// ∂P/∂F at each of the points: `[J][L][i][j][point]` is ∂P_iJ/∂F_jL.
pub(crate) type ModuliMats<const D: usize> = [[Mats<D>; D]; D];

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

    /// Kinematics and stress.
    fn state_at(&self, h: &Mat<D>) -> Result<PointState, NotPositive>;

    /// [`Material::volume_ratio`].
    fn volume_ratio_at(&self, h: &Mat<D>) -> f64;

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
        let mut energies = [0.0; LANES];
        for l in 0..count {
            let (energy, of_point) = between(self, h.map(|h| get(h, l)).each_ref())?;
            energies[l] = energy;
            set(stress, l, &of_point);
        }
        Ok(energies)
    }

    fn increments_between(
        &self,
        h: [&Mats<D>; 2],
        dh: &Mats<D>,
        count: usize,
    ) -> Result<Mats<D>, NotPositive> {
        let mut changes = none();
        for l in 0..count {
            let ends = h.map(|h| get(h, l));
            set(&mut changes, l, &change_between(self, ends.each_ref(), &get(dh, l))?);
        }
        Ok(changes)
    }

    fn state_at(&self, h: &Mat<D>) -> Result<PointState, NotPositive> {
        let (point, across) = (self.at(h)?, self.lateral_excess(h)?);
        let strain = (*h + h.transposed() + h.transposed() * *h) * 0.5;
        Ok(PointState {
            det_f: self.volume_ratio(h),
            cauchy: in_space(&self.cauchy(&point), self.lateral(&point)),
            strain: in_space(&strain, across + 0.5 * across * across),
        })
    }

    fn volume_ratio_at(&self, h: &Mat<D>) -> f64 {
        self.volume_ratio(h)
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
