//! Contacts: two different bodies, each pair once, mass where the projection needs it, laws that go
//! together and with the scheme.

use super::super::{ContactLaw, ContactSpec, Enforcement, Persistency, PrimarySpec};
use super::Check;

impl Check<'_> {
    /// Laws and ways to keep them that have no meaning together, or not with the scheme.
    fn law(&mut self, i: usize, contact: &ContactSpec) {
        let path = |key: &str| format!("contact[{i}].{key}");
        let (predictor, penalty) =
            (contact.law == Some(ContactLaw::Predictor), contact.enforcement == Enforcement::Penalty);
        let tables = self.tables("contact");
        let given = |key: &str| tables.get(i).and_then(|n| n.table()?.get(key)).is_some();
        if contact.persistency == Persistency::Project && given("persistency") && (predictor || penalty) {
            let by = if penalty { "enforcement = \"penalty\"" } else { "law = \"predictor\"" };
            let why = format!("with {by} nothing is left to project where contact begins");
            self.add(path("persistency"), "this projection has no meaning", why, "leave persistency out");
        }
        if !penalty && given("stiffness") {
            let why = "a multiplier keeps the constraint exactly; only enforcement = \"penalty\" has springs";
            self.add(
                path("stiffness"),
                "this stiffness has no meaning",
                why,
                "leave it out, or give enforcement = \"penalty\"",
            );
        }
        if !predictor {
            return;
        }
        if penalty {
            let why = "the predictor is projected on a constraint, and a spring is none";
            self.add(
                path("law"),
                "a penalty has no predictor to project",
                why,
                "law = \"position\", or enforcement = \"multiplier\"",
            );
        }
        if self.draft.contacts.iter().flatten().any(|other| other.law != contact.law) {
            let why =
                "the predictor is one of the whole system: it is projected for all contacts or for none";
            self.add(path("law"), "contacts have different laws", why, "give all contacts one law");
        }
        let Some(scheme) = self.draft.time.as_ref().map(|time| &time.scheme) else { return };
        if let Some(kernel) = scheme.kernel()
            && !kernel.has_predictor()
        {
            let what = format!("scheme `{}` has no predictor to project", scheme.kind);
            let why = "law = \"predictor\" replaces y + Δt v in Newmark's formula, and this scheme is of two steps, of several stages, or without inertia";
            self.add(
                path("law"),
                what,
                why,
                "law = \"position\", or a scheme such as energy-momentum or chung-hulbert",
            );
        }
    }

    pub(super) fn contacts(&mut self) {
        let contacts = &self.draft.contacts;
        for (i, contact) in contacts.iter().enumerate() {
            let Some(contact) = contact else { continue };
            self.law(i, contact);
            let path = |key: &str| format!("contact[{i}].{key}");
            let secondary = self.side(&contact.secondary, path("secondary"));
            let primary = match &contact.primary {
                PrimarySpec::Side(side) => {
                    let primary = self.side(side, path("primary"));
                    if let (Some(a), Some(b)) = (secondary, primary)
                        && a.name == b.name
                    {
                        let what =
                            format!("both sides of `{}` belong to the body `{}`", contact.name, a.name);
                        let why = "a body in contact with itself belongs to a later version of Carom";
                        self.add(path("primary"), what, why, "name a side of another body");
                        continue;
                    }
                    primary
                }
                PrimarySpec::Plane { normal, .. } => {
                    if normal.iter().all(|n| *n == 0.0) {
                        let why = "it points out of the half-space, so it must have a length > 0";
                        self.add(
                            path("primary.plane.normal"),
                            "the normal is zero",
                            why,
                            "write for example normal = [0.0, 1.0]",
                        );
                    }
                    None
                }
            };
            let rigid = matches!(contact.primary, PrimarySpec::Plane { .. });
            if let Some(body) = secondary
                && self.massless(body)
                && (rigid || primary.is_some_and(|p| self.massless(p)))
                && contact.persistency == Persistency::Project
            {
                let what = format!("nothing that touches in `{}` has mass", contact.name);
                let why = "persistency = \"project\" projects velocities with the mass matrix, and a contact between massless \
                           nodes has no row in it";
                self.add(
                    path("secondary"),
                    what,
                    why,
                    format!("give contact `{}` persistency = \"none\"", contact.name),
                );
            }
            if let Some(j) =
                contacts[..i].iter().position(|c| c.as_ref().is_some_and(|c| same_pair(c, contact)))
            {
                let what = "these two sides are a contact already";
                let why = format!("contact number {} has the same pair; each would add its own force", j + 1);
                self.add(path("secondary"), what, why, "leave one of them out");
            }
        }
    }
}

/// The same sides, either way round.
fn same_pair(a: &ContactSpec, b: &ContactSpec) -> bool {
    let swapped = |a: &ContactSpec, b: &ContactSpec| a.primary == PrimarySpec::Side(b.secondary.clone());
    a.secondary == b.secondary && a.primary == b.primary || swapped(a, b) && swapped(b, a)
}
