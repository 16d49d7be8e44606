//! The place of a pane in a figure.

use crate::again::Rectangle;

/// The rectangle of a pane in pixels.
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) wide: f64,
    pub(super) high: f64,
    /// Distance of the title of its vertical axis.
    pub(super) beside: f64,
}

impl Frame {
    pub(super) fn rectangle(&self) -> Rectangle {
        [self.left, self.top, self.wide, self.high]
    }

    pub(super) fn right(&self) -> f64 {
        self.left + self.wide
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.high
    }

    /// For a point outside: the nearest one on the edge, and the direction towards it.
    pub(super) fn beyond(&self, (x, y): (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
        let edge = (x.clamp(self.left, self.right()), y.clamp(self.top, self.bottom()));
        let away = (x - edge.0, y - edge.1);
        let length = away.0.hypot(away.1);
        (length > 0.5).then(|| (edge, (away.0 / length, away.1 / length)))
    }
}
