//! Deformed bodies coloured by a nodal quantity, at several instants and the same scale.
//!
//! Geometry and quantity of a cell are its own Lagrange polynomials: colour bands are filled on a
//! fine subdivision, and edges are drawn as Bézier curves, exactly (a Lagrange edge of degree ≤ 3
//! is one).

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;

use carom_record::{Block, Cell, FieldSet};

use crate::bands::{Bands, color_bands, divided, parts, shape, small_triangles};
use crate::obstacles::Walk;
use crate::pen::{NOTHING, Pen, Point, around, open_grid};
use crate::sheet::{Legend, Sheet};
use crate::symbols::{distance, mark, wall};

/// An instant: deformed nodes, the quantity at them, and the cells.
#[derive(Default)]
pub(crate) struct Instant {
    pub(crate) time: String,
    pub(crate) points: Vec<Point>,
    pub(crate) values: Vec<f64>,
    /// Degree and node numbers.
    pub(crate) cells: Vec<(usize, Vec<usize>)>,
}

impl Instant {
    /// Cells of the plane of a field set at reference position + displacement, coloured by one
    /// component of an array.
    pub(crate) fn new(fields: &FieldSet, array: &str, component: usize, time: String) -> Option<Self> {
        let quantity = fields.array(array).filter(|a| component < a.components)?;
        let plane = fields.blocks.iter().filter(|block| is_plane(block));
        Some(Self {
            time,
            points: places(fields),
            values: quantity.values.iter().skip(component).step_by(quantity.components).copied().collect(),
            cells: plane.flat_map(|b| b.cells().map(|c| (b.degree, c.to_vec()))).collect(),
        })
        .filter(|instant| !instant.cells.is_empty())
    }

    /// The cells of one block, without a quantity.
    pub(crate) fn of_block(fields: &FieldSet, block: &Block) -> Self {
        Self::of_cells(places(fields), block, |_| true)
    }

    /// The cells of one block that are chosen by their nodes, at these places.
    pub(crate) fn of_cells(points: Vec<Point>, block: &Block, chosen: impl Fn(&[usize]) -> bool) -> Self {
        let cells = block.cells().filter(|c| chosen(c)).map(|c| (block.degree, c.to_vec())).collect();
        Self { points, cells, ..Self::default() }
    }
}

/// Whether the cells fill space.
pub(crate) fn fill_space(fields: &FieldSet) -> bool {
    fields.blocks.iter().any(|block| matches!(block.cell, Cell::Tetrahedron | Cell::Hexahedron))
}

/// Current positions of the points of a field set in D dimensions: reference position +
/// displacement.
pub(crate) fn places<const D: usize>(fields: &FieldSet) -> Vec<[f64; D]> {
    moved(fields, "displacement")
}

/// This instant with another displacement of the points.
pub(crate) fn moved<const D: usize>(fields: &FieldSet, array: &str) -> Vec<[f64; D]> {
    let u = fields.array(array).filter(|a| a.components == 3);
    let at =
        |(k, x): (usize, &[f64; 3])| std::array::from_fn(|d| x[d] + u.map_or(0.0, |u| u.values[3 * k + d]));
    fields.points.iter().enumerate().map(at).collect()
}

/// Whether the cells of a block are triangles or quadrilaterals.
pub(crate) fn is_plane(block: &Block) -> bool {
    matches!(block.cell, Cell::Triangle | Cell::Quadrilateral)
}

/// Number of corners, and so of edges, of a cell of the plane: triangles have 3, 6 or 10 nodes.
pub(crate) fn corners(nodes: &[usize]) -> usize {
    if matches!(nodes.len(), 4 | 9) { 4 } else { 3 }
}

/// The triangles that fill a cell: itself, or the halves of a quadrilateral.
pub(crate) fn triangles(nodes: &[usize]) -> Vec<Vec<usize>> {
    let halves: &[&[usize]] = match nodes.len() {
        4 => &[&[0, 1, 2], &[0, 2, 3]],
        9 => &[&[0, 1, 2, 4, 5, 8], &[0, 2, 3, 8, 6, 7]],
        _ => return vec![nodes.to_vec()],
    };
    halves.iter().map(|half| half.iter().map(|&a| nodes[a]).collect()).collect()
}

/// Filled bands of all cells: one path per colour.
fn fill(out: &mut String, instant: &Instant, bands: &Bands, to: &dyn Fn(Point) -> Point, width: f64) {
    let mut paths = vec![Pen::default(); bands.count];
    let mut n = Vec::new();
    let mut corner = Vec::new();
    let halves = instant
        .cells
        .iter()
        .flat_map(|(degree, nodes)| triangles(nodes).into_iter().map(move |t| (degree, t)));
    for (degree, nodes) in halves {
        let m = [1, 4, 5][degree.saturating_sub(1).min(2)];
        corner.clear();
        for place in divided(m) {
            shape(*degree, place, &mut n);
            let sum = |f: &dyn Fn(usize) -> f64| n.iter().zip(&nodes).map(|(n, &k)| n * f(k)).sum::<f64>();
            let p = [0, 1].map(|d| sum(&|k| instant.points[k][d]));
            corner.push((to(p), sum(&|k| instant.values[k])));
        }
        // A cell within one band is filled as a whole, inside its exact edges.
        let band = bands.of(corner[0].1);
        if corner.iter().all(|(_, f)| f.is_finite() && bands.of(*f) == band) {
            outline(&mut paths[band], *degree, &nodes, &|k| to(instant.points[k]));
            continue;
        }
        for (triangle, _) in small_triangles(m) {
            for (band, polygon) in parts(&triangle.map(|k| corner[k]), bands) {
                paths[band].polygon(&polygon);
            }
        }
    }
    for (band, pen) in paths.iter().enumerate().filter(|(_, pen)| !pen.is_empty()) {
        let d = pen.data();
        let color = bands.color(band);
        // A stroke in the colour of the fill closes the hairlines between neighbours.
        let _ = writeln!(
            out,
            "<path d=\"{d}\" fill=\"{color}\" stroke=\"{color}\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\"/>"
        );
    }
}

/// Pixels below which a body is thin.
const THIN: f64 = 5.0;

/// Mean thickness of the cells in units of length: twice their area by the length of their outline.
fn thickness(instant: &Instant) -> f64 {
    let at = |k: usize| instant.points[k];
    let mut area = 0.0;
    let mut around = 0.0;
    let mut found: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for (_, nodes) in &instant.cells {
        let count = corners(nodes);
        for e in 0..count {
            let a = nodes[e];
            let b = nodes[(e + 1) % count];
            *found.entry([a.min(b), a.max(b)]).or_default() += 1;
            area += 0.5 * (at(a)[0] * at(b)[1] - at(b)[0] * at(a)[1]);
        }
    }
    for ([a, b], _) in found.iter().filter(|(_, count)| **count == 1) {
        around += distance(at(*a), at(*b));
    }
    if around > 0.0 { 2.0 * area.abs() / around } else { f64::INFINITY }
}

/// Nodes of an edge from end to end.
pub(crate) fn edge_nodes(degree: usize, nodes: &[usize], edge: usize) -> impl Iterator<Item = usize> {
    let inner = degree - 1;
    let corners = corners(nodes);
    let between = &nodes[corners + edge * inner..corners + (edge + 1) * inner];
    std::iter::once(nodes[edge]).chain(between.iter().copied()).chain([nodes[(edge + 1) % corners]])
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

/// Adds the outline of a cell.
pub(crate) fn outline(pen: &mut Pen, degree: usize, nodes: &[usize], to: &dyn Fn(usize) -> Point) {
    for e in 0..corners(nodes) {
        bezier(pen, &edge_nodes(degree, nodes, e).map(to).collect::<Vec<_>>(), e == 0);
    }
    pen.close();
}

/// Edges of all cells: interior edges, and the outline made of the edges that belong to one cell
/// only.
pub(crate) fn edges(instant: &Instant, to: &dyn Fn(Point) -> Point) -> [Pen; 2] {
    let mut found: HashMap<[usize; 2], (usize, Vec<usize>)> = HashMap::new();
    let mut order = Vec::new();
    for (degree, nodes) in &instant.cells {
        let corners = corners(nodes);
        for e in 0..corners {
            let a = nodes[e];
            let b = nodes[(e + 1) % corners];
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
    let places = |i: &'a Instant| i.cells.iter().flat_map(|(_, nodes)| nodes.iter().map(|&k| i.points[k]));
    around(NOTHING, instants.into_iter().flat_map(places))
}

/// Colour bands for the values at some instants, which are round-off up to `floor`.
pub(crate) fn colors(instants: &[Instant], floor: f64) -> (Bands, [bool; 2]) {
    let used = |i: &Instant| {
        i.cells.iter().flat_map(|(_, nodes)| nodes.iter().map(|&k| i.values[k])).collect::<Vec<_>>()
    };
    color_bands(instants.iter().flat_map(used), floor)
}

/// The figure, broad and narrow; `obstacles` are the surfaces at each instant within `frame`, and
/// `marks` points on them with normals.
pub(crate) fn figure(
    instants: &[Instant],
    (obstacles, marks, frame): (&[Vec<Walk>], &[Walk], [f64; 4]),
    title: &str,
    legend: &Legend,
    length: &str,
) -> [String; 2] {
    let draw = |sheet: &mut Sheet, k: usize| {
        let instant = &instants[k];
        let to = sheet.map(k);
        let scale = sheet.scale;
        let out = &mut sheet.out;
        out.push_str(&open_grid());
        // The colour of a body that is thinner than its outline is drawn as a line.
        let thin = thickness(instant) * scale < THIN;
        let [inside, outline] = edges(instant, &to).map(|pen| pen.data().to_string());
        if thin {
            let style = "fill=\"none\" stroke=\"#777\" stroke-width=\"52\"";
            let _ = writeln!(out, "<path d=\"{outline}\" {style}/>");
        }
        fill(out, instant, legend.bands, &to, if thin { 35.0 } else { 10.0 });
        if thin {
            out.push_str("</g>\n");
        } else {
            let _ = writeln!(
                out,
                "<path d=\"{inside}\" fill=\"none\" stroke=\"#000\" stroke-opacity=\"0.28\" \
             stroke-width=\"8\"/>\n\
             <path d=\"{outline}\" fill=\"none\" stroke=\"#000\" stroke-width=\"18\" \
             stroke-linecap=\"round\"/>\n</g>"
            );
        }
        for walk in obstacles.get(k).into_iter().flatten() {
            wall(out, &walk.iter().map(|&(p, n)| (to(p), [-n[0], n[1]])).collect::<Vec<_>>(), 0.0);
        }
        for &(p, n) in marks.get(k).into_iter().flatten() {
            mark(out, to(p), [-n[0], n[1]]);
        }
    };
    let headings = instants.iter().map(|instant| instant.time.as_str());
    Sheet::pair(title, headings, frame, 34.0, draw).map(|sheet| sheet.finish(legend, length))
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
