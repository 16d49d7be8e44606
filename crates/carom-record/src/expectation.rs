//! What `[[expect]] what = "…"` asks for, as a number of the record.
//!
//! ```text
//! min C · max C · first C · last C · at T C (linear between rows) · time of min C · time of max C · the name of a metric
//! ```

use crate::History;
use crate::metrics::{self, DEFINITIONS};

/// Value of an expectation.
///
/// # Errors
/// In words: what is not there, or why it cannot be told.
pub fn evaluate(history: &History, what: &str) -> Result<f64, String> {
    let words: Vec<&str> = what.split_whitespace().collect();
    let times = history.times();
    let column = |name: &str| {
        let values = history.column(name).ok_or_else(|| format!("there is no column `{name}` in the history"))?;
        if values.is_empty() {
            return Err("the history has no rows".to_string());
        }
        match values.iter().position(|x| x.is_nan()) {
            Some(row) => Err(format!("column `{name}` is not a number at time {}", times.get(row).unwrap_or(&0.0))),
            None => Ok(values),
        }
    };
    let extreme = |name: &str, which: &str| {
        let beats = if which == "min" { f64::lt } else { f64::gt };
        metrics::extreme(column(name)?, beats).ok_or_else(|| format!("column `{name}` is empty"))
    };
    match words[..] {
        [which @ ("min" | "max"), name] => extreme(name, which).map(|(_, value)| value),
        ["time", "of", which @ ("min" | "max"), name] => extreme(name, which).map(|(row, _)| times[row]),
        ["first", name] => Ok(column(name)?[0]),
        ["last", name] => column(name).map(|values| values[values.len() - 1]),
        ["at", time, name] => {
            let values = column(name)?;
            let time: f64 = time.parse().map_err(|_| format!("`{time}` is not a time"))?;
            let range = || format!("time {time} is outside the record, {} to {}", times[0], times[times.len() - 1]);
            metrics::at(times, values, time).ok_or_else(range)
        }
        [name] => match metrics::all(history).into_iter().find(|m| m.name == name) {
            Some(metric) => metric.value.ok_or_else(|| format!("this record has no {}", metric.definition)),
            None => Err(unknown(what)),
        },
        _ => Err(unknown(what)),
    }
}

fn unknown(what: &str) -> String {
    let names = DEFINITIONS.map(|(name, _)| name).join(", ");
    format!(
        "`{what}` is not an expectation: min, max, first, last, at T, time of min or time of max and a column, or one of {names}"
    )
}
