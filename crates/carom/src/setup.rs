//! Builds the simulation of a case: the model with a stepper, on the grid of times.

use carom_case::{Case, NewtonSpec, Problem, TangentRule};
use carom_mechanics::model::Model;
use carom_mechanics::stability::{SAFETY, stable_step};
use carom_mechanics::{
    Before, Explicit, Grid, Implicit, Impulsive, Rejected, Settings, Simulation, State, Stepper, Tangent,
};
use carom_time::{Integrator, Nonsmooth};

use crate::build::{build, overlaps};
use crate::initial::{before, given};

/// Builds the model of a case and its state at t = 0. Cells are computed by this many threads; the
/// result does not depend on it.
///
/// # Errors
/// All problems of the case that only its meshes reveal.
pub fn simulation(case: &Case, threads: usize) -> Result<Simulation, Vec<Problem>> {
    let model = build(case)?;
    let placed = case.initial.is_some() || case.manufactured.is_some();
    let overlaps = if placed { Vec::new() } else { overlaps(&model) };
    let problems = [overlaps, too_long(case, &model)].concat();
    if !problems.is_empty() {
        return Err(problems);
    }
    let before: Option<Before> = match (&case.initial, &model.loads.manufactured) {
        (Some(initial), _) => Some(before(initial, case, &model)?),
        (None, Some(motion)) => Some(given(motion, &model)?),
        (None, None) => None,
    };
    let stepper = stepper(case, &model)?;
    let inertia = !case.time.scheme.is_static();
    Simulation::new(model, stepper, grid(case), inertia, before, threads)
        .map_err(|rejected| vec![no_start(case, placed, &rejected)])
}

/// Builds the model of a case and resumes from a state of an earlier run of it; the run of its
/// `[initial]` is no longer needed.
///
/// # Errors
/// As [`simulation`].
pub fn resumed(case: &Case, threads: usize, state: State) -> Result<Simulation, Vec<Problem>> {
    let model = build(case)?;
    let stepper = stepper(case, &model)?;
    Ok(Simulation::resume(model, stepper, grid(case), state, threads))
}

fn grid(case: &Case) -> Grid {
    // Load steps create no energy: the difference between works and energies is the error of a sum
    // over few steps.
    let guard = case.time.energy_guard.filter(|_| !case.time.scheme.is_static());
    Grid { dt: case.time.step, steps: (case.time.end / case.time.step).round() as u64, guard }
}

/// Why a case has no initial state, with its key and a suggestion.
fn no_start(case: &Case, placed: bool, rejected: &Rejected) -> Problem {
    let (path, what, help) = match rejected {
        Rejected::NoValue(_) => {
            ("load".into(), "a formula has no value at t = 0", "change it so that it has one")
        }
        Rejected::Jump { .. } => {
            ("support".into(), "a support would jump at the start", "let its `move` begin where the body is")
        }
        Rejected::Inverted { body, .. } if !placed => {
            let k = case.bodies.iter().position(|b| b.name == *body).unwrap_or_default();
            let help = "let neighbouring places stay neighbours, the determinant of the formulas' derivatives positive";
            (format!("body[{k}].position"), "the initial position turns a cell inside out", help)
        }
        _ => ("body".into(), "the start has no acceleration", "check masses and supports"),
    };
    Problem::new(path, what, rejected.to_string(), help)
}

/// The stepper of a case.
fn stepper(case: &Case, model: &Model) -> Result<Box<dyn Stepper>, Vec<Problem>> {
    let settings = settings(&case.newton);
    let integrator = case.time.scheme.integrator().map_err(|error| {
        let path = format!("time.scheme.{}", error.key());
        vec![Problem::new(
            path,
            "the scheme cannot be used",
            error.to_string(),
            "carom explain lists schemes",
        )]
    })?;
    Ok(match integrator {
        Integrator::Alpha(scheme, _) => Box::new(Implicit::new(Box::new(scheme), settings)),
        Integrator::Stages(kernel, _) => Box::new(Implicit::new(kernel, settings)),
        Integrator::Nonsmooth(Nonsmooth::Impulse(scheme), _) => Box::new(Impulsive::new(scheme, settings)),
        Integrator::Nonsmooth(Nonsmooth::Explicit(_), _) => Box::new(Explicit::new(model)),
    })
}

fn settings(newton: &NewtonSpec) -> Settings {
    let tangent = match newton.tangent {
        TangentRule::Frozen => Tangent::Frozen,
        TangentRule::FrozenDouble => Tangent::FrozenDouble,
        TangentRule::Full => Tangent::Full,
    };
    Settings {
        tolerance: newton.tolerance,
        max_iterations: newton.max_iterations,
        tangent,
        mixing: newton.mixing,
    }
}

/// The problem of a step longer than the stable one of an explicit scheme.
pub fn too_long(case: &Case, model: &Model) -> Vec<Problem> {
    if !case.time.scheme.is_explicit() {
        return Vec::new();
    }
    let step = case.time.step;
    let Some(stable) = stable_step(model) else {
        let why = "a cell is inverted at the start, or a free node has no mass";
        return vec![Problem::new(
            "time.scheme",
            "the stable step cannot be computed",
            why,
            "check meshes and densities",
        )];
    };
    let longest = SAFETY * stable.power;
    if step <= longest {
        return Vec::new();
    }
    let what =
        format!("the step {step:e} is longer than {} is stable with: {longest:.4e}", case.time.scheme.kind);
    let why = format!(
        "an explicit step must stay below 2/ω_max = {:.4e} (bound by single cells {:.4e}); {SAFETY} of it is accepted",
        stable.power, stable.cell
    );
    let divided = case.time.end / (case.time.end / longest).ceil();
    vec![Problem::new(
        "time.step",
        what,
        why,
        format!("step = {divided:.6e} divides the end time; an implicit scheme has no such limit"),
    )]
}
