//! What to try, by the keyword of the reason: one line per remedy, the most promising first.

use carom_case::{Case, Law};
use carom_record::{Advice, Source, StopPlace};

use super::change::{Change, Kind, Original};

/// Keyword of the energy guard, beside those of rejected steps.
pub(super) const GUARD: &str = "energy-guard";

/// Keyword of the audit.
pub(super) const AUDIT: &str = "audit";

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
const FINER: Remedy = (None, "a finer mesh there (`refine` of a polygon, or a mesh file), or a smaller load");
const INERTIA: Remedy = (
    Some(Kind::Inertia),
    "a scheme with inertia, here one that damps motion: beyond a limit load, and from a start far from equilibrium, \
     load steps find no equilibrium; t is then a time, which must be long enough for the motion to settle",
);
const OTHER_LAW: Remedy = (
    None,
    "another law, `neo-hookean` for example, where the body is compressed: the stress of `saint-venant-kirchhoff` \
     decreases again beyond a limit load (a bar at 0.58 of its length), which is a loss of stability of the law that \
     neither mesh nor step removes",
);
const ROUNDED: Remedy = (None, "a rounded corner there, or the other side as the primary one");
const DEGREE: Remedy = (None, "an element of lower degree (T3) there: its cells invert later");
const GUARD_OFF: Remedy = (
    None,
    "`time.energy_guard = false`, to inspect what the run does beyond this point; its results are then \
     unreliable",
);

/// The remedies of each reason.
const TABLE: &[(&str, &[Remedy])] = &[
    ("inverted-cell", &[INERTIA, OTHER_LAW, SHORTER, DAMPED, BATHE, FALLBACK, FINER, DEGREE]),
    ("contact-geometry", &[INERTIA, SHORTER, BATHE, PENALTY, FALLBACK, FINER, ROUNDED]),
    ("no-convergence", &[INERTIA, OTHER_LAW, SHORTER, FULL, PENALTY, MULTIPLIER, BATHE, FALLBACK, FINER]),
    ("active-set-cycle", &[INERTIA, SHORTER, PENALTY, BATHE, FALLBACK, FINER, ROUNDED]),
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
    (
        "no-value",
        &[(
            None,
            "a formula with a finite value up to the end of the run; for `mu` one that is not negative, as max(…, 0)",
        )],
    ),
    (
        "unconstrained-body",
        &[
            (None, "a [[support]] for the body, or its `move` in place of a force"),
            INERTIA,
            (None, "a larger `mu` or `shear` of a contact that is to hold it"),
        ],
    ),
    ("jump", &[(None, "a `move` that starts at the positions of its nodes")]),
    ("penetration", &[INERTIA, SHORTER, STIFFER, MULTIPLIER, PENALTY, BATHE, FALLBACK, FINER, ROUNDED]),
    ("unstable-step", &[SHORTER, BATHE, FINER]),
    ("not-finite", &[INERTIA, SHORTER, BATHE, FALLBACK, FINER]),
    (AUDIT, &[SHORTER, (None, "a report of this run to the authors: one of the two methods is wrong")]),
    (GUARD, &[PROJECT, LONGER, SHORTER, BATHE, DAMPED, SOFTER, FALLBACK, FINER, GUARD_OFF]),
];
/// The remedies of any other reason.
const OTHERWISE: &[Remedy] = &[INERTIA, SHORTER, BATHE, DAMPED, PENALTY, FALLBACK, FINER];

/// What to try after a stop at a contact or in a body, or anywhere, with the changes of the case.
pub(super) fn of(
    kind: &str,
    case: &Case,
    source: &Source,
    place: Option<&StopPlace>,
) -> Vec<(Advice, Option<Change>)> {
    let remedies = TABLE.iter().find(|(of, _)| *of == kind).map_or(OTHERWISE, |(_, remedies)| remedies);
    let original = Original::new(case, source);
    let contact = place.and_then(|place| place.contact.as_deref());
    let body = place.and_then(|place| place.body.as_deref().or(place.node.as_ref().map(|n| n.body.as_str())));
    let there = || case.bodies.iter().filter(|b| body.is_none_or(|body| body == b.name));
    let lowest = || there().all(|body| body.element.degree() == 1);
    let softens = there()
        .filter_map(|body| case.material(body))
        .any(|material| material.law == Law::SaintVenantKirchhoff);
    let advice = |&(change, what): &Remedy| {
        let of_contact = [LONGER.1, PROJECT.1, ROUNDED.1].contains(&what);
        if what == OTHER_LAW.1 && !softens
            || what == DEGREE.1 && lowest()
            || of_contact && case.contacts.is_empty()
        {
            return None;
        }
        let change = match change {
            Some(kind) => {
                original.sets(kind, contact)?;
                original.changed(kind, contact)
            }
            None => None,
        };
        let sets = change.as_ref().map_or_else(Vec::new, |change| change.sets.clone());
        Some((Advice { what: what.into(), sets, trial: None }, change))
    };
    remedies.iter().filter_map(advice).collect()
}
