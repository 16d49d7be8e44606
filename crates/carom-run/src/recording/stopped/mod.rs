//! Why a simulation stopped: the place, the last iterations, and what to try.

mod advice;
mod change;
mod place;

use carom_case::Case;
use carom_mechanics::{GridReport, Simulation, Stopped, Surfaces};
use carom_record::{FieldSet, PointArray, Stop, StopIteration};

use super::fields::{displacements, field_set};
pub(super) use advice::advice;
use place::place;

/// Explains a stop, without advice, with the fields of the last accepted state and the rejected
/// positions.
pub(crate) fn explain(
    case: &Case,
    simulation: &Simulation,
    stopped: &Stopped,
    report: &GridReport,
) -> (Stop, FieldSet) {
    let model = simulation.model();
    let state = simulation.state();
    let trace = simulation.trace();
    let (kind, time, dt) = match stopped {
        Stopped::NoStep { time, dt, rejected, .. } => (rejected.kind(), *time, *dt),
        Stopped::EnergyGuard { time, .. } => (advice::GUARD, *time, simulation.dt()),
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
    };
    (stop, fields)
}
