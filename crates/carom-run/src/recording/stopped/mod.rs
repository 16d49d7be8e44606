//! Why a simulation stopped: the place, the last iterations, and what to try.

mod advice;
mod change;
mod place;
mod trials;

use carom_case::Case;
use carom_mechanics::{GridReport, Simulation, State, Stopped};
use carom_record::{Advice, FieldSet, Manifest, PointArray, RecordError, Recorder, Stop, StopIteration};

use super::fields::field_set;
use super::outcome::Options;
use place::place;
use trials::Effort;

/// Steps before a stop at which trials may begin.
const FEW: u64 = 5;

/// A run that stopped.
pub(super) struct Record<'a> {
    pub case: &'a Case,
    pub simulation: &'a Simulation,
    /// The states of its last two checkpoints, the latest first.
    pub earlier: &'a [State; 2],
}

/// Writes why a simulation stopped, before and after the trials: a killed process leaves the first.
pub(super) fn write_stop(
    record: &Record,
    stopped: &Stopped,
    last: &GridReport,
    options: Options,
    writer: &mut dyn Recorder,
    manifest: &mut Manifest,
) -> Result<(), RecordError> {
    let Record { case, simulation, earlier: [latest, before] } = record;
    let (mut stop, fields) = explain(case, simulation, stopped, last);
    writer.stop(&stop, &fields, manifest)?;
    if options.trials {
        // Not the counters: those of a run that was resumed count the attempts of the last step twice.
        let effort = Effort {
            iterations: trials::TYPICAL * simulation.state().step,
            unknowns: simulation.model().free.len() as u64,
        };
        let earlier = if latest.step + FEW <= simulation.state().step { latest } else { before };
        try_out(&mut stop, case, earlier, effort, options.threads);
        writer.stop(&stop, &fields, manifest)?;
    }
    Ok(())
}

/// Explains a stop; `fields`: the last accepted state and the rejected positions.
pub(crate) fn explain(
    case: &Case,
    simulation: &Simulation,
    stopped: &Stopped,
    report: &GridReport,
) -> (Stop, FieldSet) {
    let (model, state, trace) = (simulation.model(), simulation.state(), simulation.trace());
    let (kind, time, dt) = match stopped {
        Stopped::NoStep { time, dt, rejected, .. } => (rejected.kind(), *time, *dt),
        Stopped::EnergyGuard { time, .. } => (advice::GUARD, *time, simulation.dt()),
        Stopped::Audit { time, .. } => (advice::AUDIT, *time, simulation.dt()),
    };
    let finite = |x: f64| x.is_finite().then_some(x);
    let iterations = trace.iterations().map(|i| StopIteration {
        number: i.number,
        residual: finite(i.residual),
        gap: finite(i.gap),
        correction: finite(i.correction),
        length: i.length,
        active: i.active,
        changed: i.changed,
    });
    let mut fields = field_set(case, model, state);
    if trace.positions().len() == state.y.len() {
        let axes = model.dimension;
        let moved = trace.positions().iter().zip(&model.reference).map(|(y, x)| y - x).collect::<Vec<_>>();
        let vectors =
            moved.chunks_exact(axes).flat_map(|u| [0, 1, 2].map(|i| u.get(i).copied().unwrap_or(0.0)));
        let values = vectors.take(3 * fields.points.len()).collect();
        let unit = case.units.length.clone();
        fields.arrays.push(PointArray { name: "rejected".into(), unit, components: 3, values });
    }
    let place = place(model, state, stopped, report, trace);
    let stop = Stop {
        kind: kind.into(),
        reason: stopped.to_string(),
        step: state.step + 1,
        time,
        dt,
        last: state.time,
        iterations: iterations.collect(),
        advice: advice::of(kind, case, place.as_ref().and_then(|place| place.contact.as_deref())),
        place,
        trials: None,
    };
    (stop, fields)
}

/// Tries what to try, from the start or from an earlier state, and puts what got past first.
fn try_out(stop: &mut Stop, case: &Case, earlier: &State, effort: Effort, threads: usize) {
    stop.trials = Some(trials::words(effort));
    let contact = stop.place.as_ref().and_then(|place| place.contact.clone());
    for advice in &mut stop.advice {
        let Some(change) = change::Change::of(&advice.sets, case, contact.as_deref()) else { continue };
        match trials::trial(&change, case, earlier, stop.time, effort, threads) {
            Some(trial) => advice.trial = Some(trial),
            // The model refuses it, so it is no advice.
            None => advice.sets.clear(),
        }
    }
    let passed = |advice: &Advice| advice.trial.as_ref().is_some_and(|trial| trial.passed);
    stop.advice.sort_by_key(|advice| !passed(advice));
}
