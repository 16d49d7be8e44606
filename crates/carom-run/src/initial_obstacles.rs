//! Moving obstacles at the start of a run, of a case that begins at the end of another one: free
//! obstacles go on, and those that follow formulas begin where these say.

use std::ops::Range;

use carom_case::{Case, ContactSpec, ObstacleMotion, Problem, Velocities};
use carom_mechanics::model::Model;
use carom_mechanics::{InitialState, State};

/// A case that begins at the end of another run.
pub(crate) struct Continued<'a> {
    pub(crate) case: &'a Case,
    pub(crate) model: &'a Model,
    /// The case of the other run.
    pub(crate) old: &'a Case,
    /// The last state of the other run.
    pub(crate) state: &'a State,
    /// First node of the obstacles in the other run.
    pub(crate) first: usize,
}

impl Continued<'_> {
    /// Sets places and velocities of the free obstacles. Returns the contacts of those that go on
    /// where they were: the other run has a free obstacle of the same shape in a contact of the
    /// same name.
    ///
    /// # Errors
    /// The case gives such an obstacle a velocity.
    pub(crate) fn go_on(
        &self,
        velocities: Velocities,
        before: &mut InitialState,
    ) -> Result<Vec<usize>, Vec<Problem>> {
        let d = self.model.dimension;
        let mut continued = Vec::new();
        for (k, contact) in self.case.contacts.iter().enumerate() {
            let ObstacleMotion::Free { velocity, .. } = &contact.motion else { continue };
            let parts = &self.model.parts;
            let Some(part) = parts.iter().find(|part| part.is_rigid() && part.name == contact.name) else {
                continue;
            };
            let dofs = part.first_node * d..(part.first_node + 1) * d;
            let keeps = velocities == Velocities::Keep;
            let Some(from) = self.dofs_of(contact) else {
                before.v[dofs.clone()].copy_from_slice(&self.model.initial_velocity[dofs]);
                continue;
            };
            if velocity.iter().any(|v| *v != 0.0) {
                let what = format!("the obstacle of contact \"{}\" has an initial velocity", contact.name);
                let why = "it goes on from the other run: [initial] sets its place and its velocity";
                let key = contact.path("primary.velocity");
                return Err(vec![Problem::new(key, what, why, "leave it out")]);
            }
            before.y[dofs.clone()].copy_from_slice(&self.state.y[from.clone()]);
            if keeps {
                before.v[dofs].copy_from_slice(&self.state.v[from]);
            }
            continued.push(k);
        }
        Ok(continued)
    }

    /// The dofs in the other run of the free obstacle that goes on in a contact.
    fn dofs_of(&self, contact: &ContactSpec) -> Option<Range<usize>> {
        let d = self.model.dimension;
        let mut node = self.first;
        for other in &self.old.contacts {
            let is_free = matches!(other.motion, ObstacleMotion::Free { .. });
            if is_free && other.name == contact.name && other.primary == contact.primary {
                return Some(node * d..(node + 1) * d);
            }
            node += other.motion.nodes(d);
        }
        None
    }
}
