//! Colour bands inside a Lagrange triangle.
//!
//! A small triangle, on which the quantity is taken as linear, is cut along the levels between the
//! bands into convex polygons, one per band, which together cover the triangle.

use crate::axis::round_step;
use crate::palette::{diverging, sequential};
use crate::pen::Point;

/// Shape functions of a Lagrange triangle in VTK's node order at barycentric (a, b, c) of its
/// corners.
pub(crate) fn shape(degree: usize, [a, b, c]: [f64; 3], out: &mut Vec<f64>) {
    out.clear();
    match degree {
        1 => out.extend([a, b, c]),
        2 => {
            out.extend([a, b, c].map(|l| l * (2.0 * l - 1.0)));
            out.extend([4.0 * a * b, 4.0 * b * c, 4.0 * c * a]);
        }
        _ => {
            out.extend([a, b, c].map(|l| 0.5 * l * (3.0 * l - 1.0) * (3.0 * l - 2.0)));
            for (l, m) in [(a, b), (b, c), (c, a)] {
                out.extend([4.5 * l * m * (3.0 * l - 1.0), 4.5 * l * m * (3.0 * m - 1.0)]);
            }
            out.push(27.0 * a * b * c);
        }
    }
}

/// Row by row, the points that divide each side of a triangle into `m` parts, as barycentric
/// coordinates of its corners.
pub(crate) fn divided(m: usize) -> impl Iterator<Item = [f64; 3]> {
    let share = move |i: usize| i as f64 / m as f64;
    let point = move |j: usize, i: usize| [1.0 - share(i) - share(j), share(i), share(j)];
    (0..=m).flat_map(move |j| (0..=m - j).map(move |i| point(j, i)))
}

/// The small triangles between these points, and which of their sides lie on a side of the large
/// one.
pub(crate) fn small_triangles(m: usize) -> impl Iterator<Item = ([usize; 3], [bool; 3])> {
    // Row j starts at `row(j)`: m + 1 − j points.
    let row = move |j: usize| j * (m + 1) - j * j.saturating_sub(1) / 2;
    (0..m).flat_map(move |j| (0..m - j).map(move |i| (j, i))).flat_map(move |(j, i)| {
        let low = row(j) + i;
        let high = row(j + 1) + i;
        let upright = ([low, low + 1, high], [j == 0, i + j + 1 == m, i == 0]);
        let turned = (i + 1 < m - j).then_some(([low + 1, high + 1, high], [false; 3]));
        std::iter::once(upright).chain(turned)
    })
}

/// The part of a polygon where sign·(value − level) ≥ 0.
fn clip(polygon: &[(Point, f64)], level: f64, sign: f64) -> Vec<(Point, f64)> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (i, &(p, f)) in polygon.iter().enumerate() {
        let (q, g) = polygon[(i + 1) % polygon.len()];
        let inside = sign * (f - level) >= 0.0;
        let next = sign * (g - level) >= 0.0;
        if inside {
            out.push((p, f));
        }
        if inside != next {
            let s = (level - f) / (g - f);
            out.push(([p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])], level));
        }
    }
    out
}

/// Colour bands: `count` of equal width between `low` and `high`; values outside take the colour of
/// the nearest band. Where values have either sign, zero is in the middle of a band; where they
/// have not, `low` is zero.
pub(crate) struct Bands {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) count: usize,
}

impl Bands {
    /// A single white band for values that are zero to round-off.
    pub(crate) const ZERO: Self = Self { low: -1.0, high: 1.0, count: 1 };

    pub(crate) fn is_zero(&self) -> bool {
        self.count == 1 && self.low < 0.0
    }

    fn level(&self, i: usize) -> f64 {
        self.low + (self.high - self.low) * i as f64 / self.count as f64
    }

    pub(crate) fn color(&self, band: usize) -> String {
        let middle = 0.5 * (self.level(band) + self.level(band + 1));
        if self.low < 0.0 {
            diverging(middle / self.low.abs().max(self.high.abs()))
        } else {
            sequential(middle / self.high)
        }
    }

    pub(crate) fn of(&self, value: f64) -> usize {
        let x = (value - self.low) / (self.high - self.low) * self.count as f64;
        (x.max(0.0) as usize).min(self.count - 1)
    }
}

/// Colour bands for all values except the outermost 0.5 % at either end, and whether values lie
/// below or above them; one white band if none exceeds `floor`.
pub(crate) fn color_bands(values: impl Iterator<Item = f64>, floor: f64) -> (Bands, [bool; 2]) {
    let mut values: Vec<f64> = values.filter(|x| x.is_finite()).collect();
    values.sort_unstable_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    let value = |k: usize| values.get(k).copied().unwrap_or(0.0);
    if value(0).abs().max(value(last).abs()) <= floor {
        return (Bands::ZERO, [false; 2]);
    }
    let low = value(last / 200).min(0.0);
    let high = value(last - last / 200).max(0.0);
    // Edges are half a step off round numbers, so that zero stress is white.
    let step = round_step(high - low, 24.0);
    let [below, above] = [-low, high].map(|x| (x / step - 0.5).ceil().max(0.0));
    let low = -(below + 0.5) * step;
    let high = (above + 0.5) * step;
    (Bands { low, high, count: (below + above) as usize + 1 }, [value(0) < low, value(last) > high])
}

/// Colour bands from zero for values that are not negative: all but the largest 0.5 %, and whether
/// values lie above them.
pub(crate) fn positive_bands(values: impl Iterator<Item = f64>, floor: f64) -> (Bands, [bool; 2]) {
    positive_bands_of(std::iter::once(values), floor)
}

/// Range of the values at several instants: all but the largest 0.5 % at each of them. In all
/// instants together those of a short impact would be few.
pub(crate) fn positive_bands_of(
    instants: impl Iterator<Item = impl Iterator<Item = f64>>,
    floor: f64,
) -> (Bands, [bool; 2]) {
    let mut high = 0.0_f64;
    let mut most = 0.0_f64;
    for values in instants {
        let mut values: Vec<f64> = values.filter(|x| x.is_finite()).collect();
        values.sort_unstable_by(f64::total_cmp);
        if let Some(last) = values.len().checked_sub(1) {
            high = high.max(values[last - last / 200]);
            most = most.max(values[last]);
        }
    }
    if most <= floor {
        return (Bands::ZERO, [false; 2]);
    }
    let step = round_step(high, 16.0);
    let count = (high / step * (1.0 - 1e-12)).ceil();
    (Bands { low: 0.0, high: count * step, count: count as usize }, [false, most > count * step])
}

/// The parts of a triangle by band: convex polygons.
pub(crate) fn parts(triangle: &[(Point, f64); 3], bands: &Bands) -> Vec<(usize, Vec<Point>)> {
    if triangle.iter().any(|(_, f)| !f.is_finite()) {
        return Vec::new();
    }
    let [first, last] =
        [f64::min, f64::max].map(|pick| bands.of(triangle.iter().map(|t| t.1).reduce(pick).unwrap_or(0.0)));
    let part = |band| {
        let mut polygon = triangle.to_vec();
        if band > first {
            polygon = clip(&polygon, bands.level(band), 1.0);
        }
        if band < last {
            polygon = clip(&polygon, bands.level(band + 1), -1.0);
        }
        (polygon.len() > 2).then(|| (band, polygon.iter().map(|c| c.0).collect()))
    };
    (first..=last).filter_map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pen::{GRID, Pen};

    /// Nodes of the reference triangle in VTK's order.
    fn nodes(degree: usize) -> Vec<[f64; 3]> {
        let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut nodes = corners.to_vec();
        for e in 0..3 {
            let a = corners[e];
            let b = corners[(e + 1) % 3];
            let at = |s: f64| [0, 1, 2].map(|d| a[d] + s * (b[d] - a[d]));
            nodes.extend((1..degree).map(|i| at(i as f64 / degree as f64)));
        }
        if degree == 3 {
            nodes.push([1.0 / 3.0; 3]);
        }
        nodes
    }

    #[test]
    fn shapes_are_one_at_their_node_and_zero_at_the_others() {
        let mut n = Vec::new();
        for degree in 1..=3 {
            for (i, node) in nodes(degree).into_iter().enumerate() {
                shape(degree, node, &mut n);
                assert_eq!(n.len(), nodes(degree).len());
                assert!(n.iter().enumerate().all(|(j, v)| (v - f64::from(u8::from(i == j))).abs() < 1e-15));
            }
        }
    }

    #[test]
    fn bands_cover_a_triangle_exactly_once() {
        let bands = Bands { low: -1.0, high: 2.0, count: 6 };
        let mut paths = vec![Pen::default(); 6];
        let triangle = [([0.0, 0.0], -3.0), ([100.0, 0.0], 0.25), ([0.0, 100.0], 9.0)];
        parts(&triangle, &bands).iter().for_each(|(band, polygon)| paths[*band].polygon(polygon));
        let area = |pen: &Pen| -> f64 {
            let polygon = |p: &str| {
                let steps: Vec<f64> = p
                    .replace(['m', 'l'], " ")
                    .replace('-', " -")
                    .split_whitespace()
                    .map(|x| x.parse().unwrap())
                    .collect();
                // Relative to the first corner.
                let mut at = [0.0; 2];
                let mut corners = vec![[0.0; 2]];
                for step in steps.as_chunks::<2>().0.iter().skip(1) {
                    at = [at[0] + step[0], at[1] + step[1]];
                    corners.push(at);
                }
                let next = |i: usize| corners[(i + 1) % corners.len()];
                let twice =
                    (0..corners.len()).map(|i| corners[i][0] * next(i)[1] - next(i)[0] * corners[i][1]);
                twice.sum::<f64>() / (2.0 * GRID * GRID)
            };
            pen.data().split_terminator('z').map(polygon).sum()
        };
        assert!(paths.iter().all(|d| !d.is_empty()));
        assert!((paths.iter().map(area).sum::<f64>() - 5000.0).abs() < 2.0);
    }

    /// A stress of 1e-12 moduli is a white body, not a colourful one.
    #[test]
    fn round_off_has_one_colour() {
        let values = || (0..100).map(|i| 1e-12 * f64::from(i - 50));
        for (bands, _) in [color_bands(values(), 1e-10), positive_bands(values(), 1e-10)] {
            assert!(bands.is_zero() && bands.color(bands.of(4e-11)) == diverging(0.0));
        }
        assert!(color_bands(values(), 1e-13).0.count > 10);
    }

    #[test]
    fn zero_is_in_the_middle_of_a_band_and_outliers_are_cut_off() {
        let values = (0..1000).map(|i| -0.03 * f64::from(i)).chain([-500.0, 0.3]);
        let (bands, cut) = color_bands(values, 0.0);
        assert_eq!((bands.low, bands.high, bands.count, cut), (-31.0, 1.0, 16, [true, false]));
        assert_eq!(bands.color(bands.of(0.0)), diverging(0.0));
        assert!(color_bands(std::iter::empty(), 0.0).0.is_zero());
        let (bands, cut) = positive_bands((0..1000).map(f64::from).chain([5000.0]), 0.0);
        assert_eq!((bands.low, bands.high, bands.count, cut), (0.0, 1000.0, 10, [false, true]));
        // A short peak among many instants at rest.
        let instants =
            (0..1000).map(|k| (0..10).map(move |i| if k == 7 { 100.0 * f64::from(i) } else { 0.0 }));
        let (bands, cut) = positive_bands_of(instants, 0.0);
        assert_eq!((bands.high, cut), (900.0, [false, false]));
    }
}
