//! Remedies by the keyword of the reason: one line per remedy, the most promising first. A
//! remedy that does not fit the case is left out, and one that depends on it names what the case
//! has: its elements, its friction.

use std::collections::BTreeSet;

use carom_case::{BodySpec, Case, ContactSpec, FormulaSpec, Law, MeshSpec};
use carom_record::{Advice, Source, StopPlace};

use super::change::{Kind, Original, quoted};

/// Keyword of the energy guard, beside those of rejected steps.
pub(super) const GUARD: &str = "energy-guard";

/// A remedy: the change that makes it, if the program can make it, and in words.
type Remedy = (Option<Kind>, &'static str);

const SHORTER: Remedy = (Some(Kind::Shorter), "a shorter step from the start");
const LONGER: Remedy = (
    Some(Kind::Longer),
    "a longer step: energy is created where nodes come into contact, less often with longer steps",
);
const DAMPED: Remedy = (Some(Kind::Damped), "more damping of high frequencies by the same scheme");
const BATHE: Remedy = (Some(Kind::Bathe), "a scheme that dissipates what the mesh does not resolve");
const PENALTY: Remedy = (Some(Kind::Penalty), "penalty springs, which have no active set that must converge");
const AUGMENTED: Remedy =
    (Some(Kind::Augmented), "an augmented Lagrangian, with which contacts may depend on each other");
const MULTIPLIER: Remedy = (Some(Kind::Multiplier), "multipliers, which prevent penetration exactly");
const STIFFER: Remedy = (Some(Kind::Stiffer), "stiffer springs");
const SOFTER: Remedy = (Some(Kind::Softer), "softer springs, which a step resolves better");
const PROJECT: Remedy = (
    Some(Kind::Project),
    "velocities that are projected where contact begins, so that this creates no energy",
);
const FULL: Remedy = (Some(Kind::Full), "a new tangent in every iteration");
const FALLBACK: Remedy = (
    Some(Kind::Fallback),
    "another scheme for the steps at which the run would stop: backward Euler with contact implicit in velocity, \
     which dissipates energy in them",
);
const FINER: Remedy = (None, "a finer mesh there");
const INERTIA: Remedy = (
    Some(Kind::Inertia),
    "a scheme with inertia, here one that damps motion: beyond a limit load load steps find no equilibrium; t is then a time, which must be long enough for the motion to settle",
);
const OTHER_LAW: Remedy = (
    None,
    "another law, `neo-hookean` for example, where the body is compressed: the stress of `saint-venant-kirchhoff` \
     decreases again beyond a limit load (a bar at 0.58 of its length), which is a loss of stability of the law that \
     neither mesh nor step removes",
);
const ROUNDED: Remedy = (None, "a rounded corner there");
const DEGREE: Remedy = (None, "an element of lower degree there: its cells invert later");
const FRICTION: Remedy = (None, "friction of a contact that is to hold it");
const MU: Remedy = (None, "for `mu` a formula that is not negative, as max(…, 0)");
const GUARD_OFF: Remedy = (
    None,
    "`time.energy_guard = false`, to inspect what the run does beyond this point; its results are then \
     unreliable",
);

/// The remedies of each reason.
const TABLE: &[(&str, &[Remedy])] = &[
    ("inverted-cell", &[INERTIA, OTHER_LAW, DAMPED, BATHE, FALLBACK, FINER, DEGREE, SHORTER]),
    ("contact-geometry", &[INERTIA, SHORTER, BATHE, PENALTY, FALLBACK, FINER, ROUNDED]),
    (
        "no-convergence",
        &[INERTIA, OTHER_LAW, AUGMENTED, SHORTER, FULL, PENALTY, MULTIPLIER, BATHE, FALLBACK, FINER],
    ),
    ("active-set-cycle", &[INERTIA, AUGMENTED, SHORTER, PENALTY, BATHE, FALLBACK, FINER, ROUNDED]),
    (
        "linear-solver",
        &[
            INERTIA,
            SHORTER,
            FULL,
            PENALTY,
            (None, "supports that prevent every rigid motion, and no part of zero stiffness"),
        ],
    ),
    (
        "overconstrained-contact",
        &[
            (
                None,
                "supports that do not constrain the nodes of the contact, or contact sides without the \
                 supported nodes",
            ),
            PENALTY,
        ],
    ),
    ("negative-mass", &[(None, "`mass = \"consistent\"` or `\"lumped\"`, or more cells behind the contact")]),
    ("no-value", &[(None, "a formula with a finite value up to the end of the run"), MU]),
    (
        "unconstrained-body",
        &[(None, "a [[support]] for the body, or its `move` in place of a force"), INERTIA, FRICTION],
    ),
    ("jump", &[(None, "a `move` that starts at the positions of its nodes")]),
    ("penetration", &[INERTIA, PENALTY, MULTIPLIER, BATHE, FALLBACK, FINER, ROUNDED, STIFFER, SHORTER]),
    ("unstable-step", &[SHORTER, BATHE]),
    ("not-finite", &[INERTIA, SHORTER, BATHE, FALLBACK, FINER]),
    (GUARD, &[PROJECT, BATHE, DAMPED, LONGER, SOFTER, FALLBACK, FINER, SHORTER, GUARD_OFF]),
];
/// The remedies of any other reason.
const OTHERWISE: &[Remedy] = &[INERTIA, SHORTER, BATHE, DAMPED, PENALTY, FALLBACK, FINER];

/// Remedies for a stop of this `kind`, at a contact or in a body, or anywhere.
pub(in crate::recording) fn advice(
    kind: &str,
    case: &Case,
    source: &Source,
    place: Option<&StopPlace>,
) -> Vec<Advice> {
    let remedies = TABLE.iter().find(|(of, _)| *of == kind).map_or(OTHERWISE, |(_, remedies)| remedies);
    let mut remedies: Vec<&Remedy> = remedies.iter().collect();
    if case.time.scheme.is_explicit() {
        // An explicit step that is too long may end in any of these ways.
        remedies.sort_by_key(|remedy| **remedy != SHORTER);
    }
    let original = Original::new(case, source);
    let contact = place.and_then(|place| place.contact.as_deref());
    let there = There::new(&original, case, place);
    let advice = |&&(change, what): &&Remedy| {
        let what = there.words(what)?;
        let sets = match change {
            Some(kind) => {
                let sets = original.accepted(original.sets(kind, contact)?);
                // Some contacts have no fallback at all.
                if kind == Kind::Fallback && sets.is_empty() && original.is_known() {
                    return None;
                }
                sets
            }
            None => Vec::new(),
        };
        Some(Advice { what, sets })
    };
    remedies.iter().filter_map(advice).collect()
}

/// The bodies and contacts at the place of a stop: all of the case if it has none.
struct There<'a> {
    original: &'a Original<'a>,
    case: &'a Case,
    bodies: Vec<&'a BodySpec>,
    contacts: Vec<&'a ContactSpec>,
}

impl<'a> There<'a> {
    fn new(original: &'a Original, case: &'a Case, place: Option<&StopPlace>) -> Self {
        let contact = place.and_then(|place| place.contact.as_deref());
        let body =
            place.and_then(|place| place.body.as_deref().or(place.node.as_ref().map(|n| n.body.as_str())));
        let is_at = |of: &&ContactSpec| match contact {
            Some(name) => of.name == name,
            None => body.is_none_or(|body| of.bodies().any(|name| name == body)),
        };
        Self {
            original,
            case,
            bodies: case.bodies.iter().filter(|b| body.is_none_or(|body| body == b.name)).collect(),
            contacts: case.contacts.iter().filter(is_at).collect(),
        }
    }

    /// A remedy in the words of the case; none if the case has not what it changes.
    fn words(&self, what: &str) -> Option<String> {
        let has_contact = !self.case.contacts.is_empty();
        let more = |words: &str| Some(format!("{what}{words}"));
        if what == OTHER_LAW.1 {
            return self.has_law(Law::SaintVenantKirchhoff).then(|| what.to_owned());
        }
        if what == LONGER.1 || what == PROJECT.1 {
            return has_contact.then(|| what.to_owned());
        }
        if what == ROUNDED.1 {
            let may_be_swapped =
                self.contacts.iter().any(|c| c.primary.side().is_some() && !c.is_of_itself());
            let other = if may_be_swapped { ", or the other side as the primary one" } else { "" };
            return has_contact.then(|| format!("{what}{other}"));
        }
        if what == FINER.1 {
            let refines =
                self.bodies.iter().any(|body| matches!(body.mesh.source(), MeshSpec::Polygon { .. }));
            let how = if refines { " (`refine` of the polygon)" } else { "" };
            let stable = if self.case.time.scheme.is_explicit() {
                ", with a step that is shorter by the same factor"
            } else {
                ""
            };
            let less = if self.case.loads.is_empty() { "" } else { ", or a smaller load" };
            return more(&format!("{how}{stable}{less}"));
        }
        if what == DEGREE.1 {
            let lower = self.lower_elements()?;
            return Some(what.replacen("degree", &format!("degree ({lower})"), 1));
        }
        if what == FRICTION.1 {
            let rubs = self.contacts.iter().any(|contact| contact.friction.exists());
            let words = if rubs { "larger friction (`mu` or `shear`)" } else { "friction (`mu`)" };
            return (!self.contacts.is_empty()).then(|| what.replacen("friction", words, 1));
        }
        if what == MU.1 {
            let varies = |c: &&ContactSpec| matches!(c.friction.mu, Some(FormulaSpec::Text(_)));
            return self.case.contacts.iter().any(|c| varies(&c)).then(|| what.to_owned());
        }
        Some(what.to_owned())
    }

    fn has_law(&self, law: Law) -> bool {
        let mut materials = self.bodies.iter().flat_map(|body| self.case.materials_of(body));
        materials.any(|material| material.law == law)
    }

    /// Elements of degree 1 in place of those of higher degree, of bodies that can have them: cells
    /// that would lock are refused.
    fn lower_elements(&self) -> Option<String> {
        let higher = self.bodies.iter().filter(|body| body.element.degree() > 1);
        let lower = higher.filter_map(|body| {
            let element = format!("{:?}", body.element.with_degree(1)?);
            self.original
                .permits(&format!("body.{}.element={element}", quoted(&body.name)))
                .then_some(element)
        });
        let lower: BTreeSet<String> = lower.collect();
        (!lower.is_empty()).then(|| lower.into_iter().collect::<Vec<_>>().join(", "))
    }
}
