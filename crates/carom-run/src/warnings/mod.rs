//! Warnings: doubts that a reviewer would have about a valid case. None of them stops a run. They
//! are written into the manifest and the log, and shown by `carom check`, `carom run`,
//! `carom study` and the pages.
//!
//! [`WARNINGS`] is the one table; a rule is a function of the case and its model, or of the record.

mod cells;
mod courses;
mod elements;
mod extent;
mod found;
mod loads;
mod masses;
mod meshes;
mod obstacles;
mod record;
mod shear;
mod steps;
mod stick;
mod unconnected;
mod velocities;
mod waves;

use carom_case::Case;
use carom_mechanics::model::Model;
use carom_record::{Run, Warning};

pub use found::Found;
pub(crate) use record::{LARGE_ROTATION, LARGE_STRAIN};

/// How a warning is found.
#[derive(Clone, Copy, Debug)]
pub enum Rule {
    /// Before the run.
    Model(fn(&Case, &Model) -> Vec<Found>),
    /// After it.
    Record(fn(&Case, &Model, &Run) -> Vec<Found>),
    /// Before it, from what is expected, and after it, from what happened.
    Both(fn(&Case, &Model) -> Vec<Found>, fn(&Case, &Model, &Run) -> Vec<Found>),
}

/// A warning that may be given.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Name of the warning.
    pub id: &'static str,
    /// Why it matters.
    pub why: &'static str,
    /// A remedy.
    pub advice: &'static str,
    /// When it is given.
    pub rule: Rule,
}

/// All warnings.
pub const WARNINGS: [Entry; 35] = [
    Entry {
        id: "coarse-secondary",
        why: "nodes of the primary side may penetrate between those of the secondary one, by a fiftieth of the \
            length of a facet",
        advice: "a finer secondary side, or the finer side as the secondary one",
        rule: Rule::Model(meshes::coarse_secondary),
    },
    Entry {
        id: "unmatched-pressure",
        why: "node-to-segment contact fails the patch test on non-matching meshes: pressures and stresses at the \
              contact surface have errors of 10 % or more",
        advice: "method = \"mortar\" in the plane, matching meshes, resultants, or probes a few cells away",
        rule: Rule::Model(meshes::unmatched_pressure),
    },
    Entry {
        id: "inside-obstacle",
        why: "only nodes on its free side are kept out of a rigid obstacle: the body moves as if it were not there",
        advice: "the obstacle turned the other way",
        rule: Rule::Model(obstacles::inside_obstacle),
    },
    Entry {
        id: "velocity-jump",
        why: "neither mesh nor step resolves the front of this wave: stresses and contact forces oscillate behind \
              it, and their peaks depend on both",
        advice: "an initial velocity of the body that is that of the motion, and zero where a support holds it, or a motion that begins with the velocity of the body, such as one with t^2",
        rule: Rule::Model(velocities::velocity_jump),
    },
    Entry {
        id: "fast-impact",
        why: "the impact strains the softer body by about this ratio, where laws of elasticity do not hold and cells \
              invert",
        advice: "a look at the units of velocity, stiffness and density; a slower impact",
        rule: Rule::Model(velocities::fast_impact),
    },
    Entry {
        id: "wave-speed",
        why: "in solids it is between 1 and 20 000 m/s: stiffness and density are probably not in the units of the case, or \
              Poisson's ratio is too close to 1/2",
        advice: "consistent units, such as mm, s, t and MPa, or mm, ms, g and MPa, or mm, ms, kg and GPa",
        rule: Rule::Model(waves::wave_speed),
    },
    Entry {
        id: "unresolved-load",
        why: "a step knows a load at its ends, or in its middle, alone: of a blow that lies elsewhere the body feels \
              nothing, and of a short one a part that depends on the step",
        advice: "a step a tenth as long as the load lasts, or a longer and weaker load of the same impulse",
        rule: Rule::Model(loads::unresolved_load),
    },
    Entry {
        id: "short-run",
        why: "the far side of the body has not felt anything by then, and the units of time may be wrong",
        advice: "a later end",
        rule: Rule::Model(waves::short_run),
    },
    Entry {
        id: "flat-cell",
        why: "it is 1 for an equilateral cell and 0 for a flat one, which is too stiff, inverts early, and makes linear \
              systems ill-conditioned and stable steps short",
        advice: "a better mesh there; in Gmsh, a more even size or an optimised mesh",
        rule: Rule::Model(cells::flat_cell),
    },
    Entry {
        id: "locking",
        why: "elements of degree 1 lock at nearly constant volume, and the response is too stiff",
        advice: "an element of degree 2",
        rule: Rule::Model(elements::locking),
    },
    Entry {
        id: "stiff-bending",
        why: "elements of degree 1 shear where they should bend",
        advice: "an element of degree 2, or more cells across the thickness",
        rule: Rule::Model(elements::stiff_bending),
    },
    Entry {
        id: "bar-modulus",
        why: "dimension 1 has no lateral strain: bodies are columns that cannot widen, not free bars",
        advice: "poisson = 0 (or lambda = 0, mu = E/2) for a bar whose sides are free, and plane = \"stress\" in \
            dimension 2 if it yields",
        rule: Rule::Model(elements::bar_modulus),
    },
    Entry {
        id: "strained-massless",
        why: "a node without mass moves to its equilibrium position in the first step, and the strain energy \
            released is lost",
        advice: "mass = \"consistent\", smaller cells at the contact, or a start from a state of equilibrium with [initial]",
        rule: Rule::Model(masses::strained_massless),
    },
    Entry {
        id: "undamped-stick",
        why: "the traction then vibrates about the one that carries the body, for as long as the stick lasts, and its first \
              peak beyond mu ends it: stick lasts too short, at any step. A real body damps such vibrations",
        advice: "a scheme that damps what the step does not resolve, such as bathe, or chung-hulbert with rho_inf = 0.5; \
                 persistency = \"project\" where it is \"none\"",
        rule: Rule::Model(stick::undamped_stick),
    },
    Entry {
        id: "conditional-stability",
        why: "vibrations of the mesh whose Ω = ωΔt is above the limit of stability grow in every step, until they \
              are all that is left of the motion",
        advice: "other parameters (`newmark`: beta ≥ gamma/2 and gamma ≥ 1/2), another scheme, or steps so short that \
                 the energy of the run stays the same; `carom explain` prints the spectral radius",
        rule: Rule::Model(steps::conditional_stability),
    },
    Entry {
        id: "unconnected-bodies",
        why: "every body has nodes of its own: nothing holds the two together there, and nothing keeps one out of the other",
        advice: "a [[contact]] between the sides that touch; to connect the two, a [[tie]] of these sides",
        rule: Rule::Model(unconnected::unconnected_bodies),
    },
    Entry {
        id: "long-step",
        why: "the contact force of this step is an impulse divided by Δt: a shorter step changes the largest one by a \
              fifth or more. Duration and rebound of an impact that takes few steps change, too",
        advice: "a shorter step, until the numbers that you need no longer change",
        rule: Rule::Record(steps::long_step),
    },
    Entry {
        id: "merged-impacts",
        why: "interruptions of contact that are shorter than 2 % of the recorded time do not end an episode: restitution, \
              duration and impulse are those of several impacts, and depend on the end of the run",
        advice: "an earlier end, or the numbers of a single impact from the columns of history.csv",
        rule: Rule::Record(record::merged_impacts),
    },
    Entry {
        id: "split-impact",
        why: "an interruption of contact as long as 2 % of the recorded time ends an episode: restitution, duration and \
              impulse are those before it, and with a later end of the run they are those of both parts",
        advice: "a later end, if both are parts of one impact, or numbers from the columns of history.csv",
        rule: Rule::Record(record::split_impact),
    },
    Entry {
        id: "one-node",
        why: "force and pressure are those of a single node and depend on the mesh around it",
        advice: "a finer mesh at the contact",
        rule: Rule::Record(record::one_node),
    },
    Entry {
        id: "open-contact",
        why: "the bodies did not meet on the sides of the contact before the end, or not where these are",
        advice: "a later end, or sides that meet; nothing where the contact is a precaution",
        rule: Rule::Record(record::open_contact),
    },
    Entry {
        id: "dependent-gaps",
        why: "without friction forces and their sum are right, but how the pressure is shared between these nodes and \
              others is not determined: pressures there may be anything, and with different mu so may friction",
        advice: "enforcement = \"augmented\" (implicit schemes); the finer side as the primary one if the secondary one \
                 is held; a side without the nodes that supports or ties hold",
        rule: Rule::Record(record::dependent_gaps),
    },
    Entry {
        id: "shear-area",
        why: "`shear` limits the force of a row to this stress times the area of its node: with several rows friction is \
              too large, and without an area it is missing",
        advice: "nodes of the secondary side that do not lie over joints of the primary one; with method = \"mortar\", a finer \
                 secondary side",
        rule: Rule::Record(shear::shear_area),
    },
    Entry {
        id: "undeclared-contact",
        why: "nothing keeps them apart: contact acts only between the sides that a [[contact]] names",
        advice: "a [[contact]] that names the sides that meet, or one with between = \"all\" (which leaves out bodies that a tie joins); or ending the run before they meet",
        rule: Rule::Both(courses::undeclared_contact, record::undeclared_contact),
    },
    Entry {
        id: "edge-between-nodes",
        why: "a rigid obstacle holds nodes alone, in the plane also parts of it that are narrower than a facet: between \
              nodes the rest enters the body, the contact is too soft or absent there, and a body that glides over a \
              round part rises and falls by as much",
        advice: "a finer mesh there (of a round part the depth falls with the square of its size), or nodes of the body along an edge, on the obstacle's side of it; or a stiff body in place of the obstacle, whose edges and corners are held",
        rule: Rule::Record(record::edge_between_nodes),
    },
    Entry {
        id: "deep-penetration",
        why: "where bodies penetrate each other by so much, place and size of the contact forces are wrong by as much",
        advice: "a shorter step, or a finer mesh at the contact",
        rule: Rule::Record(record::deep_penetration),
    },
    Entry {
        id: "large-rotation",
        why: "linear elasticity takes rotations for strains, and a body that turns is stretched and resists",
        advice: "law = \"neo-hookean\" or \"saint-venant-kirchhoff\" with the same constants",
        rule: Rule::Record(record::large_rotation),
    },
    Entry {
        id: "large-strain",
        why: "linear elasticity is that of small strain: what is reported as Cauchy stress is P, and differs from P Fᵀ/J by as much as the strain",
        advice: "law = \"neo-hookean\" or \"saint-venant-kirchhoff\" with the same constants",
        rule: Rule::Record(record::large_strain),
    },
    Entry {
        id: "ambiguous-friction",
        why: "μ is so large that the same forces allow stick, slip or lift-off; which of them is found depends on the path of the iteration",
        advice: "a smaller mu, a shorter step (inertia makes it unique), or mu as a formula that grows to its value",
        rule: Rule::Record(record::ambiguous_friction),
    },
    Entry {
        id: "unstable-equilibrium",
        why: "the tangent stiffness is not positive definite: the least disturbance makes the body leave this equilibrium, \
              because it buckles, snaps through or necks; a real body would not stay in it",
        advice: "a small load or imperfection to the side, with load steps short enough to follow where it leads; or [initial] from \
                 this run and a dynamic scheme, with steps that resolve how the motion grows: long implicit steps damp it, and stay",
        rule: Rule::Record(record::unstable_equilibrium),
    },
    Entry {
        id: "faded-start",
        why: "the way to the equilibrium is another one than that of the loads at once: with friction or plastic flow so \
              may be the equilibrium, and `dissipation` contains the work of what fades",
        advice: "loads that grow with t from zero, or a grip that eases off by a traction; nothing for elastic bodies \
                 without friction",
        rule: Rule::Record(record::faded_start),
    },
    Entry {
        id: "fallback-steps",
        why: "in these steps the scheme had no acceptable solution; the fallback is of first order, dissipates modes that the step does not resolve, \
              and its contact is inelastic",
        advice: "a shorter step, a finer mesh at the contact or a scheme with more damping; `log.jsonl` has the reason of each step",
        rule: Rule::Record(record::fallback_steps),
    },
    Entry {
        id: "numerical-dissipation",
        why: "elastic bodies keep this energy: vibrations and rebounds become smaller by the scheme and its step, not by the \
            material",
        advice: "a shorter step, or a scheme that dissipates less, such as energy-momentum or the same one with a larger rho_inf; nothing where \
                 vibrations are meant to die out",
        rule: Rule::Record(record::numerical_dissipation),
    },
    Entry {
        id: "energy-created",
        why: "an elastic body cannot create energy; motion, forces and stresses afterwards are artefacts of the \
            scheme",
        advice: "a scheme with more damping, another step, persistency = \"project\" where it is \"none\", or the energy guard, which stops such a run",
        rule: Rule::Record(record::energy_created),
    },
    Entry {
        id: "hidden-energy",
        why: "the total energy does not rise, because friction or plastic flow dissipates as much as was created: they may \
              dissipate more than the energy that was available, and bodies may hop",
        advice: "a scheme with damping at high frequencies or one that conserves energy; a shorter step does not always help",
        rule: Rule::Record(record::hidden_energy),
    },
];

impl Entry {
    fn given(&self, found: Vec<Found>) -> impl Iterator<Item = Warning> + use<> {
        let Self { id, why, advice: of_entry, .. } = *self;
        found.into_iter().map(move |Found { place, what, advice }| Warning {
            id: id.into(),
            place,
            what,
            why: why.into(),
            advice: advice.unwrap_or_else(|| of_entry.into()),
        })
    }
}

/// The warnings that a case and its model give before the run.
pub fn warnings(case: &Case, model: &Model) -> Vec<Warning> {
    let given = |entry: &Entry| match entry.rule {
        Rule::Model(find) | Rule::Both(find, _) => Some(entry.given(find(case, model))),
        Rule::Record(_) => None,
    };
    WARNINGS.iter().filter_map(given).flatten().collect()
}

/// The warnings that the record of a run gives; of one that stopped only the overlaps, which may be
/// why it stopped.
pub(crate) fn warnings_of_record(case: &Case, model: &Model, run: &Run, finished: bool) -> Vec<Warning> {
    let given = |entry: &Entry| match entry.rule {
        _ if !finished && entry.id != "undeclared-contact" => None,
        Rule::Record(find) | Rule::Both(_, find) => Some(entry.given(find(case, model, run))),
        Rule::Model(_) => None,
    };
    WARNINGS.iter().filter_map(given).flatten().collect()
}
