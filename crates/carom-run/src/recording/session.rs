//! `run` and `resume`: run a simulation to its end, with records, checkpoints and manifest.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use carom_case::Case;
use carom_mechanics::{Attempt, GridReport, Simulation, State, Stopped, penetration};
use carom_record::{ContactRow, Event, Manifest, Run, RunWriter, Source, Status, Stop};
use cpu_time::{ProcessTime, ThreadTime};
use serde::{Deserialize, Serialize};

use super::columns::{Since, center_weights, columns, row};
use super::fields::{consistent_weights, field_set, gap_of, sides};
use super::log::{entry, relaxed, repairs};
use super::outcome::{End, Options, Outcome, Progress, RunError};
use super::stopped::{FEW, Found, Record};
use super::verdicts::judge;
use crate::setup::Setup;
use crate::warnings::{warnings, warnings_of_record};

/// Time between signs of life while a step is bisected.
const HEARTBEAT: Duration = Duration::from_secs(1);

/// What a run has counted, and where its time went, up to a checkpoint.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Tally {
    counters: BTreeMap<String, u64>,
    timings: BTreeMap<String, f64>,
}

/// Data of a step besides the simulation.
struct Session<'a> {
    case: &'a Case,
    simulation: Simulation,
    writer: RunWriter,
    manifest: Manifest,
    weights: Vec<f64>,
    field_steps: Vec<u64>,
    /// Whether each probe had its recorded stresses after the last step.
    stressed: Vec<bool>,
    began: Instant,
    first_step: u64,
    /// What happened since the previous row.
    since: Since,
    /// What earlier processes counted up to the checkpoint that this one began from.
    earlier: Tally,
    /// Wall seconds spent on writing.
    output: f64,
    /// Processor seconds in steps.
    cpu: f64,
    values: Vec<f64>,
    /// States for trials, the latest first; none of a run that was resumed.
    trials_from: Option<[State; 2]>,
}

/// Runs a case into a directory that must not exist yet.
///
/// # Errors
/// The case's problems (nothing is written), or an input/output error.
pub fn run(
    case: &Case,
    source: Source,
    directory: &Path,
    options: Options,
    observe: &mut (dyn FnMut(&Progress) + Send),
    stop: &AtomicBool,
) -> Result<Outcome, RunError> {
    let simulation = Setup::new(case).threads(options.threads).start().map_err(RunError::Case)?;
    let simulation = if options.audit { simulation.audited() } else { simulation };
    let resolved = serde_json::to_value(case).map_err(|e| RunError::Incompatible { what: e.to_string() })?;
    let version = env!("CARGO_PKG_VERSION");
    let mut manifest =
        Manifest::new(version, resolved, source, columns(case, simulation.model()), options.threads);
    manifest.sides = sides(simulation.model());
    manifest.warnings = warnings(case, simulation.model());
    let writer = RunWriter::create(
        directory,
        &manifest,
        &bytes(simulation.state(), Since::default(), &Tally::default())?,
    )?;
    let mut session = Session::new(case, simulation, writer, manifest);
    session.trials_from = options.trials.then(|| [(); 2].map(|()| session.simulation.state().clone()));
    session.write_start()?;
    session.go(options, observe, stop, Vec::new())
}

/// Resumes a run that was stopped or killed; a finished one is returned as it is.
///
/// # Errors
/// As [`run`], and if the record does not fit this version.
pub fn resume(
    directory: &Path,
    options: Options,
    observe: &mut (dyn FnMut(&Progress) + Send),
    stop: &AtomicBool,
) -> Result<Outcome, RunError> {
    let manifest = Manifest::read(directory)?;
    let case: Case =
        serde_json::from_value(manifest.case.clone()).map_err(|error| RunError::Incompatible {
            what: format!(
                "the case in {} was resolved by Carom {} and does not fit this version: {error}",
                directory.join("manifest.json").display(),
                manifest.version
            ),
        })?;
    let case = &case;
    if manifest.status == Status::Finished {
        // The process may have been killed between the last row and the verdicts.
        if manifest.expectations.is_empty() && !case.expects.is_empty() {
            judge(Run::open(directory)?, &case.expects)?;
        }
        let steps = case.time.steps();
        return Ok(Outcome {
            directory: directory.to_path_buf(),
            end: End::Finished,
            steps: steps as u64,
            time: case.time.end,
            wall: 0.0,
            remarks: vec!["the run was already finished; nothing was computed".into()],
        });
    }
    let reopened = RunWriter::reopen(directory)?;
    let (state, since, tally): (State, Since, Tally) =
        postcard::from_bytes(&reopened.payload).map_err(|error| RunError::Incompatible {
            what: format!(
                "the checkpoint of {} does not fit this version of Carom: {error}",
                directory.display()
            ),
        })?;
    let simulation = Setup::new(case).threads(options.threads).resume(state).map_err(RunError::Case)?;
    let simulation = if options.audit { simulation.audited() } else { simulation };
    let mut manifest = reopened.manifest;
    manifest.status = Status::Running;
    // Those of a killed process are older in the manifest.
    (manifest.counters, manifest.timings) = (tally.counters.clone(), tally.timings.clone());
    manifest.reason = None;
    Stop::forget(directory, &mut manifest);
    manifest.started = carom_record::now();
    manifest.threads = options.threads;
    let remarks = reopened.fallback.iter().map(ToString::to_string).collect();
    let mut session = Session::new(case, simulation, reopened.writer, manifest);
    (session.since, session.earlier) = (since, tally);
    session.writer.manifest(&session.manifest)?;
    if reopened.rows == 0 {
        session.write_start()?;
    }
    session.go(options, observe, stop, remarks)
}

impl<'a> Session<'a> {
    fn new(case: &'a Case, simulation: Simulation, mut writer: RunWriter, manifest: Manifest) -> Self {
        writer.field_format(case.output.format);
        let at = |time: &f64| simulation.grid().nearest(*time);
        let field_steps = case.output.at_times.iter().map(at).collect();
        let weights = center_weights(simulation.model());
        let first_step = simulation.state().step;
        let stressed = stressed(&simulation);
        let began = Instant::now();
        Self {
            case,
            simulation,
            writer,
            manifest,
            weights,
            field_steps,
            stressed,
            since: Since::default(),
            earlier: Tally::default(),
            began,
            first_step,
            output: 0.0,
            cpu: 0.0,
            values: Vec::new(),
            trials_from: None,
        }
    }

    /// Mesh repairs, warnings, row and fields of the initial state.
    fn write_start(&mut self) -> Result<(), RunError> {
        let strain = self.simulation.state().ledger.strain;
        for event in repairs(self.case).into_iter().chain(relaxed(self.case, strain)) {
            self.writer.log(&event)?;
        }
        self.log_warnings(0)?;
        let penetration = penetration(self.simulation.model(), self.simulation.state());
        self.since.add(&GridReport { penetration, ..GridReport::default() });
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

    /// Adds the warnings that only the record of a finished run shows.
    fn add_warnings(&mut self, run: &Run) -> Result<(), RunError> {
        let known = self.manifest.warnings.len();
        self.manifest.warnings.extend(warnings_of_record(self.case, run));
        self.log_warnings(known)
    }

    fn go(
        mut self,
        options: Options,
        observe: &mut (dyn FnMut(&Progress) + Send),
        stop: &AtomicBool,
        remarks: Vec<String>,
    ) -> Result<Outcome, RunError> {
        let (mut end, mut last) = (End::Finished, GridReport::default());
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
            });
            self.cpu += busy.seconds();
            let step = self.simulation.state().step + u64::from(advanced.is_err());
            for event in &report.events {
                self.writer.log(&entry(self.simulation.model(), step, event))?;
            }
            self.count(&report);
            if let Err(stopped) = advanced {
                let event = Event::new(step, self.simulation.state().time, "stopped", stopped.to_string());
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
        self.close(end, &last, options, stop, remarks)
    }

    /// Logs where a probe's stress ceases to exist. This depends on the states before and after the
    /// step only, so that a resumed run logs the same.
    fn log_lost_stress(&mut self) -> Result<(), RunError> {
        let now = stressed(&self.simulation);
        let (model, state) = (self.simulation.model(), self.simulation.state());
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
        self.since.add(report);
        let output = &self.case.output;
        let (step, last) = (self.simulation.state().step, self.simulation.finished());
        if step % output.history_every as u64 == 0 || last {
            self.write_row()?;
        }
        let every = output.fields_every as u64;
        if (every > 0 && (step % every == 0 || last)) || self.field_steps.contains(&step) {
            self.write_fields()?;
        }
        if step % output.checkpoint_every as u64 == 0 && !last {
            self.checkpoint()?;
        }
        if let Some(states) = &mut self.trials_from
            && step % FEW.max(output.checkpoint_every as u64) == 0
        {
            states.rotate_right(1);
            states[0].clone_from(self.simulation.state());
        }
        Ok(())
    }

    fn write_row(&mut self) -> Result<(), RunError> {
        let (model, state) = (self.simulation.model(), self.simulation.state());
        let dt = self.simulation.grid().length(state.step);
        row(model, state, dt, &self.since, &self.weights, &mut self.values);
        self.since = Since::default();
        self.writer.history(&self.values)?;
        for (contact, pairs) in model.contacts.iter().zip(&state.pairs) {
            if pairs.iter().all(|p| !p.active) {
                continue;
            }
            let weights = consistent_weights(contact, state, self.case.thickness);
            // In a dent, a node has several pairs.
            let mut of_node = vec![0.0; weights.len()];
            pairs.iter().filter(|p| p.active).for_each(|pair| of_node[pair.node] += pair.lambda);
            for pair in pairs.iter().filter(|p| p.active) {
                let node = contact.kinematics.secondary()[pair.node];
                let y = &state.y[node * model.dimension..(node + 1) * model.dimension];
                let (gap, normal) = gap_of(contact, pair, state);
                self.writer.contact(&ContactRow {
                    step: state.step,
                    time: state.time,
                    contact: contact.name.as_str().into(),
                    node: node as u64,
                    point: std::array::from_fn(|i| y.get(i).copied().unwrap_or(0.0)),
                    facet: pair.facet as u64,
                    xi: pair.xi,
                    gap,
                    multiplier: pair.lambda,
                    pressure: -of_node[pair.node] / weights[pair.node],
                    normal,
                })?;
            }
        }
        Ok(())
    }

    fn write_fields(&mut self) -> Result<(), RunError> {
        if self.case.output.fields_every > 0 || !self.field_steps.is_empty() {
            let (model, state) = (self.simulation.model(), self.simulation.state());
            self.writer.fields(state.step, state.time, &field_set(self.case, model, state))?;
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
    }

    fn progress(&self, report: &GridReport) -> Progress {
        let (state, steps) = (self.simulation.state(), self.simulation.steps());
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

    /// Adds what this process has spent so far to what earlier ones had. A checkpoint holds both, so
    /// that a killed process is counted up to there.
    fn tally(&mut self) {
        let Tally { counters, timings } = &self.earlier;
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
        let factorisations = counters.get("factorisations").copied().unwrap_or_default();
        let counters = &mut self.manifest.counters;
        counters.insert("steps".into(), self.simulation.state().step);
        counters.insert("factorisations".into(), factorisations + self.simulation.factorisations());
    }

    /// Writes a checkpoint of the state as it is.
    fn checkpoint(&mut self) -> Result<(), RunError> {
        self.tally();
        let state = self.simulation.state();
        let tally =
            Tally { counters: self.manifest.counters.clone(), timings: self.manifest.timings.clone() };
        Ok(self.writer.checkpoint(state.step, &bytes(state, self.since, &tally)?)?)
    }

    /// Writes why the simulation stopped, before and after the trials: a process that is killed in them
    /// leaves a run that stopped.
    fn explain(
        &mut self,
        stopped: &Stopped,
        last: &GridReport,
        options: Options,
        interrupted: &AtomicBool,
    ) -> Result<(), RunError> {
        let source = self.manifest.source.clone();
        let (case, simulation, earlier) = (self.case, &self.simulation, self.trials_from.as_ref());
        let record = Record { case, source: &source, simulation, earlier };
        let mut found = Found::new(&record, stopped, last);
        found.write(self.writer.directory(), &mut self.manifest)?;
        if options.trials {
            self.writer.manifest(&self.manifest)?;
            found.try_out(&record, options.threads, interrupted);
            found.write(self.writer.directory(), &mut self.manifest)?;
            self.writer.manifest(&self.manifest)?;
        }
        Ok(())
    }

    /// Writes the last checkpoint and manifest, with the warnings and verdicts on the record.
    fn close(
        mut self,
        end: End,
        last: &GridReport,
        options: Options,
        interrupted: &AtomicBool,
        remarks: Vec<String>,
    ) -> Result<Outcome, RunError> {
        self.checkpoint()?;
        let manifest = &mut self.manifest;
        (manifest.status, manifest.reason) = match &end {
            End::Finished => (Status::Finished, None),
            End::Interrupted => (Status::Stopped, Some("stopped by the user".into())),
            End::Stopped(stopped) => (Status::Failed, Some(stopped.to_string())),
        };
        if let End::Stopped(stopped) = &end {
            self.explain(stopped, last, options, interrupted)?;
        }
        // A record that cannot be read does not make a finished run unfinished.
        let asked = match end {
            End::Finished => true,
            End::Stopped(_) => !self.case.expects.is_empty(),
            End::Interrupted => false,
        };
        let read = asked.then(|| Run::open(self.writer.directory()));
        if let (End::Finished, Some(Ok(run))) = (&end, &read) {
            self.add_warnings(run)?;
        }
        let state = self.simulation.state();
        let wall = self.began.elapsed().as_secs_f64();
        let outcome = Outcome {
            directory: self.writer.directory().to_path_buf(),
            steps: state.step,
            time: state.time,
            wall,
            remarks,
            end,
        };
        self.writer.finish(&self.manifest)?;
        if let Some(run) = read.transpose()? {
            judge(Run { manifest: self.manifest, ..run }, &self.case.expects)?;
        }
        Ok(outcome)
    }
}

fn stressed(simulation: &Simulation) -> Vec<bool> {
    let (model, state) = (simulation.model(), simulation.state());
    model.probes.iter().map(|probe| probe.has_stress(&model.parts, &state.y)).collect()
}

/// A checkpoint: the state, what the next row will count, and what the run has counted.
fn bytes(state: &State, since: Since, tally: &Tally) -> Result<Vec<u8>, RunError> {
    postcard::to_stdvec(&(state, since, tally))
        .map_err(|e| RunError::Incompatible { what: format!("the state cannot be encoded: {e}") })
}

/// Processor time: of this thread alone, since other runs may share the process; of the whole
/// process if steps use several threads.
enum Busy {
    Thread(ThreadTime),
    Process(ProcessTime),
}

impl Busy {
    fn now(threads: usize) -> Self {
        if threads == 1 { Self::Thread(ThreadTime::now()) } else { Self::Process(ProcessTime::now()) }
    }

    fn seconds(&self) -> f64 {
        match self {
            Self::Thread(began) => began.elapsed().as_secs_f64(),
            Self::Process(began) => began.elapsed().as_secs_f64(),
        }
    }
}
