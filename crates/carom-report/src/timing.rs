//! Timing of a run: wall time by phase, in total and per step, and the counters.

use carom_record::Manifest;
use maud::{Markup, html};

use crate::labels::number;
use crate::text::Prose;

/// Three significant digits; all digits of the integer part of a larger number.
pub(crate) fn three(x: f64) -> String {
    let unit = if x == 0.0 { 1.0 } else { 10.0_f64.powi(x.abs().log10().floor().min(2.0) as i32 - 2) };
    number((x / unit).round() * unit)
}

/// A counter in words.
fn counter(name: &str, is_explicit: bool) -> String {
    match name {
        "newton" if is_explicit => "iterations of the contact forces".to_owned(),
        "newton" => "Newton iterations".to_owned(),
        "rejected" => "rejected attempts".to_owned(),
        "activations" => "activations of contact nodes".to_owned(),
        "releases" => "releases of contact nodes".to_owned(),
        name => name.replace('_', " "),
    }
}

/// Width of a bar of 100 %, in rem.
const WIDTH: f64 = 8.0;

/// The section of the page.
pub(crate) fn timing(m: &Manifest) -> Markup {
    let steps = m.counters.get("steps").copied().unwrap_or(0);
    let is_explicit = m.case.pointer("/time/scheme/kind").is_some_and(|kind| kind == "central-difference");
    let each = |whole: f64| if steps > 0 { three(whole / steps as f64) } else { "–".into() };
    html! {
        h2 { "Timing" }
        @if let Some(&total) = m.timings.get("total") {
            table.timing {
                thead {
                    tr {
                        th { "Phase" } th.n { "Total (s)" } th.n { "Per step (ms)" } th.n { "Share" } th {}
                        th { "Description" }
                    }
                }
                @let all = ("total", "wall time of the run without its set-up", total);
                @for (name, what, seconds) in m.phases().into_iter().chain([all]).filter(|phase| phase.2 > 0.0) {
                    @let share = seconds / total.max(f64::MIN_POSITIVE);
                    tr {
                        td { (name) } td.n { (three(seconds)) } td.n { (each(1e3 * seconds)) }
                        td.n { @if share < 0.005 { "< 1 %" } @else { (format_args!("{:.0} %", 100.0 * share)) } }
                        td.share { span style=(format_args!("width:{:.2}rem", WIDTH * share)) {} }
                        td { (what) }
                    }
                }
            }
        }
        @if let Some(&cpu) = m.timings.get("cpu") {
            p {
                "Processor time of the first thread in the time steps: " (three(cpu)) "\u{a0}s (" (each(1e3 * cpu))
                "\u{a0}ms per step)."
            }
        }
        table {
            thead { tr { th { "Counter" } th.n { "Total" } th.n { "Per step" } } }
            @for (name, &count) in m.counters.iter().filter(|(_, count)| **count > 0) {
                tr {
                    td { (counter(name, is_explicit)) } td.n { (count) }
                    td.n { @if name != "steps" { (each(count as f64)) } }
                }
            }
        }
        p.small {
            (Prose("Data: `manifest.json` (counters, timings). `carom run --profile` prints the times of the \
                    phases."))
        }
    }
}
