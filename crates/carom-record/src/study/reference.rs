//! The reference that the arms of a study are compared with, and its uncertainty.
//!
//! ```text
//! computed    three runs at h, 2h and 4h; value f(h), uncertainty |f(h) − f(2h)|
//!             established if |f(h) − f(2h)| ≤ 0.7 |f(2h) − f(4h)|, or ≤ 1 % of |f(h)|
//! an arm      the same with the arms that differ from it only in the step; with a single run nothing is established
//! exact       the formulas of [exact], and the metrics that can be computed from these columns; uncertainty 0
//! ideal       the values for elastic bodies: no change or dissipation of energy, no penetration
//! ```
//!
//! A column is established in the same way, with the deviation of f(2h) from f(h) as its
//! uncertainty. Only established values are used for rankings.

use std::collections::BTreeMap;
use std::path::Path;

use carom_formula::Formula;

use super::arm::{Arm, step};
use super::digits::short;
use super::manifest::StudyManifest;
use crate::metrics::{self, Metric};
use crate::{Column, History, RecordError, Run, Status};

/// Largest ratio of successive differences under refinement.
pub const FALL: f64 = 0.7;
/// Relative difference that is negligible.
pub const SMALL: f64 = 0.01;

/// Metrics whose exact value is zero in every case.
pub const IDEAL: [&str; 8] = [
    "energy_lost",
    "energy_created",
    "energy_drift",
    "energy_lost_impact",
    "dissipated_integrator",
    "dissipated_contact",
    "penetration",
    "penetration_mean",
];

/// A reference value, or why there is none.
#[derive(Clone, Debug, PartialEq)]
pub enum Standing {
    /// It is established.
    Established {
        /// The value.
        value: f64,
        /// Its uncertainty.
        uncertainty: f64,
    },
    /// It is not established, for this reason.
    Not(String),
}

impl Standing {
    /// Value and uncertainty.
    pub fn established(&self) -> Option<(f64, f64)> {
        match self {
            Self::Established { value, uncertainty } => Some((*value, *uncertainty)),
            Self::Not(_) => None,
        }
    }

    /// From values at decreasing steps, the finest last.
    pub fn of(values: &[f64]) -> Self {
        match *values {
            [.., coarse, middle, fine] => {
                let (before, last) = ((middle - coarse).abs(), (fine - middle).abs());
                if last <= FALL * before || last <= SMALL * fine.abs() {
                    Self::Established { value: fine, uncertainty: last }
                } else {
                    Self::Not(format!(
                        "the last halving of the step changed it by {}, the one before by {}",
                        short(last),
                        short(before)
                    ))
                }
            }
            [middle, fine] if (fine - middle).abs() <= SMALL * fine.abs() => {
                Self::Established { value: fine, uncertainty: (fine - middle).abs() }
            }
            [_, _] => Self::Not("two runs differ by more than 1 %, and there is no third run".to_owned()),
            _ => Self::Not("a single run gives no error estimate".to_owned()),
        }
    }
}

/// The part of a run that is used for comparisons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times of the rows.
    pub times: Vec<f64>,
    /// Columns of probes and of the striker's centre, and [`FORCE`], the magnitude of the contact
    /// force.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// The metrics.
    pub metrics: Vec<Metric>,
}

/// Column name of the magnitude of the contact force.
pub const FORCE: &str = "contact force";

impl Trajectory {
    /// From a record.
    pub fn of(run: &Run, metrics: &[Metric]) -> Self {
        let history = &run.history;
        let mut names: Vec<String> = metrics::probe_columns(run).into_iter().map(str::to_owned).collect();
        if let Some(striker) = metrics::striker(history) {
            names.extend(["x", "y"].map(|axis| format!("{striker}.center_{axis}")));
        }
        let columns = names.into_iter().filter_map(|name| {
            let values = history.column(&name)?.to_vec();
            Some((name, values))
        });
        let mut columns: BTreeMap<_, _> = columns.collect();
        columns.insert(FORCE.to_owned(), metrics::contact_force(history));
        Self { times: history.times().to_vec(), columns, metrics: metrics.to_vec() }
    }

    fn value(&self, metric: &str) -> Option<f64> {
        self.metrics.iter().find(|m| m.name == metric)?.value
    }
}

/// A reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Description in words.
    pub what: String,
    /// Its runs, the finest last; for exact formulas, one sampled from them.
    runs: Vec<Trajectory>,
    exact: bool,
}

impl Reference {
    /// Of runs at decreasing steps, the finest last.
    pub fn of_runs(what: String, runs: Vec<Trajectory>) -> Self {
        Self { what, runs, exact: false }
    }

    /// Of formulas in t by column, sampled at `rows` + 1 times from 0 to `end`.
    pub fn of_formulas(formulas: &BTreeMap<String, String>, end: f64, rows: usize) -> Option<Self> {
        let times: Vec<f64> = (0..=rows).map(|i| end * i as f64 / rows as f64).collect();
        let mut columns = BTreeMap::new();
        for (name, text) in formulas {
            let formula = Formula::parse(text, &["t"]).ok()?;
            columns.insert(name.clone(), times.iter().map(|t| formula.value(&[*t])).collect::<Vec<_>>());
        }
        let names = std::iter::once("time").chain(columns.keys().map(String::as_str));
        let described = names.map(|name| Column {
            name: name.into(),
            unit: String::new(),
            description: String::new(),
            integer: false,
        });
        let values = std::iter::once(times.clone()).chain(columns.values().cloned());
        let history = History::new(described.collect(), values.collect());
        let mut known = metrics::all(&history);
        for column in columns.keys() {
            let of = metrics::COLUMNS.iter().map(|(d, value)| Metric {
                name: format!("{column}:{}", d.name).into(),
                value: value(&history, column),
                unit: String::new(),
                definition: d.meaning,
            });
            known.extend(of);
        }
        if history.column("contact_force_x").is_some() {
            columns.insert(FORCE.to_owned(), metrics::contact_force(&history));
        }
        let sampled = Trajectory { times, columns, metrics: known };
        Some(Self { what: "the exact formulas of [exact]".to_owned(), runs: vec![sampled], exact: true })
    }

    /// Reference value of a metric.
    pub fn metric(&self, name: &str) -> Standing {
        let values: Vec<Option<f64>> = self.runs.iter().map(|run| run.value(name)).collect();
        if self.exact {
            return match values.first() {
                Some(Some(value)) => Standing::Established { value: *value, uncertainty: 0.0 },
                _ => Standing::Not("[exact] has no columns to compute it from".to_owned()),
            };
        }
        match values.into_iter().collect::<Option<Vec<f64>>>() {
            Some(values) => Standing::of(&values),
            None => Standing::Not("a run of the reference has no value".to_owned()),
        }
    }

    /// Times and values of a column.
    pub fn column(&self, name: &str) -> Option<(&[f64], &[f64])> {
        let run = self.runs.last()?;
        Some((&run.times, run.columns.get(name)?))
    }

    /// Names of its columns.
    pub fn columns(&self) -> Vec<&str> {
        self.runs.last().map_or_else(Vec::new, |run| run.columns.keys().map(String::as_str).collect())
    }

    /// Deviation of a column from the same column at twice the step, if the runs establish it.
    pub fn uncertainty(&self, column: &str) -> Standing {
        if self.exact {
            return Standing::Established { value: 0.0, uncertainty: 0.0 };
        }
        let apart = |a: &Trajectory, b: &Trajectory| {
            let (fine, coarse) = (b.columns.get(column)?, a.columns.get(column)?);
            metrics::deviation(&a.times, coarse, (&b.times, fine))
        };
        let apart: Option<Vec<f64>> = self.runs.windows(2).map(|pair| apart(&pair[0], &pair[1])).collect();
        match apart.as_deref() {
            Some([.., before, last]) if *last <= FALL * before || *last <= SMALL => {
                Standing::Established { value: 0.0, uncertainty: *last }
            }
            Some([.., before, last]) => Standing::Not(format!(
                "the last halving of the step changed it by {} of its range, the one before by {}",
                short(*last),
                short(*before)
            )),
            Some([last]) if *last <= SMALL => Standing::Established { value: 0.0, uncertainty: *last },
            Some([_]) => {
                Standing::Not("two runs differ by more than 1 %, and there is no third run".to_owned())
            }
            _ => Standing::Not("a single run gives no error estimate".to_owned()),
        }
    }

    /// Uncertainty of a column at the times of the reference.
    pub fn band(&self, column: &str) -> Vec<f64> {
        let Some((times, values)) = self.column(column) else { return Vec::new() };
        let before = self.runs.len().checked_sub(2).and_then(|i| self.runs.get(i));
        let other = before.and_then(|run| Some((&run.times, run.columns.get(column)?)));
        let off = |(t, v): (&f64, &f64)| {
            other.and_then(|(times, values)| metrics::at(times, values, *t)).map_or(0.0, |x| (x - v).abs())
        };
        times.iter().zip(values).map(off).collect()
    }
}

impl StudyManifest {
    /// Indices of the arms of the reference, the finest last: the three of a computed reference, or
    /// the named arm after those arms that differ from it only in a longer step.
    fn reference_arms(&self) -> Vec<usize> {
        let Some(named) = self.arms.iter().position(|a| self.reference.as_ref() == Some(&a.name)) else {
            return Vec::new();
        };
        let others = |a: &Arm| {
            let sets = a
                .sets
                .iter()
                .filter(|s| !s.trim_start().starts_with("time.step"))
                .cloned()
                .collect::<Vec<_>>();
            (sets, a.case_path.clone(), a.role.fine)
        };
        let size = |i: &usize| step(&self.arms[*i], "time.step").unwrap_or_default();
        let alike =
            |i: &usize| others(&self.arms[*i]) == others(&self.arms[named]) && size(i) >= size(&named);
        let mut found: Vec<usize> = (0..self.arms.len()).filter(alike).collect();
        found.sort_by(|a, b| size(b).total_cmp(&size(a)));
        found.split_off(found.len().saturating_sub(3))
    }

    /// The reference that arms are compared with.
    ///
    /// # Errors
    /// Input/output or system error, or a damaged record.
    pub(super) fn reference(&self, directory: &Path) -> Result<Option<Reference>, RecordError> {
        if self.reference.as_deref() == Some("exact") {
            let Some(case) = self.arms.first().map(|a| &a.case) else { return Ok(None) };
            let formulas =
                case.get("exact").and_then(|e| serde_json::from_value(e.clone()).ok()).unwrap_or_default();
            let end = case.pointer("/time/end").and_then(serde_json::Value::as_f64).unwrap_or_default();
            return Ok(Reference::of_formulas(&formulas, end, 8000));
        }
        let mut runs = Vec::new();
        let arms = self.reference_arms();
        for i in &arms {
            if self.state(directory, &self.arms[*i])?.0 == Some(Status::Finished) {
                let run = Run::open(&directory.join(&self.arms[*i].directory))?;
                runs.push(Trajectory::of(&run, &metrics::of_run(&run)));
            }
        }
        let Some(last) = arms.last().filter(|_| runs.len() == arms.len()) else { return Ok(None) };
        let count = match runs.len() {
            1 => "a single run, whose error is not known".to_owned(),
            n => format!("the finest of {n} runs whose steps double"),
        };
        Ok(Some(Reference::of_runs(format!("\"{}\", {count}", self.arms[*last].name), runs)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: differences that halve establish a value, differences that do not decrease do not,
    /// and differences below 1 % do.
    #[test]
    fn what_a_refinement_establishes() {
        assert_eq!(
            Standing::of(&[1.4, 1.2, 1.1]),
            Standing::Established { value: 1.1, uncertainty: 1.2 - 1.1 }
        );
        assert!(matches!(Standing::of(&[1.4, 1.2, 1.4]), Standing::Not(_)));
        assert_eq!(Standing::of(&[1.0, 1.0, 1.0 + 0.005]).established().map(|x| x.0), Some(1.005));
        assert!(matches!(Standing::of(&[1.0]), Standing::Not(_)));
        assert!(matches!(Standing::of(&[1.0, 1.1]), Standing::Not(_)));
    }

    /// The bar on a wall: a force of 300 from 0.5 to 7/6. Its variation is 600; its impulse is a
    /// difference of the integral.
    #[test]
    fn metrics_of_exact_formulas() {
        let formulas = [
            ("active", "if(t >= 0.5, if(t < 7/6, 1, 0), 0)"),
            ("contact_force_x", "if(t >= 0.5, if(t < 7/6, 300, 0), 0)"),
            ("contact_impulse_x", "300*min(max(t-0.5,0),2/3)"),
        ];
        let formulas = formulas.map(|(name, text)| (name.to_owned(), text.to_owned())).into();
        let reference = Reference::of_formulas(&formulas, 2.0, 2000).unwrap();
        let value = |name: &str| reference.metric(name).established().unwrap();
        assert_eq!(value("force_variation"), (600.0, 0.0));
        assert!((value("impulse_x").0 - 200.0).abs() < 1e-9);
        assert!(matches!(reference.metric("apex"), Standing::Not(_)));
    }
}
