//! The grid of times of a run.

/// A grid of times with its energy guard: 0, (1 − phase)Δt, (2 − phase)Δt, … , end. A phase other
/// than 0 shifts all instants between by this fraction of a step; the first and the last step are
/// shorter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Step Δt.
    pub dt: f64,
    /// Steps to the end.
    pub steps: u64,
    /// Shift as a fraction of a step, in [0, 1).
    pub phase: f64,
    /// Fraction of the energy scale so far that may be created before the run stops; none
    /// disables the guard.
    pub guard: Option<f64>,
    /// Energy of round-off of positions, which may always be created.
    pub floor: f64,
}

impl Grid {
    /// The time after so many steps.
    pub fn time(&self, step: u64) -> f64 {
        if self.phase == 0.0 {
            step as f64 * self.dt
        } else if step == 0 {
            0.0
        } else if step < self.steps {
            (step as f64 - self.phase) * self.dt
        } else {
            (self.steps - 1) as f64 * self.dt
        }
    }

    /// Length of a step, counted from 1.
    pub fn length(&self, step: u64) -> f64 {
        if self.phase == 0.0 {
            self.dt
        } else if step <= 1 {
            (1.0 - self.phase) * self.dt
        } else if step < self.steps {
            self.dt
        } else {
            self.phase * self.dt
        }
    }

    /// Number of the step whose end is nearest to a time.
    pub fn nearest(&self, time: f64) -> u64 {
        // The first and the last step may be shorter.
        let step = ((time / self.dt + self.phase).round() as u64).min(self.steps);
        let nearer = |other: &u64| (self.time(*other) - time).abs() < (self.time(step) - time).abs();
        [step.saturating_sub(1), (step + 1).min(self.steps)].into_iter().find(nearer).unwrap_or(step)
    }
}
