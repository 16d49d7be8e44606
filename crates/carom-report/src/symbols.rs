//! Symbols of mechanics: arrows, walls with hatching, rollers; scale bars.

use std::fmt::Write as _;

use crate::chart::write_text;
use crate::pen::{Point, polyline};

pub(crate) fn plus(p: Point, s: f64, d: Point) -> Point {
    [p[0] + s * d[0], p[1] + s * d[1]]
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Unit vector from `a` to `b`; zero where they coincide.
pub(crate) fn direction(a: Point, b: Point) -> Point {
    let d = [b[0] - a[0], b[1] - a[1]];
    let length = d[0].hypot(d[1]);
    if length > 0.0 { [d[0] / length, d[1] / length] } else { [0.0; 2] }
}

/// An arrow with a filled head and a white outline.
pub(crate) fn arrow(out: &mut String, from: Point, to: Point, color: &str) {
    let d = direction(from, to);
    let side = [-d[1], d[0]];
    let neck = plus(to, -9.0, d);
    let [a, b] = [4.0, -4.0].map(|s| plus(neck, s, side));
    let shaft = polyline(&[from, neck]);
    for (stroke, width) in [("#fff", 5.0), (color, 1.8)] {
        let _ =
            writeln!(out, "<path d=\"{shaft}\" stroke=\"{stroke}\" stroke-width=\"{width}\" fill=\"none\"/>");
    }
    let _ = writeln!(out, "<path d=\"{}z\" fill=\"{color}\"/>", polyline(&[to, a, b]));
}

/// Equidistant points along a polyline, ends included, with the outward normal.
pub(crate) fn along(line: &[(Point, Point)], spacing: f64) -> Vec<(Point, Point)> {
    let lengths: Vec<f64> = line.windows(2).map(|w| distance(w[1].0, w[0].0)).collect();
    let total: f64 = lengths.iter().sum();
    let count = (total / spacing).round().max(1.0);
    let mut places = Vec::new();
    let mut k = 0;
    let mut before = 0.0;
    for i in 0..=count as usize {
        let s = total * i as f64 / count;
        while k + 1 < lengths.len() && before + lengths[k] < s {
            before += lengths[k];
            k += 1;
        }
        let (Some(&(a, n)), Some(&(b, _))) = (line.get(k), line.get(k + 1)) else { break };
        places.push((plus(a, s - before, direction(a, b)), n));
    }
    places
}

/// A line with hatching on its outer side, at a distance `offset` from `line`, whose points have
/// outward unit normals.
pub(crate) fn wall(out: &mut String, line: &[(Point, Point)], offset: f64) {
    let shifted: Vec<(Point, Point)> = line.iter().map(|&(p, n)| (plus(p, offset, n), n)).collect();
    let d = polyline(&shifted.iter().map(|(p, _)| *p).collect::<Vec<_>>());
    // The outward normal turned by 45 degrees.
    let stroke = |(p, n): (Point, Point)| polyline(&[p, plus(p, 7.0, [n[0] - n[1], n[1] + n[0]])]);
    let hatch: String = along(&shifted, 7.0).into_iter().map(stroke).collect();
    let _ = writeln!(
        out,
        "<path d=\"{hatch}\" stroke=\"#555\" stroke-width=\"0.8\" fill=\"none\"/>\n<path d=\"{d}\" \
         stroke=\"#222\" stroke-width=\"1.5\" fill=\"none\"/>"
    );
}

/// A mark on a rigid surface, in the body: a triangle whose tip is on the surface; `n` points into
/// the body.
pub(crate) fn mark(out: &mut String, p: Point, n: Point) {
    let foot = plus(p, 13.0, n);
    let [a, b] = [6.0, -6.0].map(|s| plus(foot, s, [-n[1], n[0]]));
    let _ = writeln!(out, "<path d=\"{}z\" fill=\"#222\"/>", polyline(&[p, a, b]));
}

/// A probe: a diamond, which is not taken for a roller.
pub(crate) fn probe_mark([x, y]: Point) -> String {
    format!(
        "<path d=\"M{x:.1} {:.1}l5.2 5.2l-5.2 5.2l-5.2 -5.2z\" fill=\"#000\" stroke=\"#fff\" \
         stroke-width=\"1.6\" paint-order=\"stroke\"/>\n",
        y - 5.2
    )
}

/// A scale bar of a length from its left end to its right end, in pixels, at a height.
pub(crate) fn scale_bar(out: &mut String, [x, y]: Point, pixels: f64, (length, unit): (f64, &str)) {
    let d = format!("M{x} {y:.1}v6m0 -3h{pixels:.1}m0 -3v6");
    let _ = writeln!(out, "<path d=\"{d}\" fill=\"none\" stroke=\"#222\"/>");
    write_text(out, x + pixels + 8.0, y + 7.0, "", format!("{length} {unit}").trim());
}
