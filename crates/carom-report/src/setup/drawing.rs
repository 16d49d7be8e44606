//! Positions of nodes, sides and bodies in the drawing of a case.

use std::collections::HashMap;

use carom_record::{Block, FieldSet};
use serde_json::Value;

use crate::palette::LINES;
use crate::pen::{Pen, Point, path};
use crate::recorded::Recorded;
use crate::symbols::{direction, plus};

/// Colours of the two sides of a contact.
pub(super) const SECONDARY: &str = LINES[2];
pub(super) const PRIMARY: &str = LINES[1];
/// Largest width of the picture, and width of the key.
pub(super) const ROOM: f64 = 470.0;
pub(super) const KEY: f64 = 320.0;
/// Height of a bar in pixels.
pub(super) const BAR: f64 = 26.0;
/// Letters of names of probes and of bodies, which stand out from what they cover.
pub(super) const BOLD: &str = "font-weight=\"bold\" font-size=\"15\" stroke=\"#fff\" stroke-width=\"4\" \
    paint-order=\"stroke\" stroke-linejoin=\"round\"";
pub(super) const ITALIC: &str = "font-style=\"italic\" font-size=\"15\" stroke=\"#fff\" stroke-width=\"4\" \
    paint-order=\"stroke\" stroke-linejoin=\"round\"";
/// Fill colours of supported sides in space, one for each support in turn.
pub(super) const SUPPORTS: [&str; 3] = ["#9db4ca", "#a3c4ab", "#c3aecf"];
/// Colours of their outlines.
pub(super) const SUPPORT_LINES: [&str; 3] = ["#44607c", "#34703f", "#75508c"];

/// The polyline of a side in pixels, with outward unit normals.
pub(super) type Walk = Vec<(Point, Point)>;

/// A case and its mapping to the page.
pub(super) struct Setup<'a> {
    pub(super) run: &'a Recorded,
    pub(super) fields: &'a FieldSet,
    /// Positions of the points of `fields`.
    pub(super) points: Vec<Point>,
    pub(super) flat: bool,
    pub(super) scale: f64,
    pub(super) origin: Point,
    /// A point on the inner side of each edge, by the numbers of its end nodes.
    pub(super) inside: HashMap<[usize; 2], Point>,
}

impl Setup<'_> {
    pub(super) fn case(&self) -> &Value {
        &self.run.manifest.case
    }

    pub(super) fn to(&self, p: Point) -> Point {
        [self.origin[0] + p[0] * self.scale, self.origin[1] - p[1] * self.scale]
    }

    pub(super) fn node(&self, k: usize) -> Point {
        self.points.get(k).map_or([f64::NAN; 2], |p| self.to(*p))
    }

    /// The cells of a body.
    pub(super) fn block(&self, body: &str) -> Option<&Block> {
        self.fields.blocks.iter().find(|block| block.body == body)
    }

    /// Mean position of the nodes of a body, or the node nearest to it where it lies outside.
    pub(super) fn center(&self, body: &str) -> Option<Point> {
        let block = self.block(body)?;
        let mut sum = [0.0; 2];
        block.connectivity.iter().for_each(|&k| sum = plus(sum, 1.0, self.node(k)));
        let mean = sum.map(|s| s / block.connectivity.len() as f64);
        let away = |p: Point| (p[0] - mean[0]).hypot(p[1] - mean[1]);
        let nodes = || block.connectivity.iter().map(|&k| self.node(k));
        let near = nodes().min_by(|a, b| away(*a).total_cmp(&away(*b)))?;
        let furthest = nodes().map(away).fold(0.0, f64::max);
        Some(if away(near) > 0.3 * furthest { near } else { mean })
    }

    /// Current position of a reference point, moved like the nearest node.
    pub(super) fn moved(&self, [x, y]: Point) -> Point {
        let distance = |p: &[f64; 3]| (p[0] - x).hypot(p[1] - y);
        let moved = self.fields.points.iter().zip(&self.points);
        let near = moved.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
        near.map_or([x, y], |(from, to)| [x + to[0] - from[0], y + to[1] - from[1]])
    }

    /// Degree of the cells along a side.
    pub(super) fn degree(&self, side: &str) -> usize {
        let body = side.split_once('.').map_or(side, |s| s.0);
        self.block(body).map_or(1, |b| b.degree)
    }

    /// The connected parts of a side.
    pub(super) fn walks(&self, side: &str) -> Vec<Walk> {
        let chains = self.run.manifest.sides.get(side).map_or(&[][..], Vec::as_slice);
        let degree = self.degree(side);
        chains.iter().map(|chain| self.walk(side, chain, degree)).filter(|walk| walk.len() > 1).collect()
    }

    fn walk(&self, side: &str, chain: &[usize], degree: usize) -> Walk {
        if let (true, [k]) = (self.flat, chain) {
            // An end of a bar, as a vertical line.
            let [x, y] = self.node(*k);
            let middle = self.center(side.split_once('.').map_or(side, |s| s.0)).map_or(x, |c| c[0]);
            let n = [if x < middle { -1.0 } else { 1.0 }, 0.0];
            return vec![([x, y - 0.5 * BAR], n), ([x, y + 0.5 * BAR], n)];
        }
        let outward = |i: usize| {
            let facet = (i / degree).min((chain.len() - 2) / degree) * degree;
            let (a, b) = (chain[facet], chain[(facet + degree).min(chain.len() - 1)]);
            let t = direction(self.node(a), self.node(b));
            let within =
                self.inside.get(&[a.min(b), a.max(b)]).map_or([0.0; 2], |p| direction(self.node(a), *p));
            let n = [-t[1], t[0]];
            if n[0] * within[0] + n[1] * within[1] > 0.0 { [t[1], -t[0]] } else { n }
        };
        if chain.len() < 2 {
            Vec::new()
        } else {
            (0..chain.len()).map(|i| (self.node(chain[i]), outward(i))).collect()
        }
    }

    pub(super) fn stroke(out: &mut String, pen: &Pen, color: &str) {
        let style = "stroke-width=\"64\" stroke-linecap=\"round\"";
        path(out, pen, &format!("fill=\"none\" stroke=\"{color}\" {style}"));
    }
}
