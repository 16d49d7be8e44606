//! Potentials of which a discrete gradient is formed: a law at up to four points, with what they
//! remember.
//!
//! With the memory at the start of a step and the length of the step fixed, the response of a law
//! with memory to F is that of a hyperelastic law with the incremental potential ΔW. The discrete
//! gradient P̄ of ΔW between the ends of a step has P̄:ΔF = ΔW(F₁) − ΔW(F₀). Where nothing evolves
//! at F₀, as of laws that do not depend on rates, this is the change of the stored energy and what
//! is dissipated.

use carom_algebra::{Four, Mat};

use crate::material::{Along, AtFour, NotPositive, Past, Pointwise};
use crate::points::lanes;

/// A law at the first `count` of four points.
#[derive(Clone, Copy)]
pub(crate) struct Potential<'a, const D: usize> {
    pub(crate) law: &'a dyn Pointwise<D>,
    /// Memory of these points at the start of a step.
    pub(crate) past: Past<'a>,
    /// Count of points.
    pub(crate) count: usize,
}

impl<const D: usize> Potential<'_, D> {
    /// The law at H; overwrites the memory, unless it is empty.
    #[inline(always)]
    pub(crate) fn at(&self, h: &Mat<D, Four>, memory: &mut [f64]) -> Result<AtFour<D>, NotPositive> {
        self.law.stresses(&lanes(h), &self.past, self.count, memory)
    }

    /// The law at H, and its change with dF.
    #[inline(always)]
    pub(crate) fn along(&self, h: &Mat<D, Four>, df: Option<&Mat<D, Four>>) -> Result<Along<D>, NotPositive> {
        self.law.along(&lanes(h), df.map(lanes).as_ref(), &self.past, self.count)
    }
}
