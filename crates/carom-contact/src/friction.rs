//! Coulomb's and Tresca's laws, with exact projection onto the cone:
//!
//! ```text
//! |q| ≤ r,    S = 0 where |q| < r,    q = r S/|S| where S ≠ 0,    r = min(μ|λ|, limit)
//! μ = μ_s in stick, μ_d + (μ_s − μ_d) exp(−c |Ṡ|) in slip
//! ```
//!
//! S is the slip of a step and q the tangential traction, vectors of the tangent plane: the force
//! of the pair is λ∇g + Σ q_α H_α with H_α = ∂S_α/∂y, and q·S ≥ 0 is lost. A pair that slips in the
//! direction d has q = −μλd, so that only the direction of its force, λ(∇g − μ Σ d_α H_α), differs
//! from that without friction and the cone follows the pressure within Newton's method. In the
//! plane d is a sign; in space it is an unknown, whose equation is that nothing slips across it. A
//! pair that sticks is a constraint S = 0 with the multipliers q, or a spring.
//!
//! States follow from the iterates by a primal–dual active set over {open, stick, slip}: a stick
//! whose traction leaves the cone slips in the direction of the traction, a slip against its
//! direction sticks. A recurring set first makes changes wait for convergence, then allows one at a
//! time, as in `active_set.rs`.

use serde::{Deserialize, Serialize};

use crate::active_set::Cycle;
use crate::visited::Visited;

/// Excess of a traction over the cone, relative to the largest cone, that still sticks.
const EDGE: f64 = 1e-10;

/// Components of a tangential vector along the two tangents of a pair; in the plane there is one
/// tangent, and the second component is zero.
pub type Along = [f64; 2];

/// Euclidean length |x| of a tangential vector.
pub fn length(x: Along) -> f64 {
    x[0].hypot(x[1])
}

/// Scalar product a·b of two tangential vectors.
pub fn inner(a: Along, b: Along) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Whether a closed pair sticks, or in which direction it slips.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum FrictionState {
    /// Stick: the slip of the step is zero.
    #[default]
    Stick,
    /// Slip in the direction d, a unit vector in the tangent plane; in the plane a sign.
    Slip(Along),
}

impl FrictionState {
    /// The state of a pair without friction: it slips, in any direction.
    pub const FREE: Self = Self::Slip([1.0, 0.0]);

    /// The state in which a closing pair starts, from its slip in the iterate: the projection of
    /// the traction onto the cone of a pressure that is still zero.
    pub fn of(slip: Along, tolerance: f64) -> Self {
        let size = length(slip);
        if size > tolerance { Self::Slip(slip.map(|s| s / size)) } else { Self::Stick }
    }

    /// The state in which a closing pair starts under a law, from its slip.
    pub fn under(law: &Law, slip: Along, tolerance: f64) -> Self {
        if law.is_none() { Self::FREE } else { Self::of(slip, tolerance) }
    }

    /// Direction d of the slip; zero in stick.
    pub fn direction(self) -> Along {
        match self {
            Self::Stick => [0.0; 2],
            Self::Slip(direction) => direction,
        }
    }

    /// The state with its direction rounded, to recognise a visited one; exact in the plane.
    fn rounded(self) -> [i8; 2] {
        self.direction().map(|d| (2.0 * d).round() as i8)
    }
}

/// Tangential state and history of a pair; not used without friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tangential {
    /// Whether the pair sticks or slips.
    pub friction_state: FrictionState,
    /// Tangents at the point where the pair was last evaluated, which turn with the normal; zero
    /// before the first evaluation, and in the plane.
    pub tangents: [[f64; 3]; 2],
    /// Tangential traction q.
    pub traction: Along,
    /// Accumulated slip since the pair closed.
    pub slip: Along,
    /// Traction at the start of the step, from which a tangential spring is stretched further; in
    /// an augmented Lagrangian the traction of the last round.
    pub before: Along,
}

impl Tangential {
    /// Adds a traction along a tangential vector to a pair that sticks; turns the direction of a
    /// pair that slips as if that traction were added to it.
    pub fn pull(&mut self, along: Along, traction: f64) {
        let pulled = [0, 1].map(|i| self.traction[i] + traction * along[i]);
        match self.friction_state {
            FrictionState::Stick => self.traction = pulled,
            FrictionState::Slip(_) => self.friction_state = FrictionState::of(pulled, 0.0),
        }
    }
}

/// Law of friction of a node at an instant: Coulomb's, with a coefficient that may decay with the
/// rate of slip, or Tresca's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// Static coefficient of friction μ_s ≥ 0; infinite in Tresca's law.
    pub stick: f64,
    /// Dynamic coefficient of friction μ_d ≥ 0.
    pub slip: f64,
    /// Decay c of the coefficient with the rate of slip, a time per length; infinite if slip has
    /// μ_d at once.
    pub decay: f64,
    /// Largest tangential traction; infinite in Coulomb's law.
    pub limit: f64,
}

/// Size of the traction of a slip, the radius of the friction cone, with its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Radius {
    /// Radius r of the friction cone; negative where the pair pulls.
    pub value: f64,
    /// Derivative ∂r/∂(−λ) of the radius by the pressure.
    pub by_pressure: f64,
    /// Derivative ∂r/∂|Ṡ| of the radius by the rate of slip.
    pub by_rate: f64,
}

/// The coefficient of friction at a rate of slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficient {
    /// Coefficient of friction μ.
    pub value: f64,
    /// Derivative ∂μ/∂|Ṡ| by the rate of slip.
    pub by_rate: f64,
}

impl Law {
    /// Coulomb's law with one coefficient.
    pub const fn coulomb(coefficient: f64) -> Self {
        Self { stick: coefficient, slip: coefficient, decay: 0.0, limit: f64::INFINITY }
    }

    /// Whether there is no friction: the traction is zero under any pressure.
    pub fn is_none(&self) -> bool {
        self.limit == 0.0 || self.stick == 0.0 && self.slip == 0.0
    }

    /// Largest tangential traction of a pair that sticks under a pressure |λ|.
    pub fn grip(&self, pressure: f64) -> f64 {
        if pressure > 0.0 { (self.stick * pressure).min(self.limit) } else { 0.0 }
    }

    /// Size of the traction in slip under a pressure −λ at a rate of slip |Ṡ|. Coulomb's law goes
    /// on to negative ones, so that iterates in which a pair pulls have the forces of one linear
    /// problem and converge; the pair is then released.
    pub fn slip(&self, pressure: f64, rate: f64) -> Radius {
        if pressure <= 0.0 && (self.stick.is_infinite() || self.limit == 0.0) {
            return Radius::default();
        }
        let coefficient = self.coefficient(rate);
        let value = coefficient.value * pressure;
        if value < self.limit {
            Radius { value, by_pressure: coefficient.value, by_rate: coefficient.by_rate * pressure }
        } else {
            Radius { value: self.limit, ..Radius::default() }
        }
    }

    /// Coefficient of friction at a rate of slip, with its derivative.
    pub fn coefficient(&self, rate: f64) -> Coefficient {
        if self.stick == self.slip || self.decay.is_infinite() {
            return Coefficient { value: self.slip, by_rate: 0.0 };
        }
        let rest = (self.stick - self.slip) * (-self.decay * rate).exp();
        Coefficient { value: self.slip + rest, by_rate: -self.decay * rest }
    }
}

/// State of a closed pair that decides whether it sticks or slips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionPair {
    /// Whether the pair sticks or slips.
    pub friction_state: FrictionState,
    /// Tangential traction q.
    pub traction: Along,
    /// Slip S of the pair in the step.
    pub slip: Along,
    /// Largest tangential traction while the pair sticks.
    pub cone: f64,
}

/// A pair that changes between stick and slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateChange {
    /// Index of the pair.
    pub pair: usize,
    /// State to which the pair changes.
    pub friction_state: FrictionState,
}

/// A change of a pair whose present state violates the law, with the size of the violation: a
/// traction over the largest cone for stick, a length for slip.
#[derive(Clone, Copy)]
struct Wrong {
    change: StateChange,
    violation: f64,
}

impl Wrong {
    fn new(pair: usize, friction_state: FrictionState, violation: f64) -> Self {
        Self { change: StateChange { pair, friction_state }, violation }
    }

    /// Whether the pair changes to stick.
    fn sticks(&self) -> bool {
        self.change.friction_state == FrictionState::Stick
    }
}

/// Primal–dual active set over stick and slip of the pairs of a contact, with the states that it
/// has visited in one step.
#[derive(Clone, Debug)]
pub struct StickSlip {
    visited: Visited<Vec<Option<[i8; 2]>>>,
    slip_tolerance: f64,
}

impl StickSlip {
    /// Starts with no visited states. `slip_tolerance`: slip in the wrong direction that does not
    /// count; `within`: whether pairs may change before Newton's method has converged.
    pub fn new(slip_tolerance: f64, within: bool) -> Self {
        Self { visited: Visited::new(within), slip_tolerance }
    }

    /// Pairs that change between stick and slip, with their new states; an open pair, or one
    /// without a traction yet, is given as `None`.
    ///
    /// # Errors
    /// If the states return to those visited before in spite of all restrictions.
    pub fn changes(
        &mut self,
        pairs: &[Option<FrictionPair>],
        converged: bool,
    ) -> Result<Vec<StateChange>, Cycle> {
        if self.visited.waits(converged) {
            return Ok(Vec::new());
        }
        let widest = pairs.iter().flatten().map(|pair| pair.cone).fold(0.0, f64::max);
        let mut wrong: Vec<Wrong> = Vec::new();
        for (p, pair) in pairs.iter().enumerate() {
            let Some(pair) = pair else { continue };
            let backwards = -inner(pair.friction_state.direction(), pair.slip);
            if pair.friction_state == FrictionState::Stick {
                let excess = length(pair.traction) - pair.cone;
                if excess > EDGE * widest {
                    wrong.push(Wrong::new(p, FrictionState::of(pair.traction, 0.0), excess / widest));
                }
            } else if backwards > self.slip_tolerance {
                wrong.push(Wrong::new(p, FrictionState::Stick, backwards));
            }
        }
        if wrong.is_empty() {
            return Ok(Vec::new());
        }
        let after = |wrong: &[Wrong]| -> Vec<Option<[i8; 2]>> {
            let mut states: Vec<_> =
                pairs.iter().map(|pair| pair.map(|pair| pair.friction_state.rounded())).collect();
            for Wrong { change, .. } in wrong {
                states[change.pair] = Some(change.friction_state.rounded());
            }
            states
        };
        self.visited.visit(after(&[]), &after(&wrong), converged);
        if self.visited.waits(converged) {
            return Ok(Vec::new());
        }
        if self.visited.is_cautious() {
            // Sticks that leave the cone before slips in the wrong direction, the worst first.
            wrong.sort_by(|a, b| a.sticks().cmp(&b.sticks()).then(b.violation.total_cmp(&a.violation)));
            let untried = wrong.iter().find(|wrong| !self.visited.contains(&after(&[**wrong])));
            return match untried {
                Some(wrong) => Ok(vec![wrong.change]),
                None => Err(Cycle { pairs: wrong.iter().map(|wrong| wrong.change.pair).collect() }),
            };
        }
        Ok(wrong.into_iter().map(|wrong| wrong.change).collect())
    }

    /// Clears the visited states, for pairs that have changed themselves.
    pub fn restart(&mut self) {
        self.visited.restart();
    }
}
