//! Where panes lie in a figure of a width.

use super::frame::Frame;
use super::legend::LINE;
use super::scale::Scale;
use super::{Curve, Pane, Plot, direct, legend};
use crate::text;

pub(super) const LEFT: f64 = 62.0;
pub(super) const RIGHT: f64 = 12.0;
const TOP: f64 = 30.0;
const BELOW: f64 = 34.0;
/// Font size of ticks.
pub(super) const TICK: f64 = 11.0;
/// Least width of a pane with its axis.
const LEAST: f64 = 210.0;

/// The layout of a figure. Of two of different widths, panes are equally high and have the same
/// vertical scales.
pub(super) struct Layout<'a> {
    pub(super) width: f64,
    pub(super) columns: usize,
    /// Left end of the first pane.
    left: f64,
    cell: f64,
    wide: f64,
    high: f64,
    beside: f64,
    /// The legend below, with its lines.
    pub(super) entries: Vec<&'a Curve>,
    pub(super) lines: Vec<Vec<usize>>,
    /// Lower end of the panes.
    pub(super) end: f64,
}

impl<'a> Layout<'a> {
    /// With labels beside the curves, or a legend below if `beside` is false.
    pub(super) fn new(plot: &'a Plot, width: f64, beside: bool) -> Self {
        let columns = plot.across.max(1).min((width / LEAST) as usize).max(1);
        let labels = if beside { direct::room(plot.legend().into_iter()) } else { 0.0 };
        let high = Self::high(plot);
        let scales = plot.panes.iter().map(|pane| plot.y_scale(pane, high));
        let ticks: Vec<String> = scales.flat_map(|scale| scale.axis.ticks).map(|(_, label)| label).collect();
        let widest = ticks.iter().map(|label| text::width(label) * TICK).fold(0.0, f64::max);
        let left = LEFT.max(widest + 32.0);
        // A title of an axis keeps away from the pane to its left.
        let titled = (0..plot.panes.len()).any(|i| i % columns > 0 && !plot.y_label(i, columns).is_empty());
        let right = if titled { 3.0 * RIGHT } else { RIGHT };
        let cell = width / columns as f64;
        let entries = if beside { Vec::new() } else { plot.legend() };
        let lines = legend::lines(&entries, width - LEFT, plot.direct);
        let end = plot.panes.len().div_ceil(columns) as f64 * (TOP + high + BELOW);
        let wide = cell - left - right.max(labels);
        Self { width, columns, left, cell, wide, high, beside: widest + 19.0, entries, lines, end }
    }

    /// Height of a pane.
    fn high(plot: &Plot) -> f64 {
        let most = plot.panes.iter().map(|pane| pane.curves.len()).max().unwrap_or(0);
        let high = match (plot.across, plot.panes.len()) {
            (3.., _) => 150.0,
            (2, _) => 230.0,
            (_, 2..) => 190.0,
            _ => 320.0_f64,
        };
        if plot.direct { high.max(direct::LINE * most as f64 + 6.0) } else { high }
    }

    pub(super) fn height(&self) -> f64 {
        self.end + 22.0 + LINE * self.lines.len() as f64 + 6.0
    }

    /// The middle of the title of the horizontal axes.
    pub(super) fn middle(&self) -> f64 {
        if self.columns > 1 { 0.5 * self.width } else { self.left + 0.5 * self.wide }
    }

    /// The place of pane `i`.
    pub(super) fn frame(&self, i: usize) -> Frame {
        Frame {
            left: (i % self.columns) as f64 * self.cell + self.left,
            top: (i / self.columns) as f64 * (TOP + self.high + BELOW) + TOP,
            wide: self.wide,
            high: self.high,
            beside: self.beside,
        }
    }
}

impl Plot {
    /// The vertical scale of a pane of a height.
    pub(super) fn y_scale(&self, pane: &Pane, high: f64) -> Scale {
        Scale::new(self.y_range(pane), (high / 40.0).max(2.0), false, self.log[1])
    }

    /// The title of the vertical axis of pane `i` in a number of columns: where only the first pane
    /// of every row has one, that of its row.
    pub(super) fn y_label(&self, i: usize, columns: usize) -> &str {
        let across = self.across.max(1);
        let of_row =
            self.panes.iter().enumerate().all(|(k, pane)| k % across == 0 || pane.y_label.is_empty());
        match of_row && across > 1 {
            true if i.is_multiple_of(columns) => &self.panes[i - i % across].y_label,
            true => "",
            false => &self.panes[i].y_label,
        }
    }
}
