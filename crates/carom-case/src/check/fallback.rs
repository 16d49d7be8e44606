//! Checks of the fallback: a step with contact implicit in velocity replaces one in which
//! multipliers enforce contact at the positions of bodies with mass.

use super::super::{
    BodySpec, ContactLaw, ContactPoint, ContactSpec, Detection, Enforcement, Fallback, Method, SchemeSpec,
};
use super::Check;

impl Check<'_> {
    pub(super) fn fallback(&mut self) {
        let draft = self.draft;
        let Some(time) = draft.time.as_ref().filter(|time| time.fallback == Fallback::Velocity) else {
            return;
        };
        if let Some(why) = of_scheme(&time.scheme) {
            self.refuse(&format!("with scheme `{}`", time.scheme.kind), why, "leave out `fallback`");
            return;
        }
        for contact in draft.contact.iter().flatten() {
            for (what, why, help) in of_contact(contact) {
                self.refuse(&format!("with {what} of contact `{}`", contact.name), why, help);
            }
        }
        let light = |body: &&BodySpec| self.massless(body) || body.mass.is_redistributed();
        if let Some(body) = draft.body.iter().flatten().find(light) {
            let why = "the velocity of a node without mass does not follow from an impulse";
            let help = "give the body a density > 0 and mass = \"consistent\" or \"lumped\", or leave out `fallback`";
            self.refuse(&format!("with nodes without mass in body `{}`", body.name), why, help);
        }
    }

    fn refuse(&mut self, with: &str, why: &str, help: &str) {
        let what = format!("fallback = \"velocity\" cannot be used {with}");
        self.add_unique("time.fallback".to_owned(), what, why, help);
    }
}

fn of_scheme(scheme: &SchemeSpec) -> Option<&'static str> {
    if scheme.is_static() {
        Some("load steps have no velocities")
    } else if scheme.nonsmooth().is_some() {
        Some("its steps have their own contact law, without an active set that could fail")
    } else {
        None
    }
}

/// Properties of a contact with which the fallback step is not implemented; for each the key and
/// value, the reason, and a remedy.
fn of_contact(contact: &ContactSpec) -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    let is_of_the_paper = contact.xi == ContactPoint::Frozen || contact.detection == Detection::Trajectory;
    let all = [
        (
            contact.enforcement == Enforcement::Penalty,
            "enforcement = \"penalty\"",
            "the step constrains gaps, and would eject nodes that springs let penetrate",
            "use enforcement = \"multiplier\", or leave out `fallback`",
        ),
        (
            contact.enforcement == Enforcement::Augmented,
            "enforcement = \"augmented\"",
            "the step finds its impulses by a complementarity problem, not in rounds",
            "use enforcement = \"multiplier\", or leave out `fallback`",
        ),
        (
            contact.friction.exists(),
            "friction",
            "the step has normal impulses only, and a node that sticks would slip in it",
            "leave out the friction, or `fallback`",
        ),
        (
            contact.restitution != 0.0,
            "a restitution",
            "the step is inelastic: it would lose the energy that the restitution returns",
            "leave out the restitution, or `fallback`",
        ),
        (
            contact.law == Some(ContactLaw::Predictor),
            "law = \"predictor\"",
            "the step has no predictor to project",
            "use law = \"position\", or leave out `fallback`",
        ),
        (
            contact.method == Method::Mortar,
            "method = \"mortar\"",
            "the step finds impulses on single nodes",
            "use method = \"node-to-segment\", or leave out `fallback`",
        ),
        (
            is_of_the_paper,
            "detection = \"trajectory\"",
            "the step measures gaps at closest points, and the paper's method does not",
            "use detection = \"closest-point\", or leave out `fallback`",
        ),
    ];
    all.into_iter().filter(|(applies, ..)| *applies).map(|(_, what, why, help)| (what, why, help))
}
