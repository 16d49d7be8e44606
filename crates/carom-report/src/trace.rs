//! A curve as SVG path data, with no more points than can be seen.
//!
//! Points are removed by two rules. First, of each column of half a pixel only the first, lowest,
//! highest and last point are kept. Second, points within a tenth of a pixel of the line between
//! two kept points are removed (D. H. Douglas, T. K. Peucker, Cartographica 10, 1973); the first,
//! last, lowest and highest point of the curve are always kept. Removed points are thus within 0.6
//! pixels of the drawn curve, and within 0.1 pixels where no column has more than four points.
//! Coordinates are written in tenths of a pixel relative to the previous point as written, so that
//! rounding errors do not accumulate.

use std::ops::Range;

use crate::pen::Point;

/// Width of a column in pixels.
const COLUMN: f64 = 0.5;
/// Largest distance in pixels from the drawn line of a point removed by the second rule.
const BOUND: f64 = 0.1;

/// Path data of a curve in pixels; points that are not finite are gaps.
pub(crate) fn path(points: impl Iterator<Item = (f64, f64)>) -> String {
    let points: Vec<(f64, f64)> = points.collect();
    let parts = points.split(|p| !(p.0.is_finite() && p.1.is_finite())).filter(|part| !part.is_empty());
    let mut out = String::new();
    let mut at = [0; 2];
    for part in parts {
        write(&mut out, &mut at, &thinned(part));
    }
    out
}

/// Path data of the area between two edges in pixels, both from left to right.
pub(crate) fn area(edges: [Vec<(f64, f64)>; 2]) -> String {
    let [mut around, lower] = edges.map(|mut points| {
        points.retain(|p| p.0.is_finite() && p.1.is_finite());
        thinned(&points)
    });
    around.extend(lower.into_iter().rev());
    let mut out = String::new();
    write(&mut out, &mut [0; 2], &around);
    if !out.is_empty() {
        out.push('z');
    }
    out
}

fn thinned(points: &[(f64, f64)]) -> Vec<Point> {
    let points = columns(points);
    let fixed = ends_and_extremes(0..points.len(), |i| points[i][1]);
    let mut keep = vec![false; points.len()];
    fixed.iter().for_each(|&i| keep[i] = true);
    let mut open: Vec<(usize, usize)> = fixed.windows(2).map(|pair| (pair[0], pair[1])).collect();
    while let Some((a, b)) = open.pop() {
        let off = |i: usize| (i, distance(points[i], points[a], points[b]));
        let farthest = (a + 1..b).map(off).max_by(|p, q| p.1.total_cmp(&q.1));
        if let Some((i, _)) = farthest.filter(|(_, off)| *off > BOUND) {
            keep[i] = true;
            open.extend([(a, i), (i, b)]);
        }
    }
    (0..points.len()).filter(|&i| keep[i]).map(|i| points[i]).collect()
}

/// First, lowest, highest and last point of each column.
fn columns(points: &[(f64, f64)]) -> Vec<Point> {
    let same = |a: &(f64, f64), b: &(f64, f64)| (a.0 / COLUMN).floor() == (b.0 / COLUMN).floor();
    let mut out = Vec::new();
    for column in points.chunk_by(same) {
        let kept = ends_and_extremes(0..column.len(), |i| column[i].1);
        out.extend(kept.into_iter().map(|i| [column[i].0, column[i].1]));
    }
    out
}

/// First, lowest, highest and last of some rows with values, in order, each once.
pub(crate) fn ends_and_extremes(rows: Range<usize>, value: impl Fn(usize) -> f64) -> Vec<usize> {
    let by_value = |a: &usize, b: &usize| value(*a).total_cmp(&value(*b));
    let extremes = [rows.clone().min_by(by_value), rows.clone().max_by(by_value)];
    let ends = [rows.clone().next(), rows.last()];
    let mut found: Vec<usize> = ends.into_iter().chain(extremes).flatten().collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Distance of a point from the segment between two others.
fn distance(p: Point, a: Point, b: Point) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1]];
    let r = [p[0] - a[0], p[1] - a[1]];
    let square = d[0] * d[0] + d[1] * d[1];
    let along = if square > 0.0 { ((r[0] * d[0] + r[1] * d[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (r[0] - along * d[0]).hypot(r[1] - along * d[1])
}

/// Appends one part: a move and lines, each relative to the previous point.
fn write(out: &mut String, at: &mut [i64; 2], points: &[Point]) {
    for (k, p) in points.iter().enumerate() {
        let end = p.map(|x| (x * 10.0).round() as i64);
        // The first move of a path starts at the origin; lines after a move need no letter.
        if k == 0 {
            out.push('m');
        }
        for (i, (to, from)) in end.iter().zip(&*at).enumerate() {
            let by = to - from;
            if (k > 0 || i > 0) && by >= 0 {
                out.push(' ');
            }
            tenths(out, by);
        }
        *at = end;
    }
}

/// A number of tenths, as short as SVG allows.
fn tenths(out: &mut String, n: i64) {
    if n < 0 {
        out.push('-');
    }
    let whole = n.unsigned_abs() / 10;
    let rest = n.unsigned_abs() % 10;
    if whole > 0 || rest == 0 {
        out.push_str(&whole.to_string());
    }
    if rest > 0 {
        out.push('.');
        out.push_str(&rest.to_string());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of path data, part by part.
    fn read(d: &str) -> Vec<Vec<Point>> {
        let mut parts = Vec::new();
        let mut at = [0.0; 2];
        for part in d.trim_end_matches('z').split('m').filter(|p| !p.is_empty()) {
            let numbers: Vec<f64> =
                part.replace('-', " -").split_whitespace().map(|n| n.parse().unwrap()).collect();
            let mut points = Vec::new();
            for by in numbers.chunks(2) {
                at = [at[0] + by[0], at[1] + by[1]];
                points.push(at);
            }
            parts.push(points);
        }
        parts
    }

    fn away(p: (f64, f64), line: &[Point]) -> f64 {
        line.windows(2).map(|ab| distance([p.0, p.1], ab[0], ab[1])).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn extremes_and_gaps_are_kept() {
        // 100 000 points on 10 pixels, one spike up, one down, one gap.
        let value = |i: usize| match i {
            31_234 => 99.0,
            67_890 => -55.0,
            80_000 => f64::NAN,
            _ => (i % 7) as f64,
        };
        let d = path((0..100_000).map(|i| (i as f64 * 1e-4, value(i))));
        let parts = read(&d);
        let heights: Vec<f64> = parts.concat().iter().map(|p| p[1]).collect();
        assert!([99.0, -55.0].iter().all(|e| heights.iter().any(|h| (h - e).abs() < 1e-9)), "{d}");
        assert_eq!(parts.len(), 2);
        assert!(d.len() < 2000, "{}", d.len());
    }

    /// Every point of the curve is within the bound, plus half the diagonal of the grid, of the
    /// drawn line.
    #[test]
    fn removed_points_are_close_to_the_drawn_line() {
        let grid = 0.05 * f64::sqrt(2.0);
        // At most one point in a column: the second rule alone.
        let curve: Vec<(f64, f64)> = (0..1200)
            .map(|i| f64::from(i) * 0.55)
            .map(|x| (x, 90.0 + 60.0 * (x / 40.0).sin() * (-x / 300.0).exp()))
            .collect();
        let d = path(curve.iter().copied());
        let line = read(&d).concat();
        let worst = curve.iter().map(|p| away(*p, &line)).fold(0.0, f64::max);
        assert!(worst <= BOUND + grid && worst > 0.5 * BOUND, "{worst}");
        assert!(line.len() < curve.len() / 5, "{} of {}", line.len(), curve.len());
        // Lowest, highest, first and last point are kept.
        let edge = |better: fn(f64, f64) -> bool| {
            curve.iter().copied().reduce(|a, b| if better(b.1, a.1) { b } else { a }).unwrap()
        };
        for p in [edge(|a, b| a < b), edge(|a, b| a > b), curve[0], curve[1199]] {
            assert!(line.iter().any(|q| (q[0] - p.0).abs() < 0.051 && (q[1] - p.1).abs() < 0.051), "{p:?}");
        }
        // Many points in a column: both rules.
        let curve: Vec<(f64, f64)> = (0..60_000)
            .map(|i| f64::from(i) * 0.005)
            .map(|x| (x, 70.0 + 60.0 * (x * 9.0).sin() * (x / 70.0).cos()))
            .collect();
        let line = read(&path(curve.iter().copied())).concat();
        let worst = curve.iter().map(|p| away(*p, &line)).fold(0.0, f64::max);
        assert!(worst <= COLUMN + BOUND + grid, "{worst}");
    }

    #[test]
    fn short_numbers_without_drift() {
        assert_eq!(path([(0.0, 1.0), (1.0, 2.0), (2.0, 0.5)].into_iter()), "m0 1 1 1 1-1.5");
        assert_eq!(
            area([vec![(0.0, 1.0), (9.0, 1.2)], vec![(0.0, 3.0), (9.0, 3.0)]]),
            "m0 1 9 .2 0 1.8-9 0z"
        );
        assert_eq!(path([(f64::NAN, 1.0)].into_iter()), "");
        assert_eq!(area([Vec::new(), Vec::new()]), "");
        // Rounding errors of a thousand segments do not accumulate.
        let zigzag = (0..1000).map(|i| (f64::from(i) * 0.633, f64::from(i % 2) * 5.0));
        let end = *read(&path(zigzag)).concat().last().unwrap();
        assert!((end[0] - 632.4).abs() < 1e-6 && (end[1] - 5.0).abs() < 1e-6, "{end:?}");
    }
}
