//! The drawing of a case in space: bodies with their cells, rigid obstacles, supported and loaded
//! sides, loads, gravity, initial velocities and probes.

use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

use carom_record::FieldSet;

use super::drawing::{BOLD, ITALIC, ROOM, SUPPORT_LINES, SUPPORTS, Setup};
use super::forces::{COLOR, Load, load};
use super::key::placed;
use crate::again::{Rectangle, again, once};
use crate::axis::round_step;
use crate::bodies::places;
use crate::chart::{open, write_text};
use crate::figure::NARROW;
use crate::pen::{Point, around};
use crate::place::BODIES;
use crate::recorded::Recorded;
use crate::space::{
    DRAWN, Facet, Paint, Place, View, box_of, corners, cross, draw, frame, length, minus, pieces, skin,
    underlay, wires,
};
use crate::symbols::{arrow, direction, plus, probe_mark, scale_bar};
use crate::values::{list, place, text, texts, unit, vector};

/// Length in pixels of an arrow parallel to the page, and about how many are drawn on a side.
const LENGTH: f64 = 30.0;
const ARROWS: usize = 24;
/// Room for the axes below the picture.
const FOOT: f64 = 84.0;

/// A case as it is seen.
struct Solid<'a> {
    setup: Setup<'a>,
    view: View,
    places: Vec<Place>,
    skin: Vec<Facet>,
    /// Numbers of the facets of the skin by the corners of their face.
    numbers: HashMap<Vec<usize>, Vec<usize>>,
}

/// The figure; nothing without extent.
pub(super) fn figure(run: &Recorded, fields: &FieldSet, narrow: bool) -> Option<String> {
    let (view, places, skin) = (View::axonometric(), places(fields), skin(fields));
    let rigid: Vec<[Place; 2]> =
        wires(run, box_of(&skin, &places)).iter().flat_map(|wire| wire.at_first().to_vec()).collect();
    let lines = rigid.iter().flatten().map(|place| view.on_page(*place));
    let [x0, x1, y0, y1] = around(frame(&skin, &places, &view), lines);
    if !(x1 > x0 && y1 > y0) {
        return None;
    }
    let margin = 52.0;
    let scales = [ROOM, NARROW - 2.0 * margin].map(|room: f64| (room / (x1 - x0)).min(430.0 / (y1 - y0)));
    let scale = scales[usize::from(narrow)];
    let [broad, size] = [scales[0], scale].map(|scale| [(x1 - x0) * scale, (y1 - y0) * scale]);
    let (left, top) = (margin, margin);
    let place = [left, top, size[0], size[1]];
    let points = places.iter().map(|p| view.on_page(*p)).collect();
    let origin = [left - x0 * scale, top + y1 * scale];
    let setup = Setup { run, fields, points, flat: false, scale, origin, inside: HashMap::new() };
    let beside = left + size[0] + margin + 20.0;
    let mut key = String::new();
    let lines = setup.key(&mut key, if narrow { 12.0 } else { beside });
    let bottom = top + size[1] + margin;
    let (key, [width, height]) = placed(key, lines, narrow, [beside, bottom + FOOT]);
    let mut out = open("Initial configuration", width, height);
    let mut numbers: HashMap<Vec<usize>, Vec<usize>> = HashMap::new();
    for (k, facet) in skin.iter().enumerate() {
        numbers.entry(facet.face.clone()).or_default().push(k);
    }
    let solid = Solid { setup, view, places, skin, numbers };
    underlay(&mut out, &rigid, &view, &|p| solid.setup.to(p));
    if narrow {
        again(&mut out, "setup-bodies", [left, top, broad[0], broad[1]], place);
    } else {
        let mut bodies = String::new();
        solid.bodies(&mut bodies, place);
        once(&mut out, "setup-bodies", "picture", &bodies);
    }
    solid.sides(&mut out);
    solid.loads(&mut out);
    solid.probes(&mut out);
    view.triad(&mut out, [40.0, bottom + 32.0], 30.0);
    let bar = round_step(x1 - x0, 3.0);
    let length = unit(solid.setup.case(), "length");
    scale_bar(&mut out, [110.0, bottom + 46.0], bar * scale, (bar, length));
    out.push_str(&key);
    out.push_str("</svg>\n");
    Some(out)
}

impl Solid<'_> {
    fn to(&self, p: Place) -> Point {
        self.setup.to(self.view.on_page(p))
    }

    /// Numbers of the facets of a side.
    fn side(&self, name: &str) -> Vec<usize> {
        let facets = self.setup.run.manifest.sides.get(name).map_or(&[][..], Vec::as_slice);
        facets.iter().filter_map(|nodes| self.numbers.get(&corners(nodes))).flatten().copied().collect()
    }

    /// Middle of a facet and its outward unit normal.
    fn middle(&self, facet: &Facet) -> (Place, Place) {
        let [a, b, c] = [0, 1, 2].map(|k| self.places[facet.nodes[k]]);
        let n = cross(minus(b, a), minus(c, a));
        let size = length(n);
        ([0, 1, 2].map(|d| (a[d] + b[d] + c[d]) / 3.0), n.map(|x| x / size))
    }

    fn seen(&self, facet: usize) -> bool {
        self.view.of(self.middle(&self.skin[facet]).1)[2] > 1e-9
    }

    /// Bodies, with supported sides in a colour of their own.
    fn bodies(&self, out: &mut String, place: Rectangle) {
        // A facet of two supports has the colour of the first.
        let mut supported: HashMap<usize, usize> = HashMap::new();
        for (k, support) in list(self.setup.case(), "supports").iter().enumerate() {
            for facet in texts(support, "on").flat_map(|side| self.side(side)) {
                supported.entry(facet).or_insert(k % SUPPORTS.len());
            }
        }
        let number: HashMap<&Facet, f64> = (self.skin.iter().enumerate())
            .map(|(k, facet)| {
                let color =
                    supported.get(&k).map_or(facet.block % BODIES.len(), |support| BODIES.len() + support);
                (facet, color as f64)
            })
            .collect();
        let to = |p: Point| self.setup.to(p);
        let pieces =
            pieces(&self.skin, &self.places, &|facet, _| number[facet], &self.view, &to, self.setup.scale);
        let colors: Vec<&str> = BODIES.iter().chain(&SUPPORTS).copied().collect();
        let drawn = pieces.len() <= DRAWN;
        draw(out, &pieces, &Paint::Parts(&colors), place, drawn);
    }

    /// Outlines of supported and loaded sides; dashed where the side turns its back to the eye.
    fn sides(&self, out: &mut String) {
        // An edge of two sides is drawn once: two lines of dashes would be a solid one.
        let mut drawn = HashSet::new();
        for what in ["supports", "loads"] {
            for (color, side) in self.outlined(what) {
                let mut found: HashMap<[usize; 2], (usize, usize)> = HashMap::new();
                let mut order = Vec::new();
                for &k in &side {
                    for e in (0..3).filter(|&e| self.skin[k].sides[e]) {
                        let [a, b] = [e, (e + 1) % 3].map(|c| self.skin[k].nodes[c]);
                        let key = [a.min(b), a.max(b)];
                        let entry = found.entry(key).or_insert_with(|| {
                            order.push((key, e));
                            (0, k)
                        });
                        entry.0 += 1;
                    }
                }
                for (key, e) in order {
                    let (count, facet) = found[&key];
                    let facet_is_seen = self.seen(facet);
                    if count > 1 || !drawn.insert((key, color, facet_is_seen)) {
                        continue;
                    }
                    let dashes = if facet_is_seen { "" } else { " stroke-dasharray=\"4 3\"" };
                    let facet = &self.skin[facet];
                    let line = crate::bodies::edge_nodes(facet.degree, &facet.nodes, e)
                        .map(|k| self.to(self.places[k]))
                        .map(|[x, y]| format!("{x:.1},{y:.1}"))
                        .collect::<Vec<_>>();
                    let _ = writeln!(
                        out,
                        "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" \
                         stroke-width=\"1.6\"{dashes}/>",
                        line.join(" ")
                    );
                }
            }
        }
    }

    /// The sides of supports or loads, with the colours of their outlines.
    fn outlined(&self, what: &str) -> Vec<(&'static str, Vec<usize>)> {
        let sides = |item, color| texts(item, "on").map(move |side| (color, self.side(side)));
        let items = list(self.setup.case(), what).iter();
        if what == "supports" {
            let colors = SUPPORT_LINES.into_iter().cycle();
            return items.zip(colors).flat_map(|(item, color)| sides(item, color)).collect();
        }
        items.filter_map(load).flat_map(|load| sides(load.spec, COLOR)).collect()
    }

    /// An arrow along a vector that ends (`presses`) or begins at a place.
    fn arrow(&self, out: &mut String, at: Place, vector: Place, presses: bool, color: &str) {
        let size = length(vector);
        let [x, y] = self.view.on_page(vector.map(|x| x / size));
        let along = [x * LENGTH, -y * LENGTH];
        // Arrows towards the eye would be dots.
        let shown = along[0].hypot(along[1]);
        if shown < 0.25 * LENGTH || shown.is_nan() {
            return;
        }
        let p = self.to(at);
        let [from, to] = if presses { [-1.0, 0.0] } else { [0.0, 1.0] };
        arrow(out, plus(p, from, along), plus(p, to, along), color);
    }

    fn forces(&self, out: &mut String, load: &Load) {
        for side in texts(load.spec, "on").map(|side| self.side(side)) {
            let front: Vec<usize> = side.iter().copied().filter(|&k| self.seen(k)).collect();
            let facets = if front.is_empty() { side } else { front };
            for k in facets.iter().step_by(facets.len().div_ceil(ARROWS).max(1)) {
                let (at, n) = self.middle(&self.skin[*k]);
                let values = self.setup.values_at(load, &at);
                let towards = match (load.kind, values.as_slice()) {
                    ("pressure", [p, ..]) => n.map(|x| -x * p.signum()),
                    (_, [x, y, z]) => [*x, *y, *z],
                    _ => continue,
                };
                let presses = (0..3).map(|d| towards[d] * n[d]).sum::<f64>() < 0.0;
                self.arrow(out, at, towards, presses, COLOR);
            }
        }
    }

    /// Loads, names of bodies, gravity and initial velocities.
    fn loads(&self, out: &mut String) {
        for load in list(self.setup.case(), "loads").iter().filter_map(load) {
            self.forces(out, &load);
        }
        for body in list(self.setup.case(), "bodies") {
            let Some(block) = self.setup.block(text(body, "name")) else {
                continue;
            };
            let count = block.connectivity.len() as f64;
            let middle =
                [0, 1, 2].map(|d| block.connectivity.iter().map(|&k| self.places[k][d]).sum::<f64>() / count);
            let [x, y] = self.to(middle);
            write_text(out, x, y - 12.0, &format!("text-anchor=\"middle\" {ITALIC}"), text(body, "name"));
            let force = list(self.setup.case(), "loads")
                .iter()
                .filter_map(load)
                .find(|l| l.kind == "body-force" && text(l.spec, "body") == text(body, "name"));
            let force = force.map(|l| self.setup.values_at(&l, &middle)).unwrap_or_default();
            for (symbol, color, v) in [
                ("g", "#222", self.setup.gravity(body)),
                ("v_{0}", "#222", vector(body.get("velocity"))),
                ("b", COLOR, force),
            ] {
                let Ok(v) = Place::try_from(v) else { continue };
                if v.iter().all(|x| *x == 0.0) {
                    continue;
                }
                self.arrow(out, middle, v, false, color);
                let [right, up] = self.view.on_page(v);
                let end = plus([x, y], LENGTH + 12.0, direction([0.0; 2], [right, -up]));
                write_text(out, end[0] + 6.0, end[1] + 4.0, ITALIC, symbol);
            }
        }
    }

    fn probes(&self, out: &mut String) {
        for probe in list(self.setup.case(), "probes") {
            let Some(at) = place::<3>(probe.get("at")) else { continue };
            let distance = |p: &Place| (0..3).map(|d| (p[d] - at[d]).powi(2)).sum::<f64>();
            let near = (self.setup.fields.points.iter().zip(&self.places))
                .min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
            let Some((from, to)) = near else { continue };
            let [x, y] = self.to([0, 1, 2].map(|d| at[d] + to[d] - from[d]));
            // Inside a body, or on faces that are all turned away.
            let of_node = |k: &usize| self.skin[*k].nodes.iter().any(|node| self.places[*node] == *to);
            let is_seen = (0..self.skin.len()).filter(of_node).any(|k| self.seen(k));
            if is_seen {
                out.push_str(&probe_mark([x, y]));
            } else {
                let _ = writeln!(
                    out,
                    "<path d=\"M{x:.1} {:.1}l5.2 5.2l-5.2 5.2l-5.2 -5.2z\" fill=\"none\" stroke=\"#000\" \
                     stroke-width=\"1.6\" stroke-dasharray=\"2.2 1.6\"/>",
                    y - 5.2
                );
            }
            write_text(out, x + 8.0, y - 7.0, BOLD, text(probe, "name"));
        }
    }
}
