//! Clocks of the phases of a step.

/// Wall seconds by phase, for `--profile`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Timings {
    /// Cell forces and tangents.
    pub assembly: f64,
    /// Detection, gaps and their derivatives.
    pub contact: f64,
    /// Filling, ordering and factoring the linear system.
    pub factor: f64,
    /// Solving with the factors.
    pub solve: f64,
}

/// Runs `work` and adds the seconds it took to `clock`.
pub(crate) fn timed<T>(clock: &mut f64, work: impl FnOnce() -> T) -> T {
    let began = std::time::Instant::now();
    let done = work();
    *clock += began.elapsed().as_secs_f64();
    done
}
