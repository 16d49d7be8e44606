//! Yield stress over the equivalent plastic strain α.

use std::sync::Arc;

use carom_algebra::Real;

/// Yield stress σ_y(α) > 0, which does not fall.
#[derive(Clone, Debug, PartialEq)]
pub enum Hardening {
    /// σ_y = yield + modulus α.
    Linear {
        /// Yield stress at α = 0.
        yield_stress: f64,
        /// Hardening modulus, ≥ 0.
        modulus: f64,
    },
    /// σ_y = yield + modulus α + rise (1 − exp(−rate α)) (E. Voce, J. Inst. Met. 74 (1948)
    /// 537–562).
    Voce {
        /// Yield stress at α = 0.
        yield_stress: f64,
        /// Hardening modulus at large α, ≥ 0.
        modulus: f64,
        /// Rise of the yield stress that saturates, ≥ 0.
        rise: f64,
        /// Rate of its saturation, > 0.
        rate: f64,
    },
    /// Straight between given points, constant beyond the last.
    Table(Table),
}

/// Points of a yield stress that does not fall.
#[derive(Clone, Debug, PartialEq)]
pub struct Table(Arc<[Entry]>);

/// A point of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Entry {
    alpha: f64,
    stress: f64,
    /// ∫ (σ_y − σ_y(0)) dα up to the point.
    stored: f64,
}

/// Yield stress at a plastic strain, and the energy that hardening has stored there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strength<T = f64> {
    /// σ_y.
    pub stress: T,
    /// ∫ (σ_y − σ_y(0)) dα from zero: what hardening stores.
    pub stored: T,
}

/// Plastic flow in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow<T = f64> {
    /// Δα.
    pub strain: T,
    /// dσ_y/dα at the end.
    pub slope: T,
    /// ∫ (σ_y − σ_y(α)) dα over the step.
    pub hardening: T,
}

impl Table {
    /// Points [α, σ_y]: α rises from 0, σ_y > 0 does not fall. None of others.
    pub fn new(points: &[[f64; 2]]) -> Option<Self> {
        let starts = points.first().is_some_and(|[alpha, stress]| *alpha == 0.0 && *stress > 0.0);
        let rises = points.windows(2).all(|pair| pair[1][0] > pair[0][0] && pair[1][1] >= pair[0][1]);
        if !(starts && rises && points.iter().flatten().all(|x| x.is_finite())) {
            return None;
        }
        let initial = points[0][1];
        let mut entries: Vec<Entry> = Vec::with_capacity(points.len());
        for &[alpha, stress] in points {
            let stored = entries.last().map_or(0.0, |last| {
                last.stored + (alpha - last.alpha) * (0.5 * (last.stress + stress) - initial)
            });
            entries.push(Entry { alpha, stress, stored });
        }
        Some(Self(entries.into()))
    }

    /// Index of the last point whose α is not larger.
    fn segment(&self, alpha: f64) -> usize {
        self.0.partition_point(|entry| entry.alpha <= alpha).max(1) - 1
    }

    /// Slope of the segment after a point; zero after the last.
    fn slope(&self, segment: usize) -> f64 {
        let start = &self.0[segment];
        self.0.get(segment + 1).map_or(0.0, |end| (end.stress - start.stress) / (end.alpha - start.alpha))
    }

    fn at(&self, alpha: f64) -> Strength {
        let segment = self.segment(alpha);
        let start = &self.0[segment];
        let beyond = alpha - start.alpha;
        let rise = self.slope(segment) * beyond;
        let over = start.stress - self.0[0].stress;
        Strength { stress: start.stress + rise, stored: start.stored + beyond * (over + 0.5 * rise) }
    }

    /// Δα of [`Hardening::flow`], exact: segment by segment.
    fn flow(&self, alpha: f64, excess: f64, stiffness: f64) -> f64 {
        let mut strain = 0.0;
        let mut remaining = excess;
        for segment in self.segment(alpha)..self.0.len() {
            let resistance = stiffness + self.slope(segment);
            let end = self.0.get(segment + 1).map_or(f64::INFINITY, |end| end.alpha);
            let whole = remaining / resistance;
            let room = end - alpha - strain;
            strain += whole.min(room.max(0.0));
            if whole <= room {
                break;
            }
            remaining -= resistance * room.max(0.0);
        }
        strain
    }

    /// ∫ (σ_y − σ_y(α)) dα from α over a strain, segment by segment.
    fn hardening(&self, alpha: f64, strain: f64) -> f64 {
        let mut integral = 0.0;
        let mut risen = 0.0;
        let mut from = alpha;
        for segment in self.segment(alpha)..self.0.len() {
            let end = self.0.get(segment + 1).map_or(f64::INFINITY, |end| end.alpha);
            let part = (end.min(alpha + strain) - from).max(0.0);
            let slope = self.slope(segment);
            integral += part * (risen + 0.5 * slope * part);
            risen += slope * part;
            from = end;
            if alpha + strain <= end {
                break;
            }
        }
        integral
    }
}

impl Hardening {
    /// σ_y(0).
    pub fn initial(&self) -> f64 {
        match self {
            Self::Linear { yield_stress, .. } | Self::Voce { yield_stress, .. } => *yield_stress,
            Self::Table(table) => table.0[0].stress,
        }
    }

    /// The yield stress at α.
    #[inline(always)]
    pub fn at<T: Real>(&self, alpha: T) -> Strength<T> {
        match self {
            Self::Linear { yield_stress, modulus } => {
                let rise = T::of(*modulus) * alpha;
                Strength { stress: T::of(*yield_stress) + rise, stored: T::of(0.5) * rise * alpha }
            }
            Self::Voce { yield_stress, modulus, rise, rate } => {
                let saturated = alpha.map(|alpha| -(-rate * alpha).exp_m1());
                let linear = T::of(*modulus) * alpha;
                let rise = T::of(*rise);
                Strength {
                    stress: T::of(*yield_stress) + linear + rise * saturated,
                    stored: T::of(0.5) * linear * alpha + rise * (alpha - saturated / T::of(*rate)),
                }
            }
            Self::Table(table) => Strength {
                stress: alpha.map(|alpha| table.at(alpha).stress),
                stored: alpha.map(|alpha| table.at(alpha).stored),
            },
        }
    }

    /// The flow Δα from α with `excess` − `stiffness` Δα = σ_y(α + Δα) − σ_y(α), for a trial stress
    /// that exceeds σ_y(α) by `excess`; none where that is zero.
    #[inline(always)]
    pub fn flow<T: Real>(&self, alpha: T, excess: T, stiffness: f64) -> Flow<T> {
        match self {
            Self::Linear { modulus, .. } => {
                let strain = excess * T::of(1.0 / (stiffness + modulus));
                let modulus = T::of(*modulus);
                Flow { strain, slope: modulus, hardening: T::of(0.5) * modulus * strain * strain }
            }
            Self::Voce { modulus, rise, rate, .. } => {
                let left = alpha.map(|alpha| rise * (-rate * alpha).exp());
                let strain = left.zip(excess, |left, excess| {
                    let by_strain = stiffness + modulus;
                    saturating_flow(excess, by_strain, left, *rate)
                });
                let saturated = strain.map(|strain| -(-rate * strain).exp_m1());
                let modulus = T::of(*modulus);
                let rate = T::of(*rate);
                Flow {
                    strain,
                    slope: modulus + left * rate * (T::of(1.0) - saturated),
                    hardening: T::of(0.5) * modulus * strain * strain + left * (strain - saturated / rate),
                }
            }
            Self::Table(table) => {
                let strain = alpha.zip(excess, |alpha, excess| table.flow(alpha, excess, stiffness));
                let hardening = alpha.zip(strain, |alpha, strain| table.hardening(alpha, strain));
                let slope = (alpha + strain).map(|alpha| table.slope(table.segment(alpha)));
                Flow { strain, slope, hardening }
            }
        }
    }
}

/// The root Δα of `excess` = `stiffness` Δα + `left` (1 − exp(−`rate` Δα)). The remainder is convex
/// and falls with Δα: Newton's iterates rise to its root.
fn saturating_flow(excess: f64, stiffness: f64, left: f64, rate: f64) -> f64 {
    let mut strain = 0.0;
    loop {
        let saturated = -(-rate * strain).exp_m1();
        let remainder = excess - stiffness * strain - left * saturated;
        let next = strain + remainder / (stiffness + left * rate * (1.0 - saturated));
        let rises = next > strain * (1.0 + f64::EPSILON);
        if !rises {
            return strain;
        }
        strain = next;
    }
}
