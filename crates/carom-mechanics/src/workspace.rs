//! The workspace of a step: buffers that outlive it.

use crate::check::penetration::Penetration;
use crate::check::undeclared::Undeclared;
use crate::check::valid_cells::ValidCells;
use crate::linear::system::System;
use crate::model::Model;
use crate::settings::Linear;
use crate::stage::evaluation::Spare;
use crate::stage::linear_problem::LinearProblem;
use crate::state::State;
use crate::stepper::Scratch;
use crate::timings::Timings;
use crate::trace::Trace;

/// Buffers that may be discarded: no state depends on them. Timings, the trace of iterations and
/// the number of factorisations are records of what was done.
pub struct Workspace {
    /// Linear system.
    pub system: System,
    /// Memory of evaluations.
    pub(crate) spare: Spare,
    /// Memory of states.
    states: Vec<State>,
    /// Buffers of the explicit stepper.
    pub(crate) explicit: Scratch,
    /// Bodies whose cells are known to be valid.
    pub(crate) valid_cells: ValidCells,
    /// Wall time by phase.
    pub timings: Timings,
    /// Penetration of the contacts.
    pub(crate) penetration: Penetration,
    /// Overlaps without a contact.
    pub(crate) undeclared: Undeclared,
    /// The linear problem of an iteration, and its history.
    pub(crate) linear: LinearProblem,
    /// The last iterations, to explain a rejection.
    pub(crate) trace: Trace,
    /// Dependent gaps that were reported last, and in how many steps without a change.
    told: (Vec<(usize, usize)>, u32),
    /// Time until which what load steps lack of balance at the start fades; none if they reach
    /// balance in each.
    pub(crate) fade_until: Option<f64>,
}

impl Workspace {
    /// Buffers for a model.
    pub fn new(model: &Model, linear: Linear) -> Self {
        Self {
            system: System::new(model, linear),
            spare: Spare::default(),
            states: Vec::new(),
            explicit: Scratch::new(model.dimension),
            valid_cells: ValidCells::default(),
            timings: Timings::default(),
            penetration: Penetration::of_contacts(model),
            undeclared: Undeclared::new(model),
            linear: LinearProblem::new(model),
            trace: Trace::default(),
            told: (Vec::new(), 0),
            fade_until: None,
        }
    }

    /// Dependent gaps to report, by contact and node; none if they are those of the last two steps.
    /// Schemes with many steps would report the same ones in each.
    pub(crate) fn tell(&mut self, gaps: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
        if gaps != self.told.0 {
            self.told = (gaps, 0);
        }
        self.told.1 += 1;
        if self.told.1 <= 2 { self.told.0.clone() } else { Vec::new() }
    }

    /// A copy of a state, in reused memory.
    pub(crate) fn copy(&mut self, state: &State) -> State {
        let mut copy = self.states.pop().unwrap_or_default();
        copy.clone_from(state);
        copy
    }

    /// A state that follows another one, in reused memory.
    pub(crate) fn following(&mut self, state: &State) -> State {
        let mut next = self.states.pop().unwrap_or_default();
        next.follow(state);
        next
    }

    /// Returns the memory of a state.
    pub(crate) fn put(&mut self, state: State) {
        self.states.push(state);
    }
}
