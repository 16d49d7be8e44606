//! From the state at one time to the state at the next.

mod explicit;
mod implicit;
mod impulsive;
mod watch;

pub use explicit::Explicit;
pub use implicit::Implicit;
pub(crate) use implicit::averaged_contact_into;
pub use impulsive::Impulsive;

use carom_contact::PairEvent;

use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;
use crate::workspace::Workspace;

/// What happened in a step, for the record.
#[derive(Clone, Debug, Default)]
pub struct StepReport {
    /// Newton iterations.
    pub newton: u32,
    /// Secondary nodes that came into contact: (contact, global node).
    pub activations: Vec<(usize, usize)>,
    /// Secondary nodes that left contact.
    pub releases: Vec<(usize, usize)>,
    /// Hand-overs and slides off the end, with the place of their contact.
    pub events: Vec<(usize, PairEvent)>,
    /// Jump of kinetic energy where contact began.
    pub projection: f64,
}

/// A step that was accepted: finite, converged, not penetrating. Only a stepper makes one.
#[derive(Debug)]
pub struct Accepted {
    state: State,
    report: StepReport,
}

impl Accepted {
    /// Checks the last things a result must hold to.
    fn new(state: State, report: StepReport) -> Result<Self, Rejected> {
        for (what, values) in [("a position", &state.y), ("a velocity", &state.v), ("an acceleration", &state.a)] {
            if values.iter().any(|x| !x.is_finite()) {
                return Err(Rejected::NotFinite { what });
            }
        }
        if !(state.ledger.total().is_finite() && state.ledger.dissipation().is_finite()) {
            return Err(Rejected::NotFinite { what: "the energy" });
        }
        Ok(Self { state, report })
    }

    /// As [`Self::new`], for laws that let nodes penetrate: by no more than `bound`.
    fn within(state: State, report: StepReport, depth: f64, bound: f64) -> Result<Self, Rejected> {
        if depth > bound { Err(Rejected::Deep { depth, bound }) } else { Self::new(state, report) }
    }

    /// The state at the end of the step and what happened on the way.
    pub fn into_parts(self) -> (State, StepReport) {
        (self.state, self.report)
    }
}

/// A time stepper.
pub trait Stepper<const D: usize>: Send + Sync {
    /// One step of size `dt` from `state` to the time `to`. The grid index of the result is the caller's to set.
    fn step(
        &self,
        model: &Model<D>,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace<D>,
    ) -> Result<Accepted, Rejected>;
}
