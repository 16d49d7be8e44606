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
    /// In words.
    pub words: String,
    /// Uncertainty of the errors that comes from the reference.
    pub uncertainty: f64,
    /// Quantities of the same kind that the reference does not establish, which are left out.
    pub left_out: Vec<String>,
    /// Preferred measures that are not established, and why.
    pub passed_over: Vec<(String, String)>,
}

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
    reference.map_or_else(|| Standing::Not("the study has no reference".to_owned()), |r| r.metric(metric))
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

impl Judge<'_> {
    /// The measure of a candidate with the errors of all runs, or the reason why there is none.
    pub(super) fn measured(
        &self,
        candidate: &Candidate,
    ) -> Result<(Measure, Vec<Option<f64>>), (String, String)> {
        let measure = |name: &str, words: String, uncertainty: f64| Measure {
            name: name.into(),
            words,
            uncertainty,
            left_out: Vec::new(),
            passed_over: Vec::new(),
        };
        match candidate {
            Candidate::Metric(name) => match standing(self.reference, name) {
                Standing::Not(why) => Err(((*name).to_owned(), why)),
                Standing::Established { value, uncertainty } => {
                    let errors =
                        self.rows.iter().map(|row| row.value(name).map(|x| error(x, value))).collect();
                    let words = if value == 0.0 {
                        format!("{name}, which should be 0")
                    } else {
                        format!("error of {name}")
                    };
                    Ok((
                        measure(
                            name,
                            words,
                            if value == 0.0 { uncertainty } else { (uncertainty / value).abs() },
                        ),
                        errors,
                    ))
                }
            },
            Candidate::Mean(names) => {
                let parts: Result<Vec<_>, _> =
                    names.iter().map(|name| self.measured(&Candidate::Metric(name))).collect();
                let parts = parts?;
                let mean = |run: usize| {
                    let each: Option<Vec<f64>> = parts.iter().map(|(_, errors)| errors[run]).collect();
                    each.map(|errors| errors.iter().sum::<f64>() / parts.len() as f64)
                };
                let uncertainty = parts.iter().map(|(part, _)| part.uncertainty).fold(0.0, f64::max);
                let words = format!("mean error of {}", names.join(" and "));
                Ok((
                    measure(&names.join(" and "), words, uncertainty),
                    (0..self.rows.len()).map(mean).collect(),
                ))
            }
            Candidate::Columns(name, kind) => {
                let Some(reference) = self.reference else {
                    return Err(((*name).to_owned(), "the study has no reference".to_owned()));
                };
                let columns = established(reference, *kind);
                if columns.is_empty() {
                    return Err((
                        (*name).to_owned(),
                        "the reference has no established column of this kind".to_owned(),
                    ));
                }
                let squares =
                    columns.iter().filter_map(|c| reference.uncertainty(c).established()).map(|u| u.1 * u.1);
                let uncertainty = (squares.sum::<f64>() / columns.len() as f64).sqrt();
                let errors =
                    self.compared.iter().map(|c| c.as_ref().and_then(|c| c.mean(&columns))).collect();
                let words =
                    format!("deviation of {} from the reference, relative to the range", columns.join(", "));
                let all = reference.columns().into_iter().filter(|c| kind(c));
                let left_out = all.filter(|c| reference.uncertainty(c).established().is_none());
                let left_out = left_out.map(str::to_owned).collect();
                let measure = measure(&format!("deviation of {name}"), words, uncertainty);
                Ok((Measure { left_out, ..measure }, errors))
            }
            Candidate::OfColumns(what, kind) => {
                let none = |why: &str| Err((format!("{what} of stresses"), why.to_owned()));
                let Some(reference) = self.reference else { return none("the study has no reference") };
                let columns = reference.columns().into_iter().filter(|c| kind(c));
                let names: Vec<String> = columns.map(|c| format!("{c}:{what}")).collect();
                let known: Vec<(String, f64, f64)> = names
                    .iter()
                    .filter_map(|n| {
                        let (value, off) = reference.metric(n).established().filter(|(v, _)| *v > 0.0)?;
                        Some((n.clone(), value, off / value))
                    })
                    .collect();
                if known.is_empty() {
                    return none("the reference does not establish it for any stress");
                }
                let mean = |row: &Row| {
                    let each: Option<Vec<f64>> =
                        known.iter().map(|(n, right, _)| row.value(n).map(|x| error(x, *right))).collect();
                    each.map(|e| e.iter().sum::<f64>() / e.len() as f64)
                };
                let uncertainty = known.iter().map(|k| k.2).fold(0.0, f64::max);
                let words =
                    format!("error of {}", known.iter().map(|k| k.0.as_str()).collect::<Vec<_>>().join(", "));
                let left_out = names.into_iter().filter(|n| known.iter().all(|k| k.0 != *n)).collect();
                let measure = measure(&format!("{what} of stresses"), words, uncertainty);
                Ok((Measure { left_out, ..measure }, self.rows.iter().map(mean).collect()))
            }
        }
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
