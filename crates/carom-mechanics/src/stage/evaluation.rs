//! An iterate of a stage, and what was computed there.

use carom_contact::{Along, Answer, DiscreteGradient, Pairing, Rows};
use educe::Educe;

use crate::materials::Materials;
use crate::stage::balance::Forces;
use crate::state::State;

/// The unknowns of a stage.
#[derive(Debug, Default, Educe)]
#[educe(Clone)]
pub struct Iterate {
    /// d = y − y_s.
    pub increment: Vec<f64>,
    /// Pairs of each contact, multipliers included.
    pub pairings: Vec<Pairing>,
    /// Number of times that the springs of augmented Lagrangians became ten times stiffer.
    pub stiffer: i32,
}

impl Iterate {
    /// The start of a step: no increment, the pairs of the state.
    pub fn at_start(state: &State) -> Self {
        let pairings = state.pairs.iter().cloned().map(Pairing::new).collect();
        Self { increment: vec![0.0; state.y.len()], pairings, stiffer: 0 }
    }

    /// The initial guess of a stage: positions for constant acceleration over `dt`, unchanged
    /// multipliers, each pair free to change facets again. Inactive pairs are searched again, so
    /// that they depend on positions alone.
    pub(crate) fn predict(&mut self, v: &[f64], a: &[f64], dt: f64) {
        for (increment, (v, a)) in self.increment.iter_mut().zip(v.iter().zip(a)) {
            *increment += dt * (v + 0.5 * dt * a);
        }
        self.pairings.iter_mut().for_each(Pairing::restart);
    }

    /// Adds a share of the increment of the last step.
    pub(crate) fn extrapolate(&mut self, last: &[f64], share: f64) {
        self.increment.iter_mut().zip(last).for_each(|(increment, last)| *increment += share * last);
    }
}

/// Results at an iterate.
#[derive(Clone, Debug, Default)]
pub struct Evaluation {
    /// The iterate, with contact points updated to its positions and the activity of springs set.
    pub at: Iterate,
    /// y = y_s + d.
    pub y: Vec<f64>,
    /// Positions at which internal forces and loads are evaluated; for a discrete gradient, the
    /// midpoint of the step.
    pub place: Vec<f64>,
    /// Forces over all dofs.
    pub forces: Forces,
    /// a(d).
    pub acceleration: Vec<f64>,
    /// r over all dofs: the reaction force at constrained ones.
    pub residual: Vec<f64>,
    /// A row per pair of each contact.
    pub rows: Vec<Rows>,
    /// Directions of the contact forces where they are not the gradients of these rows, a row per
    /// pair: discrete gradients, or turned by friction; empty for other contacts.
    pub turned: Vec<Rows>,
    /// H where slips are measured, with the slip S as gaps, a row per pair and tangent; empty
    /// without friction.
    pub slips: Vec<Rows>,
    /// y_½ = y_s + d/2; empty without friction.
    pub middle: Vec<f64>,
    /// Traction of each active pair of a contact beyond what acts along its direction.
    pub rests: Vec<Vec<Along>>,
    /// Energy of tangential springs, a part of `springs`.
    pub stick_springs: f64,
    /// The interface's response to each row.
    pub answers: Vec<Vec<Answer>>,
    /// Strain energy of the bodies at `y`, or at the averaged positions.
    pub strain: f64,
    /// What the materials remember and store there.
    pub materials: Materials,
    /// Energy of penalty springs.
    pub springs: f64,
    /// Size of the residual and its reference.
    pub measure: Measure,
    /// A buffer.
    pub(crate) gradient: DiscreteGradient,
}

impl Evaluation {
    /// Directions of the forces of a contact, a row per pair.
    pub(crate) fn directions(&self, contact: usize) -> &Rows {
        let turned = &self.turned[contact];
        if turned.is_empty() { &self.rows[contact] } else { turned }
    }
}

/// Size of a residual and its reference.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measure {
    /// ‖r‖ over the free dofs.
    pub residual: f64,
    /// Sum of the norms of its terms.
    pub forces: f64,
    /// Largest |g| of the active constraints, and slip that friction prevents.
    pub gap: f64,
    /// Whether `gap` contains that of rows for which others may stand: slips that friction
    /// prevents, and single nodes beside a field of pressure.
    pub may_depend: bool,
}

/// Unused evaluations, whose memory is reused.
#[derive(Debug, Default)]
pub struct Spare(Vec<Evaluation>);

impl Spare {
    /// An evaluation to be filled.
    pub(crate) fn take(&mut self) -> Evaluation {
        self.0.pop().unwrap_or_default()
    }

    /// Returns the memory of an evaluation.
    pub(crate) fn put(&mut self, evaluation: Evaluation) {
        self.0.push(evaluation);
    }

    /// A copy of an iterate in reused memory.
    pub(crate) fn copy(&mut self, of: &Iterate) -> Iterate {
        let mut iterate = self.0.last_mut().map(|spare| std::mem::take(&mut spare.at)).unwrap_or_default();
        iterate.clone_from(of);
        iterate
    }
}
