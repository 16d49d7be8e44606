//! Quantities of records, as `what = "…"` of `[[expect]]` and claims name them.
//!
//! ```text
//! question := FORM column [ of "ARM" ] | FORM [ columns ] [ by step ] | NAME [ of "ARM" ]         in any expression with numbers
//!             difference COLUMN of "ARM" and "ARM"          = peak [ COLUMN of "ARM" - COLUMN of "ARM" ];  rms difference … likewise
//! FORM     := min · max · first · last · at T (linear between rows) · time of min · time of max
//!             range (max − min) · drift (largest |c − c₀|) · peak (largest |c|) · rms (√ of the mean of c² over the rows)
//! columns  := an expression in columns, each with `of "ARM"` in a study
//! NAME     := a metric of `metrics`, COLUMN:min etc., energy_lost:N, or `stopped` (1 if the run could not continue, 0 if it ended)
//! ```
//!
//! An expression in columns of several arms uses the rows whose times occur in all records (to 1e-9
//! of the span); `by step` matches rows by step number instead, for records with different units of
//! time. Only rows with `after < time < before`, strictly, are used.

use std::borrow::Cow;

use crate::expression::{self, Expression, Token, tokens};
use crate::metrics::{self, COLUMNS, FREE, HISTORY, PRESSURE, WORK};
use crate::{History, Run, Status};

/// Two times are equal if they differ by less than this fraction of the span of the first record.
const SAME_TIME: f64 = 1e-9;

/// The value of an expectation, or of one side of a claim.
pub type Question = Expression<Quantity>;

/// A number computed from a record.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// A metric by its name, of an arm.
    Metric(String, Option<String>),
    /// A reduction of columns.
    Reduced(Form, Series),
}

/// How a column is reduced to a number.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Form {
    Min,
    Max,
    First,
    Last,
    At(f64),
    TimeOfMin,
    TimeOfMax,
    Range,
    Drift,
    Peak,
    Rms,
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
    /// Its name.
    pub column: String,
    /// The arm.
    pub arm: Option<String>,
}

/// A column with the times and steps of its rows.
#[derive(Clone, Debug)]
pub struct Rows<'a> {
    /// Times.
    pub times: Cow<'a, [f64]>,
    /// Step numbers.
    pub steps: Cow<'a, [f64]>,
    /// Values.
    pub values: Cow<'a, [f64]>,
}

/// The rows that are used: those strictly between two times.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Window {
    /// Only rows after this time.
    pub after: Option<f64>,
    /// Only rows before this time.
    pub before: Option<f64>,
}

impl Window {
    fn contains(self, time: f64) -> bool {
        self.after.is_none_or(|t| time > t) && self.before.is_none_or(|t| time < t)
    }
}

/// The source of the numbers: one record, or the arms of a study.
pub trait Records {
    /// A metric by its name.
    ///
    /// # Errors
    /// Why there is none.
    fn metric(&self, name: &str, arm: Option<&str>) -> Result<f64, String>;

    /// A column.
    ///
    /// # Errors
    /// Why there is none.
    fn column(&self, asked: &Asked) -> Result<Rows<'_>, String>;
}

impl Question {
    /// Parses a question.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::of(&tokens(text)?)
    }

    pub(crate) fn of(tokens: &[Token]) -> Result<Self, String> {
        expression::parse(tokens, &quantity)
    }

    /// Its value in these records.
    ///
    /// # Errors
    /// What is missing, or why there is no value.
    pub fn answer(&self, records: &dyn Records, window: Window) -> Result<f64, String> {
        let value = self.value(&mut |quantity| match quantity {
            Quantity::Metric(name, arm) => records.metric(name, arm.as_deref()),
            Quantity::Reduced(form, series) => {
                let (times, values) = series.rows(records, window)?;
                form.of(&times, &values)
            }
        })?;
        if value.is_finite() { Ok(value) } else { Err(format!("its value is {value}")) }
    }

    /// The same question, with this arm for quantities that name none.
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

    /// Whether it depends on `stopped`, so that an unfinished record is used too.
    pub fn asks_whether_stopped(&self) -> bool {
        self.quantities().iter().any(|q| matches!(q, Quantity::Metric(name, _) if name == "stopped"))
    }
}

impl Series {
    /// Parses a column, or an expression in columns.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn parse(text: &str) -> Result<Self, String> {
        series(&tokens(text)?)
    }

    /// Times and values of its rows.
    ///
    /// # Errors
    /// What is missing.
    pub fn rows(&self, records: &dyn Records, window: Window) -> Result<(Vec<f64>, Vec<f64>), String> {
        let (times, mut values) = common(std::slice::from_ref(self), records, window)?;
        Ok((times, values.swap_remove(0)))
    }

    /// The same series, with this arm for columns that name none.
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
) -> Result<(Vec<f64>, Vec<Vec<f64>>), String> {
    let names: Vec<&Asked> = series.iter().flat_map(|s| s.columns.quantities()).collect();
    let columns = names.iter().map(|a| records.column(a)).collect::<Result<Vec<_>, _>>()?;
    let Some(first) = columns.first() else { return Err("no column is named".to_owned()) };
    let by_step = series.iter().any(|s| s.by_step);
    let keys: Vec<&[f64]> = columns.iter().map(|c| if by_step { &*c.steps } else { &*c.times }).collect();
    let span = keys[0].last().unwrap_or(&0.0) - keys[0].first().unwrap_or(&0.0);
    let (mut times, mut values) = (Vec::new(), vec![Vec::new(); series.len()]);
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
        (true, true, 1) => Err("the history has no rows".to_owned()),
        (true, true, _) => Err("the records have no common rows".to_owned()),
        (true, false, _) => Err("there are no rows between `after` and `before`".to_owned()),
    }
}

impl Form {
    /// The reduction of a column.
    ///
    /// # Errors
    /// The column has no rows, or the time was not recorded.
    pub fn of(self, times: &[f64], values: &[f64]) -> Result<f64, String> {
        let none = || "the history has no rows".to_owned();
        let least = metrics::extreme(values, f64::lt).ok_or_else(none)?;
        let most = metrics::extreme(values, f64::gt).ok_or_else(none)?;
        Ok(match self {
            Self::Min => least.1,
            Self::Max => most.1,
            Self::TimeOfMin => times[least.0],
            Self::TimeOfMax => times[most.0],
            Self::Range => most.1 - least.1,
            Self::First => values[0],
            Self::Last => values[values.len() - 1],
            Self::Drift => values.iter().fold(0.0, |drift, x| f64::max(drift, (x - values[0]).abs())),
            Self::Peak => f64::max(most.1.abs(), least.1.abs()),
            Self::Rms => (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt(),
            Self::At(time) => metrics::at(times, values, time).ok_or_else(|| {
                format!("time {time} is outside the record, {} to {}", times[0], times[times.len() - 1])
            })?,
        })
    }
}

/// The form at the start of a sequence of tokens, and the tokens after it.
fn form(tokens: &[Token]) -> Result<Option<(Form, &[Token])>, String> {
    let words: Vec<&str> = tokens.iter().map_while(Token::word).take(3).collect();
    let (form, length) = match words[..] {
        ["time", "of", "min", ..] => (Form::TimeOfMin, 3),
        ["time", "of", "max", ..] => (Form::TimeOfMax, 3),
        ["at", time, ..] => (Form::At(time.parse().map_err(|_| format!("`{time}` is not a time"))?), 2),
        ["min", ..] => (Form::Min, 1),
        ["max", ..] => (Form::Max, 1),
        ["first", ..] => (Form::First, 1),
        ["last", ..] => (Form::Last, 1),
        ["range", ..] => (Form::Range, 1),
        ["drift", ..] => (Form::Drift, 1),
        ["peak", ..] => (Form::Peak, 1),
        ["rms", ..] => (Form::Rms, 1),
        _ => return Ok(None),
    };
    Ok(Some((form, &tokens[length..])))
}

fn quantity(tokens: &[Token]) -> Result<Quantity, String> {
    let word = |i: usize| tokens.get(i).and_then(Token::word);
    match (word(0), word(1)) {
        (Some("difference"), _) => return difference(Form::Peak, &tokens[1..]),
        (Some("rms"), Some("difference")) => return difference(Form::Rms, &tokens[2..]),
        _ => {}
    }
    if let Some((form, columns)) = form(tokens)? {
        let series = series(columns).map_err(|e| format!("{e} in `{}`", joined(tokens)))?;
        return Ok(Quantity::Reduced(form, series));
    }
    match tokens {
        [Token::Word(name)] => Ok(Quantity::Metric(name.clone(), None)),
        [Token::Word(name), Token::Word(of), Token::Quoted(arm)] if of == "of" => {
            Ok(Quantity::Metric(name.clone(), Some(arm.clone())))
        }
        _ => Err(unknown(&joined(tokens))),
    }
}

fn series(tokens: &[Token]) -> Result<Series, String> {
    let bare = |t: &Token, text| t.word() == Some(text);
    let (inside, by_step) = match tokens {
        [open, inside @ .., close, by, step]
            if bare(open, "[") && bare(close, "]") && bare(by, "by") && bare(step, "step") =>
        {
            (inside, true)
        }
        [open, inside @ .., close] if bare(open, "[") && bare(close, "]") => (inside, false),
        _ => return column(tokens).map(|a| Series { columns: Expression::Quantity(a), by_step: false }),
    };
    Ok(Series { columns: expression::parse(inside, &column)?, by_step })
}

fn column(tokens: &[Token]) -> Result<Asked, String> {
    match tokens {
        [Token::Word(column)] => Ok(Asked { column: column.clone(), arm: None }),
        [Token::Word(column), Token::Word(of), Token::Quoted(arm)] if of == "of" => {
            Ok(Asked { column: column.clone(), arm: Some(arm.clone()) })
        }
        [] => Err("a column is missing".to_owned()),
        _ => Err(unknown(&joined(tokens))),
    }
}

fn difference(form: Form, tokens: &[Token]) -> Result<Quantity, String> {
    let [Token::Word(column), Token::Word(of), Token::Quoted(one), Token::Word(and), Token::Quoted(other)] =
        tokens
    else {
        return Err(not_a_difference(tokens));
    };
    if (of.as_str(), and.as_str()) != ("of", "and") {
        return Err(not_a_difference(tokens));
    }
    let side = |arm: &String| Expression::Quantity(Asked { column: column.clone(), arm: Some(arm.clone()) });
    let columns = Expression::Binary(expression::Sign::Minus, Box::new([side(one), side(other)]));
    Ok(Quantity::Reduced(form, Series { columns, by_step: false }))
}

fn not_a_difference(tokens: &[Token]) -> String {
    format!("`difference {}` must have the form difference COLUMN of \"ARM\" and \"ARM\"", joined(tokens))
}

fn joined(tokens: &[Token]) -> String {
    let one = |token: &Token| match token {
        Token::Word(word) => word.clone(),
        Token::Quoted(text) => format!("\"{text}\""),
    };
    tokens.iter().map(one).collect::<Vec<_>>().join(" ")
}

fn unknown(what: &str) -> String {
    format!(
        "`{what}` is not a valid quantity: give min, max, first, last, at T, time of min, time of max, range, drift, peak or rms and a column, or \
         one of the metrics {}",
        metric_names().join(", ")
    )
}

/// Names of the metrics of a column.
pub fn column_metric_names() -> Vec<&'static str> {
    COLUMNS.iter().chain(&FREE).map(|(d, _)| d.name).collect()
}

/// Names of metrics that need no column.
pub fn metric_names() -> Vec<&'static str> {
    let history = HISTORY.iter().map(|(d, _)| d.name);
    history.chain(PRESSURE.iter().chain(&WORK).map(|(d, _)| d.name)).chain(["stopped"]).collect()
}

fn no_arms(arm: Option<&str>) -> Result<(), String> {
    arm.map_or(Ok(()), |arm| Err(format!("this is a single run, which has no arm \"{arm}\"")))
}

/// A metric of the history, or of one of its columns.
pub(crate) fn metric(history: &History, name: &str) -> Result<f64, String> {
    if let Some(n) = name.strip_prefix("energy_lost:") {
        let n = n
            .parse()
            .map_err(|_| format!("`{n}` is not the number of an impact; the first one is energy_lost:1"))?;
        return metrics::energy_lost_at(history, n)
            .ok_or_else(|| format!("the record has no completed impact number {n}"));
    }
    if let Some((column, what)) = name.rsplit_once(':') {
        history.column(column).ok_or_else(|| no_column(column))?;
        let (_, value) = metrics::of_column(history, column, what).ok_or_else(|| {
            format!("`{what}` is not a metric of a column; these are: {}", column_metric_names().join(", "))
        })?;
        return value.ok_or_else(|| format!("{what} of `{column}` is not defined for this record"));
    }
    match metrics::all(history).into_iter().find(|m| m.name == name) {
        Some(metric) => metric
            .value
            .ok_or_else(|| format!("not defined for this record; definition: {}", metric.definition)),
        None => Err(unknown(name)),
    }
}

fn no_column(name: &str) -> String {
    format!("there is no column `{name}` in the history")
}

/// A column of a history.
pub(crate) fn rows<'a>(history: &'a History, name: &str) -> Result<Rows<'a>, String> {
    let values = history.column(name).ok_or_else(|| no_column(name))?;
    let steps = history.column("step").unwrap_or_default();
    Ok(Rows { times: history.times().into(), steps: steps.into(), values: values.into() })
}

impl Records for History {
    fn metric(&self, name: &str, arm: Option<&str>) -> Result<f64, String> {
        no_arms(arm)?;
        metric(self, name)
    }

    fn column(&self, asked: &Asked) -> Result<Rows<'_>, String> {
        no_arms(asked.arm.as_deref())?;
        rows(self, &asked.column)
    }
}

impl Records for Run {
    fn metric(&self, name: &str, arm: Option<&str>) -> Result<f64, String> {
        no_arms(arm)?;
        if name == "stopped" {
            return Ok(f64::from(u8::from(self.manifest.status == Status::Failed)));
        }
        if let Some((_, value)) = WORK.iter().find(|(work, _)| work.name == name) {
            return value(self).ok_or_else(|| format!("the manifest has no {name}"));
        }
        if let Some((_, value)) = PRESSURE.iter().find(|(pressure, _)| pressure.name == name) {
            return value(self)
                .ok_or_else(|| format!("{name} is defined only for static runs that end in contact"));
        }
        metric(&self.history, name)
    }

    fn column(&self, asked: &Asked) -> Result<Rows<'_>, String> {
        self.history.column(&asked.column).ok_or_else(|| no_column(&asked.column))?;
        Records::column(&self.history, asked)
    }
}
