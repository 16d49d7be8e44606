//! When the frozen factor is made anew: the one rule.
//!
//! A solve with the factor shrinks what is left by θ on average and costs about as much as a
//! residual; a new factor costs as much as [`COST`] solves (Deuflhard, Newton Methods for Nonlinear
//! Problems, §2.1.1). It is made anew within a step where θ promises that more solves are left to
//! the end of the stage than that, and at the beginning of a step where the last one took more than
//! the mean cost since it was made: the rule that makes this mean least when solves become more and
//! more.
//!
//! The factor is a function of the [`Point`] in the state alone, so a resumed run goes on with the
//! same bits.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// Cost of forming and factoring a tangent, in solves with the frozen one.
const COST: f64 = 6.0;
/// Shrinking by a solve that is expected of a factor nothing is known of.
const EXPECTED: f64 = 0.1;
/// ln of what a step is to shrink its first correction by.
const DIGITS: f64 = 18.0;
/// Stages whose factors of mass and stiffness agree to this, relatively, have the same matrix: both
/// of a step of Bathe's rule do, but for round-off.
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
    /// Factor of the tangent of the loads, and their time.
    pub(crate) follower: f64,
    pub(crate) time: f64,
    /// Nodes that are eliminated last, ascending: contact acts on them alone.
    pub(crate) boundary: Vec<usize>,
}

/// The point of the frozen factor and what has been spent since it was made.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrozenTangent {
    pub(crate) point: Option<Arc<Point>>,
    steps: u32,
    /// Solves, in all and in the last step.
    spent: f64,
    last: f64,
}

/// What one stage shows of the factor.
#[derive(Debug)]
pub(crate) struct Renewal {
    pub(crate) frozen: FrozenTangent,
    /// A new factor is wanted before the next solve.
    pub(crate) due: bool,
    /// Its numbers are to have all of their digits.
    pub(crate) double: bool,
    /// Factors made.
    pub(crate) made: u32,
    /// How often what was left shrank with the present factor, and ln of by how much in all.
    shrunk: (f64, f64),
}

impl Renewal {
    /// At the beginning of a stage with these factors of mass and stiffness.
    pub(crate) fn new(frozen: &FrozenTangent, mass: f64, stiffness: f64, double: bool) -> Self {
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * b.abs();
        let fits = frozen.point.as_ref().is_some_and(|p| same(p.mass, mass) && same(p.stiffness, stiffness));
        let due =
            !fits || (frozen.steps > 0 && frozen.last > (COST + frozen.spent) / f64::from(frozen.steps));
        Self { frozen: frozen.clone(), due, double, made: 0, shrunk: (0.0, 0.0) }
    }

    /// A new factor was made.
    pub(crate) fn renewed(&mut self, point: Arc<Point>) {
        self.frozen = FrozenTangent { point: Some(point), ..FrozenTangent::default() };
        (self.due, self.shrunk) = (false, (0.0, 0.0));
        self.made += 1;
    }

    /// Mean shrinking by a solve with the present factor.
    fn rate(&self) -> f64 {
        if self.shrunk.0 > 0.0 { (self.shrunk.1 / self.shrunk.0).exp().min(0.99) } else { EXPECTED }
    }

    /// Solves after the one that has left `size` until `goal` is left.
    pub(crate) fn solves(&self, size: f64, goal: f64) -> f64 {
        (size * self.rate() / goal).ln() / -self.rate().ln()
    }

    /// Whether so many solves are left to the `goal` of the stage that a new factor is cheaper.
    pub(crate) fn pays(&self, size: f64, goal: f64) -> bool {
        self.shrunk.0 > 0.0 && self.solves(size, goal) > COST
    }

    /// What is left was `ratio` times as large after a solve.
    pub(crate) fn observe(&mut self, ratio: f64) {
        self.shrunk.0 += 1.0;
        self.shrunk.1 += ratio.clamp(1e-4, 2.0).ln();
    }

    /// What the next step is to know.
    pub(crate) fn finish(mut self) -> FrozenTangent {
        self.frozen.steps += 1;
        // A step of one solve has shown nothing slower than that.
        let rate = if self.shrunk.0 > 0.0 { self.rate() } else { EXPECTED * EXPECTED };
        self.frozen.last = DIGITS / -rate.ln();
        self.frozen.spent += self.frozen.last;
        self.frozen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_is_made_anew_where_more_solves_are_left_than_it_costs() {
        let mut renewal = Renewal::new(&FrozenTangent::default(), 1.0, 1.0, true);
        assert!(renewal.due, "there is none");
        renewal.renewed(Arc::default());
        assert!(!renewal.pays(1.0, 1e-9), "nothing has been seen of it yet");
        renewal.observe(0.1);
        // Eight more solves by a tenth each against six for a factor; two against six.
        assert!(renewal.pays(1e-1, 1e-9) && !renewal.pays(1e-6, 1e-9));
        assert!((renewal.solves(1e-3, 1e-6) - 2.0).abs() < 1e-9);
    }

    #[test]
    fn steps_that_take_longer_than_the_mean_end_the_life_of_a_factor() {
        let point = Arc::new(Point { mass: 1.0, stiffness: 1.0, ..Point::default() });
        let mut frozen = {
            let mut renewal = Renewal::new(&FrozenTangent::default(), 1.0, 1.0, true);
            renewal.renewed(point);
            renewal.observe(0.01);
            renewal.finish()
        };
        // ln 1e-2 takes 3.9 solves a step and the factor 6: the mean after n steps is 3.9 + 6/n.
        for _ in 0..5 {
            let mut renewal = Renewal::new(&frozen, 1.0, 1.0, true);
            assert!(!renewal.due);
            renewal.observe(0.01);
            frozen = renewal.finish();
        }
        let mut slow = Renewal::new(&frozen, 1.0, 1.0, true);
        slow.observe(0.1);
        assert!(Renewal::new(&slow.finish(), 1.0, 1.0, true).due);
        assert!(Renewal::new(&frozen, 2.0, 1.0, true).due, "another step has another matrix");
    }
}
