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

use carom_algebra::Mat;

use super::hardening::{Flow, Hardening};
use super::hencky::Hencky;
use super::hyperelastic::Material;
use super::kinematics::exp_m1;
use super::past::Past;
use super::principal_frame::{PrincipalFrame, PrincipalStress, by_principal_stress};
use super::{NotPositive, Thickness};

/// Von Mises plasticity with isotropic hardening in logarithmic strains.
#[derive(Clone, Debug, PartialEq)]
pub struct J2 {
    /// Law of the elastic strain.
    pub elastic: Hencky,
    /// Yield stress over plastic strain.
    pub hardening: Hardening,
}

/// A point in a step.
pub struct Point<const D: usize> {
    of: PrincipalStress<D>,
    start: Remembered<D>,
    flow: Flow,
    /// Elastic strain that turns into plastic strain, (1 − β) e.
    flown: [f64; 3],
    /// Energy stored by the elastic strain and by hardening.
    stored: f64,
    /// ψ.
    released: f64,
}

impl Thickness for J2 {
    /// The stretch without elastic strain across.
    fn first_stretch(&self, past: &Past) -> f64 {
        past.memory.get(5).map_or(0.0, |plastic| 1.0 / (1.0 + plastic).sqrt() - 1.0)
    }
}

/// Memory of a point.
#[derive(Clone, Copy)]
struct Remembered<const D: usize> {
    /// C_p⁻¹ − I within the dimensions of the body.
    plastic: Mat<D>,
    /// Component of C_p⁻¹ − I in the other directions.
    across: f64,
    alpha: f64,
}

/// Count of components of a symmetric tensor within D dimensions, and one across where there are
/// other directions.
const fn components(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2 + if dimension < 3 { 1 } else { 0 }
}

impl<const D: usize> Remembered<D> {
    #[inline(always)]
    fn read(memory: &[f64]) -> Self {
        let mut plastic = Mat::ZERO;
        let mut next = 0;
        for i in 0..D {
            for j in i..D {
                plastic.0[i][j] = memory[next];
                plastic.0[j][i] = memory[next];
                next += 1;
            }
        }
        let across = if D < 3 { memory[next] } else { 0.0 };
        Self { plastic, across, alpha: memory[components(D)] }
    }

    #[inline(always)]
    fn write(&self, memory: &mut [f64]) {
        let mut next = 0;
        for i in 0..D {
            for j in i..D {
                memory[next] = self.plastic.0[i][j];
                next += 1;
            }
        }
        if D < 3 {
            memory[next] = self.across;
        }
        memory[components(D)] = self.alpha;
    }
}

impl J2 {
    /// The point of a frame from what it remembers, with flow or without.
    #[inline(always)]
    fn respond<const D: usize>(
        &self,
        frame: PrincipalFrame<D>,
        start: Remembered<D>,
        may_flow: bool,
    ) -> Point<D> {
        let mu = self.elastic.mu;
        let strains = frame.deviator();
        let norm = strains.iter().map(|strain| strain * strain).sum::<f64>().sqrt();
        let mises = 6.0_f64.sqrt() * mu * norm;
        let strength = self.hardening.at(start.alpha);
        let excess = mises - strength.stress;
        if !(may_flow && excess > 0.0) {
            let stored = self.elastic.energy_of(frame.trace(), &strains) + strength.stored;
            let of = self.elastic.stress_at(frame);
            return Point { of, start, flow: Flow::default(), flown: [0.0; 3], stored, released: 0.0 };
        }
        let flow = self.hardening.flow(start.alpha, excess, 3.0 * mu);
        let share = 3.0 * mu * flow.strain / mises;
        let shear = 2.0 * mu * (1.0 - share);
        let mean = self.elastic.bulk() * frame.trace();
        let elastic = strains.map(|strain| (1.0 - share) * strain);
        let hardened = self.hardening.at(start.alpha + flow.strain).stored;
        let stored = self.elastic.energy_of(frame.trace(), &elastic) + hardened;
        let of = PrincipalStress {
            frame,
            kirchhoff: strains.map(|strain| mean + shear * strain),
            volumetric: self.elastic.bulk() - shear / 3.0,
            shear,
            softening: 2.0 * mu * (3.0 * mu / (3.0 * mu + flow.slope) - share),
            direction: strains.map(|strain| strain / norm),
        };
        Point {
            of,
            start,
            flow,
            flown: strains.map(|strain| share * strain),
            stored,
            released: flow.strain * (excess - 1.5 * mu * flow.strain) - flow.hardening,
        }
    }
}

impl<const D: usize> Material<D> for J2 {
    const MEMORY: usize = components(D) + 1;
    const YIELDS: bool = true;
    type Point = Point<D>;

    fn at(&self, h: &Mat<D>) -> Result<Point<D>, NotPositive> {
        self.after(h, &Past { memory: &[0.0; 7][..=components(D)], dt: 0.0 })
    }

    #[inline(always)]
    fn after(&self, h: &Mat<D>, past: &Past) -> Result<Point<D>, NotPositive> {
        let start = Remembered::read(past.memory);
        let frame = PrincipalFrame::new(h, Some(&start.plastic), start.across)?;
        Ok(self.respond(frame, start, true))
    }

    #[inline(always)]
    fn remember(&self, p: &Point<D>, memory: &mut [f64]) {
        let mut end = p.start;
        if p.flow.strain > 0.0 {
            let frame = &p.of.frame;
            // F⁻¹ nₐ in the columns.
            let pulled = frame.inverse_transposed.transposed() * frame.axes;
            let mut shrinks = frame.squares;
            for (square, flown) in shrinks.iter_mut().zip(p.flown) {
                *square *= exp_m1(-2.0 * flown);
            }
            for i in 0..D {
                for j in i..D {
                    for a in 0..D {
                        end.plastic.0[i][j] += shrinks[a] * (pulled.0[i][a] * pulled.0[j][a]);
                    }
                }
            }
            end.across += shrinks[2];
            end.alpha += p.flow.strain;
        }
        end.write(memory);
    }

    #[inline(always)]
    fn dissipated(&self, p: &Point<D>) -> f64 {
        self.hardening.initial() * p.flow.strain
    }

    fn plastic_strain(&self, memory: &[f64]) -> f64 {
        memory.get(components(D)).copied().unwrap_or(0.0)
    }

    #[inline(always)]
    fn unevolved(&self, p: &Point<D>) -> Option<Point<D>> {
        Some(self.respond(p.of.frame, p.start, false))
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
