//! Expected values, and the comparison of a record with them.
//!
//! ```text
//! got = question                                                 without `formula`
//! got = ‖c(t) − formula(t)‖ / scale                              with it; c is the column, or [ columns ], of the question
//!       max: largest |·|;  rms: √ of the mean of the squares     over the rows with after < t < before
//! ```

use carom_formula::Formula;
use serde::{Deserialize, Serialize};

use crate::Reason;
use crate::question::{Form, Question, Records, Series, Window};
use crate::{Expectation, Run, Status};

/// An expected value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Expect {
    /// The quantity: [`crate::question`].
    pub what: String,
    /// Bound on the value.
    pub bound: Bound,
    /// Where the expected value comes from.
    pub source: Option<String>,
    /// Expected values of the column; the bound is then on the deviation from them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviation: Option<Deviation>,
    /// Only rows after this time are used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<f64>,
    /// Only rows before this time are used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub before: Option<f64>,
    /// The order of convergence, in a study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<OrderOf>,
    /// Norm of deviations, if given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub norm: Option<Norm>,
    /// Skipped by `carom verify --fast`.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub slow: bool,
}

/// An order of convergence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrderOf {
    /// A quantity, or a column.
    pub of: String,
    /// Key of the case that is refined.
    pub against: String,
    /// Only arms whose names contain this.
    pub arms: Option<String>,
    /// The exact value of the quantity.
    pub exact: Option<f64>,
}

/// A column's deviation from a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// Formula in `t`, or `exact`: the formula of the case for the column.
    pub formula: String,
    /// The formula that `exact` refers to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exact: Option<String>,
    /// Norm of the deviation.
    pub norm: Norm,
    /// Number that divides it.
    pub scale: f64,
}

/// Norm of a function of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Norm {
    /// Largest absolute value.
    Max,
    /// Root mean square over the rows.
    Rms,
}

/// Bound of an expectation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// |got − value| ≤ tolerance.
    Near {
        /// Expected value.
        value: f64,
        /// Absolute tolerance.
        tolerance: f64,
    },
    /// |got − value| ≤ relative·|value|.
    Relative {
        /// Expected value.
        value: f64,
        /// Relative tolerance.
        relative: f64,
    },
    /// got ≤ value.
    AtMost(f64),
    /// got ≥ value.
    AtLeast(f64),
}

impl Bound {
    /// The bound in words: `-0.7827 ± 0.004`.
    pub fn words(self) -> String {
        match self {
            Self::Near { value, tolerance } => format!("{} ± {}", plain(value), plain(tolerance)),
            Self::Relative { value, relative } => {
                format!("{} ± {} %", plain(value), plain(short_percent(relative)))
            }
            Self::AtMost(most) => format!("≤ {}", plain(most)),
            Self::AtLeast(least) => format!("≥ {}", plain(least)),
        }
    }

    /// Whether a number satisfies the bound.
    pub fn holds(self, got: f64) -> bool {
        match self {
            Self::Near { value, tolerance } => (got - value).abs() <= tolerance,
            Self::Relative { value, relative } => (got - value).abs() <= relative * value.abs(),
            Self::AtMost(most) => got <= most,
            Self::AtLeast(least) => got >= least,
        }
    }

    /// The expected value; for an upper or lower bound, the bound itself.
    pub fn value(self) -> f64 {
        match self {
            Self::Near { value, .. }
            | Self::Relative { value, .. }
            | Self::AtMost(value)
            | Self::AtLeast(value) => value,
        }
    }

    /// Absolute tolerance about the expected value; none for an upper or lower bound.
    pub fn tolerance(self) -> Option<f64> {
        match self {
            Self::Near { tolerance, .. } => Some(tolerance),
            Self::Relative { value, relative } => Some(relative * value.abs()),
            Self::AtMost(_) | Self::AtLeast(_) => None,
        }
    }
}

/// A number for messages: small and large ones with an exponent.
fn plain(x: f64) -> String {
    if x != 0.0 && !(1e-4..1e6).contains(&x.abs()) { format!("{x:e}") } else { x.to_string() }
}

/// A share in per cent, without the digits that the product by 100 makes up.
fn short_percent(share: f64) -> f64 {
    format!("{:.9e}", share * 100.0).parse().unwrap_or(share * 100.0)
}

impl Norm {
    /// Norm of a column; 0 without rows.
    pub fn of(self, values: &[f64]) -> f64 {
        match self {
            Self::Max => values.iter().fold(0.0, |most, x| f64::max(most, x.abs())),
            Self::Rms if values.is_empty() => 0.0,
            Self::Rms => Form::Rms.of(&[], values).unwrap_or_default(),
        }
    }
}

impl Deviation {
    /// Deviation of a column.
    ///
    /// # Errors
    /// The formula is invalid, or its value at the time of a row is not finite.
    pub fn of(&self, times: &[f64], values: &[f64]) -> Result<f64, Reason> {
        let text = self.exact.as_ref().unwrap_or(&self.formula);
        let formula = Formula::parse(text, &["t"]).map_err(|e| format!("`{text}`: {e}"))?;
        let difference = |(t, c): (&f64, &f64)| {
            let expected = formula.value(&[*t]);
            if expected.is_finite() {
                Ok(c - expected)
            } else {
                Err(format!("`{text}` is {expected} at t = {t}"))
            }
        };
        let differences = times.iter().zip(values).map(difference).collect::<Result<Vec<_>, _>>()?;
        Ok(self.norm.of(&differences) / self.scale)
    }
}

impl Expect {
    /// The rows that are used.
    pub fn window(&self) -> Window {
        Window { after: self.after, before: self.before }
    }

    /// The value in a record.
    ///
    /// # Errors
    /// Why there is none.
    pub fn got(&self, records: &dyn Records) -> Result<f64, Reason> {
        match &self.deviation {
            _ if self.order.is_some() => Err("an order of convergence needs a study".into()),
            None => Question::parse(&self.what)?.answer(records, self.window()),
            Some(deviation) => {
                let (times, values) = Series::parse(&self.what)?.rows(records, self.window())?;
                deviation.of(&times, &values)
            }
        }
    }

    /// The quantity in words.
    pub fn words(&self) -> String {
        let mut words = match &self.deviation {
            None => self.what.clone(),
            Some(Deviation { formula, norm, scale, .. }) => {
                let norm = if *norm == Norm::Rms { "rms" } else { "max" };
                let scale = if *scale == 1.0 { String::new() } else { format!(" / {scale}") };
                format!("{norm} |{} − ({formula})|{scale}", self.what)
            }
        };
        if let Some(after) = self.after {
            words.extend([", t > ".to_owned(), after.to_string()]);
        }
        if let Some(before) = self.before {
            words.extend([", t < ".to_owned(), before.to_string()]);
        }
        words
    }

    /// The outcome for a value, or for a missing one.
    pub fn verdict(&self, got: Result<f64, Reason>) -> Expectation {
        let (got, why) = match got {
            Ok(got) => (Some(got), None),
            Err(why) => (None, Some(why.into())),
        };
        Expectation {
            what: self.words(),
            expected: self.bound.words(),
            value: Some(self.bound.value()),
            tolerance: self.bound.tolerance(),
            got,
            pass: got.is_some_and(|x| self.bound.holds(x)),
            why,
            source: self.source.clone(),
            slow: self.slow,
        }
    }

    /// Whether it depends on `stopped`.
    pub fn asks_whether_stopped(&self) -> bool {
        self.deviation.is_none() && Question::parse(&self.what).is_ok_and(|q| q.asks_whether_stopped())
    }
}

/// Compares a record with expectations. A run that did not finish is judged only if one of them
/// depends on `stopped`.
pub fn judge(run: &Run, expects: &[Expect]) -> Vec<Expectation> {
    let judged = run.manifest.status == Status::Finished || expects.iter().any(Expect::asks_whether_stopped);
    let reason = || run.manifest.reason.clone().unwrap_or_else(|| "it has not finished".to_owned());
    let got =
        |e: &Expect| if judged { e.got(run) } else { Err(format!("the run stopped: {}", reason()).into()) };
    expects.iter().map(|e| e.verdict(got(e))).collect()
}

#[cfg(test)]
mod tests;
