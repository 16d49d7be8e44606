//! The refactoring criterion of the frozen tangent.
//!
//! A solve with the factor reduces the error by θ on average and costs about as much as a residual;
//! a new factor costs as much as several solves (Deuflhard, Newton Methods for Nonlinear Problems,
//! §2.1.1). It is recomputed within a step if θ predicts more solves than that to the end of the
//! stage. It is recomputed at the beginning of a step if the last one took more than the mean cost
//! since the last refactoring, which minimises this mean for a growing number of solves.
//!
//! The factor is a function of the [`Point`] in the state alone, so a resumed run is bitwise
//! identical.

use std::sync::Arc;

use carom_solid::{Configuration, Past};
use serde::{Deserialize, Serialize};

/// Expected reduction by a solve with an unknown factor.
const EXPECTED: f64 = 0.1;
/// ln of the reduction of the first correction in a step.
const DIGITS: f64 = 18.0;
/// Relative tolerance within which stages share a matrix by their factors of mass and stiffness:
/// both of a step of Bathe's rule do, up to round-off.
const SAME: f64 = 1e-12;

/// All data that determine the factor.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Positions of the internal tangent.
    pub(crate) at: Vec<f64>,
    /// Factor of the mass matrix.
    pub(crate) mass: f64,
    /// Factor of the internal tangent.
    pub(crate) stiffness: f64,
    /// Factor of the loads' tangent, and their time.
    pub(crate) follower: f64,
    pub(crate) time: f64,
    /// What the materials remember at the start of the step, and the time since; empty and zero if
    /// none remembers anything.
    pub(crate) memory: Arc<Vec<f64>>,
    pub(crate) dt: f64,
    /// Nodes eliminated last, ascending (interface nodes): contact acts on them alone.
    pub(crate) boundary: Vec<usize>,
}

impl Point {
    /// Where the internal tangent is computed.
    pub(crate) fn configuration(&self) -> Configuration<'_> {
        Configuration { before: None, y: &self.at, past: Past { memory: &self.memory, dt: self.dt } }
    }
}

/// The point of the frozen factor and the cost since it was made.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrozenTangent {
    pub(crate) point: Option<Arc<Point>>,
    steps: u32,
    /// Solves in total and in the last step.
    spent: f64,
    last: f64,
}

/// Statistics of the factor in one stage.
#[derive(Debug)]
pub(crate) struct Renewal {
    pub(crate) frozen: FrozenTangent,
    /// A new factor is due before the next solve.
    pub(crate) due: bool,
    /// It is required in double precision.
    pub(crate) double: bool,
    /// Cost of a factor, in solves.
    cost: f64,
    /// Number of factors made.
    pub(crate) made: u32,
    /// Number of observed reductions with the current factor, and the ln of their product.
    shrunk: (f64, f64),
}

impl Renewal {
    /// At the beginning of a stage with these factors of mass and stiffness.
    pub(crate) fn new(frozen: &FrozenTangent, [mass, stiffness]: [f64; 2], double: bool, cost: f64) -> Self {
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * b.abs();
        let fits = frozen.point.as_ref().is_some_and(|p| same(p.mass, mass) && same(p.stiffness, stiffness));
        let due =
            !fits || (frozen.steps > 0 && frozen.last > (cost + frozen.spent) / f64::from(frozen.steps));
        Self { frozen: frozen.clone(), due, double, cost, made: 0, shrunk: (0.0, 0.0) }
    }

    /// Records a new factor.
    pub(crate) fn renewed(&mut self, point: Arc<Point>) {
        self.frozen = FrozenTangent { point: Some(point), ..FrozenTangent::default() };
        (self.due, self.shrunk) = (false, (0.0, 0.0));
        self.made += 1;
    }

    /// Mean reduction by a solve with the current factor.
    fn rate(&self) -> f64 {
        if self.shrunk.0 > 0.0 { (self.shrunk.1 / self.shrunk.0).exp().min(0.99) } else { EXPECTED }
    }

    /// Number of further solves to reduce `size` to `goal`, after the last one.
    pub(crate) fn solves(&self, size: f64, goal: f64) -> f64 {
        (size * self.rate() / goal).ln() / -self.rate().ln()
    }

    /// Whether a new factor is cheaper than the remaining solves to the `goal` of the stage.
    pub(crate) fn pays(&self, size: f64, goal: f64) -> bool {
        self.shrunk.0 > 0.0 && self.solves(size, goal) > self.cost
    }

    /// Records a reduction by the factor `ratio` in a solve.
    pub(crate) fn observe(&mut self, ratio: f64) {
        self.shrunk.0 += 1.0;
        self.shrunk.1 += ratio.clamp(1e-4, 2.0).ln();
    }

    /// The data for the next step.
    pub(crate) fn finish(mut self) -> FrozenTangent {
        self.frozen.steps += 1;
        // A step of one solve gives no evidence of slower convergence.
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
        let mut renewal = Renewal::new(&FrozenTangent::default(), [1.0, 1.0], true, 6.0);
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
            let mut renewal = Renewal::new(&FrozenTangent::default(), [1.0, 1.0], true, 6.0);
            renewal.renewed(point);
            renewal.observe(0.01);
            renewal.finish()
        };
        // ln 1e-2 takes 3.9 solves per step and the factor 6: the mean after n steps is 3.9 + 6/n.
        for _ in 0..5 {
            let mut renewal = Renewal::new(&frozen, [1.0, 1.0], true, 6.0);
            assert!(!renewal.due);
            renewal.observe(0.01);
            frozen = renewal.finish();
        }
        let mut slow = Renewal::new(&frozen, [1.0, 1.0], true, 6.0);
        slow.observe(0.1);
        assert!(Renewal::new(&slow.finish(), [1.0, 1.0], true, 6.0).due);
        assert!(Renewal::new(&frozen, [2.0, 1.0], true, 6.0).due, "another step has another matrix");
    }
}
