//! The time loop: steps on the grid of times n·Δt, bisected after a rejection and returned to the
//! grid, monitored by the energy guard.

use carom_contact::{PairEvent, Passed};

use crate::grid::Grid;
use crate::model::Model;
use crate::penetration::Depths;
use crate::rejected::Rejected;
use crate::start::{Before, start};
use crate::state::{OtherModel, State};
use crate::stepper::{StepReport, Stepper};
use crate::substeps::{Next, Progress, decide};
use crate::timings::{Timings, timed};
use crate::workspace::Workspace;

/// Why a simulation stopped before its end; the state of the last grid time is preserved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Stopped {
    /// No step from here is accepted, however small.
    #[error(
        "the step at t = {time:.6} was bisected {halvings} times, to Δt = {dt:.3e}, and is still rejected: {rejected}"
    )]
    NoStep {
        /// Time of the last accepted state.
        time: f64,
        /// Smallest step tried.
        dt: f64,
        /// Bisections of the grid's step.
        halvings: u32,
        /// The reason for its rejection.
        rejected: Rejected,
    },
    /// The scheme created energy.
    #[error(
        "energy was created at t = {time:.6}: {created:.4e}, which is {} % of the energy scale {scale:.4e}; the limit is {} %", percent(created / scale), percent(*share)
    )]
    EnergyGuard {
        /// Time.
        time: f64,
        /// Rise of total − external work above its running minimum.
        created: f64,
        /// Allowed fraction.
        share: f64,
        /// Largest kinetic + strain energy so far, or Σ |ΔW| of the external work.
        scale: f64,
    },
}

/// A fraction in per cent, to three significant digits.
fn percent(fraction: f64) -> f64 {
    let percent = 100.0 * fraction;
    format!("{percent:.2e}").parse().unwrap_or(percent)
}

/// An event for the log.
#[derive(Clone, Debug, PartialEq)]
pub enum LogEvent {
    /// A step was rejected and will be bisected.
    Rejected {
        /// Time at its start.
        time: f64,
        /// Step size.
        dt: f64,
        /// Reason.
        rejected: Rejected,
    },
    /// A secondary node came into contact or left it.
    ActiveSet {
        /// Time at the end of the (sub)step.
        time: f64,
        /// Index of the contact.
        contact: usize,
        /// Global node.
        node: usize,
        /// Whether it came (true) or left.
        active: bool,
    },
    /// A pair changed its facet or slid off the end.
    Pair {
        /// Time at the end of the (sub)step.
        time: f64,
        /// Index of the contact.
        contact: usize,
        /// The event.
        event: PairEvent,
    },
    /// Two bodies without a contact overlap, or one crosses itself, for the first time.
    Overlap {
        /// Time.
        time: f64,
        /// Indices of the bodies.
        bodies: (usize, usize),
    },
    /// Velocities were projected at activation.
    Projection {
        /// Time.
        time: f64,
        /// Jump of kinetic energy.
        jump: f64,
    },
    /// Velocities of nodes that left contact were changed by its restitution.
    Restitution {
        /// Time.
        time: f64,
        /// Jump of kinetic energy.
        jump: f64,
    },
}

/// Events between two grid times.
#[derive(Clone, Debug, Default)]
pub struct GridReport {
    /// Newton iterations of the accepted steps.
    pub newton: u32,
    /// Rejected steps.
    pub rejected: u32,
    /// Nodes that came into contact.
    pub activations: u32,
    /// Nodes that left contact.
    pub releases: u32,
    /// Largest penetration at the ends of its steps.
    pub penetration: Depths,
    /// Events in order.
    pub events: Vec<LogEvent>,
}

impl GridReport {
    /// Adds an accepted step that ended at a time.
    fn add(&mut self, time: f64, step: StepReport) {
        self.newton += step.newton;
        self.activations += step.activations.len() as u32;
        self.releases += step.releases.len() as u32;
        self.penetration = self.penetration.max(step.penetration);
        for (list, active) in [(step.activations, true), (step.releases, false)] {
            let event = |(contact, node)| LogEvent::ActiveSet { time, contact, node, active };
            self.events.extend(list.into_iter().map(event));
        }
        let pairs = step.events.into_iter();
        self.events.extend(pairs.map(|(contact, event)| LogEvent::Pair { time, contact, event }));
        if step.projection != 0.0 {
            self.events.push(LogEvent::Projection { time, jump: step.projection });
        }
        if step.restitution != 0.0 {
            self.events.push(LogEvent::Restitution { time, jump: step.restitution });
        }
    }

    fn reject(&mut self, time: f64, dt: f64, rejected: Rejected) {
        self.rejected += 1;
        self.events.push(LogEvent::Rejected { time, dt, rejected });
    }

    /// Forgets the steps since an earlier report, but not the work on them.
    pub(crate) fn return_to(&mut self, earlier: Self) {
        let (newton, rejected) = (self.newton, self.rejected);
        let later = self.events.split_off(earlier.events.len());
        *self = Self { newton, rejected, ..earlier };
        let rejections = |event: &LogEvent| matches!(event, LogEvent::Rejected { .. });
        self.events.extend(later.into_iter().filter(rejections));
    }
}

/// A model with its state.
pub struct Simulation {
    model: Model,
    /// At the last grid time.
    state: State,
    grid: Grid,
    stepper: Box<dyn Stepper>,
    work: Workspace,
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
        before: Option<Before>,
        threads: usize,
    ) -> Result<Self, Rejected> {
        let mut simulation = Self::at(model, stepper, grid, State::default(), threads);
        let Self { model, work, .. } = &mut simulation;
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
        let work = Workspace::new(&model);
        Self { model, state, grid, stepper, work }
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

    /// Assembles the tangent of the internal forces at the current state, as for every factor. For
    /// measurements.
    ///
    /// # Errors
    /// If a cell is inverted.
    pub fn assemble(&mut self) -> Result<(), Rejected> {
        self.work.system.assemble(&self.model, &self.state.y)
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
        // On one of the threads, so that parallel calls within a step do not switch threads.
        let threads = self.model.threads.clone();
        threads.within(|| self.advance_here(report))
    }

    fn advance_here(&mut self, report: &mut GridReport) -> Result<(), Stopped> {
        let (start, length) = (self.grid.time(self.state.step), self.grid.length(self.state.step + 1));
        // The state after the substeps so far; none before the first.
        let mut reached: Option<State> = None;
        let mut progress = Progress { level: self.state.bisection.level(), done: 0 };
        let (mut kept, mut bisected) = (None, false);
        while progress.done() < 1.0 {
            let dt = length / f64::from(1_u32 << progress.level);
            let time = start + progress.done as f64 * dt;
            let to = start + (progress.done + 1) as f64 * dt;
            let from = reached.as_ref().unwrap_or(&self.state);
            let stepped = self.stepper.step(&self.model, from, dt, to, &mut self.work);
            let stepped = stepped.and_then(|step| {
                let check = || nothing_passed(&self.model, &from.y, &step.state().y);
                timed(&mut self.work.timings.contact, check)?;
                Ok(step)
            });
            let (taken, rejected) =
                match decide(stepped, from, self.grid.guard, &mut kept, &mut progress, report) {
                    Next::Take(step) => (Some(step), None),
                    Next::Bisect(rejected) => (None, Some(rejected)),
                    Next::Return(rejected, step) => (Some(step), Some(rejected)),
                    Next::Stop(rejected) => {
                        report.reject(time, dt, rejected.clone());
                        return Err(Stopped::NoStep { time, dt, halvings: progress.level, rejected });
                    }
                };
            if let Some(rejected) = rejected {
                report.reject(time, dt, rejected);
            }
            let Some(step) = taken else {
                progress.bisect();
                bisected = true;
                continue;
            };
            let (next, step) = step.into_parts();
            report.add(next.time, step);
            if let Some(before) = reached.replace(next) {
                self.work.put(before);
            }
            progress.advance();
        }
        let Some(mut state) = reached else { return Ok(()) };
        state.bisection = self.state.bisection.after(bisected);
        state.step += 1;
        state.time = self.grid.time(state.step);
        let mut overlapping = self.work.others.overlapping(&self.model, &state.y);
        overlapping.extend(self.work.others.crossing_themselves(&self.model, &state.y));
        for pair in overlapping {
            if !state.overlaps.contains(&pair) {
                state.overlaps.push(pair);
                report.events.push(LogEvent::Overlap { time: state.time, bodies: pair });
            }
        }
        self.watch(&state)?;
        self.work.put(std::mem::replace(&mut self.state, state));
        Ok(())
    }

    /// Checks the energy guard.
    fn watch(&self, state: &State) -> Result<(), Stopped> {
        let Some(share) = self.grid.guard else { return Ok(()) };
        let ledger = &state.ledger;
        let (created, scale) = (ledger.rise(), ledger.scale());
        if ledger.created() > share * scale {
            return Err(Stopped::EnergyGuard { time: state.time, created, share, scale });
        }
        Ok(())
    }
}

/// That no node was inside a body between these positions.
fn nothing_passed(model: &Model, before: &[f64], now: &[f64]) -> Result<(), Rejected> {
    for contact in &model.contacts {
        if let Some(Passed { node, depth, limit }) = contact.kinematics.passed(before, now) {
            return Err(Rejected::Passed { contact: contact.name.clone(), node, depth, limit });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentages_have_three_digits() {
        let stopped = Stopped::EnergyGuard { time: 0.5, created: 0.0123456, share: 5e-6, scale: 0.1 };
        let message = "energy was created at t = 0.500000: 1.2346e-2, which is 12.3 % of the energy scale 1.0000e-1; the limit is 0.0005 %";
        assert_eq!(stopped.to_string(), message);
    }
}
