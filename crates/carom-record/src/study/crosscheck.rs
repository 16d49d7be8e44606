//! Whether the conclusion of a level depends on what was matched there. At equal steps a method may
//! be best because its steps cost more; at equal cost, because another one was given longer steps.
//! The error of every method is interpolated between its levels, linearly in logarithms, at the
//! cost (in a design of matched cost, at the step) of the first arm of a level; its uncertainty is
//! the larger one of the two levels. A method whose levels do not reach that far has no such error.
//! The conclusion changes if another method is distinguishably better there, as in the ranking
//! (places.rs).

use super::arm::step;
use super::design::Kind;
use super::manifest::StudyManifest;
use super::places::{Ranked, alike};
use super::row::Row;

/// Comparison of the methods at a level by what was not matched there: at equal step if costs were
/// matched, otherwise at equal cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Crosscheck {
    /// Number of the level.
    pub level: usize,
    /// Quantity at which errors are interpolated: `cost` or `step`.
    pub at: &'static str,
    /// Value of this quantity for the arm that is ranked first at the level.
    pub value: f64,
    /// The method that is ranked first at the level.
    pub first: String,
    /// Methods with their interpolated errors, the smallest first; includes the method `first`.
    pub errors: Vec<(String, f64)>,
    /// The method with the smallest interpolated error, if that is distinguished from the error of
    /// the method ranked first.
    pub better: Option<String>,
}

/// A method with its errors: abscissa, error, uncertainty.
type Curve = (String, Vec<[f64; 3]>);

/// Compares the methods at every level of a design; empty unless it has at least two levels and two
/// methods. `uncertainty` is the part of the uncertainty of the errors that comes from the
/// reference.
pub(super) fn of(
    manifest: &StudyManifest,
    rows: &[Row],
    levels: &[Vec<Ranked>],
    uncertainty: f64,
) -> Vec<Crosscheck> {
    let Some(design) = &manifest.design else { return Vec::new() };
    let by_step = design.kind == Kind::MatchedCost;
    let at = |arm: usize| {
        if by_step { step(&manifest.arms[arm], "time.step") } else { rows[arm].value("cpu_time") }
    };
    let method = |arm: usize| manifest.arms[arm].method().to_owned();
    let mut methods: Vec<Curve> = Vec::new();
    for ranked in levels.iter().flatten().filter(|r| r.sound) {
        let Some(x) = at(ranked.arm).filter(|x| *x > 0.0 && ranked.error > 0.0) else { continue };
        let name = method(ranked.arm);
        match methods.iter_mut().find(|m| m.0 == name) {
            Some(known) => known.1.push([x, ranked.error, ranked.uncertainty]),
            None => methods.push((name, vec![[x, ranked.error, ranked.uncertainty]])),
        }
    }
    let level = |(level, ranked): (usize, &Vec<Ranked>)| {
        let first = ranked.first().filter(|r| r.sound)?;
        let value = at(first.arm)?;
        let known = |(name, points): &Curve| Some((name.clone(), interpolated(points, value)?));
        let mut errors: Vec<(String, (f64, f64))> = methods.iter().filter_map(known).collect();
        errors.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let at = if by_step { "step" } else { "cost" };
        let first = method(first.arm);
        let own = errors.iter().find(|(name, _)| *name == first)?.1;
        let best = errors.first().filter(|(_, error)| !alike(*error, own, uncertainty));
        let better = best.map(|(name, _)| name.clone());
        let several = errors.len() > 1;
        let errors = errors.into_iter().map(|(name, (error, _))| (name, error)).collect();
        several.then_some(Crosscheck { level, at, value, first, errors, better })
    };
    if levels.len() < 2 { Vec::new() } else { levels.iter().enumerate().filter_map(level).collect() }
}

/// Error, linear in logarithms between the two points around x, and uncertainty; none outside, up
/// to round-off.
fn interpolated(points: &[[f64; 3]], x: f64) -> Option<(f64, f64)> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    if let Some([_, error, uncertainty]) = sorted.iter().find(|p| (p[0] / x - 1.0).abs() < 1e-9) {
        return Some((*error, *uncertainty));
    }
    let [a, b] = sorted.windows(2).find(|pair| pair[0][0] <= x && x <= pair[1][0])?.try_into().ok()?;
    let share = (x / a[0]).ln() / (b[0] / a[0]).ln();
    Some((a[1] * (b[1] / a[1]).powf(share), f64::max(a[2], b[2])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// e = 1/x between 1 and 4 is 1/2 at 2, with the larger uncertainty; outside nothing is known.
    #[test]
    fn power_laws_are_interpolated_exactly() {
        let points = [[4.0, 0.25, 0.02], [1.0, 1.0, 0.01]];
        let (error, uncertainty) = interpolated(&points, 2.0).unwrap();
        assert!((error - 0.5).abs() < 1e-15 && uncertainty == 0.02);
        assert_eq!((interpolated(&points, 4.0), interpolated(&points, 5.0)), (Some((0.25, 0.02)), None));
    }
}
