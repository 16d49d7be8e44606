//! What a step computes in: scratch that outlives it, and clocks.

use carom_contact::Linearised;
use carom_time::Stage;

use crate::balance::Forces;
use crate::evaluation::Trial;
use crate::mixing::Mixing;
use crate::model::{LoadsAt, Model, Prescribed};
use crate::state::Means;
use crate::system::System;

/// Scratch that is rebuilt at will and never changes a bit of a result.
pub struct Workspace<const D: usize> {
    /// Linear system.
    pub(crate) system: System<D>,
    /// Forces of the last evaluation.
    pub(crate) forces: Forces,
    /// Accelerations of the last evaluation.
    pub(crate) acceleration: Vec<f64>,
    /// Linearised gaps of every pair of every contact.
    pub(crate) gaps: Vec<Vec<Linearised<D>>>,
    /// ∂λ/∂g of every pair of every contact that is a spring now; 0 of the others.
    pub(crate) stiffnesses: Vec<Vec<f64>>,
    /// Energy of the springs of penalties at the last evaluation.
    pub(crate) springs: f64,
    /// The stage being solved.
    pub(crate) stage: Stage,
    /// Means over the step, as far as its stages are solved.
    pub(crate) means: Means,
    /// Wall time by phase.
    pub timings: Timings,
    /// r of the last evaluation over all dofs: at held ones, the force of their support.
    pub(crate) residual: Vec<f64>,
    /// Loads at the stage's time.
    pub(crate) loads: LoadsAt,
    /// Moved dofs at the stage's end.
    pub(crate) motions: Vec<Prescribed>,
    /// What moved dofs still have to go; zero elsewhere.
    pub(crate) remaining: Vec<f64>,
    /// ∂f_int/∂y · remaining.
    pub(crate) pull: Vec<f64>,
    /// Right-hand side of a solve.
    pub(crate) right: Vec<f64>,
    /// Positions the internal forces are taken at.
    pub(crate) at: Vec<f64>,
    /// Δy of the last solve.
    pub(crate) correction: Vec<f64>,
    /// Δλ of the last solve.
    pub(crate) multipliers: Vec<f64>,
    /// What the last iterations with one factor have shown.
    pub(crate) mixing: Mixing,
    /// The trial before the last correction.
    pub(crate) saved: Trial,
}

impl<const D: usize> Workspace<D> {
    /// Scratch for a model; cells are computed by this many threads.
    pub fn new(model: &Model<D>, threads: usize) -> Self {
        let zeros = vec![0.0; model.dofs()];
        Self {
            system: System::new(model, threads),
            forces: Forces {
                inertia: zeros.clone(),
                internal: zeros.clone(),
                loads: zeros.clone(),
                contact: zeros.clone(),
                known: zeros.clone(),
            },
            acceleration: zeros.clone(),
            gaps: vec![Vec::new(); model.contacts.len()],
            stiffnesses: vec![Vec::new(); model.contacts.len()],
            springs: 0.0,
            stage: Stage::default(),
            means: Means::new(model.dofs()),
            timings: Timings::default(),
            residual: zeros.clone(),
            loads: LoadsAt::default(),
            motions: Vec::new(),
            remaining: zeros.clone(),
            pull: zeros.clone(),
            right: Vec::new(),
            at: zeros.clone(),
            correction: zeros,
            multipliers: Vec::new(),
            mixing: Mixing::default(),
            saved: Trial::default(),
        }
    }
}

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
