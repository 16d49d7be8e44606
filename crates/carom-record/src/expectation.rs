//! Comparison of a record with expected values.
//!
//! ```text
//! got = question                                                 without `formula`
//! got = ‖c(t) − formula(t)‖ / scale                              with it; c is the column, or [ columns ], of the question
//!       max: largest |·|;  rms: √ of the mean of the squares     over the rows with after < t < before
//! ```

use crate::Reason;
use crate::question::{Form, Question, Records, Series, Window};
use crate::{Deviation, Expect, Expectation, Norm, Run, Status};
use carom_formula::Formula;

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
    /// Window of time whose rows are used.
    pub fn window(&self) -> Window {
        Window { after: self.after, before: self.before }
    }

    /// Value of the quantity in a record.
    ///
    /// # Errors
    /// The reason why the quantity has no value.
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

    /// The outcome for the value of the quantity, or for the reason why it has none.
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

    /// Whether the expectation depends on `stopped`, so that an unfinished record is judged too.
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
