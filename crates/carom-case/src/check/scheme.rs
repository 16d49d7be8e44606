//! Requirements of a scheme on masses, supports and contacts.

use carom_time::Nonsmooth;

use super::super::{ContactLaw, MassKind, ObstacleMotion, SchemeSpec};
use super::Check;

impl Check<'_> {
    pub(super) fn requirements_of_scheme(&mut self) {
        let draft = self.draft;
        let Some(spec) = self.scheme() else { return };
        if let Some(scheme) = spec.nonsmooth() {
            self.masses(spec);
            self.nothing_moves(spec);
            self.rules_of_stages(spec);
            if matches!(scheme, Nonsmooth::Explicit(scheme) if !scheme.restitution) {
                let why = "its contact force only prevents penetration at the next positions";
                self.no_restitution(spec, why);
            }
        } else if spec.conserves() {
            self.conserving_restitution(spec);
        } else if spec.integrator().is_ok() {
            self.no_restitution(spec, "its contact law constrains positions at the end of a step");
        }
        for contact in draft.contact.iter().flatten() {
            let Some(law) = contact.law.filter(|law| *law != spec.contact_law()) else { continue };
            if law == ContactLaw::Predictor && spec.nonsmooth().is_none() {
                // Whether an implicit scheme has a predictor is checked with the contacts.
                continue;
            }
            let (what, why, help) = match law {
                ContactLaw::Velocity => (
                    "law = \"velocity\" constrains velocities by impulses",
                    format!("the unknowns of {} are positions and forces", spec.kind),
                    "leave law out, or use scheme moreau-jean or nonsmooth-generalized-alpha",
                ),
                ContactLaw::Predictor => (
                    "this scheme has no predictor to project",
                    format!("{} has its own rule for contact", spec.kind),
                    "leave law out, or use a scheme such as energy-momentum or chung-hulbert",
                ),
                ContactLaw::Position => (
                    "law = \"position\" constrains positions",
                    format!("the unknowns of {} are velocities and impulses", spec.kind),
                    "leave law out, or use another scheme (carom explain lists them)",
                ),
            };
            self.add_unique(contact.path("law"), what, why, help);
        }
    }

    /// Reports bodies with nodes without mass, and consistent masses under an explicit scheme.
    fn masses(&mut self, spec: &SchemeSpec) {
        for (i, body) in self.draft.body.iter().enumerate() {
            let Some(body) = body else { continue };
            if self.massless(body) {
                let what = format!("body `{}` has no mass, and {} divides by it", body.name, spec.kind);
                let why = "it computes velocities from forces or impulses divided by the mass of each node";
                self.add(
                    format!("body[{i}].material"),
                    what,
                    why,
                    "give a density > 0, or use an implicit scheme of the α family",
                );
            } else if body.mass.is_redistributed() {
                let what =
                    format!("body `{}` has nodes without mass, and {} divides by it", body.name, spec.kind);
                let why = "it computes velocities from forces or impulses divided by the mass of each node";
                self.add(format!("body[{i}].mass"), what, why, "use mass = \"lumped\"");
            } else if spec.is_explicit() && body.mass == MassKind::Consistent {
                let what = format!(
                    "{} needs a lumped mass, but that of body `{}` is consistent",
                    spec.kind, body.name
                );
                let why = "an explicit step divides each force by the mass of its node; a consistent mass couples the nodes and would \
                           require solving a linear system in every step";
                let key = if self.given("body", i, "mass").is_some() { ".mass" } else { "" };
                let path = format!("body[{i}]{key}");
                self.add(path, what, why, format!("give body `{}` mass = \"lumped\"", body.name));
            }
        }
    }

    /// Reports supports and obstacles with prescribed motion, which the scheme does not implement.
    fn nothing_moves(&mut self, spec: &SchemeSpec) {
        let draft = self.draft;
        let supports = draft.support.iter().enumerate();
        let moved = supports.filter(|(_, support)| support.as_ref().is_some_and(|s| !s.moves.is_empty()));
        let supports = moved.map(|(i, _)| {
            let help =
                "fix the side, apply a [[load]] instead, or use an implicit scheme such as chung-hulbert";
            ("moving supports are", "support", format!("support[{i}].move"), help)
        });
        let contacts = draft.contact.iter().flatten();
        let moved = contacts.filter(|c| matches!(c.motion, ObstacleMotion::Prescribed { .. }));
        let obstacles = moved.map(|contact| {
            let help = "leave out `motion` and give the bodies the opposite velocity, or use an implicit \
                        scheme such as chung-hulbert";
            ("moving obstacles are", "obstacle", contact.path("primary"), help)
        });
        let manufactured = self.document.root().get("manufactured").map(|_| {
            let help = "use an implicit scheme such as chung-hulbert";
            ("a boundary that moves is", "support", "manufactured".to_owned(), help)
        });
        for (many, one, path, help) in supports.chain(obstacles).chain(manufactured).collect::<Vec<_>>() {
            let what = format!("{many} not available with {}", spec.kind);
            let why = format!(
                "the work and the impulse of a moving {one} are not implemented for explicit schemes and those with impulses"
            );
            self.add(path, what, why, help);
        }
    }

    /// Reports keys about averages and projections that do not apply to the scheme.
    fn rules_of_stages(&mut self, spec: &SchemeSpec) {
        for (i, contact) in self.tables("contact").iter().enumerate() {
            let word = |key| contact.table().and_then(|t| t.get(key)?.text());
            if word("force") == Some("end") {
                let why = format!(
                    "{} does not average contact forces: a step has one force or one impulse",
                    spec.kind
                );
                self.add(
                    format!("contact[{i}].force"),
                    "force = \"end\" cannot be used with this scheme",
                    why,
                    "leave it out",
                );
            }
            if let Some(enforcement @ ("penalty" | "augmented")) = word("enforcement") {
                let why = format!(
                    "{} has its own rule for contact, with forces or impulses instead of springs",
                    spec.kind
                );
                let what = format!("enforcement = \"{enforcement}\" cannot be used with this scheme");
                self.add(format!("contact[{i}].enforcement"), what, why, "leave it out");
            }
            if word("persistency") == Some("project") {
                let why = format!("{} has its own rule for velocities where contact begins", spec.kind);
                let what = "persistency = \"project\" cannot be used with this scheme";
                self.add(format!("contact[{i}].persistency"), what, why, "leave it out, or use \"none\"");
            }
        }
    }

    fn no_restitution(&mut self, spec: &SchemeSpec, why: &str) {
        for contact in self.draft.contact.iter().flatten() {
            let e = contact.restitution;
            if e != 0.0 {
                let what = format!("{} has no restitution, but e = {e} is given", spec.kind);
                let help = "leave restitution out, or use scheme energy-momentum, moreau-jean, nonsmooth-generalized-alpha or paoli-schatzman";
                // Another value would not be accepted either.
                let path = contact.path("restitution");
                self.problems.retain(|problem| problem.path != path);
                self.add_unique(path, what, why, help);
            }
        }
    }
}
