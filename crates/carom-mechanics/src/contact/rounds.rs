//! The rounds of augmented Lagrangians: when Newton's method has converged, their multipliers are
//! replaced by its forces, until closed gaps and the slips of sticking nodes are below a tolerance.

use carom_contact::{FrictionState, Pair, inner, length};

use crate::contact::augmented::take;
use crate::rejected::Rejected;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;

/// Largest gap of a closed pair, and slip of a sticking one, as a fraction of L.
const TOLERANCE: f64 = 1e-10;
/// Largest number of rounds.
const MOST: u32 = 60;
/// Reduction of the largest gap by a round below which springs become ten times stiffer, and how
/// often they may.
const ENOUGH: f64 = 0.01;
const STIFFEST: i32 = 8;

impl Equations<'_> {
    /// r and k of a pair; none without an augmented Lagrangian.
    pub(crate) fn augmentation(&self, contact: usize, pair: &Pair, stiffer: i32) -> Option<[f64; 2]> {
        let springs = self.augmented[contact].get(pair.node)?;
        Some(springs.map(|spring| spring * 10.0_f64.powi(stiffer)))
    }

    /// 1/k of a closed pair that sticks.
    pub(crate) fn stick_yields(&self, contact: usize, pair: &Pair, stiffer: i32) -> Option<f64> {
        let [_, stiffness] = self.augmentation(contact, pair, stiffer)?;
        (pair.tangential.friction_state == FrictionState::Stick).then(|| stiffness.recip())
    }

    /// (q − q̂)/k of a closed pair along one component, which its slip has in this round; 0 if it
    /// has none to prevent.
    pub(crate) fn stretch(&self, contact: usize, pair: &Pair, along: [f64; 2], stiffer: i32) -> f64 {
        let tangential = &pair.tangential;
        let stretched = [0, 1].map(|i| tangential.traction[i] - tangential.before[i]);
        self.stick_yields(contact, pair, stiffer).map_or(0.0, |yields| inner(along, stretched) * yields)
    }
}

/// Rounds of one solve.
#[derive(Debug)]
pub(crate) struct Rounds {
    count: u32,
    /// Largest gap or slip at the end of the last one.
    largest: f64,
}

impl Rounds {
    pub(crate) fn new() -> Self {
        Self { count: 0, largest: f64::INFINITY }
    }

    /// Begins another round with the forces of a converged iterate; returns whether one is needed.
    ///
    /// # Errors
    /// If there were too many.
    pub(crate) fn next(&mut self, equations: &Equations, now: &mut Evaluation) -> Result<bool, Rejected> {
        let model = equations.model;
        let augmented = |k: &usize| model.contacts[*k].augmentation.is_some();
        let mut largest = 0.0_f64;
        for k in (0..model.contacts.len()).filter(augmented) {
            for (p, pair) in now.at.pairings[k].pairs.iter().enumerate().filter(|(_, pair)| pair.active) {
                largest = largest.max(now.rows[k].row(p).gap.abs());
                if model.contacts[k].friction.is_some()
                    && pair.tangential.friction_state == FrictionState::Stick
                {
                    largest = largest.max(length(now.slip_of((k, p))));
                }
            }
        }
        if largest <= TOLERANCE * model.scale {
            return Ok(false);
        }
        if self.count == MOST {
            let gap = [largest / model.scale, TOLERANCE];
            return Err(Rejected::NoMultipliers { rounds: self.count, gap });
        }
        if largest > ENOUGH * self.largest && now.at.stiffer < STIFFEST {
            now.at.stiffer += 1;
        }
        for k in (0..model.contacts.len()).filter(augmented) {
            now.at.pairings[k].pairs.iter_mut().for_each(take);
        }
        (self.count, self.largest) = (self.count + 1, largest);
        Ok(true)
    }
}
