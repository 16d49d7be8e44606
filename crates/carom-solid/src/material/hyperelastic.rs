//! The interface of a hyperelastic law.

use carom_algebra::{Four, Mat, Real, Vector};

use super::kinematics::{NotPositive, excess_det};
use super::past::{MOST, Past};
use crate::points::{LANES, Mats, four, get, lanes, set};

/// ∂P/∂F at each of four points: `[J][L][i][j][point]` is ∂P_iJ/∂F_jL.
pub type Moduli<const D: usize> = [[[[[f64; LANES]; D]; D]; D]; D];

/// A law at each of four points; the last two are zero without a memory.
pub struct AtFour<const D: usize> {
    /// Ψ.
    pub stored: Four,
    /// P.
    pub stress: Mat<D, Four>,
    /// [`Material::dissipated`].
    pub dissipated: Four,
    /// [`Material::released`].
    pub released: Four,
}

impl<const D: usize> AtFour<D> {
    /// At points where nothing evolves.
    #[inline(always)]
    pub fn elastic(stored: Four, stress: Mat<D, Four>) -> Self {
        Self { stored, stress, dissipated: Four::ZERO, released: Four::ZERO }
    }
}

/// A law at each of four points, and its change with dF; ∂ψ/∂F, ψ being [`Material::released`], and
/// its change, which are zero unless the law splits ([`Material::SPLITS`]).
pub struct Along<const D: usize> {
    /// The law.
    pub at: AtFour<D>,
    /// ∂P/∂F : dF.
    pub change: Mat<D, Four>,
    /// P without flow in the step, less P.
    pub released_stress: Mat<D, Four>,
    /// ∂P/∂F : dF without flow in the step, less that with flow.
    pub released_change: Mat<D, Four>,
}

impl<const D: usize> Along<D> {
    /// At points where nothing flows.
    #[inline(always)]
    pub fn elastic(at: AtFour<D>, change: Mat<D, Four>) -> Self {
        Self { at, change, released_stress: Mat::ZERO, released_change: Mat::ZERO }
    }
}

/// A hyperelastic law. [`Material::after`] computes common terms once. `after`, `energy`, `stress`
/// and `tangent` are `#[inline(always)]`: they are compiled into the loop over quadrature points,
/// for wide registers. A law whose formulas are written for any number
/// ([`Real`](carom_algebra::Real)) evaluates four points at once: it replaces `four`, `four_along`
/// and `moduli`.
///
/// A law with memory has, for the memory at the start of a step and the length of the step, an
/// incremental potential ΔW(F) = Ψ + 𝒟 of the stored energy Ψ and the energy 𝒟 that is dissipated
/// in the step; the stress is ∂ΔW/∂F. What an objective one remembers does not depend on the
/// rotation in F: discrete gradients evaluate it at the strain. It states [`Material::MEMORY`],
/// [`Material::remember`] and [`Material::dissipated`]; others need none of these. One that yields
/// adds [`Material::YIELDS`] and [`Material::released`], and [`Material::SPLITS`] where it can.
pub trait Material<const D: usize>: Send + Sync {
    /// Degree of Ψ as a polynomial in F to be integrated exactly; 0 if it is not a polynomial.
    const ENERGY_DEGREE: usize = 0;

    /// Whether Ψ depends on FᵀF alone; otherwise it is quadratic in H.
    const OBJECTIVE: bool = true;

    /// Count of numbers that a quadrature point remembers, at most 64; all are zero at the start of
    /// a run.
    const MEMORY: usize = 0;

    /// Whether ΔW lacks a second derivative where flow begins within a step.
    const YIELDS: bool = false;

    /// Whether ΔW of a law that yields is a smooth function less [`Material::released`], and its
    /// own [`Material::four_along`] gives ∂ψ/∂F and its change, for which there is no default.
    const SPLITS: bool = false;

    /// Kinematics at a point.
    type Point;

    /// Kinematics at H = F − I, and what follows from the memory at the start of a step.
    fn after(&self, h: &Mat<D>, past: &Past) -> Result<Self::Point, NotPositive>;

    /// Kinematics at H at the start of a run.
    #[inline(always)]
    fn at(&self, h: &Mat<D>) -> Result<Self::Point, NotPositive> {
        const { assert!(Self::MEMORY <= MOST, "a point remembers at most 64 numbers") };
        self.after(h, &Past::virgin(Self::MEMORY))
    }

    /// Overwrites the memory with that at the end of the step.
    fn remember(&self, _: &Self::Point, _: &mut [f64]) {}

    /// Energy per reference volume that is dissipated in the step.
    fn dissipated(&self, _: &Self::Point) -> f64 {
        0.0
    }

    /// Energy by which ΔW of a law that yields is below that of the same law without flow, zero if
    /// and only if there is no flow; not as their difference, which would consist of round-off for
    /// small steps.
    #[inline(always)]
    fn released(&self, _: &Self::Point) -> f64 {
        0.0
    }

    /// Equivalent plastic strain in what a point remembers.
    fn plastic_strain(&self, _: &[f64]) -> f64 {
        0.0
    }

    /// Strain energy Ψ per reference volume.
    fn energy(&self, point: &Self::Point) -> f64;

    /// First Piola–Kirchhoff stress P.
    fn stress(&self, point: &Self::Point) -> Mat<D>;

    /// The block Kᵢⱼ = Σ ∂Pᵢᴶ/∂Fⱼᴸ aᴶ bᴸ, bilinear in the reference gradients a and b.
    fn tangent(&self, point: &Self::Point, a: &Vector<D>, b: &Vector<D>) -> Mat<D>;

    /// ∂P/∂F : dF.
    #[inline(always)]
    fn change(&self, point: &Self::Point, df: &Mat<D>) -> Mat<D> {
        let mut dp = Mat::ZERO;
        for j in 0..D {
            let mut unit = Vector::ZERO;
            unit[j] = 1.0;
            for l in 0..D {
                let mut other = Vector::ZERO;
                other[l] = 1.0;
                let block = self.tangent(point, &unit, &other);
                for i in 0..D {
                    for k in 0..D {
                        dp.0[i][j] += block.0[i][k] * df.0[k][l];
                    }
                }
            }
        }
        dp
    }

    /// A step at the first `count` of four points; H = 0 in the other lanes, whose results do not
    /// count. Memories of the points follow each other. Overwrites the memory of the points with
    /// that at the end of the step, unless that slice is empty.
    #[inline(always)]
    fn four(
        &self,
        h: &Mat<D, Four>,
        past: &Past,
        count: usize,
        memory: &mut [f64],
    ) -> Result<AtFour<D>, NotPositive> {
        self.each_of_four(h, past, count, memory, |_, _| ())
    }

    /// [`Material::four`] with the changes along dF, zero without one.
    #[inline(always)]
    fn four_along(
        &self,
        h: &Mat<D, Four>,
        df: Option<&Mat<D, Four>>,
        past: &Past,
        count: usize,
    ) -> Result<Along<D>, NotPositive> {
        let df = df.map(lanes);
        let mut changes = [[[0.0; LANES]; D]; D];
        let at = self.each_of_four(h, past, count, &mut [], |l, point| {
            if let Some(df) = &df {
                set(&mut changes, l, &self.change(point, &get(df, l)));
            }
        })?;
        Ok(Along::elastic(at, four(&changes)))
    }

    /// [`Material::four`] with ∂P/∂F.
    #[inline(always)]
    fn moduli(
        &self,
        h: &Mat<D, Four>,
        past: &Past,
        count: usize,
        memory: &mut [f64],
        moduli: &mut Moduli<D>,
    ) -> Result<AtFour<D>, NotPositive> {
        let unit = Mat::<D>::identity().0.map(Vector);
        self.each_of_four(h, past, count, memory, |l, point| {
            for (row, a) in moduli.iter_mut().zip(&unit) {
                for (block, b) in row.iter_mut().zip(&unit) {
                    set(block, l, &self.tangent(point, a, b));
                }
            }
        })
    }

    /// [`Material::four`], one point after the other; hands each to `also`.
    #[inline(always)]
    fn each_of_four(
        &self,
        h: &Mat<D, Four>,
        past: &Past,
        count: usize,
        memory: &mut [f64],
        mut also: impl FnMut(usize, &Self::Point),
    ) -> Result<AtFour<D>, NotPositive> {
        let h = lanes(h);
        let mut out = AtFour::elastic(Four::ZERO, Mat::ZERO);
        let mut stress: Mats<D> = [[[0.0; LANES]; D]; D];
        let mut memories = memory.chunks_exact_mut(Self::MEMORY.max(1));
        for l in 0..count {
            let point = self.after(&get(&h, l), &past.part(l, Self::MEMORY))?;
            out.stored.0[l] = self.energy(&point);
            out.dissipated.0[l] = self.dissipated(&point);
            out.released.0[l] = self.released(&point);
            set(&mut stress, l, &self.stress(&point));
            if let Some(memory) = memories.next() {
                self.remember(&point, memory);
            }
            also(l, &point);
        }
        Ok(AtFour { stress: four(&stress), ..out })
    }

    /// Cauchy stress within the dimensions of the body, P Fᵀ/J, of a point at H; of a law of small
    /// strain P itself.
    fn cauchy(&self, point: &Self::Point, h: &Mat<D>) -> Mat<D> {
        if !Self::OBJECTIVE {
            return self.stress(point);
        }
        let f = Mat::identity() + *h;
        self.stress(point) * f.transposed() * (1.0 / (1.0 + excess_det(h)))
    }

    /// Cauchy normal stress in the directions in which the body does not extend.
    fn lateral(&self, point: &Self::Point) -> f64;

    /// F − 1 in the directions in which the body does not extend.
    fn lateral_excess(&self, _: &Self::Point) -> f64 {
        0.0
    }

    /// Determinant J of the three-dimensional deformation gradient, positive or not.
    fn volume_ratio(&self, h: &Mat<D>, _: &Past) -> f64 {
        1.0 + excess_det(h)
    }

    /// [`volume_ratio`](Self::volume_ratio) at four points, of a law without memory.
    #[inline(always)]
    fn volume_ratio_of_four(&self, h: &Mat<D, Four>) -> Four {
        Four::of(1.0) + excess_det(h)
    }
}
