//! Laws with memory. With the memory at the start of a step and the length of the step fixed, the
//! response to F is that of a hyperelastic law with the incremental potential ΔW, so that every
//! kernel of such laws serves: tangents, increments, discrete gradients.
//!
//! The discrete gradient P̄ of ΔW between the ends of a step has P̄:ΔF = ΔW(F₁) − ΔW(F₀). Where
//! nothing evolves at F₀, as of laws that do not depend on rates, this is the change of the stored
//! energy and what is dissipated.

use carom_algebra::{Mat, Vector};

use super::past::Past;
use super::{Material, NotPositive};

/// A law with what it remembers, as a hyperelastic law.
pub(crate) struct Incremental<'a, L> {
    pub(crate) law: &'a L,
    pub(crate) past: Past<'a>,
}

impl<const D: usize, L: Material<D>> Material<D> for Incremental<'_, L> {
    const ENERGY_DEGREE: usize = L::ENERGY_DEGREE;
    const OBJECTIVE: bool = L::OBJECTIVE;
    const YIELDS: bool = L::YIELDS;
    type Point = L::Point;

    #[inline(always)]
    fn at(&self, h: &Mat<D>) -> Result<L::Point, NotPositive> {
        self.law.after(h, &self.past)
    }

    #[inline(always)]
    fn unevolved(&self, point: &L::Point) -> Option<L::Point> {
        self.law.unevolved(point)
    }

    #[inline(always)]
    fn released(&self, point: &L::Point) -> f64 {
        self.law.released(point)
    }

    #[inline(always)]
    fn energy(&self, point: &L::Point) -> f64 {
        self.law.energy(point) + self.law.dissipated(point)
    }

    #[inline(always)]
    fn stress(&self, point: &L::Point) -> Mat<D> {
        self.law.stress(point)
    }

    #[inline(always)]
    fn tangent(&self, point: &L::Point, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        self.law.tangent(point, a, b)
    }

    #[inline(always)]
    fn change(&self, point: &L::Point, df: &Mat<D>) -> Mat<D> {
        self.law.change(point, df)
    }

    fn cauchy(&self, point: &L::Point, h: &Mat<D>) -> Mat<D> {
        self.law.cauchy(point, h)
    }

    fn lateral(&self, point: &L::Point) -> f64 {
        self.law.lateral(point)
    }

    fn lateral_excess(&self, point: &L::Point) -> f64 {
        self.law.lateral_excess(point)
    }

    fn volume_ratio(&self, h: &Mat<D>, _: &Past) -> f64 {
        self.law.volume_ratio(h, &self.past)
    }
}
