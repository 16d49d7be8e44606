//! Questions, and their values in records.

use std::borrow::Cow;

use super::form::Form;
use crate::Reason;
use crate::expression::Expression;

/// Two times are equal if they differ by less than this fraction of the span of the first record.
const SAME_TIME: f64 = 1e-9;

/// Expression that an expectation, or one side of a claim, evaluates.
pub type Question = Expression<Quantity>;

/// A number computed from a record.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// Metric by its name, and the arm if one is named.
    Metric(String, Option<String>),
    /// A reduction of columns.
    Reduced(Form, Series),
}

/// Columns combined row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The expression in columns.
    pub columns: Expression<Asked>,
    /// Whether rows of several arms are matched by their step instead of their time.
    pub by_step: bool,
}

/// A column, of an arm in a study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// Name of the column.
    pub column: String,
    /// Name of the arm; none outside a study.
    pub arm: Option<String>,
}

/// A column with the times and steps of its rows.
#[derive(Clone, Debug)]
pub struct Rows<'a> {
    /// Times of the rows.
    pub times: Cow<'a, [f64]>,
    /// Step numbers of the rows.
    pub steps: Cow<'a, [f64]>,
    /// Values of the column.
    pub values: Cow<'a, [f64]>,
}

/// Window of time: only rows strictly between two times are used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Window {
    /// Time after which rows are used; none for all rows from the first.
    pub after: Option<f64>,
    /// Time before which rows are used; none for all rows up to the last.
    pub before: Option<f64>,
}

impl Window {
    fn contains(self, time: f64) -> bool {
        self.after.is_none_or(|t| time > t) && self.before.is_none_or(|t| time < t)
    }
}

/// The source of the numbers: one record, or the arms of a study.
pub trait Records {
    /// Value of a metric by its name.
    ///
    /// # Errors
    /// The reason why the metric is not available.
    fn metric(&self, name: &str, arm: Option<&str>) -> Result<f64, Reason>;

    /// Rows of a column.
    ///
    /// # Errors
    /// The reason why the column is not available.
    fn column(&self, asked: &Asked) -> Result<Rows<'_>, Reason>;
}

impl Question {
    /// Evaluates the question in these records; only rows in the window are used.
    ///
    /// # Errors
    /// What is missing, or why there is no value.
    pub fn answer(&self, records: &dyn Records, window: Window) -> Result<f64, Reason> {
        let value = self.value(&mut |quantity| match quantity {
            Quantity::Metric(name, _) if window != Window::default() => {
                Err(format!("`{name}` is a metric of the whole run, not of the rows between two times")
                    .into())
            }
            Quantity::Metric(name, arm) => records.metric(name, arm.as_deref()),
            Quantity::Reduced(form, series) => {
                let (times, values) = series.rows(records, window)?;
                form.of(&times, &values)
            }
        })?;
        if value.is_finite() { Ok(value) } else { Err(format!("its value is {value}").into()) }
    }

    /// Copies the question, with this arm for quantities that name none.
    pub(crate) fn of_arm(&self, arm: &str) -> Self {
        self.map(&|quantity| match quantity {
            Quantity::Metric(name, of) => {
                Quantity::Metric(name.clone(), of.clone().or_else(|| Some(arm.to_owned())))
            }
            Quantity::Reduced(form, series) => Quantity::Reduced(*form, series.of_arm(arm)),
        })
    }

    /// The arm of each quantity; none for a quantity without an arm.
    pub fn arms(&self) -> Vec<Option<&str>> {
        let mut arms = Vec::new();
        for quantity in self.quantities() {
            match quantity {
                Quantity::Metric(_, arm) => arms.push(arm.as_deref()),
                Quantity::Reduced(_, series) => {
                    arms.extend(series.columns.quantities().iter().map(|a| a.arm.as_deref()));
                }
            }
        }
        arms
    }

    /// Whether the question depends on `stopped`, so that an unfinished record is used too.
    pub fn asks_whether_stopped(&self) -> bool {
        self.quantities().iter().any(|q| matches!(q, Quantity::Metric(name, _) if name == "stopped"))
    }
}

impl Series {
    /// Times and values of the rows of the series.
    ///
    /// # Errors
    /// What is missing.
    pub fn rows(&self, records: &dyn Records, window: Window) -> Result<(Vec<f64>, Vec<f64>), Reason> {
        let (times, mut values) = common(std::slice::from_ref(self), records, window)?;
        Ok((times, values.swap_remove(0)))
    }

    /// Copies the series, with this arm for columns that name none.
    pub(crate) fn of_arm(&self, arm: &str) -> Self {
        let named = |a: &Asked| Asked {
            column: a.column.clone(),
            arm: a.arm.clone().or_else(|| Some(arm.to_owned())),
        };
        Self { columns: self.columns.map(&named), by_step: self.by_step }
    }
}

/// Times, and values of each series, for the rows that all columns have in common. Rows are matched
/// by step if one of the series requires it.
///
/// # Errors
/// What is missing.
pub fn common(
    series: &[Series],
    records: &dyn Records,
    window: Window,
) -> Result<(Vec<f64>, Vec<Vec<f64>>), Reason> {
    let names: Vec<&Asked> = series.iter().flat_map(|s| s.columns.quantities()).collect();
    let columns = names.iter().map(|a| records.column(a)).collect::<Result<Vec<_>, _>>()?;
    let Some(first) = columns.first() else { return Err("no column is named".into()) };
    let by_step = series.iter().any(|s| s.by_step);
    let keys: Vec<&[f64]> = columns.iter().map(|c| if by_step { &*c.steps } else { &*c.times }).collect();
    let span = keys[0].last().unwrap_or(&0.0) - keys[0].first().unwrap_or(&0.0);
    let mut times = Vec::new();
    let mut values = vec![Vec::new(); series.len()];
    for (row, (time, here)) in first.times.iter().zip(keys[0]).enumerate() {
        if !window.contains(*time) {
            continue;
        }
        // The same row number for the same record, otherwise the row at the same time.
        let near = |keys: &[f64]| {
            let i = keys.partition_point(|k| *k < here - SAME_TIME * span);
            keys.get(i).filter(|k| (*k - here).abs() <= SAME_TIME * span).map(|_| i)
        };
        let found = |keys: &&[f64]| if keys.get(row) == Some(here) { Some(row) } else { near(keys) };
        let Some(rows) = keys.iter().map(found).collect::<Option<Vec<_>>>() else { continue };
        let mut next = 0..;
        for (one, values) in series.iter().zip(&mut values) {
            values.push(one.columns.value(&mut |a| {
                let i = next.next().unwrap_or_default();
                let value = columns[i].values.get(rows[i]).copied().unwrap_or(f64::NAN);
                if value.is_nan() {
                    Err(format!("column `{}` is not a number at time {time}", a.column))
                } else {
                    Ok(value)
                }
            })?);
        }
        times.push(*time);
    }
    match (times.is_empty(), window == Window::default(), columns.len()) {
        (false, ..) => Ok((times, values)),
        (true, true, 1) => Err("the history has no rows".into()),
        (true, true, _) => Err("the records have no common rows".into()),
        (true, false, _) => Err("there are no rows between `after` and `before`".into()),
    }
}
