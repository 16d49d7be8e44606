//! Whether the conclusion of a level depends on what was matched there. At equal steps a method may
//! be best because its steps cost more; at equal cost, because another one was given longer steps.
//! The error of every method is interpolated between its levels, linearly in logarithms, at the cost
//! (in a design of matched cost, at the step) of the best arm of a level. A method whose levels do not
//! reach that far has no such error.

use super::arm::step;
use super::design::Kind;
use super::manifest::StudyManifest;
use super::ranking::Ranked;
use super::row::Row;

/// A level, judged by what was not matched there.
#[derive(Clone, Debug, PartialEq)]
pub struct Crosscheck {
    /// Number of the level.
    pub level: usize,
    /// What the errors are interpolated at: `cost` or `step`.
    pub at: &'static str,
    /// Its value, of the arm that is ranked first at the level.
    pub value: f64,
    /// The method that is ranked first at the level.
    pub first: String,
    /// Methods with their interpolated errors, the smallest first; the first one included.
    pub errors: Vec<(String, f64)>,
}

impl Crosscheck {
    /// The method with the smallest interpolated error, if it is not the one ranked first and differs
    /// from it by more than 5 %.
    pub fn changes(&self) -> Option<&str> {
        let own = self.errors.iter().find(|(method, _)| *method == self.first)?.1;
        let (best, error) = self.errors.first()?;
        (*best != self.first && *error < own / 1.05).then_some(best)
    }
}

/// Of every level of a design with at least two levels and two methods.
pub(super) fn of(manifest: &StudyManifest, rows: &[Row], levels: &[Vec<Ranked>]) -> Vec<Crosscheck> {
    let Some(design) = &manifest.design else { return Vec::new() };
    let by_step = design.kind == Kind::MatchedCost;
    let at = |arm: usize| {
        if by_step { step(&manifest.arms[arm], "time.step") } else { rows[arm].value("cpu_time") }
    };
    let method = |arm: usize| manifest.arms[arm].role.method.clone().unwrap_or_default();
    // Points (abscissa, error) of every method.
    let mut methods: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    for ranked in levels.iter().flatten() {
        let Some(x) = at(ranked.arm).filter(|x| *x > 0.0 && ranked.error > 0.0) else { continue };
        let name = method(ranked.arm);
        match methods.iter_mut().find(|m| m.0 == name) {
            Some(known) => known.1.push((x, ranked.error)),
            None => methods.push((name, vec![(x, ranked.error)])),
        }
    }
    let level = |(level, ranked): (usize, &Vec<Ranked>)| {
        let best = ranked.iter().filter(|r| r.place == 1).min_by(|a, b| a.error.total_cmp(&b.error))?;
        let value = at(best.arm)?;
        let mut errors: Vec<(String, f64)> = methods
            .iter()
            .filter_map(|(name, points)| Some((name.clone(), interpolated(points, value)?)))
            .collect();
        errors.sort_by(|a, b| a.1.total_cmp(&b.1));
        let at = if by_step { "step" } else { "cost" };
        (errors.len() > 1).then(|| Crosscheck { level, at, value, first: method(best.arm), errors })
    };
    if levels.len() < 2 { Vec::new() } else { levels.iter().enumerate().filter_map(level).collect() }
}

/// Linear in logarithms between the two points around x; none outside, up to round-off.
fn interpolated(points: &[(f64, f64)], x: f64) -> Option<f64> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let exact = sorted.iter().find(|p| (p.0 / x - 1.0).abs() < 1e-9);
    if let Some(point) = exact {
        return Some(point.1);
    }
    let [a, b] = sorted.windows(2).find(|pair| pair[0].0 <= x && x <= pair[1].0)?.try_into().ok()?;
    let share = (x / a.0).ln() / (b.0 / a.0).ln();
    Some(a.1 * (b.1 / a.1).powf(share))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// e = 1/x between 1 and 4 is 1/2 at 2; outside nothing is known.
    #[test]
    fn power_laws_are_interpolated_exactly() {
        let points = [(4.0, 0.25), (1.0, 1.0)];
        assert!((interpolated(&points, 2.0).unwrap() - 0.5).abs() < 1e-15);
        assert_eq!((interpolated(&points, 4.0), interpolated(&points, 5.0)), (Some(0.25), None));
    }

    #[test]
    fn a_change_is_more_than_five_percent() {
        let of = |other: f64| Crosscheck {
            level: 0,
            at: "cost",
            value: 1.0,
            first: "a".into(),
            errors: vec![("b".into(), other), ("a".into(), 1.0)],
        };
        assert_eq!((of(0.9).changes(), of(0.99).changes()), (Some("b"), None));
    }
}
