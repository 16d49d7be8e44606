//! Where a pane lies in its figure.

/// The rectangle of a pane in pixels.
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) wide: f64,
    pub(super) high: f64,
    /// Room to the left of it.
    pub(super) beside: f64,
}

impl Frame {
    pub(super) fn right(&self) -> f64 {
        self.left + self.wide
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.high
    }
}
