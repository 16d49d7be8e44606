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

/// Width of a bar of 100 %, in rem.
const WIDTH: f64 = 8.0;

/// The section of the page.
pub(crate) fn timing(m: &Manifest) -> Markup {
    let steps = m.counters.get("steps").copied().unwrap_or(0);
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
                @for (name, what, seconds) in m.phases().into_iter().chain([all]) {
                    @let share = seconds / total.max(f64::MIN_POSITIVE);
                    tr {
                        td { (name) } td.n { (three(seconds)) } td.n { (each(1e3 * seconds)) }
                        td.n { (format_args!("{:.0} %", 100.0 * share)) }
                        td.share { span style=(format_args!("width:{:.2}rem", WIDTH * share)) {} }
                        td { (what) }
                    }
                }
            }
        }
        @if let Some(&cpu) = m.timings.get("cpu") {
            p {
                "Processor time of the first thread in the time steps, without output: " (three(cpu)) " s ("
                (each(1e3 * cpu)) " ms per step). The rest of the wall time is output and waiting."
            }
        }
        table {
            thead { tr { th { "Counter" } th.n { "Total" } th.n { "Per step" } } }
            @for (name, &count) in &m.counters {
                tr { td { (name.replace('_', " ")) } td.n { (count) } td.n { (each(count as f64)) } }
            }
        }
        p.small {
            (Prose("Data: `manifest.json` (counters, timings). `carom run --profile` prints the times of the \
                    phases."))
        }
    }
}
