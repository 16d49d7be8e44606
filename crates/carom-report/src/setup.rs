//! Drawing of the initial configuration: bodies with their mesh, supports, loads, gravity, initial
//! velocities, contact sides and probes, with a key.
//!
//! Positions and cells come from the first field file, everything else from `manifest.json`
//! (`case`, `sides`).

mod drawing;
mod forces;
mod key;
mod planes;
mod solid;
mod words;

use std::collections::HashMap;
use std::fmt::Write as _;

use carom_record::{Cell, FieldSet};
use serde_json::Value;

use crate::axis::Axis;
use crate::bodies::{self, Instant, bezier, corners, edges, fill_space, places};
use crate::chart::{opened, turned, write_text};
use crate::figure::NARROW;
use crate::obstacles;
use crate::pen::{NOTHING, Pen, Point, around, open_grid};
use crate::place::fill;
use crate::recorded::Recorded;
use crate::symbols::{arrow, direction, distance, guides, motion, plus, probe_mark, rollers, wall};
use crate::values::{flat, list, text, texts, unit, vector};
use drawing::{BAR, BOLD, ITALIC, PRIMARY, ROOM, SECONDARY, Setup, Walk};
use key::placed;
pub(crate) use words::{in_words, model_in_words};

/// The figure, from the initial fields, with the key beside the drawing, and in a narrow window
/// below it; nothing without cells.
pub(crate) fn figure(run: &Recorded, fields: &FieldSet) -> Option<[String; 2]> {
    Some([drawn(run, fields, false)?, drawn(run, fields, true)?])
}

fn drawn(run: &Recorded, fields: &FieldSet, narrow: bool) -> Option<String> {
    if fill_space(fields) {
        return solid::figure(run, fields, narrow);
    }
    let room = if narrow { NARROW - 155.0 } else { ROOM };
    let flat = fields.blocks.iter().all(|b| b.cell == Cell::Curve);
    let points = places(fields);
    let mut frame = around(NOTHING, fields.blocks.iter().flat_map(|b| &b.connectivity).map(|&k| points[k]));
    // In 1D the picture includes the walls.
    for point in list(&run.manifest.case, "contacts").iter().filter_map(|c| c.pointer("/primary/plane/point"))
    {
        let x = vector(Some(point)).first().copied().filter(|_| flat).unwrap_or(frame[0]);
        (frame[0], frame[1]) = (frame[0].min(x), frame[1].max(x));
    }
    let planes = if flat { Vec::new() } else { planes::rigid(&run.manifest.case, frame) };
    frame = around(frame, planes.iter().flat_map(|plane| plane.ends));
    let obstacles = if flat { Vec::new() } else { obstacles::all(run, frame) };
    let obstacles: Vec<_> =
        obstacles.iter().filter(|o| !o.is_plane).map(|obstacle| (obstacle, obstacle.at(run, 0.0))).collect();
    let bodies = frame;
    for (obstacle, walk) in &obstacles {
        frame = obstacle.shown_in(walk, frame, bodies);
    }
    let [x0, x1, y0, y1] = frame;
    let size = [x1 - x0, if flat { 1.0 } else { y1 - y0 }];
    if !size.iter().all(|s| *s > 0.0) {
        return None;
    }
    let margin = 46.0;
    let scale = if flat { room / (x1 - x0) } else { (room / (x1 - x0)).min(430.0 / (y1 - y0)) };
    let picture = if flat { BAR } else { (y1 - y0) * scale };
    let left = 60.0 + margin;
    let right = left + (x1 - x0) * scale;
    let top = if flat { 84.0 } else { 14.0 + margin };
    let origin = [left - x0 * scale, if flat { top + 0.5 * BAR } else { top + y1 * scale }];
    let mut setup = Setup { run, fields, points, flat, scale, origin, inside: HashMap::new() };
    let mut key = String::new();
    let beside = right + margin + 36.0;
    let lines = setup.key(&mut key, if narrow { 12.0 } else { beside });
    let bottom = (top + picture + margin).max(if flat || narrow { 0.0 } else { lines - 60.0 });
    let (key, [width, height]) = placed(key, lines, narrow, [beside, bottom + 44.0]);
    // In the plane there are no shades: a dark page shows it on dark ground.
    let mut out = opened("picture sketch", "Initial configuration", width, height);
    setup.axes(&mut out, [left - margin, right + margin, top - margin, bottom]);
    setup.bodies(&mut out);
    setup.planes(&mut out, &planes, 0.6 * margin);
    for walk in obstacles.iter().flat_map(|(_, walk)| obstacles::clipped(walk, frame)) {
        setup.obstacle(&mut out, &walk);
    }
    setup.supports(&mut out);
    setup.contacts(&mut out);
    setup.loads(&mut out);
    setup.forces(&mut out);
    setup.probes(&mut out);
    out.push_str(&key);
    out.push_str("</svg>\n");
    Some(out)
}

/// Shortest support that is recognisable, in pixels.
const SHORTEST: f64 = 24.0;
/// How far the name of a body is above its middle, the room that its letters need above their line,
/// and half the height below which it is written above the body, in pixels.
const RISE: f64 = 24.0;
const LETTERS: f64 = 16.0;
const FLAT: f64 = 22.0;

/// A side, or a straight line of a length in its middle if it is shorter.
fn at_least(walk: Walk, length: f64) -> Walk {
    let (Some(&(a, n)), Some(&(b, _))) = (walk.first(), walk.last()) else { return walk };
    if walk.windows(2).map(|w| distance(w[1].0, w[0].0)).sum::<f64>() >= length {
        return walk;
    }
    let (middle, along) = (plus(a, 0.5, [b[0] - a[0], b[1] - a[1]]), direction(a, b));
    [-0.5, 0.5].map(|s| (plus(middle, s * length, along), n)).to_vec()
}

impl Setup<'_> {
    /// Coordinate axes at the edges of the picture.
    fn axes(&self, out: &mut String, [left, right, top, bottom]: [f64; 4]) {
        let length = unit(self.case(), "length");
        let axis = |low: f64, high: f64, pixels: f64| Axis::new((low, high), (pixels / 80.0).max(2.0), true);
        let x =
            axis((left - self.origin[0]) / self.scale, (right - self.origin[0]) / self.scale, right - left);
        let frame = if self.flat {
            format!("M{left:.1} {bottom:.1}H{right:.1}")
        } else {
            format!("M{left:.1} {top:.1}V{bottom:.1}H{right:.1}")
        };
        let _ = writeln!(out, "<path d=\"{frame}\" fill=\"none\" stroke=\"#888\" stroke-width=\"0.8\"/>");
        for (value, label) in &x.ticks {
            let at = self.to([*value, 0.0])[0];
            let _ =
                writeln!(out, "<path d=\"M{at:.1} {bottom:.1}v5\" stroke=\"#888\" stroke-width=\"0.8\"/>");
            write_text(out, at, bottom + 19.0, "text-anchor=\"middle\"", label);
        }
        let label = x.label("x", length);
        write_text(out, 0.5 * (left + right), bottom + 38.0, "text-anchor=\"middle\"", &label);
        if self.flat {
            return;
        }
        let y =
            axis((self.origin[1] - bottom) / self.scale, (self.origin[1] - top) / self.scale, bottom - top);
        for (value, label) in &y.ticks {
            let at = self.to([0.0, *value])[1];
            let _ = writeln!(out, "<path d=\"M{left:.1} {at:.1}h-5\" stroke=\"#888\" stroke-width=\"0.8\"/>");
            write_text(out, left - 8.0, at + 4.3, "text-anchor=\"end\"", label);
        }
        turned(out, (format!("{:.1}", left - 42.0), 0.5 * (top + bottom)), "", &y.label("y", length));
    }

    fn bodies(&mut self, out: &mut String) {
        for (k, block) in self.fields.blocks.iter().enumerate() {
            let fill = fill(k);
            if block.cell == Cell::Curve {
                for cell in block.cells() {
                    let (a, b) = (self.node(cell[0]), self.node(cell[1]));
                    let _ = writeln!(
                        out,
                        "<rect x=\"{:.2}\" y=\"{:.1}\" width=\"{:.2}\" height=\"{BAR}\" fill=\"{fill}\" \
                         stroke=\"#98a2ad\" stroke-width=\"0.6\"/>",
                        a[0].min(b[0]),
                        a[1] - 0.5 * BAR,
                        (b[0] - a[0]).abs()
                    );
                }
                continue;
            }
            for cell in block.cells() {
                let count = corners(cell);
                for e in 0..count {
                    let (a, b) = (cell[e], cell[(e + 1) % count]);
                    self.inside.insert([a.min(b), a.max(b)], self.node(cell[(e + 2) % count]));
                }
            }
            let instant = Instant::of_block(self.fields, block);
            let [inside, outline] = edges(&instant, &|p| self.to(p));
            let mut cells = Pen::default();
            for (degree, nodes) in &instant.cells {
                bodies::outline(&mut cells, *degree, nodes, &|n| self.node(n));
            }
            let (cells, inside, outline) = (cells.data(), inside.data(), outline.data());
            let _ = writeln!(
                out,
                "{}<path d=\"{cells}\" fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\"10\"/>\n\
                 <path d=\"{inside}\" fill=\"none\" stroke=\"#98a2ad\" stroke-width=\"11\"/>\n\
                 <path d=\"{outline}\" fill=\"none\" stroke=\"#222\" stroke-width=\"24\" \
                 stroke-linecap=\"round\"/>\n</g>",
                open_grid()
            );
        }
    }

    fn supports(&self, out: &mut String) {
        for support in list(self.case(), "supports") {
            let (fix, across) = (Self::directions(support), Self::is_held_across(support));
            let moved = Self::moved_axis(support);
            for side in texts(support, "on") {
                for walk in self.walks(side) {
                    if let Some(axis) = moved.filter(|_| !self.flat) {
                        motion(out, &walk, axis);
                        continue;
                    }
                    let walk = if self.flat { walk } else { at_least(walk, SHORTEST) };
                    if self.flat || fix.len() + usize::from(across) > 1 {
                        wall(out, &walk, 0.0);
                        continue;
                    }
                    if Self::is_guided(support, &walk) {
                        guides(out, &walk, Self::constrained(support));
                    } else {
                        rollers(out, &walk);
                    }
                }
            }
        }
    }

    fn contacts(&self, out: &mut String) {
        for contact in list(self.case(), "contacts") {
            let primary = contact.pointer("/primary/side").and_then(Value::as_str);
            for (side, color) in
                [(primary, PRIMARY), (contact.get("secondary").and_then(Value::as_str), SECONDARY)]
            {
                let Some(side) = side else { continue };
                let step = if self.flat { 1 } else { self.degree(side) };
                for walk in self.walks(side) {
                    let points: Vec<Point> = walk.iter().map(|w| w.0).collect();
                    let mut pen = Pen::default();
                    for k in (0..points.len() - 1).step_by(step) {
                        bezier(&mut pen, &points[k..=(k + step).min(points.len() - 1)], k == 0);
                    }
                    Self::stroke(out, &pen, color);
                }
            }
        }
    }

    /// Names of bodies, gravity and initial velocities.
    fn loads(&self, out: &mut String) {
        for body in list(self.case(), "bodies") {
            let Some(center) = self.center(text(body, "name")) else { continue };
            let [x, y] = if self.flat {
                [center[0], center[1] + 0.5 * BAR + 20.0]
            } else {
                [center[0], center[1] - self.rise(text(body, "name"), center[1])]
            };
            let halo = format!("text-anchor=\"middle\" {ITALIC}");
            write_text(out, x, y, &halo, text(body, "name"));
            let size = self.size(text(body, "name"));
            let length = (0.45 * size).clamp(24.0, 48.0);
            let gravity = self.gravity(body);
            let gravity = [0, 1].map(|i| gravity.get(i).copied().unwrap_or(0.0));
            for ([right, up], symbol, side) in
                [(gravity, "g", 1.0), (flat(body.get("velocity")), "v_{0}", -1.0)]
            {
                let d = direction([0.0; 2], [right, -up]);
                if d == [0.0; 2] {
                    continue;
                }
                // Gravity to the right of the middle, the velocity to the left; below the name.
                let from = if self.flat {
                    [center[0], center[1] - 0.5 * BAR - 30.0]
                } else {
                    [center[0] + side * 0.3 * length, center[1] - 8.0]
                };
                let end = plus(from, length, d);
                arrow(out, from, end, "#222");
                let label = if self.flat {
                    plus(from, 10.0, [-d[0].signum(), 0.5])
                } else {
                    // Beside an upright arrow, below the head of a level one.
                    let out_of_it = [side * d[1].abs(), d[0].abs()];
                    plus(plus(end, -6.0, d), 13.0, out_of_it)
                };
                write_text(out, label[0], label[1] + 4.0, &halo.replace("15", "14"), symbol);
            }
        }
    }

    /// How far the name of a body is above its middle: less where its letters would cross the upper
    /// edge, unless the body is too flat for them.
    fn rise(&self, body: &str, middle: f64) -> f64 {
        let nodes = self.block(body).into_iter().flat_map(|b| &b.connectivity).map(|&k| self.node(k));
        let half = nodes.fold(0.0, |half: f64, p| half.max(middle - p[1]));
        if half < FLAT { RISE.max(half + 6.0) } else { RISE.min(half - LETTERS) }
    }

    /// The smaller side of the box around a body, in pixels.
    fn size(&self, body: &str) -> f64 {
        let nodes = self.block(body).into_iter().flat_map(|b| &b.connectivity).map(|&k| self.node(k));
        let [left, right, top, bottom] = around(NOTHING, nodes);
        if self.flat { 100.0 } else { (right - left).min(bottom - top) }
    }

    fn probes(&self, out: &mut String) {
        for probe in list(self.case(), "probes") {
            let p = self.to(self.moved(flat(probe.get("at"))));
            out.push_str(&probe_mark(p));
            let [x, y] =
                if self.flat { [p[0] - 4.0, p[1] - 0.5 * BAR - 7.0] } else { [p[0] + 8.0, p[1] - 7.0] };
            write_text(out, x, y, BOLD, text(probe, "name"));
        }
    }
}
