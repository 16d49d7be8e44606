//! The end of every step, whatever took it: which nodes came into contact and left it, the impact
//! and the restitution of contacts on positions, what friction did, and the checks of a state that
//! is accepted.

use carom_contact::Rows;

use super::meetings::{Path, meetings};
use super::watch::depth;
use super::{Accepted, StepReport, difference, nodes_at};
use crate::carried;
use crate::friction_state::{book_states, friction_forces};
use crate::ledger::{balance_into, changes_of_reactions};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::{Means, Previous, State};
use crate::velocity::persistency::{asks, project};
use crate::velocity::restitution::{self, Impact, separate};
use crate::works::Works;
use crate::workspace::Workspace;

/// A step that is to be finished.
pub(super) struct Finish<'a> {
    pub model: &'a Model,
    /// The state at its start.
    pub start: &'a State,
    pub dt: f64,
    /// c of the momentum in accelerations (`carried.rs`); 0 of schemes that carry none.
    pub carried: f64,
    /// ½ − α_f − c of the forces by which velocities are ahead (`works.rs`); 0 of other schemes.
    pub leads: [f64; 2],
    /// Correction of the booked works for contact impulses, which work at the mean velocity
    /// (`works.rs`). Used if gaps close and velocities are projected; zero in explicit and impulse
    /// schemes and in the fallback.
    pub impulses: Works,
    /// Whether accelerations and contact forces are means over the step, not those at its end: they
    /// remain where velocities are projected.
    pub means: bool,
    /// The parts of the step, to find when nodes met the other side; none if that is not asked.
    pub paths: Vec<Path<'a>>,
    /// The data of this step for a two-step scheme, used if neither contacts nor velocities change
    /// at its end.
    pub previous: Option<Previous>,
    /// The depth that the contact law leaves; none if it leaves no more than the checks allow.
    pub leaves: Option<f64>,
}

impl Finish<'_> {
    /// The accepted step that ends in the state `next`.
    ///
    /// # Errors
    /// Why it is not accepted.
    pub(super) fn accept(
        self,
        mut next: State,
        mut report: StepReport,
        work: &mut Workspace,
    ) -> Result<Accepted, Rejected> {
        let Self { model, start, dt, .. } = self;
        // The round-off of increments does not accumulate between tied sides.
        model.points.carry(&mut next.y);
        report.activations = nodes_at(model, &difference(&next, start));
        let released = difference(start, &next);
        report.releases = nodes_at(model, &released);
        report.meetings = meetings(model, &next, &report.activations, &self.paths);
        if let Some(bound) = self.leaves {
            let depth = depth(model, &next);
            if depth > bound {
                return Err(Rejected::Deep { depth, bound });
            }
        }
        if report.activations.iter().any(|place| asks(model, place)) {
            self.impulses.book(&mut next.ledger);
        }
        let taken = start.ledger.contact_work - next.ledger.contact_work;
        restitution::take(model, &mut next, taken);
        let closed = closed(model, start, &next, &report.activations);
        let impact = Impact { dt, start, closed, means: self.means };
        let is_ahead = self.leads != [0.0; 2] && !model.motions.is_empty();
        let before = is_ahead.then(|| work.copy(&next));
        let projected = project(model, &mut next, &impact, &report.activations, &mut work.system)?;
        if let Some(jump) = projected {
            report.projection = jump;
            carried::project(&mut next, self.carried);
            if let Some(before) = &before {
                // Contact forces are those of the projected motion.
                let increment: Vec<f64> = next.y.iter().zip(&start.y).map(|(y, old)| y - old).collect();
                let changes = changes_of_reactions(model, before, &next, &increment);
                let ahead = changes.into_iter().zip(self.leads).map(|(change, lead)| lead * change);
                carried::keep(&mut next, -ahead.sum::<f64>());
            }
        }
        before.into_iter().for_each(|before| work.put(before));
        if !released.is_empty() {
            report.restitution = separate(model, &mut next, &released, &mut work.system)?;
        }
        let continues = projected.is_none() && report.activations.is_empty();
        // Projected velocities and accelerations are those of a motion that goes on.
        next.previous = match self.previous {
            Some(previous) if continues => Some(previous),
            Some(_) if projected.is_some() => Some(before_projection(model, &next, dt)),
            _ => None,
        };
        book_states(model, &mut next, dt);
        Accepted::new(model, next, report, work)
    }
}

/// The step before a state that was projected, as a two-step scheme needs it: with the state's
/// acceleration and its forces.
fn before_projection(model: &Model, state: &State, dt: f64) -> Previous {
    let mut means = Means::new(model.dofs(), model.contacts.len());
    means.contact.clone_from(&state.f_contact);
    means.contact_forces.clone_from(&state.contact_forces);
    if model.has_friction() {
        means.friction = friction_forces(state).into_owned();
    }
    if !model.loads.is_empty() {
        means.loads.clone_from(&state.f_external);
    }
    if !model.motions.is_empty() {
        let mut supports = vec![0.0; model.dofs()];
        balance_into(model, state, &state.a, &mut supports);
        for dof in model.motions.dofs() {
            means.supports[dof] = supports[dof];
            means.accelerations[dof] = state.a[dof];
        }
    }
    let motion = || state.v.iter().zip(&state.a);
    Previous {
        dt,
        increment: motion().map(|(v, a)| dt * (v - 0.5 * dt * a)).collect(),
        velocity: motion().map(|(v, a)| v - dt * a).collect(),
        means,
    }
}

/// Contact and pair of new contacts, with the gaps at the step's start where they exist.
fn closed(
    model: &Model,
    start: &State,
    next: &State,
    activations: &[(usize, usize)],
) -> Vec<((usize, usize), f64)> {
    let mut rows = Rows::new(model.dimension);
    let mut found = Vec::new();
    for &(k, node) in activations {
        let kinematics = &model.contacts[k].kinematics;
        // An edge has the number of one of its nodes.
        let mut last = None;
        let is_own = |pair: &carom_contact::Pair| kinematics.secondary()[pair.node] == node;
        for (p, pair) in next.pairs[k].iter().enumerate().filter(|(_, pair)| is_own(pair)) {
            let is_node = pair.node < kinematics.nodes();
            let closes = if is_node { last != Some(pair.node) } else { pair.active };
            last = Some(pair.node);
            if closes
                && start.past(k, pair).is_none()
                && kinematics.measure(&mut pair.clone(), &start.y, &mut rows).is_ok()
            {
                found.push(((k, p), rows.pop()));
            }
        }
    }
    found
}
