//! Checks of contacts: two different bodies, each pair once, mass where the projection needs it,
//! laws that are compatible with each other and with the scheme, and what a frozen ξ needs.

use carom_solid::Element;

use super::super::spec::SKIN;
use super::super::{
    ContactLaw, ContactPoint, ContactSpec, Detection, Enforcement, Method, ObstacleMotion, Overlap,
    Persistency, PrimarySpec, Quadrature,
};
use super::{Check, Node};

impl Check<'_> {
    /// Reports contact laws and enforcements that cannot be combined with each other or with the
    /// scheme.
    fn law(&mut self, contact: &ContactSpec) {
        let path = |key: &str| contact.path(key);
        let predictor = contact.law == Some(ContactLaw::Predictor);
        let penalty = contact.enforcement == Enforcement::Penalty;
        let multiplier = contact.enforcement == Enforcement::Multiplier;
        let given = |key: &str| self.given("contact", contact.entry, key).is_some();
        let given_persistency = given("persistency");
        let given_stiffness = given("stiffness");
        if contact.persistency == Persistency::Project && given_persistency && (predictor || penalty) {
            let by = if penalty { "enforcement = \"penalty\"" } else { "law = \"predictor\"" };
            let why = format!("with {by} there is nothing to project where contact begins");
            let what = "persistency = \"project\" cannot be used here";
            self.add(path("persistency"), what, why, "leave persistency out");
        }
        if multiplier && given_stiffness {
            let why = "a multiplier enforces the constraint exactly; only \"penalty\" and \"augmented\" have a stiffness";
            self.add(
                path("stiffness"),
                "`stiffness` is given without springs",
                why,
                "leave it out, or give enforcement = \"penalty\" or \"augmented\"",
            );
        }
        if !predictor {
            return;
        }
        let springs = match contact.enforcement {
            Enforcement::Multiplier => None,
            Enforcement::Penalty => {
                let why =
                    "the predictor is projected onto constraints, and a penalty spring is not a constraint";
                Some(("a penalty", why))
            }
            Enforcement::Augmented => {
                let why = "the predictor is projected in a problem of masses alone, which needs no springs";
                Some(("an augmented Lagrangian", why))
            }
        };
        if let Some((springs, why)) = springs {
            let what = format!("law = \"predictor\" cannot be used with {springs}");
            let help = "use law = \"position\", or enforcement = \"multiplier\"";
            self.add(path("law"), what, why, help);
        }
        if self.draft.contact.iter().flatten().any(|other| other.law != contact.law) {
            let why =
                "the predictor belongs to the whole system, so it is projected for all contacts or for none";
            self.add(path("law"), "the contacts have different laws", why, "give all contacts the same law");
        }
        let Some(scheme) = self.scheme() else { return };
        if let Some(kernel) = scheme.kernel()
            && !kernel.has_predictor()
        {
            let what = format!("scheme `{}` has no predictor to project", scheme.kind);
            let why = "law = \"predictor\" replaces y + Δt v in Newmark's formula, and this scheme has two steps, several stages or no inertia";
            self.add(
                path("law"),
                what,
                why,
                "use law = \"position\", or a scheme such as energy-momentum or chung-hulbert",
            );
        }
    }

    /// Checks what `xi = "frozen"` needs: a deformable primary side that is not a point, `detection
    /// = "trajectory"`, an enforcement without penalty springs, and a scheme of the generalised-α
    /// family without `law = "predictor"`.
    fn frozen_point(&mut self, contact: &ContactSpec) {
        if contact.xi != ContactPoint::Frozen {
            return;
        }
        let draft = self.draft;
        let scheme = self.scheme();
        let mut add = |what: &str, why: &str, hint: &str| {
            self.add(contact.path("xi"), format!("xi = \"frozen\" cannot be used {what}"), why, hint);
        };
        if contact.primary.side().is_none() {
            let why = "ξ is a place on a facet of a deformable body, and an obstacle has none";
            add("with a rigid obstacle", why, "leave xi out");
        }
        if draft.dimension == Some(1) {
            add("in dimension 1", "the primary side is a point, which has no ξ", "leave xi out");
        }
        if contact.detection != Detection::Trajectory {
            let why =
                "the ξ that is frozen in the first step of a contact is that of the trajectory crossing";
            add("with this detection", why, "give detection = \"trajectory\", or xi = \"closest\"");
        }
        if contact.enforcement == Enforcement::Penalty {
            let why = "ξ changes at the start of every step, and the energy of a spring would change with it";
            add("with a penalty", why, "give enforcement = \"multiplier\", or xi = \"closest\"");
        }
        let scheme = scheme.filter(|scheme| !scheme.is_alpha());
        let what = match scheme {
            _ if contact.law == Some(ContactLaw::Predictor) => "with law = \"predictor\"",
            Some(scheme) => &format!("with scheme `{}`", scheme.kind),
            None => return,
        };
        let why = "it is the paper's method: ξ is constant during the single solve of a step of the generalised-α \
             family";
        let hint = "use a scheme such as chung-hulbert with law = \"position\", or xi = \"closest\"";
        add(what, why, hint);
    }

    /// Reports what mortar contact does not have: other dimensions than the plane, schemes and laws
    /// with impulses, and the detection of the paper.
    fn mortar(&mut self, contact: &ContactSpec) {
        if contact.method != Method::Mortar {
            if contact.quadrature != Quadrature::Segments {
                let why = "gaps of single nodes are not integrated";
                let hint = "use method = \"mortar\", or leave `quadrature` out";
                let what = "quadrature cannot be given with this method";
                self.add_unique(contact.path("quadrature"), what, why, hint);
            }
            return;
        }
        let draft = self.draft;
        let scheme = self.scheme();
        let mut refuse = |what: &str, why: &str, hint: &str| {
            let what = format!("method = \"mortar\" cannot be used {what}");
            self.add_unique(contact.path("method"), what, why, hint);
        };
        let nodes = "use method = \"node-to-segment\"";
        if let Some(dimension @ (1 | 3)) = draft.dimension {
            let why = "its weights are integrals over curves in the plane";
            refuse(&format!("in dimension {dimension}"), why, nodes);
        }
        if contact.detection == Detection::Trajectory || contact.xi == ContactPoint::Frozen {
            let why = "trajectories of single nodes do not decide about a gap that is an average";
            refuse("with the detection of the paper", why, "leave `detection` and `xi` out");
        }
        let linear = |body: &&str| {
            let of = draft.body.iter().flatten().find(|of| of.name == **body);
            of.is_some_and(|of| matches!(of.element, Element::T3 | Element::Q4))
        };
        if contact.overlap == Overlap::Relax && contact.bodies().any(|body| linear(&body)) {
            let why = "the share of straight cells in the overlap of curved sides is not known on average";
            let hint = "use elements of higher degree, or method = \"node-to-segment\"";
            refuse("with overlap = \"relax\" and straight cells", why, hint);
        }
        if let Some(scheme) = scheme.filter(|scheme| scheme.nonsmooth().is_some()) {
            let why = "its steps solve for impulses on single nodes";
            let hint = "use an implicit scheme such as chung-hulbert, or method = \"node-to-segment\"";
            refuse(&format!("with scheme `{}`", scheme.kind), why, hint);
        } else if contact.law == Some(ContactLaw::Predictor) {
            let why = "the predictor is projected onto the gaps of single nodes";
            refuse("with law = \"predictor\"", why, "use law = \"position\"");
        }
    }

    /// Refuses `detection = "trajectory"` in dimension 3.
    fn in_space(&mut self, contact: &ContactSpec) {
        if self.draft.dimension == Some(3) && contact.detection == Detection::Trajectory {
            let what = "detection = \"trajectory\" cannot be used in dimension 3";
            let why = "it is the method of the paper, for the plane";
            self.add_unique(contact.path("detection"), what, why, "leave it out");
        }
    }

    /// Checks contact of a side with itself: it needs dimension 2 or 3, and a detection other than
    /// "trajectory".
    fn itself(&mut self, contact: &ContactSpec) {
        if !contact.is_of_itself() {
            return;
        }
        if self.draft.dimension == Some(1) {
            let what = format!("the side `{}` cannot be in contact with itself", contact.secondary);
            let why = "the case has dimension = 1, and the end of a bar is a point";
            self.add(contact.path("primary"), what, why, "give a side of another body");
        }
        if contact.detection == Detection::Trajectory {
            let what = "detection = \"trajectory\" cannot be used for contact of a side with itself";
            let why = "it checks the nodes of one side only, and here both are the same";
            self.add_unique(contact.path("detection"), what, why, "leave it out");
        }
    }

    /// Reports the key `self` of a contact without `between`.
    fn of_between(&mut self, contact: &ContactSpec) {
        if !contact.between && self.given("contact", contact.entry, "self").is_some() {
            let why = "it says whether the bodies of `between` are in contact with themselves";
            self.add(contact.path("self"), "`self` needs `between`", why, "leave it out");
        }
    }

    /// Checks a rigid obstacle that moves: a free one needs a scheme with inertia, and no body or
    /// support may have the name of its contact, which begins the names of its columns.
    fn obstacle(&mut self, contact: &ContactSpec) {
        if is_free(contact) && self.is_static() {
            let why = "the scheme \"static\" has no inertia, and nothing else constrains a free obstacle";
            let help = "give it a `motion`, or use a scheme with inertia";
            self.add(contact.path("primary.mass"), "the obstacle has no equilibrium", why, help);
        }
        let draft = self.draft;
        let bodies = draft.body.iter().flatten().map(|body| ("body", &body.name));
        let supports = draft.support.iter().flatten();
        let supports = supports.filter_map(|support| Some(("support", support.name.as_ref()?)));
        let mut taken = bodies.chain(supports).filter(|_| !contact.motion.is_fixed());
        if let Some((kind, _)) = taken.find(|(_, name)| **name == contact.name) {
            let what =
                format!("a {kind} and a contact with a moving obstacle are both named `{}`", contact.name);
            let why = "the columns of a moving obstacle have the name of its contact";
            self.add(contact.path("name"), what, why, "rename one of them");
        }
    }

    /// Path of the entry of `between` that names a side or its body; none if the contact has no
    /// such list.
    fn entry_of_between(&self, contact: &ContactSpec, side: &str) -> Option<String> {
        let list = self.given("contact", contact.entry, "between")?.list()?;
        let is = |node: &Node| {
            let name = node.text().unwrap_or_default();
            name == side || side.strip_suffix(SKIN).and_then(|body| body.strip_suffix('.')) == Some(name)
        };
        Some(format!("contact[{}].between[{}]", contact.entry, list.iter().position(is)?))
    }

    pub(super) fn contacts(&mut self) {
        let contacts = &self.draft.contact;
        for (i, contact) in contacts.iter().enumerate() {
            let Some(contact) = contact else { continue };
            let entry = |side: &str| self.entry_of_between(contact, side);
            let of_secondary = entry(&contact.secondary);
            let of_primary = contact.primary.side().and_then(entry);
            let path = |key: &str| {
                let entry = if key == "primary" { &of_primary } else { &of_secondary };
                let of_side = key == "secondary" || key == "primary";
                entry.as_ref().filter(|_| of_side).map_or_else(|| contact.path(key), ToOwned::to_owned)
            };
            let earlier = || contacts[..i].iter().flatten();
            if contact.between && self.draft.dimension == Some(1) {
                let why = "a body of dimension 1 has no boundary but its two ends";
                let help = "give `secondary` and `primary`";
                self.add_unique(path("between"), "`between` needs dimension = 2", why, help);
                continue;
            }
            if contact.between
                && earlier().any(|other| other.name == contact.name && other.entry != contact.entry)
            {
                let what = format!("two contacts are named `{}`", contact.name);
                let why = "contacts of `between` are named NAME-BODY-BODY, and names must be unique";
                self.add_unique(path("name"), what, why, "rename one of the tables");
            }
            self.in_space(contact);
            // What follows from other keys is the same for all contacts of a table.
            if !earlier().any(|other| other.entry == contact.entry) {
                self.law(contact);
                self.frozen_point(contact);
                self.mortar(contact);
                self.friction(contact);
                self.of_between(contact);
            }
            let secondary = self.side(&contact.secondary, path("secondary"));
            let primary = match &contact.primary {
                PrimarySpec::Side(side) => {
                    let primary = self.side(side, path("primary"));
                    if let (Some(a), Some(b)) = (secondary, primary)
                        && a.name == b.name
                        && !contact.is_of_itself()
                    {
                        let what =
                            format!("both sides of `{}` belong to the body `{}`", contact.name, a.name);
                        let why = "in contact of a body with itself each place may be secondary or primary, so both sides are the same";
                        let help = format!(
                            "give `{0}.{SKIN}`, its whole boundary, for both, or between = [\"{0}\"]",
                            a.name
                        );
                        self.add(path("primary"), what, why, help);
                        continue;
                    }
                    primary
                }
                PrimarySpec::Cylinder { axis, .. } if axis.iter().all(|a| *a == 0.0) => {
                    let why = "it is the direction of the cylinder, so its length must be > 0";
                    let help = "write for example axis = [0.0, 0.0, 1.0]";
                    self.add(path("primary.cylinder.axis"), "the axis is zero", why, help);
                    None
                }
                PrimarySpec::Plane { normal, .. } if normal.iter().all(|n| *n == 0.0) => {
                    let why = "it is the direction out of the half-space, so its length must be > 0";
                    let help = format!("write for example normal = {}", upward(normal.len()));
                    self.add(path("primary.plane.normal"), "the normal is zero", why, help);
                    None
                }
                _ => None,
            };
            self.obstacle(contact);
            self.itself(contact);
            let rigid = contact.primary.side().is_none() && !is_free(contact);
            if let Some(body) = secondary
                && self.massless(body)
                && (rigid || primary.is_some_and(|p| self.massless(p)))
                && contact.persistency == Persistency::Project
                && !self.is_static()
            {
                let what = format!("no node in contact `{}` has mass", contact.name);
                let why = "persistency = \"project\" projects velocities with the mass matrix, which is zero for these nodes";
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
                let what = "this pair of sides is already a contact";
                let why =
                    format!("contact number {} has the same pair, and each would add its own force", j + 1);
                self.add(path("secondary"), what, why, "leave one of them out");
            }
        }
    }
}

fn is_free(contact: &ContactSpec) -> bool {
    matches!(contact.motion, ObstacleMotion::Free { .. })
}

/// Whether two contacts have the same pair of sides, in either order.
fn same_pair(a: &ContactSpec, b: &ContactSpec) -> bool {
    let swapped = |a: &ContactSpec, b: &ContactSpec| a.primary == PrimarySpec::Side(b.secondary.clone());
    a.secondary == b.secondary && a.primary == b.primary || swapped(a, b) && swapped(b, a)
}

/// TOML of the unit vector along the last axis in a space of this dimension.
fn upward(dimension: usize) -> &'static str {
    ["[1.0]", "[0.0, 1.0]", "[0.0, 0.0, 1.0]"][dimension.clamp(1, 3) - 1]
}
