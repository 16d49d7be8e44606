//! The steps of a run in one process, with rows, fields, events and checkpoints, up to its end.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use carom_case::{BodySpec, Case, Law};
use carom_mechanics::model::Model;
use carom_mechanics::{Attempt, GridReport, Simulation, Stopped};
use carom_record::{Event, Manifest, Recorder, Run, Status, metrics};

use super::columns::Since;
use super::fields::field_set;
use super::frames::Frames;
use super::log::{entry, in_units, relaxed, repairs};
use super::outcome::{End, Outcome, Progress, RunError};
use super::rows::Rows;
use super::stopped::{advice, explain};
use super::tally::{Busy, Tally, checkpoint};
use super::verdicts::judge;
use crate::warnings::{LARGE_ROTATION, LARGE_STRAIN, warnings_of_record};

/// Time between signs of life while a step is bisected.
const HEARTBEAT: Duration = Duration::from_secs(1);

/// A simulation with its record, while this process works on it.
pub(super) struct Session<'a> {
    case: &'a Case,
    pub(super) simulation: Simulation,
    pub(super) writer: &'a mut dyn Recorder,
    pub(super) manifest: Manifest,
    pub(super) rows: Rows,
    pub(super) frames: Frames,
    /// Whether each probe had its recorded stresses after the last step.
    stressed: Vec<bool>,
    began: Instant,
    first_step: u64,
    /// Counts of earlier processes, up to the checkpoint from which this one began.
    pub(super) earlier: Tally,
    /// Largest rotation and strain of each linear-elastic body in a row so far, with their times.
    pub(super) rotations: BTreeMap<usize, [[f64; 2]; 2]>,
    /// Wall seconds spent on writing.
    output: f64,
    /// Processor seconds in steps.
    cpu: f64,
}

impl<'a> Session<'a> {
    pub(super) fn new(
        case: &'a Case,
        simulation: Simulation,
        writer: &'a mut dyn Recorder,
        manifest: Manifest,
    ) -> Self {
        let frames = Frames::new(case, &simulation);
        let rows = Rows::new(case, &simulation);
        let first_step = simulation.state().step;
        let stressed = stressed(&simulation);
        let rotations = rotations(case, simulation.model());
        let began = Instant::now();
        Self {
            case,
            simulation,
            writer,
            manifest,
            rows,
            frames,
            stressed,
            earlier: Tally::default(),
            rotations,
            began,
            first_step,
            output: 0.0,
            cpu: 0.0,
        }
    }

    /// Mesh repairs, warnings, row and fields of the initial state.
    pub(super) fn write_start(&mut self) -> Result<(), RunError> {
        let strain = self.simulation.state().ledger.strain;
        for event in repairs(self.case).into_iter().chain(relaxed(self.case, strain)) {
            self.writer.log(&event)?;
        }
        self.log_warnings(0)?;
        self.write_row()?;
        self.write_fields()
    }

    /// Logs the warnings from number `first` on.
    fn log_warnings(&mut self, first: usize) -> Result<(), RunError> {
        let state = self.simulation.state();
        for warning in &self.manifest.warnings[first..] {
            let event = Event::new(state.step, state.time, "warning", warning.to_string());
            self.writer.log(&event.with("id", warning.id.as_str()))?;
        }
        Ok(())
    }

    /// Adds the warnings that only the record of a run shows.
    fn add_warnings(&mut self, run: &Run, finished: bool) -> Result<(), RunError> {
        let known = self.manifest.warnings.len();
        let found = warnings_of_record(self.case, self.simulation.model(), run, finished);
        self.manifest.warnings.extend(found);
        self.log_warnings(known)
    }

    pub(super) fn go(
        mut self,
        observe: &mut (dyn FnMut(&Progress) + Send),
        stop: &AtomicBool,
        remarks: Vec<String>,
    ) -> Result<Outcome, RunError> {
        let mut end = End::Finished;
        let mut last = GridReport::default();
        while !self.simulation.finished() {
            if stop.load(Ordering::Relaxed) {
                end = End::Interrupted;
                break;
            }
            let mut report = GridReport::default();
            let busy = Busy::now(self.manifest.threads);
            let mut heard = Instant::now();
            let before = self.progress(&report);
            let advanced = self.simulation.advance_watched(&mut report, &mut |attempt| {
                if heard.elapsed() >= HEARTBEAT {
                    heard = Instant::now();
                    let Attempt { time, dt, rejected } = *attempt;
                    observe(&Progress { time, dt, rejected, bisecting: true, ..before });
                }
                if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            self.cpu += busy.seconds();
            if let Err(Stopped::Interrupted { .. }) = advanced {
                // The grid step is computed again when the run is resumed, and logged then.
                end = End::Interrupted;
                break;
            }
            let step = self.simulation.state().step + u64::from(advanced.is_err());
            for event in &report.events {
                self.writer.log(&in_units(self.case, entry(self.simulation.model(), step, event)))?;
            }
            self.count(&report);
            if let Err(stopped) = advanced {
                let event = Event::new(
                    step,
                    self.simulation.state().time,
                    "stopped",
                    self.case.in_units(&stopped.to_string()),
                );
                self.writer.log(&event)?;
                (end, last) = (End::Stopped(stopped), report);
                break;
            }
            self.log_lost_stress()?;
            let began = Instant::now();
            self.record(&report)?;
            self.output += began.elapsed().as_secs_f64();
            observe(&self.progress(&report));
        }
        self.close(end, &last, remarks)
    }

    /// Logs where a probe's stress ceases to exist. This depends on the states before and after the
    /// step only, so that a resumed run logs the same.
    fn log_lost_stress(&mut self) -> Result<(), RunError> {
        let now = stressed(&self.simulation);
        let model = self.simulation.model();
        let state = self.simulation.state();
        let ceased = self.stressed.iter().zip(&now).map(|(before, now)| *before && !now);
        for (probe, _) in model.probes.iter().zip(ceased).filter(|(_, ceased)| *ceased) {
            let message = format!(
                "probe \"{}\": J ≤ 0 in every cell at its point, though not at the quadrature points; its stress is NaN from here on until \
                 J > 0",
                probe.name
            );
            self.writer.log(&Event::new(state.step, state.time, "no-stress", message))?;
        }
        self.stressed = now;
        Ok(())
    }

    /// Writes the record of a grid step.
    fn record(&mut self, report: &GridReport) -> Result<(), RunError> {
        self.rows.since.add(report);
        let output = &self.case.output;
        let step = self.simulation.state().step;
        let last = self.simulation.finished();
        if step.is_multiple_of(output.history_every as u64) || last {
            self.write_row()?;
        }
        let in_contact = self.simulation.state().pairs.iter().flatten().any(|pair| pair.active);
        if self.frames.take(step, last, in_contact) {
            self.write_fields()?;
        }
        if step.is_multiple_of(output.checkpoint_every as u64) && !last {
            self.checkpoint()?;
        }
        Ok(())
    }

    fn write_row(&mut self) -> Result<(), RunError> {
        let model = self.simulation.model();
        let state = self.simulation.state();
        let (values, contacts) = self.rows.both(&self.simulation);
        self.rows.since = Since::default();
        for (body, largest) in &mut self.rotations {
            for (largest, now) in largest.iter_mut().zip(model.turn(*body, &state.y)) {
                if now > largest[0] {
                    *largest = [now, state.time];
                }
            }
        }
        self.writer.history(&values)?;
        let writer = &mut self.writer;
        model.threads.within(|| writer.contact(&contacts))?;
        Ok(())
    }

    fn write_fields(&mut self) -> Result<(), RunError> {
        if !self.frames.is_empty() {
            let model = self.simulation.model();
            let state = self.simulation.state();
            self.writer.fields(
                state.step,
                state.time,
                field_set(self.case, model, &self.rows.surfaces, state),
            )?;
        }
        Ok(())
    }

    /// Logs large rotations and strains of bodies whose strain is that of small displacements,
    /// once: the last checkpoint has none.
    fn log_rotations(&mut self) -> Result<(), RunError> {
        let step = self.simulation.state().step;
        for (body, [[angle, time], [strain, strained]]) in std::mem::take(&mut self.rotations) {
            let name = self.case.bodies[body].name.as_str();
            if strain > LARGE_STRAIN {
                let message = format!("a point of body \"{name}\" has the strain {strain:.3e}");
                let event = Event::new(step, strained, "strain", message);
                self.writer.log(&event.with("body", name).with("strain", strain))?;
            }
            if angle > LARGE_ROTATION {
                let message = format!("a point of body \"{name}\" has turned by {angle:.3e} rad");
                let event = Event::new(step, time, "rotation", message);
                self.writer.log(&event.with("body", name).with("angle", angle))?;
            }
        }
        Ok(())
    }

    fn count(&mut self, report: &GridReport) {
        let mut add = |name: &str, count: u32| {
            *self.manifest.counters.entry(name.into()).or_default() += u64::from(count);
        };
        add("newton", report.newton);
        add("rejected", report.rejected);
        add("activations", report.activations);
        add("releases", report.releases);
        if self.simulation.has_fallback() {
            add("fallbacks", report.fallbacks);
        }
    }

    fn progress(&self, report: &GridReport) -> Progress {
        let state = self.simulation.state();
        let steps = self.simulation.steps();
        let wall = self.began.elapsed().as_secs_f64();
        let done = (state.step - self.first_step).max(1);
        let ledger = &state.ledger;
        Progress {
            step: state.step,
            steps,
            time: state.time,
            dt: self.simulation.dt(),
            newton: report.newton,
            active: state.pairs.iter().flatten().filter(|p| p.active).count(),
            rejected: report.rejected,
            bisecting: false,
            activations: report.activations,
            releases: report.releases,
            created: if ledger.scale() > 0.0 { ledger.created.most() / ledger.scale() } else { 0.0 },
            wall,
            left: wall / done as f64 * (steps - state.step) as f64,
        }
    }

    /// Adds what this process has spent so far to what earlier ones had. A checkpoint holds both,
    /// so that a killed process is counted up to there.
    fn tally(&mut self) {
        let Tally { counters, timings, .. } = &self.earlier;
        let spent = self.simulation.timings();
        for (phase, seconds) in [
            ("assembly", spent.assembly),
            ("contact", spent.contact),
            ("factor", spent.factor),
            ("solve", spent.solve),
            ("output", self.output),
            ("cpu", self.cpu),
            ("total", self.began.elapsed().as_secs_f64()),
        ] {
            let earlier = timings.get(phase).copied().unwrap_or_default();
            self.manifest.timings.insert(phase.into(), earlier + seconds);
        }
        let earlier = |name: &str| counters.get(name).copied().unwrap_or_default();
        let factorisations = earlier("factorisations");
        let iterations = earlier("linear_iterations");
        let counters = &mut self.manifest.counters;
        counters.insert("steps".into(), self.simulation.state().step);
        counters.insert("factorisations".into(), factorisations + self.simulation.factorisations());
        if let Some(spent) = self.simulation.linear_iterations() {
            counters.insert("linear_iterations".into(), iterations + spent);
        }
    }

    /// Writes a checkpoint of the state as it is.
    fn checkpoint(&mut self) -> Result<(), RunError> {
        self.tally();
        if !self.writer.resumable() {
            return Ok(());
        }
        let state = self.simulation.state();
        let tally = Tally {
            counters: self.manifest.counters.clone(),
            timings: self.manifest.timings.clone(),
            rotations: self.rotations.clone(),
            frames: self.frames.written,
        };
        Ok(self.writer.checkpoint(state.step, &checkpoint(state, self.rows.since, &tally)?)?)
    }

    /// Writes why the simulation stopped, and what to try.
    fn explain(&mut self, stopped: &Stopped, last: &GridReport) -> Result<(), RunError> {
        let (mut stop, fields) = explain(self.case, &self.simulation, stopped, last);
        stop.advice = advice(&stop.kind, self.case, &self.manifest.source, stop.place.as_ref());
        Ok(self.writer.stop(&stop, &fields, &mut self.manifest)?)
    }

    /// Writes the last checkpoint and manifest, with the warnings and verdicts on the record.
    fn close(mut self, end: End, last: &GridReport, remarks: Vec<String>) -> Result<Outcome, RunError> {
        if matches!(end, End::Finished) {
            self.log_rotations()?;
        }
        self.checkpoint()?;
        let manifest = &mut self.manifest;
        (manifest.status, manifest.reason) = match &end {
            End::Finished => (Status::Finished, None),
            End::Interrupted => (Status::Stopped, Some("stopped by the user".into())),
            End::Stopped(stopped) => (Status::Failed, Some(self.case.in_units(&stopped.to_string()))),
        };
        if let End::Stopped(stopped) = &end {
            self.explain(stopped, last)?;
        }
        // A record that cannot be read does not make a finished run unfinished.
        let read = (end != End::Interrupted).then(|| self.writer.read());
        if let Some(Ok(run)) = &read {
            self.add_warnings(run, matches!(end, End::Finished))?;
        }
        let state = self.simulation.state();
        let wall = self.began.elapsed().as_secs_f64();
        let mut outcome = Outcome {
            directory: self.writer.directory().to_path_buf(),
            steps: state.step,
            time: state.time,
            wall,
            remarks,
            reason: self.manifest.reason.clone(),
            end,
            record: None,
        };
        self.writer.finish(&mut self.manifest)?;
        if let Some(run) = read.transpose()? {
            let mut run = Run { manifest: self.manifest, ..run };
            metrics::write(&run)?;
            if judge(&mut run, &self.case.expects) {
                self.writer.manifest(&run.manifest)?;
            }
            outcome.record = Some(run);
        }
        Ok(outcome)
    }
}

/// The bodies whose rotation is watched, not turned yet: one that is fixed is as it was given.
fn rotations(case: &Case, model: &Model) -> BTreeMap<usize, [[f64; 2]; 2]> {
    let moves = |k: usize| {
        let d = model.dimension;
        model.parts[k].nodes().any(|node| model.fixed[node * d..(node + 1) * d].contains(&false))
    };
    let is_linear = |body: &BodySpec| {
        case.dimension > 1 && case.materials_of(body).iter().any(|m| m.law == Law::LinearElastic)
    };
    let bodies = case.bodies.iter().enumerate().filter(|(k, body)| is_linear(body) && moves(*k));
    bodies.map(|(k, _)| (k, [[0.0; 2]; 2])).collect()
}

fn stressed(simulation: &Simulation) -> Vec<bool> {
    let model = simulation.model();
    let state = simulation.state();
    model
        .probes
        .iter()
        .map(|probe| probe.has_stress(&model.parts, &state.y, state.materials.past(0.0).memory))
        .collect()
}
