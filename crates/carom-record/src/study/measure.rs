//! Measures of goals: each goal has candidates in order of preference; the first one that the
//! reference establishes is used, with the errors of all arms.

use super::compared::{Compared, established, is_stress, is_trajectory};
use super::design::Goal;
use super::reference::{IDEAL, Reference, Standing};
use super::row::Row;

/// The measure of a ranking.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Name of the metric, or of the combination of columns.
    pub name: String,
    /// Description of the measure in words.
    pub words: String,
    /// Uncertainty of the errors that comes from the reference.
    pub uncertainty: f64,
    /// Quantities of the same kind that the reference does not establish, which are left out.
    pub left_out: Vec<String>,
    /// Preferred measures that are not established, and why.
    pub passed_over: Vec<(String, String)>,
}

impl Measure {
    fn new(name: &str, words: String, uncertainty: f64, left_out: Vec<String>) -> Self {
        Self { name: name.to_owned(), words, uncertainty, left_out, passed_over: Vec::new() }
    }
}

/// Why there is no measure.
const NO_REFERENCE: &str = "the study has no reference";

/// A possible measure of a goal.
pub(super) enum Candidate {
    Metric(&'static str),
    /// The mean error of several.
    Mean(&'static [&'static str]),
    /// The deviation of columns.
    Columns(&'static str, fn(&str) -> bool),
    /// A metric of columns.
    OfColumns(&'static str, fn(&str) -> bool),
}

/// The possible measures of a goal, in order of preference.
pub(super) fn candidates(goal: Goal) -> Vec<Candidate> {
    match goal {
        Goal::Energy => vec![Candidate::Metric("energy_drift")],
        Goal::Force => [
            "force_variation",
            "force_high_frequency",
            "peak_mean_force",
            "impulse_y",
            "impulse_x",
            "impulse_z",
        ]
        .map(Candidate::Metric)
        .into(),
        Goal::Stress => vec![
            Candidate::OfColumns("variation", is_stress),
            Candidate::OfColumns("peak_mean", is_stress),
            Candidate::Columns("stresses", is_stress),
        ],
        Goal::Friction => vec![
            Candidate::Mean(&["friction_lost", "stick_share"]),
            Candidate::Metric("friction_lost"),
            Candidate::Metric("stick_share"),
        ],
        Goal::Trajectory | Goal::Cost => vec![Candidate::Columns("displacements", is_trajectory)],
    }
}

/// The reference value of a metric.
pub fn standing(reference: Option<&Reference>, metric: &str) -> Standing {
    if IDEAL.contains(&metric) {
        return Standing::Established { value: 0.0, uncertainty: 0.0 };
    }
    reference.map_or_else(|| Standing::Not(NO_REFERENCE.to_owned()), |r| r.metric(metric))
}

/// |m − r|, relative if r is not 0.
pub fn error(value: f64, right: f64) -> f64 {
    if right == 0.0 { value.abs() } else { ((value - right) / right).abs() }
}

/// The data that measures are computed from.
pub(super) struct Judge<'a> {
    pub(super) rows: &'a [Row],
    pub(super) compared: &'a [Option<Compared>],
    pub(super) reference: Option<&'a Reference>,
}

/// A metric with its established reference value.
struct Known {
    name: String,
    right: f64,
    /// Uncertainty of the errors in the metric, relative to the reference value unless that is 0.
    uncertainty: f64,
}

impl Known {
    fn of(name: &str, right: f64, uncertainty: f64) -> Self {
        let relative = if right == 0.0 { uncertainty } else { (uncertainty / right).abs() };
        Self { name: name.to_owned(), right, uncertainty: relative }
    }
}

/// A measure with the errors of all runs.
type Measured = (Measure, Vec<Option<f64>>);

impl Judge<'_> {
    /// The measure of a candidate, or its name and the reason why there is none.
    pub(super) fn measured(&self, candidate: &Candidate) -> Result<Measured, (String, String)> {
        match candidate {
            Candidate::Metric(name) => {
                let known = self.known(name)?;
                let words = if known.right == 0.0 {
                    format!("{name}, which should be 0")
                } else {
                    format!("error of {name}")
                };
                Ok(self.mean(name, words, &[known]))
            }
            Candidate::Mean(names) => {
                let known: Result<Vec<Known>, _> = names.iter().map(|name| self.known(name)).collect();
                let name = names.join(" and ");
                Ok(self.mean(&name, format!("mean error of {name}"), &known?))
            }
            Candidate::Columns(name, kind) => {
                self.deviations(name, *kind).map_err(|why| ((*name).to_owned(), why.to_owned()))
            }
            Candidate::OfColumns(what, kind) => {
                let name = format!("{what} of stresses");
                self.of_columns(&name, what, *kind).map_err(|why| (name, why.to_owned()))
            }
        }
    }

    fn known(&self, name: &str) -> Result<Known, (String, String)> {
        match standing(self.reference, name) {
            Standing::Not(why) => Err((name.to_owned(), why)),
            Standing::Established { value, uncertainty } => Ok(Known::of(name, value, uncertainty)),
        }
    }

    /// The mean error of metrics.
    fn mean(&self, name: &str, words: String, known: &[Known]) -> Measured {
        let mean = |row: &Row| {
            let each = known.iter().map(|known| Some(error(row.value(&known.name)?, known.right)));
            let each: Option<Vec<f64>> = each.collect();
            each.map(|errors| errors.iter().sum::<f64>() / errors.len() as f64)
        };
        let uncertainty = known.iter().map(|known| known.uncertainty).fold(0.0, f64::max);
        (Measure::new(name, words, uncertainty, Vec::new()), self.rows.iter().map(mean).collect())
    }

    /// The deviation of columns from those of the reference.
    fn deviations(&self, name: &str, kind: fn(&str) -> bool) -> Result<Measured, &'static str> {
        let reference = self.reference.ok_or(NO_REFERENCE)?;
        let columns = established(reference, kind);
        if columns.is_empty() {
            return Err("the reference has no established column of this kind");
        }
        let squares =
            columns.iter().filter_map(|c| reference.uncertainty(c).established()).map(|u| u.1 * u.1);
        let uncertainty = (squares.sum::<f64>() / columns.len() as f64).sqrt();
        let errors = self.compared.iter().map(|c| c.as_ref().and_then(|c| c.mean(&columns))).collect();
        let words = format!("deviation of {} from the reference, relative to the range", columns.join(", "));
        let all = reference.columns().into_iter().filter(|c| kind(c));
        let left_out = all.filter(|c| reference.uncertainty(c).established().is_none());
        let left_out = left_out.map(str::to_owned).collect();
        Ok((Measure::new(&format!("deviation of {name}"), words, uncertainty, left_out), errors))
    }

    /// The mean error of a metric of columns.
    fn of_columns(&self, name: &str, what: &str, kind: fn(&str) -> bool) -> Result<Measured, &'static str> {
        let reference = self.reference.ok_or(NO_REFERENCE)?;
        let mut known = Vec::new();
        let mut left_out = Vec::new();
        for column in reference.columns().into_iter().filter(|c| kind(c)) {
            let metric = format!("{column}:{what}");
            match reference.metric(&metric).established().filter(|(value, _)| *value > 0.0) {
                Some((value, off)) => known.push(Known::of(&metric, value, off)),
                None => left_out.push(metric),
            }
        }
        if known.is_empty() {
            return Err("the reference does not establish it for any stress");
        }
        let names: Vec<&str> = known.iter().map(|known| known.name.as_str()).collect();
        let (measure, errors) = self.mean(name, format!("error of {}", names.join(", ")), &known);
        Ok((Measure { left_out, ..measure }, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_relative_unless_the_reference_is_zero() {
        assert_eq!((error(-0.5, 0.0), error(3.0, -2.0), error(2.0, 2.0)), (0.5, 2.5, 0.0));
    }
}
