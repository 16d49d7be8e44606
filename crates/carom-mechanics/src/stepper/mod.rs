//! Time steppers: from the state at one time to the state at the next.

mod explicit;
mod finish;
mod forward;
mod implicit;
mod impulses;
mod impulsive;
mod in_velocity;
mod increments;
mod meetings;
mod rubbing;
mod scratch;
mod tied_mass;
mod watch;
mod within;

pub use explicit::Explicit;
pub use implicit::Implicit;
pub use impulsive::Impulsive;
pub(crate) use scratch::Scratch;

use carom_contact::PairEvent;

use crate::check::penetration::{Depths, Measured};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::settings::Linear;
use crate::state::State;
use crate::timings::timed;
use crate::workspace::Workspace;

/// Events of a step, for the record.
#[derive(Clone, Debug, Default)]
pub struct StepReport {
    /// Newton iterations.
    pub newton: u32,
    /// Secondary nodes that came into contact: (contact, global node).
    pub activations: Vec<(usize, usize)>,
    /// When each of them first met the other side, if that is known.
    pub meetings: Vec<Option<f64>>,
    /// Secondary nodes that left contact.
    pub releases: Vec<(usize, usize)>,
    /// Hand-overs and slides off the end, with the index of their contact.
    pub events: Vec<(usize, PairEvent)>,
    /// Where stick and slip are not unique: the smallest relative singular value of the interface,
    /// with the sign of its determinant.
    pub ambiguity: Option<f64>,
    /// Whether the equilibrium of a load step is unstable.
    pub unstable: bool,
    /// Contact and node of closed gaps that depend on others: without multipliers, or with an
    /// arbitrary share of their impulse.
    pub dependent: Vec<(usize, usize)>,
    /// Jump of kinetic energy where contact or stick begins.
    pub projection: f64,
    /// Whether velocities were projected at the end of a stage within the step.
    pub projected_within: bool,
    /// Change of kinetic energy where an explicit step with another length is begun.
    pub begun: f64,
    /// Jump of kinetic energy by restitution where contact ends.
    pub restitution: f64,
    /// Penetration at the end.
    pub penetration: Depths,
    /// Contacts of which a node is then too deep to be trusted.
    pub doubtful: Vec<usize>,
}

/// An accepted step: finite, converged, without penetration or inverted cells. Only a stepper
/// creates one.
#[derive(Debug)]
pub struct Accepted {
    state: State,
    report: StepReport,
}

impl Accepted {
    /// Makes the final checks of a result.
    fn new(model: &Model, state: State, report: StepReport, work: &mut Workspace) -> Result<Self, Rejected> {
        for (what, values) in
            [("a position", &state.y), ("a velocity", &state.v), ("an acceleration", &state.a)]
        {
            if model.threads.max_abs(values).is_infinite() {
                return Err(Rejected::NotFinite { what });
            }
        }
        if !(state.ledger.total().is_finite() && state.ledger.dissipation().is_finite()) {
            return Err(Rejected::NotFinite { what: "the energy" });
        }
        let Workspace { timings, valid_cells, penetration, trace, .. } = work;
        let checked = timed(&mut timings.assembly, || valid_cells.check(model, &state.y))
            .and_then(|()| timed(&mut timings.contact, || penetration.check(model, &state)));
        match checked {
            Ok(Measured { depths, doubtful, .. }) => {
                Ok(Self { state, report: StepReport { penetration: depths, doubtful, ..report } })
            }
            Err(rejected) => {
                trace.end(&state.y);
                Err(rejected)
            }
        }
    }

    /// The state at the end of the step.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Takes the energies at its end into the running minimum and maximum.
    pub(crate) fn observe(&mut self) {
        self.state.ledger.observe();
    }

    /// The state at the end of the step and its events.
    pub fn into_parts(self) -> (State, StepReport) {
        (self.state, self.report)
    }
}

/// A time stepper.
pub trait Stepper: Send + Sync {
    /// Whether the acceleration of a state is that without contact, whose forces are impulses.
    fn accelerates_freely(&self) -> bool {
        false
    }

    /// Whether its steps are load steps, without inertia, that let fade what the start of a run
    /// lacks of balance if they are asked to.
    fn is_static(&self) -> bool {
        false
    }

    /// What solves its linear systems.
    fn linear(&self) -> Linear {
        Linear::Direct
    }

    /// One step of size `dt` from `state` to the time `to`. The caller sets the grid index of the
    /// result.
    fn step(
        &self,
        model: &Model,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace,
    ) -> Result<Accepted, Rejected>;
}

/// Nodes with an active pair in `a` and none in `b`: (contact, index of the secondary node). A node
/// in contact that slides into a concave corner does not come into contact.
fn difference(a: &State, b: &State) -> Vec<(usize, usize)> {
    let mut places = Vec::new();
    for (k, (pairs, others)) in a.pairs.iter().zip(&b.pairs).enumerate() {
        // Both ascend by node.
        let mut others = others.iter().filter(|pair| pair.active).peekable();
        for pair in pairs.iter().filter(|pair| pair.active) {
            while others.next_if(|other| other.node < pair.node).is_some() {}
            let place = (k, pair.node);
            if others.peek().is_none_or(|other| other.node != pair.node) && places.last() != Some(&place) {
                places.push(place);
            }
        }
    }
    places
}

/// Global numbers of secondary nodes that are given by contact and index.
fn nodes_at(model: &Model, places: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let node = |&(k, place): &(usize, usize)| (k, model.contacts[k].kinematics.secondary()[place]);
    let mut nodes: Vec<(usize, usize)> = places.iter().map(node).collect();
    nodes.dedup();
    nodes
}
