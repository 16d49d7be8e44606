//! What materials remember.

/// What materials remember at the start of a step, and the length of the step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Past<'a> {
    /// Memory of a point, or of all points of all cells of a body.
    pub memory: &'a [f64],
    /// Δt.
    pub dt: f64,
}

impl Past<'_> {
    /// The memory of one of many points or cells with `size` numbers each.
    pub(crate) fn part(&self, index: usize, size: usize) -> Self {
        let memory = self.memory.get(index * size..(index + 1) * size).unwrap_or(&[]);
        Self { memory, dt: self.dt }
    }
}
