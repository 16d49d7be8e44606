//! Deformed bodies coloured by a nodal quantity, at several instants and the same scale.
//!
//! Geometry and quantity of a cell are its own Lagrange polynomials: colour bands are filled on a
//! fine subdivision, and edges are drawn as Bézier curves, exactly (a Lagrange edge of degree ≤ 3
//! is one).

use std::collections::HashMap;
use std::fmt::Write as _;

use carom_record::{Block, Cell, FieldSet};

use crate::axis::{Axis, round_step};
use crate::bands::{Bands, band_polygons, color_bands, shape};
use crate::chart::{open, scaled, write_text};
use crate::labels::with_unit;
use crate::obstacles::Walk;
use crate::pen::{Pen, Point, open_grid};
use crate::symbols::wall;

/// One instant: deformed nodes, the quantity at them, and the cells.
pub(crate) struct Instant {
    pub(crate) time: String,
    pub(crate) points: Vec<Point>,
    pub(crate) values: Vec<f64>,
    /// Degree and node numbers.
    pub(crate) cells: Vec<(usize, Vec<usize>)>,
}

impl Instant {
    /// Triangles of a field set at reference position + displacement, coloured by one component of
    /// an array.
    pub(crate) fn new(fields: &FieldSet, array: &str, component: usize, time: String) -> Option<Self> {
        let quantity = fields.array(array).filter(|a| component < a.components)?;
        let triangles = fields.blocks.iter().filter(|b| b.cell == Cell::Triangle);
        Some(Self {
            time,
            points: places(fields),
            values: quantity.values.iter().skip(component).step_by(quantity.components).copied().collect(),
            cells: triangles.flat_map(|b| b.cells().map(|c| (b.degree, c.to_vec()))).collect(),
        })
        .filter(|instant| !instant.cells.is_empty())
    }

    /// The cells of one block, without a quantity.
    pub(crate) fn of_block(fields: &FieldSet, block: &Block) -> Self {
        Self {
            time: String::new(),
            points: places(fields),
            values: Vec::new(),
            cells: block.cells().map(|c| (block.degree, c.to_vec())).collect(),
        }
    }
}

/// Current positions of the points of a field set: reference position + displacement.
pub(crate) fn places(fields: &FieldSet) -> Vec<Point> {
    let u = fields.array("displacement").filter(|a| a.components == 3);
    let moved = |(i, x): (usize, &[f64; 3])| [0, 1].map(|d| x[d] + u.map_or(0.0, |u| u.values[3 * i + d]));
    fields.points.iter().enumerate().map(moved).collect()
}

/// Filled bands of all cells: one path per colour.
fn fill(out: &mut String, instant: &Instant, bands: &Bands, to: &dyn Fn(Point) -> Point) {
    let mut paths = vec![Pen::default(); bands.count];
    let (mut n, mut corner) = (Vec::new(), Vec::new());
    for (degree, nodes) in &instant.cells {
        let m = [1, 4, 5][degree.saturating_sub(1).min(2)];
        corner.clear();
        // Row j of the subdivision starts at `row(j)`: m + 1 − j points.
        let row = |j: usize| j * (m + 1) - j * j.saturating_sub(1) / 2;
        for j in 0..=m {
            for i in 0..=m - j {
                let (b, c) = (i as f64 / m as f64, j as f64 / m as f64);
                shape(*degree, [1.0 - b - c, b, c], &mut n);
                let sum = |f: &dyn Fn(usize) -> f64| n.iter().zip(nodes).map(|(n, &k)| n * f(k)).sum::<f64>();
                let p = [0, 1].map(|d| sum(&|k| instant.points[k][d]));
                corner.push((to(p), sum(&|k| instant.values[k])));
            }
        }
        // A cell within one band is filled as a whole, inside its exact edges.
        let band = bands.of(corner[0].1);
        if corner.iter().all(|(_, f)| f.is_finite() && bands.of(*f) == band) {
            let edge =
                |e: usize| edge_nodes(*degree, nodes, e).map(|k| to(instant.points[k])).collect::<Vec<_>>();
            (0..3).for_each(|e| bezier(&mut paths[band], &edge(e), e == 0));
            paths[band].close();
            continue;
        }
        for j in 0..m {
            for i in 0..m - j {
                let (low, high) = (row(j) + i, row(j + 1) + i);
                let mut triangle =
                    |triangle: [usize; 3]| band_polygons(&triangle.map(|k| corner[k]), bands, &mut paths);
                triangle([low, low + 1, high]);
                if i + 1 < m - j {
                    triangle([low + 1, high + 1, high]);
                }
            }
        }
    }
    for (band, pen) in paths.iter().enumerate().filter(|(_, pen)| !pen.is_empty()) {
        let (d, color) = (pen.data(), bands.color(band));
        // A stroke in the colour of the fill closes the hairlines between neighbours.
        let _ = writeln!(
            out,
            "<path d=\"{d}\" fill=\"{color}\" stroke=\"{color}\" stroke-width=\"10\" \
             stroke-linejoin=\"round\"/>"
        );
    }
}

/// Nodes of an edge from end to end.
pub(crate) fn edge_nodes(degree: usize, nodes: &[usize], edge: usize) -> impl Iterator<Item = usize> {
    let inner = degree - 1;
    let between = &nodes[3 + edge * inner..3 + (edge + 1) * inner];
    std::iter::once(nodes[edge]).chain(between.iter().copied()).chain([nodes[(edge + 1) % 3]])
}

/// Adds the Bézier curve through the nodes of an edge; with `moved` the pen first moves to its
/// start.
pub(crate) fn bezier(pen: &mut Pen, nodes: &[Point], moved: bool) {
    let mix = |weights: &[f64]| [0, 1].map(|d| weights.iter().zip(nodes).map(|(w, p)| w * p[d]).sum::<f64>());
    let controls: &[&[f64]] = match nodes.len() {
        2 => &[&[0.0, 1.0]],
        3 => &[&[-0.5, 2.0, -0.5], &[0.0, 0.0, 1.0]],
        _ => {
            &[&[-5.0 / 6.0, 3.0, -1.5, 1.0 / 3.0], &[1.0 / 3.0, -1.5, 3.0, -5.0 / 6.0], &[0.0, 0.0, 0.0, 1.0]]
        }
    };
    if moved {
        pen.go(nodes[0]);
    }
    pen.draw(&controls.iter().map(|w| mix(w)).collect::<Vec<_>>());
}

/// Edges of all cells: interior edges, and the outline made of the edges that belong to one cell
/// only.
pub(crate) fn edges(instant: &Instant, to: &dyn Fn(Point) -> Point) -> [Pen; 2] {
    let mut found: HashMap<[usize; 2], (usize, Vec<usize>)> = HashMap::new();
    let mut order = Vec::new();
    for (degree, nodes) in &instant.cells {
        for e in 0..3 {
            let (a, b) = (nodes[e], nodes[(e + 1) % 3]);
            let key = [a.min(b), a.max(b)];
            let entry = found.entry(key).or_insert_with(|| {
                order.push(key);
                (0, edge_nodes(*degree, nodes, e).collect())
            });
            entry.0 += 1;
        }
    }
    let [mut inside, mut outline] = [Pen::default(), Pen::default()];
    for (count, nodes) in order.iter().filter_map(|key| found.get(key)) {
        let points: Vec<Point> = nodes.iter().map(|&k| to(instant.points[k])).collect();
        bezier(if *count == 1 { &mut outline } else { &mut inside }, &points, true);
    }
    [inside, outline]
}

/// Bounding box of the cells: left, right, bottom, top.
pub(crate) fn frame<'a>(instants: impl IntoIterator<Item = &'a Instant>) -> [f64; 4] {
    let mut frame = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
    for instant in instants {
        for [x, y] in instant.cells.iter().flat_map(|(_, nodes)| nodes.iter().map(|&k| instant.points[k])) {
            frame = [frame[0].min(x), frame[1].max(x), frame[2].min(y), frame[3].max(y)];
        }
    }
    frame
}

/// Colour bands for the values at some instants.
pub(crate) fn colors(instants: &[Instant]) -> (Bands, [bool; 2]) {
    let used = |i: &Instant| {
        i.cells.iter().flat_map(|(_, nodes)| nodes.iter().map(|&k| i.values[k])).collect::<Vec<_>>()
    };
    color_bands(instants.iter().flat_map(used))
}

/// The figure; `label` and `unit` belong to the colour bar, `obstacles` are the surfaces at each
/// instant within `frame`.
pub(crate) fn figure(
    instants: &[Instant],
    (obstacles, frame): (&[Vec<Walk>], [f64; 4]),
    (bands, cut): (&Bands, [bool; 2]),
    title: &str,
    (label, unit): (&str, &str),
    length: &str,
) -> String {
    let [x0, x1, y0, y1] = frame;
    let aspect = (x1 - x0) / (y1 - y0).max(1e-12 * (x1 - x0).abs()).max(f64::MIN_POSITIVE);
    let columns = instants
        .len()
        .min(if aspect < 1.3 {
            5
        } else if aspect < 2.6 {
            3
        } else {
            1
        })
        .max(1);
    let (width, bar, gap) = (940.0, 96.0, 14.0);
    let cell_width = (width - bar - 8.0) / columns as f64;
    let scale = ((cell_width - gap) / (x1 - x0)).min(460.0 / (y1 - y0));
    let (picture, line) = ((y1 - y0) * scale, 30.0);
    let rows = instants.len().div_ceil(columns);
    let height = rows as f64 * (picture + line + 14.0) + 34.0;
    let mut out = open(title, width, height);
    for (k, instant) in instants.iter().enumerate() {
        let left = 8.0 + (k % columns) as f64 * cell_width + 0.5 * (cell_width - gap - (x1 - x0) * scale);
        let top = (k / columns) as f64 * (picture + line + 14.0) + line;
        let to = |p: Point| [left + (p[0] - x0) * scale, top + (y1 - p[1]) * scale];
        let letter = char::from(b'B' + (k % 25) as u8);
        let heading = left.min(8.0 + (k % columns) as f64 * cell_width + 0.5 * cell_width - 50.0);
        let _ = writeln!(
            out,
            "<text x=\"{heading:.1}\" y=\"{:.1}\"><tspan font-weight=\"bold\">({letter})</tspan> {}</text>",
            top - 11.0,
            crate::text::svg(&instant.time)
        );
        out.push_str(&open_grid());
        fill(&mut out, instant, bands, &to);
        let [inside, outline] = edges(instant, &to).map(|pen| pen.data().to_string());
        let _ = writeln!(
            out,
            "<path d=\"{inside}\" fill=\"none\" stroke=\"#000\" stroke-opacity=\"0.28\" \
             stroke-width=\"8\"/>\n\
             <path d=\"{outline}\" fill=\"none\" stroke=\"#000\" stroke-width=\"18\" \
             stroke-linecap=\"round\"/>\n</g>"
        );
        for walk in obstacles.get(k).into_iter().flatten() {
            wall(&mut out, &walk.iter().map(|&(p, n)| (to(p), [-n[0], n[1]])).collect::<Vec<_>>(), 0.0);
        }
    }
    // Scale bar of a round length below the first picture.
    let size = round_step(x1 - x0, 3.0);
    let y = height - 22.0;
    let _ = writeln!(
        out,
        "<path d=\"M8 {:.1}v6m0 -3h{:.1}m0 -3v6\" fill=\"none\" stroke=\"#222\"/>",
        y - 3.0,
        size * scale
    );
    write_text(&mut out, 8.0 + size * scale + 8.0, y + 4.0, "", format!("{size} {length}").trim());
    color_bar(&mut out, bands, cut, width - bar + 18.0, (line, height - 50.0), (label, unit));
    out.push_str("</svg>\n");
    out
}

/// Vertical colour bar with ticks, and an arrow at an end beyond which there are values.
pub(crate) fn color_bar(
    out: &mut String,
    bands: &Bands,
    cut: [bool; 2],
    x: f64,
    (top, bottom): (f64, f64),
    (label, unit): (&str, &str),
) {
    let (top, width) = (top + 22.0, 15.0);
    let h = (bottom - top) / bands.count as f64;
    let mut arrow = |end: f64, tip: f64, band: usize| {
        let color = bands.color(band);
        let _ = writeln!(
            out,
            "<path d=\"M{x:.1} {end:.1}h{width}l-7.5 {tip}z\" fill=\"{color}\" stroke=\"#222\" \
             stroke-width=\"0.7\"/>"
        );
    };
    if cut[1] {
        arrow(top, -11.0, bands.count - 1);
    }
    if cut[0] {
        arrow(bottom, 11.0, 0);
    }
    for band in 0..bands.count {
        let y = bottom - (band + 1) as f64 * h;
        let _ = writeln!(
            out,
            "<rect x=\"{x:.1}\" y=\"{y:.2}\" width=\"{width}\" height=\"{:.2}\" fill=\"{}\"/>",
            h + 0.3,
            bands.color(band)
        );
    }
    let _ = writeln!(
        out,
        "<rect x=\"{x:.1}\" y=\"{top:.1}\" width=\"{width}\" height=\"{:.1}\" fill=\"none\" stroke=\"#222\" \
         stroke-width=\"0.7\"/>",
        bottom - top
    );
    let axis = Axis::new((bands.low, bands.high), 6.0, true);
    for (value, tick) in &axis.ticks {
        let y = bottom - (bottom - top) * axis.position(*value);
        let _ =
            writeln!(out, "<path d=\"M{:.1} {y:.1}h4\" stroke=\"#222\" stroke-width=\"0.8\"/>", x + width);
        write_text(out, x + width + 7.0, y + 4.3, "", tick);
    }
    write_text(out, x - 2.0, top - 20.0, "", &with_unit(label, &scaled(unit, axis.exponent)));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic edge through four points of a parabola is that parabola.
    #[test]
    fn beziers_pass_through_the_nodes() {
        let on = |s: f64| [s * 30.0, s * s * 90.0];
        let drawn = |nodes: &[f64]| {
            let mut pen = Pen::default();
            bezier(&mut pen, &nodes.iter().map(|s| on(*s)).collect::<Vec<_>>(), true);
            pen.data().to_string()
        };
        assert_eq!(drawn(&[0.0, 1.0]), "m0 0 600 1800");
        assert_eq!(drawn(&[0.0, 0.5, 1.0]), "m0 0q300 0 600 1800");
        assert_eq!(drawn(&[0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]), "m0 0c200 0 400 600 600 1800");
    }
}
