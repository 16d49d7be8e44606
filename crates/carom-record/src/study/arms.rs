//! Numbers and columns of the arms that claims and expectations use, gathered arm by arm so that
//! only one record is in memory at a time.

use std::collections::BTreeMap;

use crate::Reason;
use crate::metrics::Metric;
use crate::question::{self, Asked, Quantity, Question, Records, Rows, Series};
use crate::{Run, Status};

/// Questions and series that are to be evaluated from the records of the arms.
#[derive(Default)]
pub(super) struct Needs {
    pub(super) questions: Vec<Question>,
    /// Series of which all columns are needed.
    pub(super) series: Vec<Series>,
}

/// Numbers and columns of the arms.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmRecords {
    metrics: BTreeMap<(String, String), Result<f64, Reason>>,
    columns: BTreeMap<(String, String), [Vec<f64>; 3]>,
    /// Why an arm has no numbers.
    missing: BTreeMap<String, String>,
}

impl ArmRecords {
    /// Takes the metrics and columns of an arm that are needed.
    pub(super) fn gather(&mut self, arm: &str, run: &Run, metrics: &[Metric], needs: &Needs) {
        let stopped = f64::from(u8::from(run.manifest.status == Status::Failed));
        self.put_metric(arm, "stopped", stopped);
        if run.manifest.status != Status::Finished {
            let reason = run.manifest.reason.as_deref().unwrap_or("it has not finished");
            self.missing.insert(arm.to_owned(), format!("arm \"{arm}\" stopped: {reason}"));
            return;
        }
        let key = |name: &str| (arm.to_owned(), name.to_owned());
        let columns = |series: &Series| series.columns.quantities().into_iter().cloned().collect::<Vec<_>>();
        let mut used: Vec<Asked> = needs.series.iter().flat_map(columns).collect();
        for quantity in needs.questions.iter().flat_map(Question::quantities) {
            match quantity {
                Quantity::Metric(name, of) if of.as_deref() == Some(arm) && name != "stopped" => {
                    let known = metrics.iter().find(|m| m.name == name.as_str()).and_then(|m| m.value);
                    let value = known.map_or_else(|| run.metric(name, None), Ok);
                    self.metrics.insert(key(name), value);
                }
                Quantity::Metric(..) => {}
                Quantity::Reduced(_, series) => used.extend(columns(series)),
            }
        }
        for name in used.iter().filter(|a| a.arm.as_deref() == Some(arm)).map(|a| &a.column) {
            if let Ok(rows) = question::rows(&run.history, name) {
                let rows = [rows.times.into_owned(), rows.steps.into_owned(), rows.values.into_owned()];
                self.columns.insert(key(name), rows);
            }
        }
    }

    /// Adds a metric of an arm.
    pub fn put_metric(&mut self, arm: &str, name: &str, value: f64) {
        self.metrics.insert((arm.to_owned(), name.to_owned()), Ok(value));
    }

    fn none(&self, arm: &str, what: &str) -> Reason {
        let missing = self.missing.get(arm).cloned();
        missing.unwrap_or_else(|| format!("arm \"{arm}\" has no {what}")).into()
    }
}

/// The arm of a quantity; in a study every quantity must name one.
fn named<'a>(arm: Option<&'a str>, what: &str) -> Result<&'a str, Reason> {
    arm.ok_or_else(|| format!("`{what}` names no arm: write `{what} of \"ARM\"`").into())
}

impl Question {
    /// Checks that every quantity names its arm.
    ///
    /// # Errors
    /// A quantity that does not.
    pub fn of_arms(&self) -> Result<(), Reason> {
        for quantity in self.quantities() {
            match quantity {
                Quantity::Metric(name, arm) => named(arm.as_deref(), name).map(drop)?,
                Quantity::Reduced(_, series) => {
                    for asked in series.columns.quantities() {
                        named(asked.arm.as_deref(), &asked.column)?;
                    }
                }
            }
        }
        Ok(())
    }
}

impl Records for ArmRecords {
    fn metric(&self, name: &str, arm: Option<&str>) -> Result<f64, Reason> {
        let arm = named(arm, name)?;
        let found = self.metrics.get(&(arm.to_owned(), name.to_owned()));
        found.cloned().unwrap_or_else(|| Err(self.none(arm, name)))
    }

    fn column(&self, asked: &Asked) -> Result<Rows<'_>, Reason> {
        let arm = named(asked.arm.as_deref(), &asked.column)?;
        let found = self.columns.get(&(arm.to_owned(), asked.column.clone()));
        let [times, steps, values] =
            found.ok_or_else(|| self.none(arm, &format!("column `{}`", asked.column)))?;
        Ok(Rows { times: times.into(), steps: steps.into(), values: values.into() })
    }
}
