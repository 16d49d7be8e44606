//! The place of a stop: the deformed mesh of the last accepted state around the node, with node,
//! facet and cell, and the outline of the rejected positions where it differs.

use std::collections::HashSet;
use std::fmt::Write as _;

use carom_record::{FieldSet, Stop, StopPlace};

use crate::axis::{range, round_step};
use crate::bodies::{Instant, bezier, corners, edges, is_plane, moved, outline, places};
use crate::chart::{open, write_text};
use crate::figure::{Figure, NARROW};
use crate::labels::instant_label;
use crate::obstacles;
use crate::palette::LINES;
use crate::pen::{self, NOTHING, Pen, Point, path};
use crate::place::{fill, mesh};
use crate::recorded::Recorded;
use crate::symbols::{distance, scale_bar, wall};

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 440.0;
/// Room for the key at the top.
const KEY: f64 = 34.0;
/// Half the height of the picture in sizes of the facet or cell.
const ZOOM: f64 = 3.0;
const NODE: &str = LINES[2];
const FACET: &str = LINES[1];
const CELL: &str = LINES[5];
const REJECTED: &str = LINES[4];

/// The figure of a run that stopped; none in dimension 1 and without fields or a place.
pub(crate) fn figure(run: &Recorded) -> Option<Figure> {
    let stop = run.stop.as_ref()?;
    let fields = Stop::fields(&run.directory, &run.manifest).ok()??;
    let place = stop.place.as_ref()?;
    if fields.blocks.iter().any(|block| !is_plane(block)) {
        return None;
    }
    let (svg, is_moved) = draw(run, stop, place, &fields, WIDTH)?;
    let (narrow, _) = draw(run, stop, place, &fields, NARROW)?;
    let rejected = if is_moved { "; dashed: rejected positions" } else { "" };
    let caption = format!(
        "Deformed mesh around the place of the stop, {}{rejected}. Data: `stopped.vtu`.",
        instant_label(run, stop.last)
    );
    Some(Figure::new("stopped", caption, [svg, narrow]))
}

/// The picture, and whether the rejected positions differ visibly.
fn draw(
    run: &Recorded,
    stop: &Stop,
    place: &StopPlace,
    fields: &FieldSet,
    width: f64,
) -> Option<(String, bool)> {
    let points: Vec<Point> = places(fields);
    let rejected = fields.array("rejected").map(|_| moved(fields, "rejected"));
    let node = place.node.as_ref()?.number;
    let at = *points.get(node)?;
    let size = size(place, fields, &points, node);
    let half = [ZOOM * size * (width / (HEIGHT - KEY)), ZOOM * size];
    let around = [at[0] - half[0], at[0] + half[0], at[1] - half[1], at[1] + half[1]];
    let bodies = of_place(place, fields, &points);
    let (low, high) = range(bodies.iter().map(|p| &p[1]));
    // Around a body that is crushed there is nothing to see.
    let margin = 0.5 * size.min((high - low).max(0.25 * size));
    let (frame, scale) = filled(around, &bodies, (margin, width));
    let height = KEY + (frame[3] - frame[2]) * scale;
    let to = |p: Point| [(p[0] - frame[0]) * scale, KEY + (frame[3] - p[1]) * scale];
    let near = |points: &[Point], nodes: &[usize]| {
        let [left, right, bottom, top] = pen::around(NOTHING, nodes.iter().map(|&k| points[k]));
        left <= frame[1] && right >= frame[0] && bottom <= frame[3] && top >= frame[2]
    };
    let mut out = open("Where the simulation stopped", width, height);
    let _ = writeln!(
        out,
        "<clipPath id=\"stopped-frame-{width}\"><rect x=\"0\" y=\"{KEY}\" width=\"{width}\" height=\"{}\"/></clipPath>\n\
         <g clip-path=\"url(#stopped-frame-{width})\">",
        height - KEY
    );
    let mut drawn = HashSet::new();
    for (k, block) in fields.blocks.iter().enumerate() {
        let instant = Instant::of_cells(points.clone(), block, |cell| near(&points, cell));
        drawn.extend(instant.cells.iter().flat_map(|(_, nodes)| nodes.iter().copied()));
        mesh(&mut out, &instant, fill(k), &to);
    }
    if let Some(cell) = Some(&place.cell_nodes).filter(|nodes| !nodes.is_empty()) {
        let block = fields.blocks.iter().find(|b| Some(&b.body) == place.body.as_ref());
        let degree = block.map_or(1, |b| b.degree);
        let mut pen = Pen::default();
        outline(&mut pen, degree, cell, &|k| to(points[k]));
        let style = format!("fill=\"{CELL}\" fill-opacity=\"0.45\" stroke=\"{CELL}\" stroke-width=\"40\"");
        path(&mut out, &pen, &style);
    }
    for obstacle in obstacles::all(run, frame) {
        for walk in obstacles::clipped(&obstacle.at(run, stop.last), frame) {
            wall(&mut out, &walk.iter().map(|&(p, n)| (to(p), [-n[0], n[1]])).collect::<Vec<_>>(), 0.0);
        }
    }
    let facet: Vec<Point> =
        place.facet_nodes.iter().filter_map(|n| points.get(n.number)).map(|&p| to(p)).collect();
    if facet.len() > 1 {
        let mut pen = Pen::default();
        bezier(&mut pen, &facet, true);
        let style = "stroke-width=\"90\" stroke-linecap=\"round\"";
        path(&mut out, &pen, &format!("fill=\"none\" stroke=\"{FACET}\" {style}"));
    }
    let visible = |new: &[Point]| drawn.iter().any(|&k| distance(to(points[k]), to(new[k])) > 1.0);
    let is_moved = rejected.as_deref().is_some_and(visible);
    if let Some(new) = rejected.as_ref().filter(|_| is_moved) {
        for block in &fields.blocks {
            let instant = Instant::of_cells(new.clone(), block, |cell| near(new, cell));
            let [_, outline] = edges(&instant, &to);
            let style = "stroke-width=\"26\" stroke-dasharray=\"110 70\" fill=\"none\"";
            path(&mut out, &outline, &format!("stroke=\"{REJECTED}\" {style}"));
        }
    }
    let [x, y] = to(at);
    let _ = writeln!(
        out,
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"13\" fill=\"none\" stroke=\"{NODE}\" stroke-width=\"2.2\"/>\n\
         <circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{NODE}\"/>\n</g>"
    );
    let _ = writeln!(
        out,
        "<rect x=\"0.5\" y=\"{KEY}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888\"/>",
        width - 1.0,
        height - KEY - 0.5
    );
    key(&mut out, place, is_moved);
    let length = round_step(frame[1] - frame[0], 6.0);
    let y = height - 14.0;
    let pixels = length * scale;
    let _ = writeln!(
        out,
        "<rect x=\"8\" y=\"{:.1}\" width=\"{:.1}\" height=\"22\" fill=\"#fff\" fill-opacity=\"0.8\"/>",
        y - 13.0,
        pixels + 90.0
    );
    scale_bar(&mut out, [14.0, y - 5.0], pixels, (length, fields.unit("displacement")));
    out.push_str("</svg>\n");
    Some((out, is_moved))
}

/// The points of the bodies of a place.
fn of_place(place: &StopPlace, fields: &FieldSet, points: &[Point]) -> Vec<Point> {
    let named = place.node.iter().chain(&place.facet_nodes).map(|node| &node.body);
    let bodies: HashSet<&String> = named.chain(&place.body).collect();
    let blocks = fields.blocks.iter().filter(|block| bodies.contains(&block.body));
    blocks.flat_map(carom_record::Block::cells).flatten().map(|&node| points[node]).collect()
}

/// The part of a frame in which these points are, with a margin, and the scale with which it fills
/// the picture: its whole width, and at most its height.
fn filled(around: [f64; 4], points: &[Point], (margin, width): (f64, f64)) -> ([f64; 4], f64) {
    let mut frame = around;
    let all = pen::around(NOTHING, points.iter().copied());
    for low in [0, 2] {
        frame[low] = around[low].max(all[low] - margin);
        frame[low + 1] = around[low + 1].min(all[low + 1] + margin);
    }
    let across = frame[1] - frame[0];
    let height = frame[3] - frame[2];
    let scale = (width / across).min((HEIGHT - KEY) / height);
    let beside = 0.5 * (width / scale - across);
    ([frame[0] - beside, frame[1] + beside, frame[2], frame[3]], scale)
}

/// Length of the facet or of the longest edge at the place.
fn size(place: &StopPlace, fields: &FieldSet, points: &[Point], node: usize) -> f64 {
    let distance = |a: usize, b: usize| distance(points[a], points[b]);
    let longest = |cell: &[usize]| {
        (0..corners(cell)).map(|e| distance(cell[e], cell[(e + 1) % corners(cell)])).fold(0.0, f64::max)
    };
    let numbers: Vec<usize> =
        place.facet_nodes.iter().map(|n| n.number).filter(|&n| n < points.len()).collect();
    if let [first, .., last] = &numbers[..] {
        return distance(*first, *last).max(f64::MIN_POSITIVE);
    }
    let cells = fields.blocks.iter().flat_map(carom_record::Block::cells).filter(|cell| cell.contains(&node));
    cells.map(longest).fold(f64::MIN_POSITIVE, f64::max)
}

fn key(out: &mut String, place: &StopPlace, moved: bool) {
    let number = place.node.as_ref().map_or(0, |node| node.number);
    let mut entries = vec![(NODE, format!("node {number}"), "")];
    if !place.facet_nodes.is_empty() {
        entries.push((FACET, place.facet.map_or("nearest facet".to_owned(), |f| format!("facet {f}")), ""));
    }
    if let Some(cell) = place.cell {
        entries.push((CELL, format!("cell {cell}"), ""));
    }
    if moved {
        entries.push((REJECTED, "rejected".to_owned(), "stroke-dasharray=\"6 4\""));
    }
    let mut x = 4.0;
    for (k, (color, label, style)) in entries.into_iter().enumerate() {
        let _ = if k == 0 {
            writeln!(
                out,
                "<circle cx=\"{:.1}\" cy=\"17\" r=\"10\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2.2\"/>\n\
                 <circle cx=\"{:.1}\" cy=\"17\" r=\"3.5\" fill=\"{color}\"/>",
                x + 12.0,
                x + 12.0
            )
        } else {
            writeln!(
                out,
                "<path d=\"M{x:.1} 17h24\" stroke=\"{color}\" stroke-width=\"5\" {style} fill=\"none\"/>"
            )
        };
        write_text(out, x + 30.0, 21.5, "", &label);
        x += 30.0 + 7.6 * label.chars().count() as f64 + 26.0;
    }
}
