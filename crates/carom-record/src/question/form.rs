//! Reductions of a column to a number, and the words for them.

use crate::Reason;
use crate::expression::Token;
use crate::metrics;

/// Reduction of a column to a number.
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

impl Form {
    /// The reduction of a column.
    ///
    /// # Errors
    /// The column has no rows, or the time was not recorded.
    pub fn of(self, times: &[f64], values: &[f64]) -> Result<f64, Reason> {
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

/// Every form, by the words that a question begins with; `T` stands for a number.
const FORMS: [(&str, Form); 11] = [
    ("min", Form::Min),
    ("max", Form::Max),
    ("first", Form::First),
    ("last", Form::Last),
    ("at T", Form::At(0.0)),
    ("time of min", Form::TimeOfMin),
    ("time of max", Form::TimeOfMax),
    ("range", Form::Range),
    ("drift", Form::Drift),
    ("peak", Form::Peak),
    ("rms", Form::Rms),
];

/// The words of all forms, as a list for messages.
pub fn form_names() -> String {
    let names = FORMS.map(|(name, _)| name);
    let [first @ .., last] = &names;
    format!("{} or {last}", first.join(", "))
}

/// The form at the start of a sequence of tokens, and the tokens after it.
pub(super) fn form(tokens: &[Token]) -> Result<Option<(Form, &[Token])>, Reason> {
    for (name, form) in FORMS {
        let length = name.split(' ').count();
        let Some((words, after)) = tokens.split_at_checked(length) else { continue };
        if !name
            .split(' ')
            .zip(words)
            .all(|(name, word)| word.word().is_some_and(|w| name == "T" || w == name))
        {
            continue;
        }
        let form = match (form, words.get(1).and_then(Token::word)) {
            (Form::At(_), Some(time)) => {
                Form::At(time.parse().map_err(|_| format!("`{time}` is not a time"))?)
            }
            _ => form,
        };
        return Ok(Some((form, after)));
    }
    Ok(None)
}
