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
    pub at: Vec<f64>,
    /// Factor of the mass matrix.
    pub mass: f64,
    /// Factor of the internal tangent.
    pub stiffness: f64,
    /// Factor of the loads' tangent.
    pub follower: f64,
    /// The time of the loads.
    pub time: f64,
    /// What the materials remember at the start of the step; empty if none remembers anything.
    pub memory: Arc<Vec<f64>>,
    /// The time since; zero if none remembers anything.
    pub dt: f64,
    /// Nodes eliminated last, ascending (interface nodes): contact acts on them alone.
    pub boundary: Vec<usize>,
}

impl Point {
    /// Where the internal tangent is computed.
    pub(crate) fn configuration(&self) -> Configuration<'_> {
        Configuration { before: None, y: &self.at, past: Past::new(&self.memory, self.dt) }
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
pub struct Renewal {
    pub(crate) frozen: FrozenTangent,
    /// A new factor is due before the next solve.
    pub due: bool,
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
    pub fn new(frozen: &FrozenTangent, [mass, stiffness]: [f64; 2], double: bool, cost: f64) -> Self {
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * b.abs();
        let fits = frozen.point.as_ref().is_some_and(|p| same(p.mass, mass) && same(p.stiffness, stiffness));
        let due =
            !fits || (frozen.steps > 0 && frozen.last > (cost + frozen.spent) / f64::from(frozen.steps));
        Self { frozen: frozen.clone(), due, double, cost, made: 0, shrunk: (0.0, 0.0) }
    }

    /// Records a new factor.
    pub fn renewed(&mut self, point: Arc<Point>) {
        self.frozen = FrozenTangent { point: Some(point), ..FrozenTangent::default() };
        (self.due, self.shrunk) = (false, (0.0, 0.0));
        self.made += 1;
    }

    /// Mean reduction by a solve with the current factor.
    fn rate(&self) -> f64 {
        if self.shrunk.0 > 0.0 { (self.shrunk.1 / self.shrunk.0).exp().min(0.99) } else { EXPECTED }
    }

    /// Number of further solves to reduce `size` to `goal`, after the last one.
    pub fn solves(&self, size: f64, goal: f64) -> f64 {
        (size * self.rate() / goal).ln() / -self.rate().ln()
    }

    /// Whether a new factor is cheaper than the remaining solves to the `goal` of the stage.
    pub fn pays(&self, size: f64, goal: f64) -> bool {
        self.shrunk.0 > 0.0 && self.solves(size, goal) > self.cost
    }

    /// Records a reduction by the factor `ratio` in a solve.
    pub fn observe(&mut self, ratio: f64) {
        self.shrunk.0 += 1.0;
        self.shrunk.1 += ratio.clamp(1e-4, 2.0).ln();
    }

    /// The data for the next step.
    pub fn finish(mut self) -> FrozenTangent {
        self.frozen.steps += 1;
        // A step of one solve gives no evidence of slower convergence.
        let rate = if self.shrunk.0 > 0.0 { self.rate() } else { EXPECTED * EXPECTED };
        self.frozen.last = DIGITS / -rate.ln();
        self.frozen.spent += self.frozen.last;
        self.frozen
    }
}
