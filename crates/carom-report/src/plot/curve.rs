//! A curve of a plot: its style, and how it is drawn.

use std::fmt::Write as _;

use crate::chart::dots;
use crate::palette::LINES;
use crate::pen::{Point, polyline};
use crate::trace;

/// Lines, markers or both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Drawn {
    /// Lines between the points.
    #[default]
    Line,
    /// Lines, and a marker at every point.
    Marked,
    /// Markers alone.
    Markers,
    /// Small dots alone.
    Dots,
}

/// A curve.
#[derive(Clone, Debug, Default)]
#[allow(clippy::struct_excessive_bools)] // Each is independent of the others.
pub(crate) struct Curve {
    pub(crate) label: String,
    /// Number of the style.
    pub(crate) style: usize,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// Intervals of the vertical values, if they have any.
    pub(crate) intervals: Vec<[f64; 2]>,
    pub(crate) drawn: Drawn,
    /// Whether it is black, thin and dashed, above all others: a reference.
    pub(crate) thin: bool,
    /// Whether its label is for tables only.
    pub(crate) unlisted: bool,
    /// Whether it is of an unsound run: grey, and without influence on the axes.
    pub(crate) apart: bool,
    /// Whether it is that of the recommended arm or method.
    pub(crate) chosen: bool,
    /// The point of the recommended arm, around which a ring is drawn.
    pub(crate) ring: Option<usize>,
}

/// The colour of every unsound run; no other curve is grey.
pub(crate) const APART: &str = "#8c8c8c";

/// Number of colours: those of lines, and brown.
pub(crate) const COLORS: usize = LINES.len() + 1;

/// Colour, dashes and marker number of a style. Seven colours of Okabe and Ito and brown, with five
/// markers, give forty different styles.
pub(crate) fn style(i: usize) -> (&'static str, &'static str, usize) {
    const DASHES: [&str; 5] = ["", "9 3", "3 2", "9 3 2 3", "1.5 2.5"];
    (LINES.get(i % COLORS).copied().unwrap_or("#7a4a1e"), DASHES[i / COLORS % 5], i % 5)
}

impl Curve {
    fn is_marked(&self) -> bool {
        matches!(self.drawn, Drawn::Marked | Drawn::Markers)
    }

    /// Colour, dashes and marker number.
    fn look(&self) -> (&'static str, &'static str, usize) {
        let (color, dashes, marker) = style(self.style);
        match () {
            () if self.thin => ("#222", "4 2", marker),
            // A curve that is alone in its pane needs no dashes.
            () if self.unlisted => (if self.apart { APART } else { color }, "", marker),
            // Grey curves are told apart by their dashes.
            () if self.apart => (APART, style(COLORS * self.style).1, marker),
            () => (color, dashes, marker),
        }
    }

    /// Draws it through points of the page; lines are clipped to the rectangle `clip`, and markers
    /// drawn where `is_inside` holds.
    pub(super) fn draw(
        &self,
        out: &mut String,
        points: &[Point],
        clip: &str,
        is_inside: &dyn Fn(Point) -> bool,
    ) {
        let (color, dashes, marker) = self.look();
        let inside = points.iter().enumerate().filter(|(_, point)| is_inside(**point));
        if self.drawn == Drawn::Dots {
            dots(out, inside.map(|(_, [x, y])| (*x, *y)), color);
            return;
        }
        if self.drawn != Drawn::Markers {
            let d = trace::path(points.iter().map(|[x, y]| (*x, *y)));
            let width = if self.apart || self.thin { 0.9 } else { 1.5 };
            let _ = writeln!(
                out,
                "<path clip-path=\"url(#{clip})\" d=\"{d}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" \
                 stroke-linejoin=\"round\" stroke-dasharray=\"{dashes}\"/>"
            );
        }
        for (k, point) in inside.filter(|_| self.is_marked()) {
            mark(out, marker, color, *point);
            if self.ring == Some(k) {
                let [x, y] = point;
                let _ = writeln!(
                    out,
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"8\" fill=\"none\" stroke=\"#222\" stroke-width=\"1.6\"/>"
                );
            }
        }
    }

    /// Draws vertical bars between points of the page, clipped to the rectangle `clip`.
    pub(super) fn bars(&self, out: &mut String, bars: impl Iterator<Item = [Point; 2]>, clip: &str) {
        let color = self.look().0;
        for [[x, low], [_, high]] in bars {
            let _ = writeln!(
                out,
                "<path clip-path=\"url(#{clip})\" d=\"M{x:.1} {low:.1}V{high:.1}\" stroke=\"{color}\" stroke-width=\"1\" \
                 stroke-opacity=\"0.55\"/>"
            );
        }
    }

    /// Draws its piece of line and marker in the legend, from a point.
    pub(super) fn entry(&self, out: &mut String, [x, y]: Point) {
        let (color, dashes, marker) = self.look();
        if self.drawn == Drawn::Dots {
            dots(out, [4.0, 13.0, 22.0].into_iter().map(|by| (x + by, y)), color);
            return;
        }
        if self.drawn != Drawn::Markers {
            let _ = writeln!(
                out,
                "<path d=\"M{x:.1} {y:.1}h26\" stroke=\"{color}\" stroke-width=\"1.8\" stroke-dasharray=\"{dashes}\"/>"
            );
        }
        if self.is_marked() {
            mark(out, marker, color, [x + 13.0, y]);
        }
    }
}

/// Markers: circle, square, triangle, diamond, inverted triangle.
fn mark(out: &mut String, marker: usize, color: &str, [x, y]: Point) {
    let corners: &[Point] = match marker {
        0 => {
            let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.6\" fill=\"{color}\"/>");
            return;
        }
        1 => &[[-3.3, -3.3], [3.3, -3.3], [3.3, 3.3], [-3.3, 3.3]],
        2 => &[[0.0, -4.4], [4.2, 3.2], [-4.2, 3.2]],
        3 => &[[0.0, -4.8], [4.8, 0.0], [0.0, 4.8], [-4.8, 0.0]],
        _ => &[[0.0, 4.4], [4.2, -3.2], [-4.2, -3.2]],
    };
    let d = polyline(&corners.iter().map(|[dx, dy]| [x + dx, y + dy]).collect::<Vec<_>>());
    let _ = writeln!(out, "<path d=\"{d}z\" fill=\"{color}\"/>");
}
