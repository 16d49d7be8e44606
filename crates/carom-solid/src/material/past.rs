//! What materials remember.

use std::ops::Range;

/// What materials remember at the start of a step, and the length of the step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Past<'a> {
    /// Memory of a point, or of all points of all cells of a body.
    pub memory: &'a [f64],
    /// Δt.
    pub dt: f64,
}

/// Most numbers that a point can remember.
pub(crate) const MOST: usize = 64;

/// Memory of a point at the start of a run.
const NOTHING: [f64; MOST] = [0.0; MOST];

impl<'a> Past<'a> {
    /// From the memory at the start of a step and the length of the step.
    pub fn new(memory: &'a [f64], dt: f64) -> Self {
        Self { memory, dt }
    }

    /// A point that remembers `size` numbers, at the start of a run.
    pub(crate) fn virgin(size: usize) -> Self {
        Self::new(&NOTHING[..size], 0.0)
    }

    /// The memory of one of many points or cells with `size` numbers each.
    pub(crate) fn part(&self, index: usize, size: usize) -> Self {
        let memory = self.memory.get(index * size..(index + 1) * size).unwrap_or(&[]);
        Self { memory, ..*self }
    }

    /// Some of the numbers; none of a law without memory.
    pub(crate) fn within(&self, range: &Range<usize>) -> Self {
        let memory = if range.is_empty() { &[] } else { &self.memory[range.clone()] };
        Self { memory, ..*self }
    }
}
