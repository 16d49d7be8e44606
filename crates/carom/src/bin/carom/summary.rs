//! The summary at the end of a run.

use serde::Serialize;

use crate::exit::{Exit, Failure};
use crate::live::duration;
use crate::simulation::{Expectation, Extreme, Outcome};
use crate::{console, out};

#[derive(Serialize)]
struct Event<'a> {
    event: &'static str,
    #[serde(flatten)]
    outcome: &'a Outcome,
}

/// Prints the outcome on standard output; with `json`, a run that stopped is an event too. A missed
/// expectation changes the exit code only with `strict`.
pub(crate) fn print(done: Result<Outcome, Failure>, json: bool, strict: bool) -> Result<Exit, Failure> {
    if json && let Err(Failure::Stopped { reason, directory, .. }) = &done {
        out::event(&serde_json::json!({ "event": "stopped", "reason": reason, "directory": directory }))?;
    }
    let outcome = done?;
    if json {
        let event = if outcome.interrupted { "interrupted" } else { "done" };
        out::event(&Event { event, outcome: &outcome })?;
    } else if !console::is_quiet() {
        out::line(&text(&outcome))?;
    }
    if outcome.interrupted {
        return Ok(Exit::Interrupted);
    }
    let missed = outcome.expectations.iter().filter(|e| !e.met);
    if !strict || missed.clone().next().is_none() {
        return Ok(Exit::Done);
    }
    if console::is_quiet() {
        missed.for_each(|e| console::say(expectation(e)));
    }
    Ok(Exit::Missed)
}

/// `min A.uy: -0.78268, as expected (-0.7827 ± 0.004)`
fn expectation(e: &Expectation) -> String {
    match (e.got, e.met) {
        (Some(got), true) => format!("{}: {}, as expected ({})", e.what, short(got), e.wanted),
        (Some(got), false) => {
            format!("{}: {}, MISSED: expected {}", e.what, missed(got, e.value), e.wanted)
        }
        (None, _) => {
            let why = e.why.as_deref().map_or_else(String::new, |why| format!(" ({why})"));
            format!("{}: not available{why}, expected {}", e.what, e.wanted)
        }
    }
}

fn text(outcome: &Outcome) -> String {
    let directory = outcome.directory.display();
    let wall = if outcome.wall > 0.0 {
        format!(" in {} of wall time", duration(outcome.wall))
    } else {
        String::new()
    };
    let time = |t| format!("{} {}", short(t), outcome.time_unit).trim_end().to_owned();
    let mut lines = vec![format!("{} steps to t = {}{wall}", outcome.steps, time(outcome.time))];
    let widest =
        |of: fn(&Extreme) -> &str| outcome.extremes.iter().map(|e| of(e).chars().count()).max().unwrap_or(0);
    let (width, unit) = (widest(|e| &e.column), widest(|e| &e.unit));
    for e in &outcome.extremes {
        let value = |x, t| format!("{:>11} {:unit$} at {:<11}", short(x), e.unit, time(t));
        let (min, max) = (value(e.min, e.min_time), value(e.max, e.max_time));
        lines.push(format!("  {:width$}  min {min}  max {max}", e.column).trim_end().to_owned());
    }
    lines.extend(outcome.expectations.iter().map(|e| format!("  {}", expectation(e))));
    for (phase, seconds) in &outcome.profile {
        let each = 1e3 * seconds / outcome.steps.max(1) as f64;
        lines.push(format!("  {phase:10} {:>10}  {:>9} ms per step", duration(*seconds), short(each)));
    }
    lines.extend(outcome.remarks.iter().map(|remark| format!("  {remark}")));
    if outcome.interrupted {
        lines.push(format!("stopped by Ctrl-C; continue with: carom resume {directory}"));
    }
    lines.push(
        outcome.report.as_ref().map_or_else(|| directory.to_string(), |page| page.display().to_string()),
    );
    lines.join("\n")
}

/// A number with five digits, in the shorter of the two notations.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || (1e-3..1e6).contains(&x.abs()) {
        let digits = (4 - x.abs().max(1e-3).log10().floor() as i32).clamp(0, 7) as usize;
        let text = format!("{x:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{x:.4e}")
    }
}

/// A number that misses an expected value, with all its digits where few do not show the miss.
pub(crate) fn missed(got: f64, expected: Option<f64>) -> String {
    let text = short(got);
    let lost = (text.parse().unwrap_or(got) - got).abs();
    if expected.is_some_and(|value| lost > 0.1 * (got - value).abs()) { format!("{got:?}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn summary_names_directory_extremes_and_expectations() {
        let outcome = Outcome {
            directory: "runs/impact-2".into(),
            interrupted: false,
            steps: 400,
            time: 0.75,
            time_unit: "s".into(),
            wall: 3.21,
            extremes: vec![Extreme {
                column: "A.uy".into(),
                unit: "m".into(),
                min: -0.78268,
                min_time: 0.43125,
                max: 0.0,
                max_time: 0.0,
            }],
            expectations: vec![Expectation {
                what: "min A.uy".into(),
                wanted: "-0.7827 ± 0.004".into(),
                got: Some(-0.78268),
                why: None,
                met: true,
                value: Some(-0.7827),
            }],
            profile: Vec::new(),
            report: Some("runs/impact-2/report.html".into()),
            remarks: Vec::new(),
        };
        let summary = text(&outcome);
        assert_eq!(
            summary.lines().collect::<Vec<_>>(),
            [
                "400 steps to t = 0.75 s in 3.2 s of wall time",
                "  A.uy  min    -0.78268 m at 0.43125 s    max           0 m at 0 s",
                "  min A.uy: -0.78268, as expected (-0.7827 ± 0.004)",
                "runs/impact-2/report.html",
            ]
        );
        let profiled = text(&Outcome { profile: vec![("assembly".into(), 1.25)], ..outcome.clone() });
        assert!(profiled.contains("\n  assembly        1.2 s      3.125 ms per step\n"), "{profiled}");
        let stopped = text(&Outcome { interrupted: true, report: None, ..outcome });
        assert!(stopped.ends_with("carom resume runs/impact-2\nruns/impact-2"), "{stopped}");
    }

    #[test]
    fn numbers_are_short() {
        let numbers = [1.0, -0.097, 123456.7, 1.875e-3, 1e-5, 25.30801, 2e9];
        let expected = ["1", "-0.097", "123457", "0.001875", "1.0000e-5", "25.308", "2.0000e9"];
        assert_eq!(numbers.map(short), expected);
    }

    #[test]
    fn a_miss_shows_in_the_digits() {
        assert_eq!(missed(5.000000000023, Some(5.0)), "5.000000000023");
        assert_eq!(missed(0.1 + 0.2, Some(0.4)), "0.3");
        assert_eq!(missed(25.308012, None), "25.308");
    }
}
