//! Picture of the overlap of bodies at the start: the mesh and the rigid obstacles around the nodes
//! that lie inside another body or an obstacle, each node with a circle whose area grows with its
//! depth.

use std::fmt::Write as _;

use carom_case::Case;
use carom_record::FieldSet;

use crate::axis::round_step;
use crate::bodies::{Instant, is_plane, places};
use crate::chart::{open, write_text};
use crate::labels::number;
use crate::obstacles;
use crate::palette::LINES;
use crate::pen::{NOTHING, Point, around};
use crate::place::{fill, mesh};
use crate::symbols::{scale_bar, wall};

const WIDTH: f64 = 640.0;
const TOP: f64 = 30.0;
/// Radius of the circle of the deepest node, where there is room for it, and of a node that
/// touches.
const LARGE: f64 = 12.0;
const SMALL: f64 = 2.0;

/// The picture of nodes (number, depth) of the bodies of a case in the plane; none without any.
pub fn overlap(case: &Case, fields: &FieldSet, nodes: &[(usize, f64)]) -> Option<String> {
    let points = places(fields);
    let nodes: Vec<(usize, f64)> = nodes.iter().copied().filter(|(node, _)| *node < points.len()).collect();
    let &(deepest, depth) = nodes.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    if fields.blocks.iter().any(|block| !is_plane(block)) {
        return None;
    }
    let size = |e: [f64; 4]| (e[1] - e[0]).max(e[3] - e[2]);
    let near = around(NOTHING, nodes.iter().map(|(node, _)| points[*node]));
    let bodies = around(NOTHING, points.iter().copied());
    let room = (0.25 * size(near)).max((8.0 * depth).min(size(bodies)));
    // No further than the bodies reach.
    let margin = 0.04 * size(bodies);
    let frame = [
        (near[0] - room).max(bodies[0] - margin),
        (near[1] + room).min(bodies[1] + margin),
        (near[2] - room).max(bodies[2] - margin),
        (near[3] + room).min(bodies[3] + margin),
    ];
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
        let instant = Instant::of_block(fields, block);
        mesh(&mut out, &instant, fill(k), &to);
    }
    for obstacle in obstacles::of_case(case, bodies) {
        for walk in obstacles::clipped(obstacle.at_first(), frame) {
            let line: Vec<_> = walk.iter().map(|&(p, n)| (to(p), [-n[0], n[1]])).collect();
            wall(&mut out, &line, 0.0);
        }
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
        let fill = fill(k);
        let y = TOP + height + 10.0;
        let _ = writeln!(
            out,
            "<rect x=\"{along:.1}\" y=\"{y:.1}\" width=\"14\" height=\"12\" fill=\"{fill}\" stroke=\"#888\"/>"
        );
        write_text(&mut out, along + 20.0, y + 10.0, "", &block.body);
    }
    let unit = fields.unit("displacement");
    let label = format!(
        "{} nodes inside another body or an obstacle; deepest: node {deepest}, {} {unit}",
        nodes.len(),
        number(depth)
    );
    write_text(&mut out, 4.0, 19.0, "", label.trim());
    let length = round_step(frame[1] - frame[0], 6.0);
    scale_bar(&mut out, [8.0, TOP + height + 13.0], length * scale, (length, unit));
    out.push_str("</svg>\n");
    Some(out)
}
