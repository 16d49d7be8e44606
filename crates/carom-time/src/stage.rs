//! What a solver sees of a time integrator: one unknown y, velocity and acceleration affine in it, and the weights of the balance.
//!
//! A step is a list of stages. At the end of each, positions y solve
//!
//! ```text
//! w.mass M a(y) + w.internal f_int + w.contact f_cont − w.external f_ext  +  (the same sum at the step's start with weights `before`) = 0
//! v(y) = velocity.slope y + velocity.offset,   a(y) = acceleration.slope y + acceleration.offset
//! ```
//!
//! with f_int at (1 − average) y + average y_s and f_cont = Gᵀλ at y. Time knows neither space nor contact.

/// Weights of the four force families in the balance of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weights {
    /// Of the inertia forces M a.
    pub mass: f64,
    /// Of the internal forces.
    pub internal: f64,
    /// Of the external forces.
    pub external: f64,
    /// Of the contact forces.
    pub contact: f64,
}

/// A nodal vector as an affine function of the unknown positions: slope·y + offset.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Affine {
    /// Factor of the unknown.
    pub slope: f64,
    /// Known part, one entry per dof.
    pub offset: Vec<f64>,
}

/// One implicit solve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stage {
    /// Where in the step the unknown lives: 0 start, 1 end.
    pub end: f64,
    /// v(y).
    pub velocity: Affine,
    /// a(y).
    pub acceleration: Affine,
    /// Weights at the stage's end.
    pub weights: Weights,
    /// Weights at the step's start.
    pub before: Weights,
    /// Internal forces are taken at (1 − average) y + average y_s; external forces at that time too.
    pub average: f64,
}

/// What is known when a stage begins: the step's start, then the ends of the stages before.
#[derive(Clone, Copy, Debug)]
pub struct Memory<'a> {
    /// (y, v, a) at the step's start, then at each finished stage's end; flat, one entry per dof.
    pub states: &'a [(&'a [f64], &'a [f64], &'a [f64])],
}

/// An implicit integrator as a list of stages.
pub trait Kernel: Send + Sync {
    /// Stages of a step.
    fn stages(&self) -> usize;

    /// Fills stage `k` (from 0) of a step of size `dt`. Reuses the buffers of `stage`.
    fn stage_into(&self, k: usize, dt: f64, memory: &Memory, stage: &mut Stage);
}
