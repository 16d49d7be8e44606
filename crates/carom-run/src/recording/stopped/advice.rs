//! What to try, by the keyword of the reason: one line per remedy, the most promising first.

use carom_case::Case;
use carom_record::Advice;

use super::change::{Change, Kind};

/// Keyword of the energy guard, beside those of rejected steps.
pub(super) const GUARD: &str = "energy-guard";

/// A remedy: the change that makes it, if the program can make it, and in words.
type Remedy = (Option<Kind>, &'static str);

const SHORTER: Remedy = (Some(Kind::Shorter), "a shorter step from the start");
const LONGER: Remedy = (
    Some(Kind::Longer),
    "a longer step: contact creates energy where nodes begin to touch, the less often the longer the step",
);
const DAMPED: Remedy = (Some(Kind::Damped), "more damping of high frequencies by the same scheme");
const BATHE: Remedy = (Some(Kind::Bathe), "a scheme that dissipates what the mesh does not resolve");
const PENALTY: Remedy = (Some(Kind::Penalty), "penalty springs, which have no active set that must settle");
const MULTIPLIER: Remedy = (Some(Kind::Multiplier), "multipliers, which prevent penetration exactly");
const STIFFER: Remedy = (Some(Kind::Stiffer), "stiffer springs");
const SOFTER: Remedy = (Some(Kind::Softer), "softer springs, which a step resolves better");
const PROJECT: Remedy =
    (Some(Kind::Project), "velocities that are projected where contact begins, so that it creates no energy");
const FULL: Remedy = (Some(Kind::Full), "a new tangent in every iteration");
const FINER: Remedy =
    (None, "a finer mesh at the place (`refine` of a polygon, or a mesh file), or a smaller load");
const ROUNDED: Remedy = (None, "a rounded corner at the place, or the other side as the primary one");
const DEGREE: Remedy = (None, "an element of lower degree (T3) at the place: its cells invert later");
const GUARD_OFF: Remedy = (
    None,
    "`time.energy_guard = false`, to inspect what the run does beyond this point; its results are then suspect",
);

/// The remedies of each reason.
const TABLE: &[(&str, &[Remedy])] = &[
    ("inverted-cell", &[SHORTER, DAMPED, BATHE, FINER, DEGREE]),
    ("contact-geometry", &[SHORTER, BATHE, PENALTY, FINER, ROUNDED]),
    ("no-convergence", &[SHORTER, FULL, PENALTY, MULTIPLIER, BATHE, FINER]),
    ("active-set-cycle", &[SHORTER, PENALTY, BATHE, FINER, ROUNDED]),
    (
        "linear-solver",
        &[
            SHORTER,
            FULL,
            PENALTY,
            (None, "supports that leave no rigid motion, and no part of zero stiffness"),
        ],
    ),
    (
        "overconstrained-contact",
        &[
            (
                None,
                "supports that do not hold the nodes of the contact, or a contact without the nodes that are held",
            ),
            PENALTY,
        ],
    ),
    ("negative-mass", &[(None, "`mass = \"consistent\"` or `\"lumped\"`, or more cells behind the contact")]),
    ("no-value", &[(None, "a formula with a finite value up to the end of the run")]),
    ("unconstrained-body", &[(None, "a support for the body, or a scheme with inertia")]),
    ("jump", &[(None, "a `move` that begins where its nodes are")]),
    ("penetration", &[SHORTER, STIFFER, MULTIPLIER, PENALTY, BATHE, FINER, ROUNDED]),
    ("not-finite", &[SHORTER, BATHE, FINER]),
    (GUARD, &[PROJECT, LONGER, SHORTER, BATHE, DAMPED, SOFTER, FINER, GUARD_OFF]),
];
/// The remedies of any other reason.
const OTHERWISE: &[Remedy] = &[SHORTER, BATHE, DAMPED, PENALTY, FINER];

/// What to try after a stop at a contact, or anywhere.
pub(super) fn of(kind: &str, case: &Case, contact: Option<&str>) -> Vec<Advice> {
    let remedies = TABLE.iter().find(|(of, _)| *of == kind).map_or(OTHERWISE, |(_, remedies)| remedies);
    let advice = |&(change, what): &Remedy| {
        let sets = match change {
            Some(kind) => Change::new(kind, case, contact)?.sets,
            None if what == DEGREE.1 && case.bodies.iter().all(|b| b.element.degree() == 1) => return None,
            None => Vec::new(),
        };
        Some(Advice { what: what.into(), sets, trial: None })
    };
    remedies.iter().filter_map(advice).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reason_has_a_remedy_of_its_own() {
        for (kind, remedies) in TABLE {
            assert!(!remedies.is_empty(), "{kind}");
            assert_eq!(TABLE.iter().filter(|(other, _)| other == kind).count(), 1, "{kind}");
        }
    }
}
