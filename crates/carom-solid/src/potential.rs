//! Potentials of which a discrete gradient is formed: a law at one point, or at four points at
//! once.

use carom_algebra::{Four, Mat, Real};

use crate::material::{Material, NotPositive};
use crate::points::{LANES, four, lanes};

/// A potential W(F) at one point, or at four points at once.
pub(crate) trait Potential<const D: usize, T: Real> {
    /// Whether W depends on FᵀF alone; otherwise it is quadratic in H.
    const OBJECTIVE: bool;

    /// Whether W lacks a second derivative where flow begins.
    const YIELDS: bool;

    /// Kinematics.
    type Point;

    fn at(&self, h: &Mat<D, T>) -> Result<Self::Point, NotPositive>;

    fn energy(&self, point: &Self::Point) -> T;

    fn stress(&self, point: &Self::Point) -> Mat<D, T>;

    fn change(&self, point: &Self::Point, df: &Mat<D, T>) -> Result<Mat<D, T>, NotPositive>;

    /// [`Material::unevolved`].
    #[inline(always)]
    fn unevolved(&self, _: &Self::Point) -> Option<Self::Point> {
        None
    }

    /// [`Material::released`].
    #[inline(always)]
    fn released(&self, _: &Self::Point) -> T {
        T::ZERO
    }
}

/// A law at one point.
pub(crate) struct Single<'a, L>(pub(crate) &'a L);

impl<const D: usize, L: Material<D>> Potential<D, f64> for Single<'_, L> {
    const OBJECTIVE: bool = L::OBJECTIVE;
    const YIELDS: bool = L::YIELDS;
    type Point = L::Point;

    #[inline(always)]
    fn at(&self, h: &Mat<D>) -> Result<L::Point, NotPositive> {
        self.0.at(h)
    }

    #[inline(always)]
    fn energy(&self, point: &L::Point) -> f64 {
        self.0.energy(point)
    }

    #[inline(always)]
    fn stress(&self, point: &L::Point) -> Mat<D> {
        self.0.stress(point)
    }

    #[inline(always)]
    fn change(&self, point: &L::Point, df: &Mat<D>) -> Result<Mat<D>, NotPositive> {
        Ok(self.0.change(point, df))
    }

    #[inline(always)]
    fn unevolved(&self, point: &L::Point) -> Option<L::Point> {
        self.0.unevolved(point)
    }

    #[inline(always)]
    fn released(&self, point: &L::Point) -> f64 {
        self.0.released(point)
    }
}

/// A law that is written for four points ([`Material::FOUR`]), at four points.
pub(crate) struct AtFour<'a, L>(pub(crate) &'a L);

/// H, Ψ and P.
pub(crate) struct PointsOfFour<const D: usize> {
    h: Mat<D, Four>,
    energy: Four,
    stress: Mat<D, Four>,
}

impl<const D: usize, L: Material<D>> Potential<D, Four> for AtFour<'_, L> {
    const OBJECTIVE: bool = L::OBJECTIVE;
    const YIELDS: bool = false;
    type Point = PointsOfFour<D>;

    #[inline(always)]
    fn at(&self, h: &Mat<D, Four>) -> Result<PointsOfFour<D>, NotPositive> {
        let (energy, stress) = self.0.at_four(h)?;
        Ok(PointsOfFour { h: *h, energy, stress })
    }

    #[inline(always)]
    fn energy(&self, point: &PointsOfFour<D>) -> Four {
        point.energy
    }

    #[inline(always)]
    fn stress(&self, point: &PointsOfFour<D>) -> Mat<D, Four> {
        point.stress
    }

    #[inline(always)]
    fn change(&self, point: &PointsOfFour<D>, df: &Mat<D, Four>) -> Result<Mat<D, Four>, NotPositive> {
        Ok(four(&self.0.changes(&lanes(&point.h), &lanes(df), LANES)?))
    }
}
