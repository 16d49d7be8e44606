//! Where the time of a run went: wall seconds by phase, in all and per step, and what was counted.

use carom_record::Manifest;
use maud::{Markup, html};

use crate::labels::number;

/// Three digits, or all of a larger number.
fn three(x: f64) -> String {
    let unit = if x == 0.0 { 1.0 } else { 10.0_f64.powi(x.abs().log10().floor().min(2.0) as i32 - 2) };
    number((x / unit).round() * unit)
}

/// Width of the bar of a phase that took all the time.
const WIDTH: f64 = 8.0;

/// The section of the page.
pub(crate) fn work(m: &Manifest) -> Markup {
    let steps = m.counters.get("steps").copied().unwrap_or(0);
    let each = |whole: f64| if steps > 0 { three(whole / steps as f64) } else { "–".into() };
    let timings = m.timings.get("total").map(|&total| {
        let phases =
            m.phases().into_iter().chain([("total", "wall seconds of the run, its set-up left out", total)]);
        phases.map(move |(name, what, seconds)| (name, what, seconds, seconds / total.max(f64::MIN_POSITIVE)))
    });
    html! {
        h2 { "Where the time went" }
        @if let Some(phases) = timings {
            table {
                thead {
                    tr { th { "Phase" } th { "In all (s)" } th { "Per step (ms)" } th { "Share" } th {} th { "What it is" } }
                }
                @for (name, what, seconds, share) in phases {
                    tr {
                        td { (name) }
                        td.n { (three(seconds)) }
                        td.n { (each(1e3 * seconds)) }
                        td.n { (format_args!("{:.0} %", 100.0 * share)) }
                        td.share { span style=(format_args!("width:{:.2}rem", WIDTH * share)) {} }
                        td { (what) }
                    }
                }
            }
        }
        @if let Some(&cpu) = m.timings.get("cpu") {
            p {
                "Processor time of the first thread in steps, output left out: " (three(cpu)) " s, "
                (each(1e3 * cpu)) " ms a step. What the phases took beyond it was waited for."
            }
        }
        table {
            thead { tr { th { "Counted" } th { "In all" } th { "Per step" } } }
            @for (name, &count) in &m.counters {
                tr { td { (name.replace('_', " ")) } td.n { (count) } td.n { (each(count as f64)) } }
            }
        }
        p.small { "From manifest.json: counters, timings; " code { "carom run --profile" } " tells the same at once." }
    }
}
