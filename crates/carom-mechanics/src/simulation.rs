//! The time loop: steps on the grid of times n·Δt, bisected after a rejection and returned to the
//! grid, monitored by the energy guard. Where the run would stop, the fallback, if there is one,
//! takes the grid step from its start.

use std::ops::ControlFlow;

use carom_contact::Passed;

use crate::check::overlapping::Overlap;
use crate::grid::Grid;
use crate::grid_report::{Attempt, GridReport, LogEvent};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::stage::balance::lacks_balance;
use crate::start::{Inertia, InitialState, start};
use crate::state::{FEW, OtherModel, State};
use crate::stepper::Stepper;
use crate::stopped::Stopped;
use crate::substeps::{Limits, MOST, Next, Progress, decide};
use crate::timings::{Timings, timed};
use crate::trace::Trace;
use crate::workspace::Workspace;

/// What is called between the trial steps of a grid step.
type Watch<'a> = dyn FnMut(&Attempt) -> ControlFlow<()> + Send + 'a;

/// A model with its state.
pub struct Simulation {
    model: Model,
    /// At the last grid time.
    state: State,
    grid: Grid,
    stepper: Box<dyn Stepper>,
    /// Takes grid steps that the stepper cannot take.
    fallback: Option<Box<dyn Stepper>>,
    work: Workspace,
    /// Bisections of Δt before the run stops.
    bisections: u32,
}

impl Simulation {
    /// A model at t = 0, with or without inertia, in its initial positions or at the end of another
    /// run. Cells are computed by this many threads; the result does not depend on it.
    ///
    /// # Errors
    /// If the start has no forces or no accelerations.
    pub fn new(
        model: Model,
        stepper: Box<dyn Stepper>,
        grid: Grid,
        inertia: bool,
        before: Option<InitialState>,
        threads: usize,
    ) -> Result<Self, Rejected> {
        let mut simulation = Self::at(model, stepper, grid, State::default(), threads);
        let Self { model, work, stepper, .. } = &mut simulation;
        let inertia = match (inertia, stepper.accelerates_freely()) {
            (false, _) => Inertia::None,
            (true, false) => Inertia::Constrained,
            (true, true) => Inertia::Free,
        };
        simulation.state = start(model, inertia, before, &mut work.system)?;
        Ok(simulation)
    }

    /// A model resumed from a state of an earlier run.
    ///
    /// # Errors
    /// If the state is of another model.
    pub fn resume(
        model: Model,
        stepper: Box<dyn Stepper>,
        grid: Grid,
        state: State,
        threads: usize,
    ) -> Result<Self, OtherModel> {
        state.fits(&model)?;
        Ok(Self::at(model, stepper, grid, state, threads))
    }

    fn at(model: Model, stepper: Box<dyn Stepper>, grid: Grid, state: State, threads: usize) -> Self {
        let model = model.on_threads(threads);
        let mut work = Workspace::new(&model, stepper.linear());
        work.system.restored.clone_from(&state.frozen.point);
        Self { model, state, grid, stepper, fallback: None, work, bisections: MOST }
    }

    /// The constant data.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The state at the last grid time.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The state at the last grid time, kept alone.
    pub fn into_state(self) -> State {
        self.state
    }

    /// Takes grid steps at which the run would stop with another stepper, from their start.
    #[must_use]
    pub fn with_fallback(self, fallback: Option<Box<dyn Stepper>>) -> Self {
        Self { fallback, ..self }
    }

    /// Whether there is a fallback.
    pub fn has_fallback(&self) -> bool {
        self.fallback.is_some()
    }

    /// Stops after fewer bisections of a step than usual. What succeeds nevertheless is what would
    /// have succeeded without.
    pub fn limit_bisections(&mut self, most: u32) {
        self.bisections = most.min(MOST);
    }

    /// The last iterations of the last attempt.
    pub fn trace(&self) -> &Trace {
        &self.work.trace
    }

    /// The grid of times.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Grid step Δt.
    pub fn dt(&self) -> f64 {
        self.grid.dt
    }

    /// Grid steps to the end.
    pub fn steps(&self) -> u64 {
        self.grid.steps
    }

    /// Continues from another state of the same model: what follows is bitwise what followed it
    /// then.
    ///
    /// # Errors
    /// If the state is of another model.
    pub fn restore(&mut self, state: State) -> Result<(), OtherModel> {
        state.fits(&self.model)?;
        self.state = state;
        Ok(())
    }

    /// Whether the end time is reached.
    pub fn finished(&self) -> bool {
        self.state.step >= self.grid.steps
    }

    /// Wall time by phase so far.
    pub fn timings(&self) -> Timings {
        self.work.timings
    }

    /// Factorisations of the linear system so far.
    pub fn factorisations(&self) -> u64 {
        self.work.system.factorisations
    }

    /// Iterations of conjugate gradients so far; none if linear systems are solved directly.
    pub fn linear_iterations(&self) -> Option<u64> {
        self.work.system.preconditioner.iterations()
    }

    /// Assembles the tangent of the internal forces at the current state, as for every
    /// factorisation. For measurements.
    ///
    /// # Errors
    /// If a cell is inverted.
    pub fn assemble(&mut self) -> Result<(), Rejected> {
        let Self { work, model, state, .. } = self;
        work.system.assemble(model, &state.configuration())
    }

    /// Advances to the next grid time and reports what happened.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn step(&mut self) -> Result<GridReport, Stopped> {
        let mut report = GridReport::default();
        self.advance(&mut report)?;
        Ok(report)
    }

    /// Advances to the next grid time.
    ///
    /// # Errors
    /// Why it cannot; `state` is then still that of the last grid time. The report contains the
    /// attempts.
    pub fn advance(&mut self, report: &mut GridReport) -> Result<(), Stopped> {
        self.advance_watched(report, &mut |_| ControlFlow::Continue(()))
    }

    /// As [`Simulation::advance`]; `watch` is called after every rejected attempt and every
    /// substep, and may end the run there.
    ///
    /// # Errors
    /// As [`Simulation::advance`]; [`Stopped::Interrupted`] if `watch` ends it.
    pub fn advance_watched(&mut self, report: &mut GridReport, watch: &mut Watch) -> Result<(), Stopped> {
        // On one of the threads, so that parallel calls within a step do not switch threads.
        let threads = self.model.threads.clone();
        threads.within(|| self.advance_here(report, watch))
    }

    fn advance_here(&mut self, report: &mut GridReport, watch: &mut Watch) -> Result<(), Stopped> {
        let before = self.fallback.is_some().then(|| report.clone());
        let step = self.state.step;
        let end = self.grid.time(step) + self.grid.length(step + 1);
        let state = match (self.step_or_fade(report, watch), before) {
            (Err(stopped), Some(before)) if stopped.is_of_the_method(end) => {
                let time = self.state.time;
                let dt = self.grid.length(step + 1);
                report.return_to(before);
                report.fall_back(time, dt, stopped.to_string());
                self.grid_step(true, report, watch)?
            }
            (stepped, _) => stepped?,
        };
        self.work.put(std::mem::replace(&mut self.state, state));
        Ok(())
    }

    /// The state at the next grid time, by the stepper. A start that lacks balance, as where a
    /// support lets go or loads act at once, asks a load step of any length for the same: where
    /// none converges, what is lacking fades until the end of the grid step.
    fn step_or_fade(&mut self, report: &mut GridReport, watch: &mut Watch) -> Result<State, Stopped> {
        let may_fade = self.state.step == 0 && self.stepper.is_static();
        let before = may_fade.then(|| report.clone());
        let stepped = self.grid_step(false, report, watch);
        let end = self.grid.time(0) + self.grid.length(1);
        match (stepped, before) {
            (Err(stopped), Some(before))
                if stopped.is_of_the_method(end) && lacks_balance(&self.model, &self.state) =>
            {
                let trace = std::mem::take(&mut self.work.trace);
                report.return_to(before);
                report.events.push(LogEvent::Faded { time: self.state.time, end });
                self.work.fade_until = Some(end);
                let faded = self.grid_step(false, report, watch);
                self.work.fade_until = None;
                if faded.as_ref().is_err_and(|again| again.is_of_the_method(end)) {
                    self.work.trace = trace;
                    return Err(stopped);
                }
                faded
            }
            (stepped, _) => stepped,
        }
    }

    /// The state at the next grid time, by the stepper or the fallback.
    fn grid_step(
        &mut self,
        falls_back: bool,
        report: &mut GridReport,
        watch: &mut Watch,
    ) -> Result<State, Stopped> {
        let start = self.grid.time(self.state.step);
        let length = self.grid.length(self.state.step + 1);
        // The state after the substeps so far; none before the first.
        let mut reached: Option<State> = None;
        let level = if falls_back { 0 } else { self.state.bisection.level() };
        let mut progress = Progress { level, done: 0 };
        let mut stored = None;
        let mut bisected = false;
        let before = report.rejected;
        let end = start + length;
        let bisections =
            if falls_back { self.bisections.min(FEW) } else { self.state.bisection.limit(self.bisections) };
        let limits = Limits { guard: self.grid.guard, floor: self.grid.floor, bisections, end };
        while progress.done() < 1.0 {
            let dt = length / f64::from(1_u32 << progress.level);
            let time = start + progress.done as f64 * dt;
            let to = start + (progress.done + 1) as f64 * dt;
            let from = reached.as_ref().unwrap_or(&self.state);
            self.work.trace.clear();
            let stepper = self.fallback.as_ref().filter(|_| falls_back).unwrap_or(&self.stepper);
            let stepped = stepper.step(&self.model, from, dt, to, &mut self.work);
            let stepped = stepped.and_then(|step| {
                let state = step.state();
                let Workspace { timings, valid_cells, .. } = &mut self.work;
                let times = [from.time, state.time];
                let positions = [&from.y[..], &state.y[..]];
                let check = || valid_cells.check_paths(&self.model, times, positions);
                timed(&mut timings.assembly, check)?;
                timed(&mut timings.contact, || nothing_passed(&self.model, &from.y, &state.y))?;
                Ok(step)
            });
            let mut taken = None;
            let mut why = None;
            match decide(stepped, from, limits, &mut stored, &mut progress, report) {
                Next::Take(step) => taken = Some(step),
                Next::Bisect(rejected) => why = Some(rejected),
                Next::Return(rejected, step) => {
                    taken = Some(step);
                    why = Some(rejected);
                }
                Next::Stop(rejected) => {
                    report.reject(time, dt, rejected.clone());
                    return Err(Stopped::NoStep { time, dt, halvings: progress.level, rejected });
                }
            }
            if let Some(rejected) = why {
                report.reject(time, dt, rejected);
            }
            // A whole grid step is its own end.
            if (report.rejected > before || progress.level > 0)
                && watch(&Attempt { time, dt, rejected: report.rejected - before }).is_break()
            {
                return Err(Stopped::Interrupted { time: self.state.time, dt: length });
            }
            let Some(step) = taken else {
                progress.bisect();
                continue;
            };
            let (next, step) = step.into_parts();
            report.add(next.time, step);
            if let Some(before) = reached.replace(next) {
                self.work.put(before);
            }
            // A step over the whole grid step replaces those within it.
            bisected = progress.level > 0;
            progress.advance();
        }
        let Some(mut state) = reached else { return Ok(self.state.clone()) };
        let recently = self.state.bisection;
        state.bisection = if falls_back { recently.after_fallback() } else { recently.after(bisected) };
        state.step += 1;
        state.time = self.grid.time(state.step);
        let Workspace { undeclared, timings, .. } = &mut self.work;
        let undeclared = timed(&mut timings.contact, || undeclared.found(&self.model, &state.y));
        let deep: Vec<Overlap> = report.doubtful.iter().map(|&contact| Overlap::Sides { contact }).collect();
        for overlap in undeclared.into_iter().chain(deep) {
            if !state.overlaps.contains(&overlap) {
                state.overlaps.push(overlap);
                report.events.push(LogEvent::Overlap { time: state.time, overlap });
            }
        }
        if let Err(stopped) = self.watch(&state) {
            self.work.trace.end(&state.y);
            return Err(stopped);
        }
        Ok(state)
    }

    /// Checks the energy guard.
    fn watch(&self, state: &State) -> Result<(), Stopped> {
        let Some(share) = self.grid.guard else { return Ok(()) };
        let ledger = &state.ledger;
        let created = ledger.created();
        let scale = ledger.scale();
        if ledger.surely_created() > share * scale + self.grid.floor {
            return Err(Stopped::EnergyGuard { time: state.time, dt: self.grid.dt, created, share, scale });
        }
        Ok(())
    }
}

/// That no node was inside a body between these positions.
fn nothing_passed(model: &Model, before: &[f64], now: &[f64]) -> Result<(), Rejected> {
    for contact in &model.contacts {
        if let Some(Passed { what, node, depth, limit }) =
            contact.kinematics.passed(before, now, contact.depths.kinks)
        {
            return Err(Rejected::Passed { contact: contact.name.clone(), what, node, depth, limit });
        }
    }
    Ok(())
}
