//! Facets as small flat triangles, and their colours.

use super::skin::{Facet, Place};
use super::view::View;
use crate::bands::{Bands, divided, shape, small_triangles};
use crate::palette::rgb;
use crate::pen::Point;

/// A triangle of the page that faces the eye.
pub(crate) struct Piece {
    /// Position on the page, and distance towards the eye, in pixels.
    pub(crate) corners: [Place; 3],
    pub(crate) values: [f64; 3],
    pub(crate) brightness: f64,
    /// Whether each of its sides, from corner i to i + 1, lies on an edge of the cell.
    pub(crate) edges: [bool; 3],
}

/// How values are coloured.
pub(crate) enum Paint<'a> {
    /// In bands.
    Bands(&'a Bands),
    /// Values are numbers of these colours.
    Parts(&'a [&'a str]),
}

impl Paint<'_> {
    /// Number of colours.
    pub(crate) fn count(&self) -> usize {
        match self {
            Self::Bands(bands) => bands.count,
            Self::Parts(colors) => colors.len(),
        }
    }

    /// Number of the colour of a value.
    pub(crate) fn of(&self, value: f64) -> usize {
        match self {
            Self::Bands(bands) => bands.of(value),
            Self::Parts(colors) => (value.round() as usize).min(colors.len().saturating_sub(1)),
        }
    }

    /// The colour with a number.
    pub(crate) fn rgb(&self, number: usize) -> [u8; 3] {
        match self {
            Self::Bands(bands) => rgb(&bands.color(number)),
            Self::Parts(colors) => colors.get(number).map_or([255; 3], |color| rgb(color)),
        }
    }

    /// The colour with a number on a piece of a brightness. Colours that stand for values are
    /// shaded less, so that they are found at the bar.
    pub(crate) fn lit(&self, color: [u8; 3], brightness: f64) -> [u8; 3] {
        match self {
            Self::Bands(_) => lit(color, 1.0 - 0.3 * (1.0 - brightness)),
            Self::Parts(_) => lit(color, brightness),
        }
    }
}

/// A colour in the light of a brightness.
fn lit(color: [u8; 3], brightness: f64) -> [u8; 3] {
    color.map(|part| (f64::from(part) * brightness).round() as u8)
}

/// Intervals along an edge of a facet: curved facets are drawn finely if there are few.
pub(crate) fn intervals(degree: usize, facets: usize) -> usize {
    if facets > 1500 { degree } else { [1, 4, 6][degree.saturating_sub(1).min(2)] }
}

/// The triangles of facets that face the eye; `value` is that of a node on a facet, `to` maps from
/// the view to the page.
pub(crate) fn pieces(
    skin: &[Facet],
    places: &[Place],
    value: &dyn Fn(&Facet, usize) -> f64,
    view: &View,
    to: &dyn Fn(Point) -> Point,
    scale: f64,
) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut n = Vec::new();
    let mut corner = Vec::new();
    for facet in skin {
        let m = intervals(facet.degree, skin.len());
        let seen: Vec<Place> = facet.nodes.iter().map(|&k| view.of(places[k])).collect();
        let of_node: Vec<f64> = facet.nodes.iter().map(|&k| value(facet, k)).collect();
        corner.clear();
        for place in divided(m) {
            shape(facet.degree, place, &mut n);
            let sum = |f: &dyn Fn(usize) -> f64| n.iter().enumerate().map(|(k, n)| n * f(k)).sum::<f64>();
            corner.push(([0, 1, 2].map(|d| sum(&|k| seen[k][d])), sum(&|k| of_node[k])));
        }
        for (numbers, sides) in small_triangles(m) {
            let Some(brightness) = View::brightness(numbers.map(|k| corner[k].0)) else { continue };
            let place = |k: usize| {
                let [x, y, z] = corner[k].0;
                let [x, y] = to([x, y]);
                [x, y, z * scale]
            };
            let values = numbers.map(|k| corner[k].1);
            let edges = [0, 1, 2].map(|side| facet.sides[side] && sides[side]);
            pieces.push(Piece { corners: numbers.map(place), values, brightness, edges });
        }
    }
    pieces
}

/// Width in pixels and colour of an edge of a cell.
pub(crate) const EDGE: f64 = 0.5;
pub(crate) const LINE: &str = "#33302c";
