//! Models without a solution: massless bodies under rules that need mass, and unconstrained bodies.

use carom_case::{Case, ContactLaw, ForceTime, Problem};
use carom_mechanics::model::{BodyInstance, Contact, Mode, RigidMotion};

/// Bodies with rigid modes that neither supports nor contacts can constrain: without inertia they
/// have no equilibrium.
pub(super) fn unconstrained(parts: &[BodyInstance], free: &[Mode], contacts: &[Contact]) -> Vec<Problem> {
    let mut problems: Vec<Problem> = Vec::new();
    for (place, part) in parts.iter().enumerate() {
        let is_of_part = |mode: &&Mode| mode.motions.iter().any(|motion| motion.part == place);
        let Some(mode) = free.iter().find(is_of_part) else { continue };
        // Bodies that ties connect have motions together: a contact of one constrains all.
        let involves = |c: &Contact| {
            let holds = |motion: &RigidMotion| {
                let nodes = parts[motion.part].nodes();
                // A body cannot constrain itself, but a piece of it another one.
                let can_constrain = !c.itself || motion.is_of_piece(parts);
                let is_secondary = || c.kinematics.secondary().iter().any(|n| nodes.contains(n));
                can_constrain && (c.primary_part == Some(motion.part) || is_secondary())
            };
            mode.motions.iter().any(holds)
        };
        if !contacts.iter().any(involves) {
            problems.push(Problem::new(
                format!("body[{place}]"),
                format!("body \"{}\" is free to {} and has no equilibrium", part.name, mode.motion()),
                "the scheme \"static\" has no inertia, and neither supports nor contacts constrain this motion",
                "add a [[support]], or use a scheme with inertia",
            ));
        }
    }
    problems
}

/// The balance of a massless body is enforced at s + 1 only; rules that act within the step do not
/// apply to it.
pub(super) fn massless(case: &Case, parts: &[BodyInstance], massless: &[bool]) -> Vec<Problem> {
    let mut problems = Vec::new();
    let light = |part: &BodyInstance| part.nodes().any(|node| massless[node * case.dimension]);
    let Some(part) = parts.iter().find(|p| light(p)) else { return problems };
    let what = |rule: &str| {
        let which = if part.is_massless() { "has no mass" } else { "has nodes without mass" };
        format!("body \"{}\" {which}, but {rule} requires mass at every node", part.name)
    };
    let why =
        "the balance of nodes without mass is enforced at the end of the step, not at the averaged state";
    if case.time.scheme.forces == carom_time::ForceRule::AverageState {
        let help = "use forces = \"average-forces\", or give a small density";
        problems.push(Problem::new("time.scheme.forces", what("forces = \"average-state\""), why, help));
    }
    if case.time.scheme.kind == "energy-momentum" {
        let help = "use a scheme other than the midpoint rule, such as bathe, or give a small density";
        problems.push(Problem::new("time.scheme.kind", what("kind = \"energy-momentum\""), why, help));
    }
    let is_light = |body: &str| parts.iter().any(|p| light(p) && p.name == body);
    for contact in &case.contacts {
        if contact.law == Some(ContactLaw::Predictor) {
            let why = "the predictor is projected with the mass matrix";
            let help = "use law = \"position\", which suffices where contact nodes have no mass";
            problems.push(Problem::new(contact.path("law"), what("law = \"predictor\""), why, help));
        }
        if contact.force == ForceTime::End && contact.bodies().any(is_light) {
            let why =
                "on a massless side, contact and internal forces must act at the same instant of the step";
            let help = "use force = \"alpha_f\", or give a small density";
            problems.push(Problem::new(contact.path("force"), what("force = \"end\""), why, help));
        }
    }
    problems
}
