//! Checks of the restitution of a conserving scheme: it returns the energy that closing contacts
//! take, after the projection of velocities and to the whole system at once.

use super::super::{ContactLaw, ContactSpec, Persistency, SchemeSpec};
use super::Check;

impl Check<'_> {
    pub(super) fn conserving_restitution(&mut self, spec: &SchemeSpec) {
        let contacts = &self.draft.contact;
        let multiplier = |contact: &&ContactSpec| contact.enforcement.is_exact();
        let first = contacts.iter().flatten().find(multiplier).map_or(0.0, |contact| contact.restitution);
        for contact in contacts.iter().flatten() {
            let Some((why, help)) = self.restitution_is_unusable(contact, first) else { continue };
            let e = contact.restitution;
            let what = format!("contact `{}` cannot have restitution = {e} with {}", contact.name, spec.kind);
            self.add_unique(contact.path("restitution"), what, why, help);
        }
    }

    /// Reason why a contact cannot have its restitution, and a remedy; `first`: the restitution of
    /// the first contact by multipliers.
    fn restitution_is_unusable(&self, contact: &ContactSpec, first: f64) -> Option<(&'static str, String)> {
        let light = |name: &str| self.body(name).is_some_and(|body| body.mass.is_redistributed());
        let massless = || contact.bodies().any(light);
        let multiplier = contact.enforcement.is_exact();
        let instead = |other: &str| format!("leave restitution out, or use {other}");
        if multiplier && contact.restitution != first {
            let why = "energy is returned to the whole system at once, so all contacts have one restitution";
            Some((why, format!("give all contacts restitution = {first}")))
        } else if contact.restitution == 0.0 {
            None
        } else if !multiplier {
            let why = "penalty springs return the energy that they store by themselves";
            Some((why, instead("enforcement = \"multiplier\"")))
        } else if contact.law == Some(ContactLaw::Predictor) {
            let why = "the energy that the projected predictor loses is not that of an impact";
            Some((why, instead("law = \"position\"")))
        } else if contact.persistency == Persistency::None {
            let why = "energy is returned to projected velocities, and persistency = \"none\" leaves them unchanged";
            Some((why, instead("persistency = \"project\"")))
        } else if massless() {
            let why = "nodes without mass have no velocity of their own to project and update";
            Some((why, instead("mass = \"consistent\" or \"lumped\"")))
        } else {
            None
        }
    }
}
