//! What an iterate gives: forces, gaps and the residual of the balance, with the tangent of the bodies where it is asked for.

use carom_contact::{Linearised, Pair};
use carom_time::{Internal, Stage};

use crate::balance::{contact_weights, mean_acceleration, residual_into};
use crate::model::Model;
use crate::penalty::{self, Configuration};
use crate::rejected::Rejected;
use crate::state::State;
use crate::workspace::{Workspace, timed};

/// The unknowns of a stage while they are being found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trial {
    /// d = y − y_s.
    pub increment: Vec<f64>,
    /// y.
    pub y: Vec<f64>,
    /// Pairs of each contact, multipliers included.
    pub pairs: Vec<Vec<Pair>>,
    /// Strain energy at the evaluated positions.
    pub strain: f64,
}

/// Size of a residual and what it is measured against.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Measure {
    pub residual: f64,
    pub forces: f64,
    pub gap: f64,
}

/// Forces, gaps and residual at the trial, and the tangent of the bodies if asked for.
pub(crate) fn evaluate<const D: usize>(
    model: &Model<D>,
    state: &State,
    trial: &mut Trial,
    work: &mut Workspace<D>,
    tangent: bool,
) -> Result<Measure, Rejected> {
    let stage = &work.stage;
    let between = stage.internal == Internal::DiscreteGradient;
    let share = if between { 1.0 } else { 1.0 - stage.average };
    for i in 0..trial.y.len() {
        trial.y[i] = state.y[i] + trial.increment[i];
        work.at[i] = state.y[i] + share * trial.increment[i];
    }
    for moved in &work.motions {
        let target = model.reference[moved.dof] + moved.motion[0];
        work.remaining[moved.dof] = (target - state.y[moved.dof]) - trial.increment[moved.dof];
    }
    let inverted = |(body, inverted)| Rejected::Inverted { body, inverted };
    let (system, at, force) = (&mut work.system, &work.at, &mut work.forces.internal);
    let pull = (!work.motions.is_empty()).then_some((&work.remaining[..], &mut work.pull[..]));
    trial.strain = timed(&mut work.timings.assembly, || match (tangent, between) {
        (true, _) => system.internal_tangent(model, between.then_some(&state.y), at, force, pull),
        (false, true) => model.internal_between(&state.y, at, force),
        (false, false) => model.internal_force(at, force),
    })
    .map_err(inverted)?;
    if between {
        // Springs that conserve energy act along the normals at the middle of the step, and pressures on the side as it lies there.
        for i in 0..trial.y.len() {
            work.at[i] = state.y[i] + 0.5 * trial.increment[i];
        }
    }
    if !model.loads.is_empty() {
        model.loads.force_into(&work.loads, &work.at, &mut work.forces.loads);
    }
    stage.acceleration.value_into(&trial.increment, &mut work.acceleration);
    if !stage.is_static() {
        for moved in &work.motions {
            // What makes the balance, whose averages are those of the scheme's a, take this mean.
            let before = state.a[moved.dof];
            let mean = mean_acceleration(stage, moved.motion[2], before);
            work.acceleration[moved.dof] = (mean - stage.before.mass * before) / stage.weights.mass;
        }
    }
    model.mass.multiply_into(&work.acceleration, &mut work.forces.inertia);

    let y = trial.y.as_chunks::<D>().0;
    work.forces.contact.fill(0.0);
    work.springs = 0.0;
    let mut measure = Measure::default();
    for (k, contact) in model.contacts.iter().enumerate() {
        let weight = contact_weights(stage, contact.force).0;
        work.gaps[k].resize(trial.pairs[k].len(), Linearised::default());
        work.stiffnesses[k].clear();
        work.stiffnesses[k].resize(trial.pairs[k].len(), 0.0);
        if let Some(penalty) = &contact.penalty {
            let at = Configuration {
                start: &state.y,
                middle: between.then_some(&work.at),
                end: &trial.y,
                moved: &trial.increment,
            };
            for (p, (pair, gap)) in trial.pairs[k].iter_mut().zip(&mut work.gaps[k]).enumerate() {
                let spring = penalty::spring(&*contact.method, penalty[pair.node], pair, &at, gap)
                    .map_err(|error| Rejected::Contact { contact: contact.name.clone(), error })?;
                work.stiffnesses[k][p] = spring.stiffness;
                work.springs += spring.energy;
                if pair.active {
                    add_gradient(gap, weight * pair.lambda, &mut work.forces.contact);
                }
            }
            continue;
        }
        for (pair, gap) in trial.pairs[k].iter_mut().zip(&mut work.gaps[k]) {
            match contact.method.linearise(pair, y, pair.lambda, gap) {
                Ok(()) => {}
                Err(error) if pair.active => {
                    return Err(Rejected::Contact { contact: contact.name.clone(), error });
                }
                // An open pair whose closest point is not unique is far away.
                Err(_) => gap.gap = f64::INFINITY,
            }
            if pair.active {
                measure.gap = measure.gap.max(gap.gap.abs());
                add_gradient(gap, weight * pair.lambda, &mut work.forces.contact);
            }
        }
    }
    measure.forces = residual_into(model, stage, &work.forces, &mut work.residual);
    measure.residual = model.free.iter().map(|&i| work.residual[i] * work.residual[i]).sum::<f64>().sqrt();
    Ok(measure)
}

/// force += factor ∇g.
pub(crate) fn add_gradient<const D: usize>(gap: &Linearised<D>, factor: f64, force: &mut [f64]) {
    for p in 0..gap.count {
        for i in 0..D {
            force[gap.nodes[p] * D + i] += factor * gap.gradient[p][i];
        }
    }
}

/// What the last digits of the positions alone make of the residual.
pub(crate) fn round_off<const D: usize>(model: &Model<D>, work: &Workspace<D>) -> f64 {
    let diagonal = work.system.diagonal(mass_factor(&work.stage), stiffness_factor(&work.stage));
    16.0 * f64::EPSILON * model.scale * diagonal.map(|d| d * d).sum::<f64>().sqrt()
}

pub(crate) fn mass_factor(stage: &Stage) -> f64 {
    stage.weights.mass * stage.acceleration.slope
}

pub(crate) fn stiffness_factor(stage: &Stage) -> f64 {
    match stage.internal {
        Internal::Gradient => stage.weights.internal * (1.0 - stage.average),
        // Its tangent is that by the end of the step already.
        Internal::DiscreteGradient => stage.weights.internal,
    }
}

pub(crate) fn follower_factor(stage: &Stage) -> f64 {
    stage.weights.external * (1.0 - stage.average)
}
