//! Warnings about steps: those that do not resolve an impact, and those with which a scheme may be
//! unstable.
//!
//! The motion of the softer body (impedance ρc) in an impact is made of pressure waves that cross
//! it along the contact's normal and return: the force of a bar that strikes a wall lasts 2L/c, and
//! that on a soft bar grows by a stair of this length (K. L. Johnson, *Contact Mechanics*, 1985, §
//! 11.1). A step Δt > L/c mixes such a wave with its return. Where it also takes a large share of
//! the velocity of approach in one step, the force of this step is an impulse divided by Δt.
//!
//! Measured with bars and discs of one and of two materials, with a damped scheme of order two and
//! with backward Euler: with Δt of 1.2 … 5 L/c the largest mean force over a sixteenth of the
//! contact differs from that with Δt/10 by 25 to 74 %, with 0.25 … 0.6 L/c by 2 to 8 % (ADR 78).

use carom_case::{Case, MaterialSpec};
use carom_mechanics::model::{BodyInstance, Model};
use carom_record::metrics::{Impact, first_episode};
use carom_record::{History, Run};
use carom_time::Explained;

use super::extent;
use super::found::{Found, short};

/// Share of the velocity of approach that a body loses in the step of the largest force, above
/// which this force is an impulse. That of half a sine in ten steps is 0.3.
const LARGE: f64 = 0.25;

/// Implicit schemes of which some vibrations grow with long steps.
pub(super) fn conditional_stability(case: &Case, _: &Model) -> Vec<Found> {
    let scheme = &case.time.scheme;
    if scheme.is_static() {
        return Vec::new();
    }
    let Ok(Explained::Stages(explained)) = scheme.integrator().map(|made| made.explain()) else {
        return Vec::new();
    };
    if explained.a_stable {
        return Vec::new();
    }
    let what = format!(
        "`{}` with these parameters is not unconditionally stable (ρ∞ = {})",
        scheme.kind,
        short(explained.rho_inf)
    );
    vec![Found::of_the_run(what)]
}

pub(super) fn long_step(case: &Case, model: &Model, run: &Run) -> Vec<Found> {
    // Rows stand for single steps.
    if case.time.scheme.is_static() || case.output.history_every != 1 {
        return Vec::new();
    }
    unseen(case, run).or_else(|| unresolved(case, model, run)).into_iter().collect()
}

/// A first contact that begins and ends between two rows.
fn unseen(case: &Case, run: &Run) -> Option<Found> {
    let episode = first_episode(&run.history).filter(|episode| episode.is_within_a_step(&run.history))?;
    let time = short(run.times()[episode.start]);
    let what = format!("contact begins and ends within the step before t = {time} {}", case.labels().time);
    Some(Found::of_the_run(what))
}

fn unresolved(case: &Case, model: &Model, run: &Run) -> Option<Found> {
    let impact = Impact::first(run).ok()?;
    let stopped = stopped(model, run, &impact)?;
    let (part, material) = softest(case, model, &impact)?;
    let across = extent::along(model, part, &impact.normal);
    let crossing = across / material.wave_speed(case.plane);
    if stopped.share < LARGE || case.time.step <= crossing {
        return None;
    }
    let units = case.labels();
    let what = format!(
        "a pressure wave crosses its {} {} in {} {}, {} of a step, and the velocity of \"{}\" changes by {} % of the velocity of approach in the step before t = {} {}, that of the largest contact force",
        short(across),
        units.length,
        short(crossing),
        units.time,
        short(crossing / case.time.step),
        stopped.body,
        short(100.0 * stopped.share),
        short(stopped.time),
        units.time,
    );
    Some(Found::of_body(&part.name, what))
}

/// A body that loses velocity in one step.
struct Stopped<'a> {
    body: &'a str,
    /// End of the step.
    time: f64,
    /// Change of its velocity over the velocity of approach.
    share: f64,
}

/// The body that the largest contact force accelerates most, in the step of this force; none if the
/// force is not that of inertia: it presses against loads or supports.
fn stopped<'a>(model: &Model, run: &Run, impact: &Impact<'a>) -> Option<Stopped<'a>> {
    let episode = first_episode(&run.history)?;
    let impulses = impulses(&run.history);
    let last = episode.end.unwrap_or(impulses.len() - 1);
    let row = (episode.start..=last).max_by(|a, b| impulses[*a].total_cmp(&impulses[*b]))?;
    let bodies = [impact.striker].into_iter().chain(impact.others.iter().copied().flatten());
    let changes = bodies.filter_map(|body| {
        let part = model.parts.iter().find(|part| part.name == body)?;
        let change = (0..model.dimension).try_fold(0.0, |sum, axis| {
            let velocity = run.column(&format!("{body}.velocity_{}", ["x", "y", "z"][axis]))?;
            Some(f64::hypot(sum, velocity[row] - velocity[row - 1]))
        })?;
        (part.total_mass * change >= 0.5 * impulses[row]).then_some((body, change / impact.approach))
    });
    let (body, share) = changes.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Stopped { body, time: run.times()[row], share })
}

/// The body of an impact with the least impedance ρc, and the material that has it.
fn softest<'a>(
    case: &'a Case,
    model: &'a Model,
    impact: &Impact,
) -> Option<(&'a BodyInstance, &'a MaterialSpec)> {
    let takes_part = |name: &str| impact.striker == name || impact.others.contains(&Some(name));
    let bodies = model.parts.iter().zip(&case.bodies).filter(|(part, _)| takes_part(&part.name));
    let materials = bodies
        .flat_map(|(part, spec)| case.materials_of(spec).into_iter().map(move |material| (part, material)));
    let impedance = |material: &MaterialSpec| material.density * material.wave_speed(case.plane);
    materials
        .filter(|(_, material)| material.density > 0.0)
        .min_by(|a, b| impedance(a.1).total_cmp(&impedance(b.1)))
}

/// Length of the contact impulse of the step that ends at each row.
fn impulses(history: &History) -> Vec<f64> {
    let axes = ["x", "y", "z"].map(|axis| history.column(&format!("contact_impulse_{axis}")));
    let of_step = |row: usize| {
        let along = |total: &&[f64]| total[row] - total[row.saturating_sub(1)];
        axes.iter().flatten().map(along).fold(0.0, f64::hypot)
    };
    (0..history.times().len()).map(of_step).collect()
}
