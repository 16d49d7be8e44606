//! Picture of the overlap of bodies at the start: the mesh around the nodes that lie inside the other
//! body, each with a circle whose area grows with its depth.

use std::fmt::Write as _;

use carom_record::{Cell, FieldSet};

use crate::axis::round_step;
use crate::bodies::{Instant, places};
use crate::chart::{open, write_text};
use crate::labels::number;
use crate::palette::LINES;
use crate::pen::Point;
use crate::place::mesh;

const WIDTH: f64 = 720.0;
const TOP: f64 = 30.0;
const FILLS: [&str; 4] = ["#e9eef4", "#f3ece0", "#e8f1e9", "#f1e8ef"];
/// Radius of the circle of the deepest node, where there is room for it, and of a node that touches.
const LARGE: f64 = 12.0;
const SMALL: f64 = 2.0;

/// The picture of nodes (number, depth) of bodies in the plane; none without any.
pub fn overlap(fields: &FieldSet, nodes: &[(usize, f64)]) -> Option<String> {
    let points = places(fields);
    let nodes: Vec<(usize, f64)> = nodes.iter().copied().filter(|(node, _)| *node < points.len()).collect();
    let &(deepest, depth) = nodes.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    if fields.blocks.iter().any(|block| block.cell != Cell::Triangle) {
        return None;
    }
    let extent = |i: usize| {
        nodes.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (node, _)| {
            [low.min(points[*node][i]), high.max(points[*node][i])]
        })
    };
    let (x, y) = (extent(0), extent(1));
    let room = (0.25 * (x[1] - x[0]).max(y[1] - y[0])).max(8.0 * depth);
    // No further than the bodies reach.
    let reach = |i: usize, low: f64, high: f64| {
        let of = points.iter().map(|p| p[i]);
        let (first, last) = (of.clone().fold(f64::INFINITY, f64::min), of.fold(f64::NEG_INFINITY, f64::max));
        let margin = 0.04 * (last - first);
        [low.max(first - margin), high.min(last + margin)]
    };
    let ([left_end, right_end], [bottom, top]) =
        (reach(0, x[0] - room, x[1] + room), reach(1, y[0] - room, y[1] + room));
    let frame = [left_end, right_end, bottom, top];
    let scale = (WIDTH / (frame[1] - frame[0])).min(600.0 / (frame[3] - frame[2]));
    let height = (frame[3] - frame[2]) * scale;
    let left = 0.5 * (WIDTH - (frame[1] - frame[0]) * scale);
    let to = |p: Point| [left + (p[0] - frame[0]) * scale, TOP + (frame[3] - p[1]) * scale];
    let mut out = open("Overlap at the start", WIDTH, TOP + height + 34.0);
    let _ = writeln!(
        out,
        "<clipPath id=\"overlap-frame\"><rect x=\"0\" y=\"{TOP}\" width=\"{WIDTH}\" height=\"{height:.1}\"/></clipPath>\n\
         <g clip-path=\"url(#overlap-frame)\">"
    );
    for (k, block) in fields.blocks.iter().enumerate() {
        let instant = Instant { points: points.clone(), ..Instant::of_block(fields, block) };
        mesh(&mut out, &instant, FILLS[k % FILLS.len()], &to);
    }
    // Not larger than the depth of the deepest node is drawn, so that it can be seen.
    let large = (0.4 * WIDTH / nodes.len() as f64).min(depth * scale).clamp(3.5, LARGE);
    for (node, d) in &nodes {
        let [x, y] = to(points[*node]);
        let radius = SMALL + (large - SMALL) * (d / depth).sqrt();
        let color = LINES[2];
        let _ = writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"{color}\" fill-opacity=\"0.35\" stroke=\"{color}\"/>"
        );
    }
    let _ = writeln!(
        out,
        "</g>\n<rect x=\"{left:.1}\" y=\"{TOP}\" width=\"{:.1}\" height=\"{height:.1}\" fill=\"none\" stroke=\"#888\"/>",
        WIDTH - 2.0 * left
    );
    let mut along = WIDTH - 8.0;
    for (k, block) in fields.blocks.iter().enumerate().rev() {
        along -= 7.6 * block.body.chars().count() as f64 + 34.0;
        let (fill, y) = (FILLS[k % FILLS.len()], TOP + height + 10.0);
        let _ = writeln!(
            out,
            "<rect x=\"{along:.1}\" y=\"{y:.1}\" width=\"14\" height=\"12\" fill=\"{fill}\" stroke=\"#888\"/>"
        );
        write_text(&mut out, along + 20.0, y + 10.0, "", &block.body);
    }
    let unit = fields.array("displacement").map_or("", |u| &u.unit);
    let label = format!(
        "{} nodes inside the other body; deepest: node {deepest}, {} {unit}",
        nodes.len(),
        number(depth)
    );
    write_text(&mut out, 4.0, 19.0, "", label.trim());
    let length = round_step(frame[1] - frame[0], 6.0);
    let (pixels, y) = (length * scale, TOP + height + 20.0);
    let _ = writeln!(
        out,
        "<path d=\"M8 {:.1}v6m0 -3h{pixels:.1}m0 -3v6\" fill=\"none\" stroke=\"#222\"/>",
        y - 7.0
    );
    write_text(&mut out, 8.0 + pixels + 8.0, y, "", format!("{length} {unit}").trim());
    out.push_str("</svg>\n");
    Some(out)
}
