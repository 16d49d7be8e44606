//! One degree of freedom, m a + k u = f: the smallest system for a kernel, and the place to verify
//! its analysis.
use crate::stage::{Affine, Kernel, Memory, PreviousStep, Stage, Weights};

/// m a + k u = f with constant f, driven by any kernel.
///
/// ```
/// use carom_time::{Oscillator, Scheme, Stage};
/// let fall = Oscillator { mass: 2.0, stiffness: 0.0, force: -19.62 };
/// let mut stage = Stage::default();
/// let [u, v, _] = fall.step(&Scheme::hu(), 0.5, fall.start(0.0, 1.0), &mut stage);
/// assert!((v + 3.905).abs() < 1e-14 && (u + 0.72625).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator {
    /// Mass m.
    pub mass: f64,
    /// Stiffness k; 0 is free fall.
    pub stiffness: f64,
    /// Force f.
    pub force: f64,
}

/// Position, velocity and (algorithmic) acceleration.
pub type Motion = [f64; 3];

impl Oscillator {
    /// The initial state with the acceleration of the balance, m a = f − k u.
    pub fn start(&self, u: f64, v: f64) -> Motion {
        [u, v, (self.force - self.stiffness * u) / self.mass]
    }

    /// One step of size `dt`; `stage` is scratch space.
    pub fn step(&self, kernel: &dyn Kernel, dt: f64, start: Motion, stage: &mut Stage) -> Motion {
        self.step_after(kernel, dt, None, start, stage)
    }

    /// One step of a two-step kernel: `before` is the increment over the previous step and the
    /// velocity at its start.
    pub fn step_after(
        &self,
        kernel: &dyn Kernel,
        dt: f64,
        before: Option<[f64; 2]>,
        start: Motion,
        stage: &mut Stage,
    ) -> Motion {
        run(kernel, dt, before, start, stage, |stage| self.increment(stage, start))
    }

    /// One step with the position imposed at the end of every stage: a dof constrained by contact.
    pub fn constrained_step(
        &self,
        kernel: &dyn Kernel,
        dt: f64,
        start: Motion,
        stage: &mut Stage,
        u: f64,
    ) -> Motion {
        self.constrained_step_after(kernel, dt, None, start, stage, u)
    }

    /// As [`Self::constrained_step`], for a two-step kernel.
    pub fn constrained_step_after(
        &self,
        kernel: &dyn Kernel,
        dt: f64,
        before: Option<[f64; 2]>,
        start: Motion,
        stage: &mut Stage,
        u: f64,
    ) -> Motion {
        run(kernel, dt, before, start, stage, |_| u - start[0])
    }

    /// ½ m v² + ½ k u² − f u.
    pub fn energy(&self, [u, v, _]: Motion) -> f64 {
        0.5 * self.mass * v * v + 0.5 * self.stiffness * u * u - self.force * u
    }

    /// The balance of a stage, linear in the increment.
    fn increment(&self, stage: &Stage, [u0, _, a0]: Motion) -> f64 {
        let Stage { weights: now, before, .. } = stage;
        let forces = |w: &Weights, a: f64| {
            w.mass * self.mass * a + w.internal * self.stiffness * u0 - w.external * self.force
        };
        let residual = forces(now, stage.acceleration.at_start[0]) + forces(before, a0);
        let stiffness = now.internal * (1.0 - stage.average) * self.stiffness;
        -residual / (now.mass * self.mass * stage.acceleration.slope + stiffness)
    }
}

fn run(
    kernel: &dyn Kernel,
    dt: f64,
    before: Option<[f64; 2]>,
    start: Motion,
    stage: &mut Stage,
    increment: impl Fn(&Stage) -> f64,
) -> Motion {
    let one = std::slice::from_ref::<f64>;
    let before = before.as_ref().map(|[d, v]| PreviousStep { increment: one(d), velocity: one(v) });
    let mut motions = vec![start];
    for k in 0..kernel.stages() {
        let states: Vec<_> = motions.iter().map(|[u, v, a]| (one(u), one(v), one(a))).collect();
        kernel.stage_into(k, dt, &Memory { states: &states, before }, stage);
        let d = increment(stage);
        let at = |map: &Affine| map.slope * d + map.at_start[0];
        motions.push([start[0] + d, at(&stage.velocity), at(&stage.acceleration)]);
    }
    motions[motions.len() - 1]
}
