//! The summary at the end of a run.

use carom_record::Expectation;
use serde::Serialize;

use crate::exit::{Exit, Failure};
use crate::simulation::Outcome;
use crate::text::{duration, missed, quantity, short};
use crate::{console, out, table};

#[derive(Serialize)]
struct Event<'a> {
    event: &'static str,
    #[serde(flatten)]
    outcome: &'a Outcome,
}

/// Prints the outcome on standard output; of a run that stopped as an event. A missed expectation
/// changes the exit code only with `strict`.
pub(crate) fn print(done: Result<Outcome, Failure>, strict: bool) -> Result<Exit, Failure> {
    if let Err(Failure::Stopped { reason, directory, .. }) = &done {
        out::event(&serde_json::json!({ "event": "stopped", "reason": reason, "directory": directory }))?;
    }
    let outcome = done?;
    let event = if outcome.interrupted { "interrupted" } else { "done" };
    out::event(&Event { event, outcome: &outcome })?;
    out::summary(&text(&outcome))?;
    if outcome.interrupted {
        return Ok(Exit::Interrupted);
    }
    let mut missed = outcome.expectations.iter().filter(|e| !e.pass).peekable();
    if !strict || missed.peek().is_none() {
        return Ok(Exit::Done);
    }
    if console::is_quiet() {
        missed.for_each(|e| console::say(expectation(e)));
    }
    Ok(Exit::Missed)
}

/// `min A.uy: -0.78268, as expected (-0.7827 ± 0.004)`
fn expectation(e: &Expectation) -> String {
    match (e.got, e.pass) {
        (Some(got), true) => format!("{}: {}, as expected ({})", e.what, short(got), e.expected),
        (Some(got), false) => {
            format!("{}: {}, MISSED: expected {}", e.what, missed(got, e.value), e.expected)
        }
        (None, _) => {
            let why = e.why.as_deref().map_or_else(String::new, |why| format!(" ({why})"));
            format!("{}: not available{why}, expected {}", e.what, e.expected)
        }
    }
}

fn text(outcome: &Outcome) -> String {
    let directory = outcome.directory.display();
    let time = |t| quantity(t, &outcome.time_unit);
    let wall = match outcome.wall {
        0.0 => String::new(),
        wall => format!(" in {} of wall time", duration(wall)),
    };
    let first = format!("{} steps to t = {}{wall}", outcome.steps, time(outcome.time));
    let shown = |x: f64, unit: &str| {
        let is_zero = outcome.sizes.as_ref().is_some_and(|sizes| sizes.is_round_off(x, unit));
        if is_zero { "≈ 0".to_owned() } else { short(x) }
    };
    let metrics = outcome.metrics.iter().filter_map(|metric| {
        Some(vec![metric.name.to_string(), shown(metric.value?, &metric.unit), metric.unit.clone()])
    });
    let extremes = outcome.extremes.iter().map(|e| {
        let at = |t| format!("{} at {}", e.unit, time(t)).trim_start().to_owned();
        let [min, max] = [shown(e.min, &e.unit), shown(e.max, &e.unit)];
        let [min_at, max_at] = [at(e.min_time), at(e.max_time)];
        vec![e.column.clone(), "min".to_owned(), min, min_at, "max".to_owned(), max, max_at]
    });
    let profile = outcome.profile.iter().map(|(phase, seconds)| {
        let each = 1e3 * seconds / outcome.steps.max(1) as f64;
        vec![phase.clone(), duration(*seconds), format!("{} ms per step", short(each))]
    });
    let indented = table::lines(&metrics.collect::<Vec<_>>(), &[1])
        .into_iter()
        .chain(table::lines(&extremes.collect::<Vec<_>>(), &[2, 5]))
        .chain(table::lines(&profile.collect::<Vec<_>>(), &[1]))
        .chain(outcome.expectations.iter().map(expectation))
        .chain(outcome.remarks.iter().cloned())
        .map(|line| format!("  {line}"));
    let mut lines: Vec<String> = std::iter::once(first).chain(indented).collect();
    if outcome.interrupted {
        lines.push(format!("interrupted; continue with: carom resume {directory}"));
    }
    lines.push(
        outcome.report.as_ref().map_or_else(|| directory.to_string(), |page| page.display().to_string()),
    );
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use carom_record::metrics::Metric;

    use super::*;
    use crate::simulation::Extreme;

    #[test]
    fn summary_names_directory_metrics_extremes_and_expectations() {
        let outcome = Outcome {
            directory: "runs/impact-2".into(),
            interrupted: false,
            steps: 400,
            time: 0.75,
            time_unit: "s".into(),
            wall: 3.21,
            metrics: vec![Metric {
                name: "peak_mean_force".into(),
                value: Some(12.5),
                unit: "N".into(),
                definition: "",
            }],
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
                expected: "-0.7827 ± 0.004".into(),
                got: Some(-0.78268),
                pass: true,
                value: Some(-0.7827),
                tolerance: None,
                why: None,
                source: None,
                slow: false,
            }],
            profile: Vec::new(),
            report: Some("runs/impact-2/report.html".into()),
            remarks: Vec::new(),
            sizes: None,
        };
        let summary = text(&outcome);
        assert_eq!(
            summary.lines().collect::<Vec<_>>(),
            [
                "400 steps to t = 0.75 s in 3.2 s of wall time",
                "  peak_mean_force  12.5  N",
                "  A.uy  min  -0.78268  m at 0.43125 s  max  0  m at 0 s",
                "  min A.uy: -0.78268, as expected (-0.7827 ± 0.004)",
                "runs/impact-2/report.html",
            ]
        );
        let profiled = text(&Outcome { profile: vec![("assembly".into(), 1.25)], ..outcome.clone() });
        assert!(profiled.contains("1.2 s  3.125 ms per step\n"), "{profiled}");
        let stopped = text(&Outcome { interrupted: true, report: None, ..outcome });
        assert!(stopped.ends_with("carom resume runs/impact-2\nruns/impact-2"), "{stopped}");
    }
}
