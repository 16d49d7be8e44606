//! The place of a stop: the deformed mesh of the last accepted state around the node, with node,
//! facet and cell, and the outline of the rejected positions where it differs.

use std::collections::HashSet;
use std::fmt::Write as _;

use carom_record::{FieldSet, Run, Stop, StopPlace};

use crate::axis::{range, round_step};
use crate::bodies::{Instant, bezier, corners, edge_nodes, edges, is_plane, places};
use crate::chart::{open, write_text};
use crate::figure::{Figure, NARROW};
use crate::labels::{instant_label, listed};
use crate::meshes::{self, Pane};
use crate::obstacles;
use crate::palette::LINES;
use crate::pen::{Pen, Point};
use crate::place::{mesh, path};
use crate::symbols::wall;

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
const FILLS: [&str; 4] = ["#e9eef4", "#f3ece0", "#e8f1e9", "#f1e8ef"];

/// The figure; none in dimension 1 and without fields or a place.
pub(super) fn figure(run: &Run, stop: &Stop) -> Option<Figure> {
    let fields = carom_record::Stop::fields(&run.directory, &run.manifest).ok()??;
    let place = stop.place.as_ref()?;
    if fields.blocks.iter().any(|block| !is_plane(block)) {
        return None;
    }
    let (svg, moved) = draw(run, stop, place, &fields, WIDTH)?;
    let (narrow, _) = draw(run, stop, place, &fields, NARROW)?;
    let rejected = if moved { " Dashed: the positions that were rejected." } else { "" };
    let there = [
        (true, "the node"),
        (!place.facet_nodes.is_empty(), "the facet"),
        (!place.cell_nodes.is_empty(), "the cell"),
    ];
    let parts: Vec<&str> = there.iter().filter(|(there, _)| *there).map(|(_, part)| *part).collect();
    let caption = format!(
        "The place of the stop at {}, the last accepted state: deformed mesh with {}, where the next step \
         failed.{rejected} Data: `stopped.vtu`, `stopped.json`.",
        instant_label(run, stop.last),
        listed(&parts)
    );
    let pane = |title: &str, array: &str| Pane {
        title: title.to_owned(),
        points: meshes::moved(&fields, array),
        values: Vec::new(),
    };
    let mut panes = vec![pane("accepted", "displacement")];
    panes.extend(fields.array("rejected").map(|_| pane("rejected", "rejected")));
    let length = fields.unit("displacement");
    let figure = Figure::new("stopped", caption, svg).with_narrow(narrow);
    Some(meshes::with_files(figure, &fields, &panes, length, String::new()))
}

/// The picture, and whether the rejected positions differ visibly.
fn draw(run: &Run, stop: &Stop, place: &StopPlace, fields: &FieldSet, width: f64) -> Option<(String, bool)> {
    let points = places(fields);
    let rejected = rejected(fields);
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
        let inside = |i: usize| {
            let [low, high] = nodes.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &k| {
                [low.min(points[k][i]), high.max(points[k][i])]
            });
            low <= frame[2 * i + 1] && high >= frame[2 * i]
        };
        inside(0) && inside(1)
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
        let shown = |points: &[Point]| Instant {
            time: String::new(),
            points: points.to_vec(),
            values: Vec::new(),
            cells: block.cells().filter(|c| near(points, c)).map(|c| (block.degree, c.to_vec())).collect(),
        };
        let instant = shown(&points);
        drawn.extend(instant.cells.iter().flat_map(|(_, nodes)| nodes.iter().copied()));
        mesh(&mut out, &instant, FILLS[k % FILLS.len()], &to);
    }
    if let Some(cell) = Some(&place.cell_nodes).filter(|nodes| !nodes.is_empty()) {
        let degree =
            fields.blocks.iter().find(|b| Some(&b.body) == place.body.as_ref()).map_or(1, |b| b.degree);
        let mut pen = Pen::default();
        for e in 0..corners(cell) {
            let edge: Vec<Point> = edge_nodes(degree, cell, e).map(|k| to(points[k])).collect();
            bezier(&mut pen, &edge, e == 0);
        }
        pen.close();
        path(
            &mut out,
            &pen,
            &format!("fill=\"{CELL}\" fill-opacity=\"0.45\" stroke=\"{CELL}\" stroke-width=\"40\""),
        );
    }
    let frame_of = [frame[0], frame[1], frame[2], frame[3]];
    for obstacle in obstacles::all(run, frame_of) {
        for walk in obstacles::clipped(&obstacle.at(run, stop.last), frame_of) {
            wall(&mut out, &walk.iter().map(|&(p, n)| (to(p), [-n[0], n[1]])).collect::<Vec<_>>(), 0.0);
        }
    }
    let facet: Vec<Point> =
        place.facet_nodes.iter().filter_map(|n| points.get(n.number)).map(|&p| to(p)).collect();
    if facet.len() > 1 {
        let mut pen = Pen::default();
        bezier(&mut pen, &facet, true);
        path(
            &mut out,
            &pen,
            &format!("fill=\"none\" stroke=\"{FACET}\" stroke-width=\"90\" stroke-linecap=\"round\""),
        );
    }
    let visible = |new: &[Point]| {
        drawn.iter().any(|&k| {
            let [a, b] = [to(points[k]), to(new[k])];
            (a[0] - b[0]).hypot(a[1] - b[1]) > 1.0
        })
    };
    let moved = rejected.as_deref().is_some_and(visible);
    if let Some(new) = rejected.as_ref().filter(|_| moved) {
        for block in &fields.blocks {
            let cells = block.cells().filter(|c| near(new, c)).map(|c| (block.degree, c.to_vec())).collect();
            let instant = Instant { time: String::new(), points: new.clone(), values: Vec::new(), cells };
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
    key(&mut out, place, moved);
    let length = round_step(frame[1] - frame[0], 6.0);
    let unit = fields.unit("displacement");
    let (y, pixels) = (height - 14.0, length * scale);
    let _ = writeln!(
        out,
        "<rect x=\"8\" y=\"{:.1}\" width=\"{:.1}\" height=\"22\" fill=\"#fff\" fill-opacity=\"0.8\"/>\n\
         <path d=\"M14 {:.1}v6m0 -3h{pixels:.1}m0 -3v6\" fill=\"none\" stroke=\"#222\"/>",
        y - 13.0,
        pixels + 90.0,
        y - 5.0
    );
    write_text(&mut out, 14.0 + pixels + 8.0, y + 2.0, "", format!("{length} {unit}").trim());
    out.push_str("</svg>\n");
    Some((out, moved))
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
    for i in 0..2 {
        let low = points.iter().map(|p| p[i]).fold(f64::INFINITY, f64::min) - margin;
        let high = points.iter().map(|p| p[i]).fold(f64::NEG_INFINITY, f64::max) + margin;
        frame[2 * i] = around[2 * i].max(low);
        frame[2 * i + 1] = around[2 * i + 1].min(high);
    }
    let (across, height) = (frame[1] - frame[0], frame[3] - frame[2]);
    let scale = (width / across).min((HEIGHT - KEY) / height);
    let beside = 0.5 * (width / scale - across);
    ([frame[0] - beside, frame[1] + beside, frame[2], frame[3]], scale)
}

/// Rejected positions.
fn rejected(fields: &FieldSet) -> Option<Vec<Point>> {
    let moved = fields.array("rejected").filter(|a| a.components == 3)?;
    let point = |(i, x): (usize, &[f64; 3])| [0, 1].map(|d| x[d] + moved.values[3 * i + d]);
    Some(fields.points.iter().enumerate().map(point).collect())
}

/// Length of the facet or of the longest edge at the place.
fn size(place: &StopPlace, fields: &FieldSet, points: &[Point], node: usize) -> f64 {
    let distance = |a: usize, b: usize| (points[a][0] - points[b][0]).hypot(points[a][1] - points[b][1]);
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
