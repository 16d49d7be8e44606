//! What a step computes in: buffers that outlive it.

use crate::equations::Spare;
use crate::linear_problem::LinearProblem;
use crate::model::Model;
use crate::state::State;
use crate::stepper::Scratch;
use crate::system::System;
use crate::timings::Timings;

/// Buffers that are rebuilt at will: no result travels through them.
pub struct Workspace {
    /// Linear system.
    pub(crate) system: System,
    /// Memory of evaluations.
    pub(crate) spare: Spare,
    /// Memory of states.
    states: Vec<State>,
    /// Buffers of the explicit stepper.
    pub(crate) explicit: Scratch,
    /// Wall time by phase.
    pub timings: Timings,
    /// ∂f_int/∂y times what moved dofs still have to go.
    pub(crate) pull: Vec<f64>,
    /// Right-hand side of a solve.
    pub(crate) right: Vec<f64>,
    /// The linear problem of an iteration, and what earlier ones have shown.
    pub(crate) linear: LinearProblem,
}

impl Workspace {
    /// Buffers for a model.
    pub fn new(model: &Model) -> Self {
        let zeros = vec![0.0; model.dofs()];
        Self {
            system: System::new(model),
            spare: Spare::default(),
            states: Vec::new(),
            explicit: Scratch::default(),
            timings: Timings::default(),
            pull: zeros.clone(),
            right: zeros,
            linear: LinearProblem::default(),
        }
    }

    /// A copy of a state, in memory that was used before.
    pub(crate) fn copy(&mut self, state: &State) -> State {
        let mut copy = self.states.pop().unwrap_or_default();
        copy.copy_from(state);
        copy
    }

    /// Gives the memory of a state back.
    pub(crate) fn put(&mut self, state: State) {
        self.states.push(state);
    }
}
