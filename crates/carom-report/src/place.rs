//! The mesh around a place, for pictures of it.

use crate::bodies::{Instant, outline};
use crate::pen::{Pen, Point, path};

/// Cells with their nodes.
pub(crate) fn mesh(out: &mut String, instant: &Instant, fill: &str, to: &dyn Fn(Point) -> Point) {
    let mut cells = Pen::default();
    for (degree, nodes) in &instant.cells {
        outline(&mut cells, *degree, nodes, &|n| to(instant.points[n]));
    }
    // Bodies may overlap at the place: both must show.
    let style = format!("fill=\"{fill}\" fill-opacity=\"0.8\" stroke=\"#98a2ad\" stroke-width=\"16\"");
    path(out, &cells, &style);
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

/// Fill colours of bodies, used in turn.
pub(crate) const BODIES: [&str; 4] = ["#e9eef4", "#f3ece0", "#e8f1e9", "#f1e8ef"];

/// The fill colour of a body with a number.
pub(crate) fn fill(body: usize) -> &'static str {
    BODIES[body % BODIES.len()]
}
