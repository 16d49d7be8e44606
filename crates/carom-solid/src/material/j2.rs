//! Plastic flow with von Mises's yield condition, isotropic hardening, and Hencky's law for the
//! elastic strain (J. C. Simo, Comput. Methods Appl. Mech. Engrg. 99 (1992) 61–112; G. Weber,
//! L. Anand, ibid. 79 (1990) 173–202). From C_p⁻¹ and α at the start of a step:
//!
//! ```text
//! b = F C_p⁻¹ Fᵀ = Σ λₐ² nₐ ⊗ nₐ,   εₐ = ln λₐ,   e = dev ε,   q = √(3/2) 2G ‖e‖,   f = q − σ_y(α)
//! f ≤ 0: Δα = 0;   f > 0: q − 3G Δα = σ_y(α + Δα)
//! τ = K tr ε I + 2G β e,   β = 1 − 3G Δα/q,   C_p⁻¹ ← C_p⁻¹ + F⁻¹ [Σ λₐ² (exp(−2(1 − β) eₐ) − 1) nₐ ⊗ nₐ] F⁻ᵀ
//! D = K − 2Gβ/3 + 2Gβ δₐᵦ − 2G [3G/(3G + σ_y′) − 3G Δα/q] Nₐ Nᵦ,   N = e/‖e‖
//! ```
//!
//! From the plastic work σ_y dα the law stores the part (σ_y − σ_y(0)) dα, which hardening takes,
//! and dissipates σ_y(0) dα. The incremental potential is that of an elastic step, less
//!
//! ```text
//! ψ = Δα f − 3G Δα²/2 − ∫ (σ_y − σ_y(α)) dα,
//! ```
//!
//! which is zero without flow and has a continuous first derivative.
//!
//! A point remembers C_p⁻¹ − I, whose increments have no round-off without flow: its upper triangle
//! within the dimensions of the body, then its component across (one and two dimensions), then α.

use carom_algebra::{Four, Mat, Real};

use super::hardening::{Flow, Hardening};
use super::hencky::Hencky;
use super::hyperelastic::{Along, AtFour, Material};
use super::kinematics::exp_m1;
use super::past::Past;
use super::principal_frame::{PrincipalFrame, PrincipalStress, by_principal_stress, store_moduli};
use super::{Moduli, NotPositive, Thickness};
use crate::points::LANES;

/// Von Mises plasticity with isotropic hardening in logarithmic strains.
#[derive(Clone, Debug, PartialEq)]
pub struct J2 {
    /// Law of the elastic strain.
    pub elastic: Hencky,
    /// Yield stress over plastic strain.
    pub hardening: Hardening,
}

/// A point in a step.
pub struct Point<const D: usize, T = f64> {
    of: PrincipalStress<D, T>,
    start: Remembered<D, T>,
    flow: Flow<T>,
    /// Elastic strain that turns into plastic strain, (1 − β) e.
    flown: [T; 3],
    /// Energy stored by the elastic strain and by hardening.
    stored: T,
    /// ψ.
    released: T,
}

impl Thickness for J2 {
    /// The stretch without elastic strain across.
    fn first_stretch(&self, past: &Past) -> f64 {
        past.memory.get(5).map_or(0.0, |plastic| 1.0 / (1.0 + plastic).sqrt() - 1.0)
    }
}

/// Memory of a point.
#[derive(Clone, Copy)]
struct Remembered<const D: usize, T> {
    /// C_p⁻¹ − I within the dimensions of the body.
    plastic: Mat<D, T>,
    /// Component of C_p⁻¹ − I in the other directions.
    across: T,
    alpha: T,
}

/// Count of the numbers of a point in space, the largest one.
const MOST: usize = components(3) + 1;

/// Count of components of a symmetric tensor within D dimensions, and one across where there are
/// other directions.
const fn components(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2 + if dimension < 3 { 1 } else { 0 }
}

impl<const D: usize, T: Real> Remembered<D, T> {
    /// From the numbers of a memory.
    #[inline(always)]
    fn read(number: impl Fn(usize) -> T) -> Self {
        let mut plastic = Mat::ZERO;
        let mut next = 0;
        for i in 0..D {
            for j in i..D {
                plastic.0[i][j] = number(next);
                plastic.0[j][i] = plastic.0[i][j];
                next += 1;
            }
        }
        let across = if D < 3 { number(next) } else { T::ZERO };
        Self { plastic, across, alpha: number(components(D)) }
    }

    /// Hands every number to a memory.
    #[inline(always)]
    fn write(&self, mut number: impl FnMut(usize, T)) {
        let mut next = 0;
        for i in 0..D {
            for j in i..D {
                number(next, self.plastic.0[i][j]);
                next += 1;
            }
        }
        if D < 3 {
            number(next, self.across);
        }
        number(components(D), self.alpha);
    }
}

impl<const D: usize, T: Real> Point<D, T> {
    /// Whether there is flow in a lane.
    #[inline(always)]
    fn flows(&self) -> bool {
        self.flow.strain.find(|strain| strain > 0.0).is_some()
    }

    /// ∂ψ/∂F and its derivative: the stress without flow less that with it.
    #[inline(always)]
    fn released_stress(&self, mu: f64) -> PrincipalStress<D, T> {
        let shear = T::of(2.0 * mu) - self.of.shear;
        let mut kirchhoff = self.flown;
        for a in 0..3 {
            kirchhoff[a] = T::of(2.0 * mu) * self.flown[a];
        }
        PrincipalStress {
            frame: self.of.frame,
            kirchhoff,
            volumetric: -shear / T::of(3.0),
            shear,
            softening: -self.of.softening,
            direction: self.of.direction,
        }
    }

    /// Memory at the end of the step.
    #[inline(always)]
    fn end(&self) -> Remembered<D, T> {
        let mut end = self.start;
        if !self.flows() {
            return end;
        }
        let frame = &self.of.frame;
        // F⁻¹ nₐ in the columns.
        let pulled = frame.inverse_transposed.transposed() * frame.axes;
        let mut shrinks = frame.squares;
        for a in 0..3 {
            shrinks[a] = shrinks[a] * exp_m1(T::of(-2.0) * self.flown[a]);
        }
        for i in 0..D {
            for j in i..D {
                for a in 0..D {
                    let product = shrinks[a] * (pulled.0[i][a] * pulled.0[j][a]);
                    end.plastic.0[i][j] = end.plastic.0[i][j] + product;
                }
            }
        }
        end.across = end.across + shrinks[2];
        end.alpha = end.alpha + self.flow.strain;
        end
    }
}

impl<const D: usize> Point<D, Four> {
    /// Overwrites the memory of the points with that at the end of the step, unless it is empty.
    #[inline(always)]
    fn write_end(&self, memory: &mut [f64]) {
        if memory.is_empty() {
            return;
        }
        let mut numbers = [[0.0; LANES]; MOST];
        self.end().write(|k, of_points: Four| numbers[k] = of_points.0);
        for (l, of_point) in memory.chunks_exact_mut(components(D) + 1).enumerate() {
            for k in 0..=components(D) {
                of_point[k] = numbers[k][l];
            }
        }
    }
}

impl J2 {
    /// The point from what it remembers.
    #[inline(always)]
    fn kinematics<const D: usize, T: Real>(
        &self,
        h: &Mat<D, T>,
        start: Remembered<D, T>,
    ) -> Result<Point<D, T>, NotPositive> {
        let frame = PrincipalFrame::new(h, Some(&start.plastic), start.across)?;
        Ok(self.respond(frame, start))
    }

    /// Four points from what they remember.
    #[inline(always)]
    fn four_points<const D: usize>(
        &self,
        h: &Mat<D, Four>,
        past: &Past,
    ) -> Result<Point<D, Four>, NotPositive> {
        let mut numbers = [[0.0; LANES]; MOST];
        for (l, of_point) in past.memory.chunks_exact(components(D) + 1).enumerate() {
            for k in 0..=components(D) {
                numbers[k][l] = of_point[k];
            }
        }
        self.kinematics(h, Remembered::read(|k| Four(numbers[k])))
    }

    /// Energies and stress of points.
    #[inline(always)]
    fn response<const D: usize>(&self, point: &Point<D, Four>) -> AtFour<D> {
        AtFour {
            stored: point.stored,
            stress: point.of.stress(),
            dissipated: self.lost(point),
            released: point.released,
        }
    }

    /// Energy that is dissipated in the step.
    #[inline(always)]
    fn lost<const D: usize, T: Real>(&self, p: &Point<D, T>) -> T {
        T::of(self.hardening.initial()) * p.flow.strain
    }

    /// The point of a frame from what it remembers. Where nothing flows, the formulas of flow give
    /// the elastic response.
    #[inline(always)]
    fn respond<const D: usize, T: Real>(
        &self,
        frame: PrincipalFrame<D, T>,
        start: Remembered<D, T>,
    ) -> Point<D, T> {
        let mu = self.elastic.mu;
        let one = T::of(1.0);
        let strains = frame.deviator();
        let [x, y, z] = strains;
        let norm = (x * x + y * y + z * z).map(f64::sqrt);
        let mises = T::of(6.0_f64.sqrt() * mu) * norm;
        let strength = self.hardening.at(start.alpha);
        let excess = (mises - strength.stress).max(T::ZERO);
        let flow = self.hardening.flow(start.alpha, excess, 3.0 * mu);
        let flows = excess.map(|excess| if excess > 0.0 { 1.0 } else { 0.0 });
        let unit = one / norm.max(T::of(f64::MIN_POSITIVE));
        let share = T::of(1.5_f64.sqrt()) * flow.strain * unit;
        let shear = T::of(2.0 * mu) * (one - share);
        let mean = T::of(self.elastic.bulk()) * frame.trace();
        let mut kirchhoff = strains;
        let mut direction = strains;
        let mut elastic = strains;
        let mut flown = strains;
        for a in 0..3 {
            kirchhoff[a] = mean + shear * strains[a];
            direction[a] = strains[a] * unit;
            elastic[a] = (one - share) * strains[a];
            flown[a] = share * strains[a];
        }
        let volumetric = T::of(self.elastic.bulk()) - shear / T::of(3.0);
        let hardens = T::of(3.0 * mu) / (T::of(3.0 * mu) + flow.slope);
        let softening = T::of(2.0 * mu) * (hardens - share) * flows;
        let hardened = self.hardening.at(start.alpha + flow.strain).stored;
        Point {
            of: PrincipalStress { frame, kirchhoff, volumetric, shear, softening, direction },
            start,
            flow,
            flown,
            stored: self.elastic.energy_of(frame.trace(), &elastic) + hardened,
            released: flow.strain * (excess - T::of(1.5 * mu) * flow.strain) - flow.hardening,
        }
    }
}

impl<const D: usize> Material<D> for J2 {
    const MEMORY: usize = components(D) + 1;
    const YIELDS: bool = true;
    const SPLITS: bool = true;
    type Point = Point<D>;

    #[inline(always)]
    fn after(&self, h: &Mat<D>, past: &Past) -> Result<Point<D>, NotPositive> {
        self.kinematics(h, Remembered::read(|k| past.memory[k]))
    }

    #[inline(always)]
    fn remember(&self, p: &Point<D>, memory: &mut [f64]) {
        p.end().write(|k, number| memory[k] = number);
    }

    #[inline(always)]
    fn four(
        &self,
        h: &Mat<D, Four>,
        past: &Past,
        _: usize,
        memory: &mut [f64],
    ) -> Result<AtFour<D>, NotPositive> {
        let point = self.four_points(h, past)?;
        point.write_end(memory);
        Ok(self.response(&point))
    }

    #[inline(always)]
    fn four_along(
        &self,
        h: &Mat<D, Four>,
        df: Option<&Mat<D, Four>>,
        past: &Past,
        _: usize,
    ) -> Result<Along<D>, NotPositive> {
        let point = self.four_points(h, past)?;
        let change = |of: &PrincipalStress<D, Four>| df.map_or(Mat::ZERO, |df| of.change(df));
        let along = Along::elastic(self.response(&point), change(&point.of));
        if !point.flows() {
            return Ok(along);
        }
        let released = point.released_stress(self.elastic.mu);
        Ok(Along { released_stress: released.stress(), released_change: change(&released), ..along })
    }

    #[inline(always)]
    fn moduli(
        &self,
        h: &Mat<D, Four>,
        past: &Past,
        _: usize,
        memory: &mut [f64],
        moduli: &mut Moduli<D>,
    ) -> Result<AtFour<D>, NotPositive> {
        let point = self.four_points(h, past)?;
        point.write_end(memory);
        store_moduli(&point.of, moduli);
        Ok(self.response(&point))
    }

    #[inline(always)]
    fn dissipated(&self, p: &Point<D>) -> f64 {
        self.lost(p)
    }

    fn plastic_strain(&self, memory: &[f64]) -> f64 {
        memory.get(components(D)).copied().unwrap_or(0.0)
    }

    #[inline(always)]
    fn released(&self, p: &Point<D>) -> f64 {
        p.released
    }

    #[inline(always)]
    fn energy(&self, p: &Point<D>) -> f64 {
        p.stored
    }

    by_principal_stress!(D);
}
