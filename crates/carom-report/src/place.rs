//! The mesh around a place, for pictures of it.

use std::fmt::Write as _;

use crate::bodies::{Instant, bezier, corners, edge_nodes};
use crate::pen::{Pen, Point, open_grid};

/// Cells with their nodes.
pub(crate) fn mesh(out: &mut String, instant: &Instant, fill: &str, to: &dyn Fn(Point) -> Point) {
    let mut cells = Pen::default();
    for (degree, nodes) in &instant.cells {
        for e in 0..corners(nodes) {
            let edge: Vec<Point> = edge_nodes(*degree, nodes, e).map(|n| to(instant.points[n])).collect();
            bezier(&mut cells, &edge, e == 0);
        }
        cells.close();
    }
    // Bodies may overlap at the place: both must show.
    path(
        out,
        &cells,
        &format!("fill=\"{fill}\" fill-opacity=\"0.8\" stroke=\"#98a2ad\" stroke-width=\"16\""),
    );
    let mut marks = Pen::default();
    for (_, nodes) in &instant.cells {
        for &k in nodes {
            let [x, y] = to(instant.points[k]);
            marks.go([x - 1.2, y]);
            marks.draw(&[[x + 1.2, y]]);
        }
    }
    path(out, &marks, "fill=\"none\" stroke=\"#667\" stroke-width=\"48\"");
}

/// A path of a pen.
pub(crate) fn path(out: &mut String, pen: &Pen, style: &str) {
    let _ = writeln!(out, "{}<path d=\"{}\" {style}/>\n</g>", open_grid(), pen.data());
}
