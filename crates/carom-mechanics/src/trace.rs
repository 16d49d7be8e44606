//! The last iterations of Newton's method, kept for the explanation of a step that is rejected. Of
//! fixed size: nothing is allocated in a step after the first.

/// Number of iterations that are kept.
const KEPT: usize = 12;

/// An iterate of Newton's method.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Iteration {
    /// Corrections before it.
    pub number: u32,
    /// ‖r‖/Σ‖f‖.
    pub residual: f64,
    /// Largest |g|/L of the active constraints.
    pub gap: f64,
    /// ‖Δy‖∞/L of the correction that led to it; infinite for the first one.
    pub correction: f64,
    /// Fraction of that correction that was taken.
    pub length: f64,
    /// Active pairs.
    pub active: u32,
    /// Whether pairs or the active set were changed here.
    pub changed: bool,
}

/// The last iterations of a solve, and the positions where the attempt ended.
#[derive(Debug, Default)]
pub struct Trace {
    ring: [Iteration; KEPT],
    count: usize,
    length: f64,
    y: Vec<f64>,
    worst: Option<usize>,
}

impl Trace {
    /// The last iterations, oldest first; none of an explicit step.
    pub fn iterations(&self) -> impl Iterator<Item = Iteration> + '_ {
        (self.count.saturating_sub(KEPT)..self.count).map(|k| self.ring[k % KEPT])
    }

    /// Positions at the last iterate, or at the end of a step that was solved and then rejected;
    /// empty if there are none.
    pub fn positions(&self) -> &[f64] {
        &self.y
    }

    /// The free dof with the largest residual where Newton's method did not converge.
    pub fn worst(&self) -> Option<usize> {
        self.worst
    }

    /// Starts a step.
    pub fn clear(&mut self) {
        self.start();
        self.y.clear();
    }

    /// Starts a solve.
    pub(crate) fn start(&mut self) {
        (self.count, self.length, self.worst) = (0, 1.0, None);
    }

    /// Adds an iterate at positions `y`.
    pub fn push(&mut self, iteration: Iteration, y: &[f64]) {
        self.ring[self.count % KEPT] = Iteration { length: self.length, ..iteration };
        self.count += 1;
        self.length = 1.0;
        self.end(y);
    }

    /// Notes that only a part of the next correction is taken.
    pub fn shorten(&mut self, length: f64) {
        self.length = length;
    }

    /// Notes the positions of a result that is rejected.
    pub(crate) fn end(&mut self, y: &[f64]) {
        self.y.clear();
        self.y.extend_from_slice(y);
    }

    /// Notes the free dof with the largest residual.
    pub fn blame(&mut self, residual: &[f64], free: &[usize]) {
        self.worst = free.iter().copied().max_by(|&a, &b| residual[a].abs().total_cmp(&residual[b].abs()));
    }
}
