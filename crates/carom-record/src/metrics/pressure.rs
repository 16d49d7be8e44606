//! Metrics of the contact pressure at rest, from the rows of contact.csv of the last recorded step
//! of a static run.
//!
//! Hertz's pressure in a line contact is half an ellipse, so its square is a parabola in the
//! tangential coordinate s:
//!
//! ```text
//! p² = p₀² (1 − ((s − c)/a)²)        fitted to p² at the nodes by least squares: linear in p₀², p₀²c/a², p₀²/a²
//! ```
//!
//! (H. Hertz 1882; K. L. Johnson, *Contact Mechanics*, 1985, § 4.2.) If the pressure at one
//! outermost node alone is nearly the largest one, the model is one half of a symmetric problem,
//! and c is the coordinate of that node. Where the parabola leaves more than half of the variance
//! of p², as under a flat punch with its peaks at the edges, there is no ellipse. Of several
//! contacts, the one with the largest load is used. Places along the contact are those of the
//! plane; in space there are none.

use super::samples::extreme;
use crate::{ContactRow, Run};

/// Pressure at the axis of half a model over the largest one, at least: nodal pressures scatter.
const NEARLY: f64 = 0.9;
/// Component of a normal along x or y, over the other one, that is round-off.
const UPRIGHT: f64 = 1e-9;

/// Peak and half-width of the ellipse fitted to pressures at given coordinates.
///
/// Needs three different coordinates (two in a half model); none if the fitted parabola has no
/// maximum, or leaves more than half of the variance of p².
pub fn hertz(places: &[f64], pressures: &[f64]) -> Option<(f64, f64)> {
    let first = places.iter().copied().reduce(f64::min)?;
    let last = places.iter().copied().reduce(f64::max)?;
    let largest = extreme(pressures, f64::gt)?.1;
    let presses = |end: f64| places.iter().zip(pressures).any(|(s, p)| *s == end && *p > NEARLY * largest);
    let half = presses(first) != presses(last);
    let top = if presses(first) { first } else { last };
    // Coordinates scaled to −1 … 1 keep the normal equations well conditioned.
    let (middle, scale) =
        if half { (top, last - first) } else { (0.5 * (first + last), 0.5 * (last - first)) };
    let size = pressures.iter().fold(0.0_f64, |m, p| m.max(p.abs()));
    let powers = |s: f64| {
        let x = (s - middle) / scale;
        if half { [1.0, 0.0, x * x] } else { [1.0, x, x * x] }
    };
    let mut matrix = [[0.0; 3]; 3];
    let mut right = [0.0; 3];
    for (s, p) in places.iter().zip(pressures) {
        let row = powers(*s);
        let square = (p / size).powi(2);
        for i in 0..3 {
            right[i] += row[i] * square;
            for j in 0..3 {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    if half {
        matrix[1][1] = 1.0;
    }
    let [a, b, c] = solved(matrix, right)?;
    let count = places.len() as f64;
    let mean = pressures.iter().map(|p| (p / size).powi(2)).sum::<f64>() / count;
    let mut variance = 0.0;
    let mut unexplained = 0.0;
    for (s, p) in places.iter().zip(pressures) {
        let [one, x, xx] = powers(*s);
        let square = (p / size).powi(2);
        variance += (square - mean).powi(2);
        unexplained += (square - (a * one + b * x + c * xx)).powi(2);
    }
    if unexplained > 0.5 * variance {
        return None;
    }
    // a + bx + cx² = peak + c(x − x₀)²
    let peak = a - b * b / (4.0 * c);
    (c < 0.0 && peak > 0.0).then(|| (size * peak.sqrt(), scale * (-peak / c).sqrt()))
}

/// Solution of three linear equations by Cramer's rule; none if they are singular.
fn solved(m: [[f64; 3]; 3], right: [f64; 3]) -> Option<[f64; 3]> {
    let det = |m: [[f64; 3]; 3]| {
        (0..3)
            .map(|i| {
                m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3])
            })
            .sum::<f64>()
    };
    let whole = det(m);
    let size = m.iter().flatten().fold(0.0_f64, |s, x| s.max(x.abs()));
    (whole.abs() > 1e-12 * size.powi(3)).then(|| {
        std::array::from_fn(|k| {
            let mut replaced = m;
            for i in 0..3 {
                replaced[i][k] = right[i];
            }
            det(replaced) / whole
        })
    })
}

/// The rows of the last recorded step of the contact with the largest load.
fn last_rows(run: &Run) -> Vec<&ContactRow<'static>> {
    let Some(last) = run.column("step").and_then(|s| s.last().copied()) else { return Vec::new() };
    let rows: Vec<_> = run.contact.iter().filter(|r| r.step as f64 == last).collect();
    let load = |name: &str| rows.iter().filter(|r| r.contact == name).map(|r| -r.multiplier).sum::<f64>();
    let names = rows.iter().map(|r| r.contact.as_ref());
    let Some(most) = names.reduce(|most, next| if load(next) > load(most) { next } else { most }) else {
        return Vec::new();
    };
    let most = most.to_owned();
    rows.into_iter().filter(|r| r.contact == most).collect()
}

/// Rows of the contact at the end of a static run; none for a dynamic run, or without
/// contact.
fn at_rest(run: &Run) -> Option<Vec<&ContactRow<'static>>> {
    let mut rows = if run.manifest.facts.is_static { last_rows(run) } else { Vec::new() };
    rows.retain(|row| row.pressure.is_finite());
    (!rows.is_empty()).then_some(rows)
}

/// Coordinates of points of rows, in the plane, along the tangent that is orthogonal to the mean
/// normal, towards +x, or +y where it is vertical: which body is the secondary one does not matter.
fn places(run: &Run, rows: &[&ContactRow], point: impl Fn(&ContactRow) -> [f64; 2]) -> Option<Vec<f64>> {
    if run.manifest.facts.dimension == 3 {
        return None;
    }
    let [x, y] = rows.iter().fold([0.0, 0.0], |n, r| std::array::from_fn(|i| n[i] + r.normal[i]));
    let is_backward = y < -UPRIGHT * x.abs() || y.abs() <= UPRIGHT * x.abs() && x > 0.0;
    let length = if is_backward { -f64::hypot(x, y) } else { f64::hypot(x, y) };
    let along = |[px, py]: [f64; 2]| (y * px - x * py) / length;
    Some(rows.iter().map(|row| along(point(row))).collect())
}

fn pressures(rows: &[&ContactRow]) -> Vec<f64> {
    rows.iter().map(|row| row.pressure).collect()
}

/// Tangential coordinate of the resultant pressure at the end of a static run, Σ λᵢ sᵢ/Σ λᵢ.
pub(crate) fn center(run: &Run) -> Option<f64> {
    let has_field = run.manifest.facts.contact_columns().has_field;
    let acts = |row: &ContactRow| if has_field { row.center } else { [row.point[0], row.point[1]] };
    let rows = at_rest(run)?;
    let forces = || rows.iter().map(|row| row.multiplier);
    let total = forces().sum::<f64>();
    let moment = forces().zip(places(run, &rows, acts)?).map(|(force, s)| force * s).sum::<f64>();
    (total != 0.0).then(|| moment / total)
}

/// Smallest pressure of a node at the end of a static run.
pub(crate) fn smallest(run: &Run) -> Option<f64> {
    extreme(&pressures(&at_rest(run)?), f64::lt).map(|x| x.1)
}

/// Largest pressure of a node at the end of a static run.
pub(crate) fn largest(run: &Run) -> Option<f64> {
    extreme(&pressures(&at_rest(run)?), f64::gt).map(|x| x.1)
}

/// Largest tangential traction of a node at the end of a static run, the pressure times the ratio
/// of the tangential to the normal force; none without friction.
pub(crate) fn largest_traction(run: &Run) -> Option<f64> {
    let rows = at_rest(run)?;
    let tractions = rows.iter().filter(|r| r.friction != "none" && r.multiplier != 0.0);
    tractions.map(|r| (r.traction * r.pressure / r.multiplier).abs()).reduce(f64::max)
}

/// [`hertz`] of the pressures at the end of a static run.
pub(crate) fn ellipse(run: &Run) -> Option<(f64, f64)> {
    let rows = at_rest(run)?;
    hertz(&places(run, &rows, |row| [row.point[0], row.point[1]])?, &pressures(&rows))
}
