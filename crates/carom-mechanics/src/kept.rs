//! When a factored tangent is kept, and when it is made anew.
//!
//! Newton's iteration with a tangent of an earlier point contracts linearly, ‖Δyᵏ⁺¹‖ ≈ θ ‖Δyᵏ‖, and costs a residual and a solve; a new tangent costs
//! as much as about [`RENEWAL`] of those (Deuflhard, Newton Methods for Nonlinear Problems, §2.1.1). It is made anew within a step where θ promises that
//! more iterations are left than it costs, and at the beginning of a step where the last one took more than the mean cost since it was made: the rule
//! that makes this mean least when iterations become more and more.
//!
//! The factor is a function of the [`Point`] in the state alone, so a resumed run goes on with the same bits.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::settings::Tangent;

/// Cost of forming and factoring a tangent, in iterations with a kept one.
const RENEWAL: f64 = 6.0;
/// Contraction that is taken for convergence with a kept tangent; slower is not.
const SLOW: f64 = 0.5;
/// Slow contractions of one solve after which new factors are no help: what is left out of them, contact that bends, is what is needed.
const PATIENCE: u32 = 2;
/// A correction this many times the last one allowed is far from the solution: a full tangent is taken no further out.
const FAR: f64 = 1e4;
/// Factors made in one solve, beyond which half the step is tried: contact of this step goes round and round.
const MOST_FACTORS: u32 = 4;
/// Most steps that take the full tangent after refusals in a row, or begin at rest after predictions in a row that were none: none after the first,
/// then 1, 3, 7, 15.
const LONGEST_REST: u32 = 15;
/// ln of what the first correction of a step is to shrink by.
const DIGITS: f64 = 18.0;
/// Most iterations, counted so, of a solve where steps have been bisected of late.
const HURRIED: f64 = 8.0;
/// Iterations with a kept tangent that count as one towards the allowed number.
const KEPT_COUNT: f64 = 3.0;

/// Stages whose factors of mass and stiffness agree to this, relatively, have the same matrix: both of a step of Bathe's rule do, but for round-off.
const SAME: f64 = 1e-12;

/// All that the factor is made of.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Positions of the internal tangent.
    pub(crate) at: Vec<f64>,
    /// Factor of the mass matrix.
    pub(crate) mass: f64,
    /// Factor of the internal tangent.
    pub(crate) stiffness: f64,
    /// Nodes that are eliminated last, ascending: contact acts on them alone.
    pub(crate) boundary: Vec<usize>,
}

/// The point of the kept factor and what has been spent since it was made.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    pub(crate) point: Option<Arc<Point>>,
    steps: u32,
    /// Iterations a step would take at the contraction seen, in all and in the last step.
    spent: f64,
    last: f64,
    /// Steps left with the full tangent.
    rest: u32,
    /// Rest after the next refusal.
    next_rest: u32,
    /// Steps left that begin at rest, and how many after the next prediction that is none.
    still: u32,
    next_still: u32,
}

/// The policy during one solve.
#[derive(Debug)]
pub(crate) struct Keeper {
    pub(crate) kept: Kept,
    /// The rule of the case; full where nothing can be kept.
    pub(crate) rule: Tangent,
    /// The full tangent is taken in every iteration.
    pub(crate) full: bool,
    /// A new tangent is wanted before the next solve.
    pub(crate) due: bool,
    /// The present tangent was made at the present iterate.
    fresh: bool,
    /// Size of the last correction with the present factor and active set.
    previous: Option<f64>,
    /// Slowest contraction of this step.
    contraction: f64,
    /// How often it was slow, and had been when the full tangent was taken.
    slow: u32,
    slow_before: u32,
    /// The last correction as a multiple of the last one allowed, where bodies touch.
    in_contact: Option<f64>,
    /// Slow contractions, and iterations with kept tangents counted, after which half the step is tried before a full tangent.
    bisects: Option<(u32, f64)>,
    /// How often corrections grew instead.
    growing: u32,
    /// Factors made in this solve.
    factors: u32,
    counted: f64,
}

impl Keeper {
    /// The policy at the start of a solve with these factors of mass and stiffness.
    pub(crate) fn new(kept: &Kept, rule: Tangent, mass: f64, stiffness: f64) -> Self {
        let mut kept = kept.clone();
        let resting = kept.rest > 0;
        kept.rest = kept.rest.saturating_sub(1);
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * b.abs();
        let fits = kept.point.as_ref().is_some_and(|p| same(p.mass, mass) && same(p.stiffness, stiffness));
        let due = !fits || (kept.steps > 0 && kept.last > (RENEWAL + kept.spent) / f64::from(kept.steps));
        Self {
            kept,
            rule,
            full: rule == Tangent::Full || resting,
            due,
            fresh: false,
            previous: None,
            contraction: 0.0,
            slow: 0,
            in_contact: None,
            bisects: None,
            slow_before: 0,
            growing: 0,
            factors: 0,
            counted: 0.0,
        }
    }

    /// Steps have been bisected of late: that is tried sooner.
    pub(crate) fn hurry(&mut self) {
        self.bisects = Some((PATIENCE, HURRIED));
    }

    /// Whether predictions have been none of late.
    pub(crate) fn distrusts(&mut self) -> bool {
        let distrusts = self.kept.still > 0;
        self.kept.still = self.kept.still.saturating_sub(1);
        distrusts
    }

    /// Takes note of whether a prediction was good; whether it is to be dropped.
    pub(crate) fn predicted(&mut self, good: bool) -> bool {
        let rest = self.kept.next_still;
        (self.kept.still, self.kept.next_still) = if good { (0, 0) } else { (rest, (2 * rest + 1).min(LONGEST_REST)) };
        !good
    }

    /// Factors made in this solve.
    pub(crate) fn made(&self) -> u32 {
        self.factors
    }

    /// Forgets the factor and what was spent on it.
    fn forget(&mut self) {
        let Kept { still, next_still, .. } = self.kept;
        self.kept = Kept { still, next_still, ..Kept::default() };
    }

    /// A new factor was made.
    pub(crate) fn renewed(&mut self, point: Arc<Point>) {
        self.forget();
        self.factors += 1;
        self.kept.point = Some(point);
        (self.due, self.fresh, self.previous, self.contraction) = (false, true, None, 0.0);
    }

    /// The tangent is not positive definite: full ones for a while.
    pub(crate) fn refused(&mut self) {
        let rest = self.kept.next_rest;
        self.forget();
        (self.kept.rest, self.kept.next_rest) = (rest, (2 * rest + 1).min(LONGEST_REST));
        self.slow_before = self.slow;
        (self.full, self.growing, self.previous) = (true, 0, None);
    }

    /// Takes note of a correction of size `step`; `goal` is the size that ends the iteration, `touching` whether bodies touch, `changed` whether the active
    /// set or facets just changed.
    pub(crate) fn observe(&mut self, step: f64, goal: f64, touching: bool, changed: bool) {
        self.counted += if self.full || self.fresh { 1.0 } else { KEPT_COUNT.recip() };
        (self.fresh, self.in_contact) = (false, touching.then_some(step / goal));
        if let Some(previous) = self.previous.filter(|_| !changed)
            && step > goal
        {
            let contraction = step / previous;
            self.contraction = self.contraction.max(contraction);
            let left = (step / goal).ln() / -contraction.min(SLOW).ln();
            self.due = contraction > SLOW || left > RENEWAL;
            self.slow += u32::from(contraction > SLOW);
            self.growing += u32::from(contraction > 1.0 && (touching || !self.full));
        }
        self.previous = Some(step);
    }

    /// Whether a full tangent is what is left to try.
    pub(crate) fn helpless(&self) -> bool {
        self.slow > PATIENCE
    }

    /// Whether all allowed iterations are spent, or half the step is the better try, because
    ///
    /// - corrections have grown more often than [`PATIENCE`] allows: with kept tangents, and where bodies touch with full ones too;
    /// - steps are being bisected anyway, and this one shrinks slowly or takes long;
    /// - bodies touch, and one more factor is due after [`MOST_FACTORS`];
    /// - bodies touch, and corrections shrink slowly while they are larger than [`FAR`], or are again with the full tangent that was to help.
    ///
    /// A body in free motion gets every chance at the step that was asked for.
    pub(crate) fn exhausted(&self, allowed: usize) -> bool {
        let over = |(slow, counted): (u32, f64)| !self.full && (self.slow > slow || self.counted > counted);
        let far = self.in_contact.is_some_and(|distance| distance > FAR);
        let again = self.in_contact.is_some() && self.due && self.factors >= MOST_FACTORS;
        let round = if self.full { self.slow_before > PATIENCE && far } else { again || self.helpless() && far };
        let hopeless = self.growing > PATIENCE || round || self.bisects.is_some_and(over);
        self.counted > allowed as f64 - 0.5 || (self.rule != Tangent::Full && hopeless)
    }

    /// What the next step is to know.
    pub(crate) fn finish(mut self) -> Kept {
        self.kept.steps += 1;
        self.kept.last = DIGITS / -self.contraction.clamp(1e-3, SLOW).ln();
        self.kept.spent += self.kept.last;
        self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALLOWED: usize = 25;

    fn keeper() -> Keeper {
        Keeper::new(&Kept::default(), Tangent::Kept, 1.0, 1.0)
    }

    /// Solves that shrink twentyfold and then go back to where they were: a factor each time, and no end.
    #[test]
    fn the_fifth_factor_in_contact_is_half_the_step() {
        for touching in [true, false] {
            let mut keeper = keeper();
            let mut made = 0;
            while made < 10 && !keeper.exhausted(ALLOWED) {
                keeper.renewed(Arc::default());
                made += 1;
                keeper.observe(1e-5, 1e-9, touching, true);
                keeper.observe(4e-6, 1e-9, touching, false);
                assert!(keeper.due, "eleven more iterations cost more than a factor");
            }
            assert_eq!(made, if touching { MOST_FACTORS } else { 10 });
        }
    }

    #[test]
    fn a_full_tangent_in_contact_is_for_small_corrections() {
        for (size, exhausted) in [(1e-3, true), (1e-7, false)] {
            let mut keeper = keeper();
            keeper.renewed(Arc::default());
            for k in 0..5 {
                keeper.observe(size * 0.8_f64.powi(k), 1e-9, true, false);
            }
            assert!(keeper.helpless());
            assert_eq!(keeper.exhausted(ALLOWED), exhausted);
        }
    }

    #[test]
    fn a_full_tangent_that_leads_far_away_in_contact_was_no_help() {
        for (touching, size, exhausted) in [(true, 1e-3, true), (true, 1e-6, false), (false, 1e-3, false)] {
            let mut keeper = keeper();
            keeper.renewed(Arc::default());
            (0..5).for_each(|k| keeper.observe(1e-7 * 0.8_f64.powi(k), 1e-9, touching, false));
            keeper.refused();
            assert!(!keeper.exhausted(ALLOWED));
            keeper.observe(size, 1e-9, touching, false);
            assert_eq!(keeper.exhausted(ALLOWED), exhausted);
        }
    }

    #[test]
    fn corrections_that_grow_end_a_solve_but_for_full_tangents_in_free_motion() {
        let grown = |full: bool, touching: bool| {
            let mut keeper = keeper();
            if full {
                keeper.observe(1e-9, 1e-9, touching, false);
                keeper.refused();
            }
            // The first correction with another tangent is compared with none.
            (0..4).for_each(|k| keeper.observe(1e-3 * 2_f64.powi(k), 1e-9, touching, false));
            keeper.exhausted(ALLOWED)
        };
        assert!(grown(false, false) && grown(false, true) && grown(true, true) && !grown(true, false));
    }
}
