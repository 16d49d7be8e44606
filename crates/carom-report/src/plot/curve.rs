//! A curve of a plot: its style, and how it is drawn.

use std::fmt::Write as _;

use super::frame::Frame;
use crate::chart::dots;
use crate::palette::LINES;
use crate::pen::{Point, polyline};
use crate::trace;

/// A curve.
#[derive(Clone, Debug, Default)]
#[allow(clippy::struct_excessive_bools)] // Each is independent of the others.
pub(crate) struct Curve {
    pub(crate) label: String,
    /// Number of the style.
    pub(crate) style: usize,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// Whether the points have markers.
    pub(crate) marked: bool,
    /// Whether there are no lines between them; without markers they are dots.
    pub(crate) points: bool,
    /// Its colour, where it is not that of the style.
    pub(crate) color: Option<&'static str>,
    /// Whether its label is for tables only.
    pub(crate) unlisted: bool,
    /// Whether it is of an unsound run: thin and grey, and without influence on the axes.
    pub(crate) apart: bool,
    /// Whether it is of less interest: thin.
    pub(crate) quiet: bool,
    /// Whether it is of a reference: thin and dashed, above all others.
    pub(crate) over: bool,
    /// Whether it is that of the recommended arm or method.
    pub(crate) chosen: bool,
    /// The point of the recommended arm.
    pub(crate) ring: Option<usize>,
}

impl Curve {
    /// Colour, dashes and marker number.
    pub(crate) fn style(&self) -> (&'static str, &'static str, usize) {
        if self.apart {
            return (APART, "", style(self.style).2);
        }
        let (color, dashes, marker) = style(self.style);
        (self.color.unwrap_or(color), dashes, marker)
    }
}

/// The colour of every unsound run; no other curve is grey.
pub(crate) const APART: &str = "#8c8c8c";

/// Number of colours: those of lines, and brown.
pub(crate) const COLORS: usize = LINES.len() + 1;

/// Colour, dashes and marker number of a style. Seven colours of Okabe and Ito and brown, with five
/// markers, give forty different styles.
pub(crate) fn style(i: usize) -> (&'static str, &'static str, usize) {
    const DASHES: [&str; 8] = ["", "9 3", "3 2", "9 3 2 3", "14 4", "5 2 1.5 2 1.5 2", "1.5 2.5", "6 6"];
    (LINES.get(i % COLORS).copied().unwrap_or("#7a4a1e"), DASHES[(i + i / COLORS) % 8], i % 5)
}

/// Whether a curve is dashed. One that is alone in its pane needs no dashes to be identified, nor
/// do the first eight colours beside markers or labels.
pub(super) fn is_dashed(curve: &Curve, direct: bool) -> bool {
    let is_first = curve.style < COLORS;
    match () {
        () if curve.apart => false,
        () if curve.marked => !is_first,
        () if curve.label.is_empty() || curve.unlisted => false,
        () => !(direct && is_first),
    }
}

/// Draws a curve inside the rectangle `id` of a frame, to which one without markers is clipped by
/// its caller.
pub(super) fn draw(
    out: &mut String,
    curve: &Curve,
    (id, frame): (&str, &Frame),
    direct: bool,
    to_x: &dyn Fn(f64) -> f64,
    to_y: &dyn Fn(f64) -> f64,
) {
    let (color, dashes, marker) = curve.style();
    let points: Vec<(f64, f64)> = curve.x.iter().zip(&curve.y).map(|(x, y)| (to_x(*x), to_y(*y))).collect();
    if curve.points && !curve.marked {
        dots(out, points.into_iter(), color);
        return;
    }
    let d = trace::path(points.iter().copied());
    let dashes = match () {
        () if curve.over => "4 2",
        () if is_dashed(curve, direct) => dashes,
        () => "",
    };
    let width = if curve.quiet || curve.apart || curve.over { 0.9 } else { 1.5 };
    let d = if curve.points { String::new() } else { d };
    let clip = if curve.marked { format!(" clip-path=\"url(#{id})\"") } else { String::new() };
    let _ = writeln!(
        out,
        "<path{clip} d=\"{d}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" \
         stroke-linejoin=\"round\" stroke-dasharray=\"{dashes}\" vector-effect=\"non-scaling-stroke\"/>"
    );
    if curve.marked {
        let finite = |p: &(usize, (f64, f64))| p.1.0.is_finite() && p.1.1.is_finite();
        for (k, (x, y)) in points.into_iter().enumerate().filter(finite) {
            match frame.beyond((x, y)) {
                None => mark(out, marker, color, x, y),
                Some((at, to)) => arrowhead(out, color, at, to),
            }
            if curve.ring == Some(k) {
                let _ = writeln!(
                    out,
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"8\" fill=\"none\" stroke=\"#222\" stroke-width=\"1.6\"/>"
                );
            }
        }
    }
}

/// What distinguishes arrowheads from markers.
pub(super) const OUTSIDE: &str = "class=\"outside\"";

/// An arrowhead at the edge of a pane, for what lies outside it in a direction.
pub(super) fn arrowhead(out: &mut String, color: &str, (x, y): (f64, f64), (dx, dy): (f64, f64)) {
    let at = |[along, aside]: Point| [x + along * dx - aside * dy, y + along * dy + aside * dx];
    let d = polyline(&[[0.0, 0.0], [-7.0, 4.0], [-7.0, -4.0]].map(at));
    let _ = writeln!(out, "<path d=\"{d}z\" fill=\"{color}\" {OUTSIDE}/>");
}

/// Markers: circle, square, triangle, diamond, inverted triangle.
pub(super) fn mark(out: &mut String, marker: usize, color: &str, x: f64, y: f64) {
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
