//! Files beside the figure of deformed bodies: positions and stress of the nodes at its instants,
//! the small triangles between the nodes, and a script that draws contours.

use std::fmt::Write as _;

use crate::bodies::{Instant, triangles};
use crate::figure::Figure;
use crate::labels::with_unit;
use crate::redraw::filled;

/// Largest number of rows; the nodes of larger bodies are in the field files only.
const MOST: usize = 40_000;

/// The corners of the small triangles of a Lagrange triangle in VTK's node order.
fn small(nodes: usize) -> &'static [[usize; 3]] {
    match nodes {
        6 => &[[0, 3, 5], [3, 1, 4], [3, 4, 5], [5, 4, 2]],
        10 => &[
            [0, 3, 8],
            [3, 9, 8],
            [3, 4, 9],
            [4, 5, 9],
            [4, 1, 5],
            [8, 9, 7],
            [9, 6, 7],
            [9, 5, 6],
            [7, 6, 2],
        ],
        _ => &[[0, 1, 2]],
    }
}

/// The figure with its files; `units` are those of time, length and stress.
pub(crate) fn with_files(
    figure: Figure,
    times: &[f64],
    instants: &[Instant],
    [time, length, stress]: [&str; 3],
) -> Figure {
    let Some(first) = instants.first() else { return figure };
    let mut used: Vec<usize> = first.cells.iter().flat_map(|(_, nodes)| nodes.iter().copied()).collect();
    used.sort_unstable();
    used.dedup();
    if used.len() * instants.len() > MOST {
        return figure;
    }
    let mut table = String::from("time,node,x,y,value\n");
    for (t, instant) in times.iter().zip(instants) {
        for &k in &used {
            let [x, y] = instant.points[k];
            let _ = writeln!(table, "{t:?},{k},{x:?},{y:?},{:?}", instant.values[k]);
        }
    }
    // Rows of one instant are counted from zero.
    let row = |node: usize| used.binary_search(&node).unwrap_or_default();
    let mut cells = String::from("a,b,c\n");
    for nodes in first.cells.iter().flat_map(|(_, nodes)| triangles(nodes)) {
        for corner in small(nodes.len()) {
            let [a, b, c] = corner.map(|k| row(nodes[k]));
            let _ = writeln!(cells, "{a},{b},{c}");
        }
    }
    let labels = [
        ("@TIME@", time.to_owned()),
        ("@X@", with_unit("x", length)),
        ("@Y@", with_unit("y", length)),
        ("@STRESS@", with_unit("σ_{yy}", stress)),
    ];
    let script = filled(include_str!("contours.py"), &labels);
    let mut figure = figure.with(table, script);
    figure.files.push(("triangles.csv", cells));
    figure
}

#[cfg(test)]
mod tests {
    use super::small;

    /// The small triangles cover the reference triangle: equal areas, all of one sense, of sum ½.
    #[test]
    fn small_triangles_fill_a_cell() {
        let third = 1.0 / 3.0;
        let six = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
        let ten = [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [third, 0.0],
            [2.0 * third, 0.0],
            [2.0 * third, third],
            [third, 2.0 * third],
            [0.0, 2.0 * third],
            [0.0, third],
            [third, third],
        ];
        for nodes in [&six[..], &ten[..]] {
            let parts = small(nodes.len());
            for corners in parts {
                let [a, b, c] = corners.map(|k: usize| nodes[k]);
                let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
                assert!((area * parts.len() as f64 - 0.5).abs() < 1e-12, "{corners:?}: {area}");
            }
        }
    }
}
