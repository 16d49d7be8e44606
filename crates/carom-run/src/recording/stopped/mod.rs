//! Why a simulation stopped: the place, the last iterations, and what to try.

mod advice;
mod change;
mod place;
mod trials;

use std::sync::atomic::AtomicBool;

use carom_case::Case;
use carom_mechanics::{GridReport, Simulation, State, Stopped};
use carom_record::{
    Advice, FieldSet, Manifest, PointArray, RecordError, Recorder, Source, Stop, StopIteration,
};

use super::fields::{displacements, field_set};
use super::pressure::Surfaces;
use change::Change;
use place::place;
use trials::{Effort, Trials, Tried};

/// Steps between a stop and the state of the run from which trials may begin, and fewest steps
/// between such states.
pub(super) const FEW: u64 = 5;

/// A run that stopped.
pub(super) struct Record<'a> {
    pub case: &'a Case,
    pub source: &'a Source,
    pub simulation: &'a Simulation,
    /// States of this run at fixed steps, the latest first; none if it was resumed, since the same
    /// run must try the same.
    pub earlier: Option<&'a [State; 2]>,
}

/// Why a simulation stopped, with what may get past.
pub(super) struct Found {
    stop: Stop,
    fields: FieldSet,
    changes: Vec<Option<Change>>,
}

impl Found {
    pub(super) fn new(record: &Record, stopped: &Stopped, last: &GridReport) -> Self {
        let (mut stop, fields) = explain(record.case, record.simulation, stopped, last);
        let advice = advice::of(&stop.kind, record.case, record.source, stop.place.as_ref());
        let changes;
        (stop.advice, changes) = advice.into_iter().unzip();
        Self { stop, fields, changes }
    }

    /// Writes both files; the manifest takes their hashes.
    pub(super) fn write(
        &self,
        writer: &mut dyn Recorder,
        manifest: &mut Manifest,
    ) -> Result<(), RecordError> {
        writer.stop(&self.stop, &self.fields, manifest)
    }

    /// Tries the changes and puts what got past first. Ctrl-C leaves the rest untried.
    pub(super) fn try_out(&mut self, record: &Record, threads: usize, interrupted: &AtomicBool) {
        let simulation = record.simulation;
        // Not the counters: those of a run that was resumed count the attempts of the last step
        // twice.
        let effort = Effort {
            iterations: trials::TYPICAL * simulation.state().step,
            unknowns: simulation.model().free.len() as u64,
        };
        let far = |state: &&State| state.step + FEW <= simulation.state().step;
        let earlier = record.earlier.and_then(|states| states.iter().find(far).or(states.last()));
        let trials = Trials {
            case: record.case,
            stop: self.stop.time,
            last: self.stop.last,
            earlier,
            effort,
            threads,
        };
        self.stop.trials = Some(trials.words());
        for (advice, change) in self.stop.advice.iter_mut().zip(&self.changes) {
            let Some(change) = change else { continue };
            match trials.trial(change, interrupted) {
                Tried::Ended(trial) => advice.trial = Some(trial),
                // The model refuses it, so it is no advice.
                Tried::Refused => advice.sets.clear(),
                Tried::NotAffordable => {}
                Tried::Interrupted => break,
            }
        }
        let passed = |advice: &Advice| advice.trial.as_ref().is_some_and(|trial| trial.passed);
        self.stop.advice.sort_by_key(|advice| !passed(advice));
    }
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
        Stopped::Interrupted { time, .. } => ("interrupted", *time, simulation.dt()),
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
    let mut fields = field_set(case, model, &Surfaces::new(model, case.thickness), state);
    if trace.positions().len() == state.y.len() {
        let mut values = displacements(model, trace.positions());
        values.truncate(3 * fields.points.len());
        let unit = case.units.length.clone();
        fields.arrays.push(PointArray { name: "rejected".into(), unit, components: 3, values });
    }
    let place = place(model, state, stopped, report, trace);
    let stop = Stop {
        kind: kind.into(),
        reason: case.in_units(&stopped.to_string()),
        step: state.step + 1,
        time,
        dt,
        last: state.time,
        iterations: iterations.collect(),
        advice: Vec::new(),
        place,
        trials: None,
    };
    (stop, fields)
}
