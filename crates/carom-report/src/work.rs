//! Where the time of a run went: wall seconds by phase, in all and per step, and what was counted.

use std::fmt::Write as _;

use carom_record::Manifest;

use crate::labels::number;
use crate::text::escape;

/// Three digits, or all of a larger number.
fn three(x: f64) -> String {
    let unit = if x == 0.0 { 1.0 } else { 10.0_f64.powi(x.abs().log10().floor().min(2.0) as i32 - 2) };
    number((x / unit).round() * unit)
}

/// Width of the bar of a phase that took all the time.
const WIDTH: f64 = 8.0;

/// The section of the page.
pub(crate) fn work(out: &mut String, m: &Manifest) {
    let steps = m.counters.get("steps").copied().unwrap_or(0);
    let each = |whole: f64| if steps > 0 { three(whole / steps as f64) } else { "–".into() };
    out.push_str("<h2>Where the time went</h2>\n");
    if let Some(&total) = m.timings.get("total") {
        out.push_str(
            "<table>\n<thead><tr><th>Phase</th><th>In all (s)</th><th>Per step (ms)</th><th>Share</th><th></th><th>What it is</th></tr></thead>\n",
        );
        for (name, what, seconds) in m.phases() {
            let share = if total > 0.0 { seconds / total } else { 0.0 };
            row(out, name, seconds, &each(1e3 * seconds), share, what);
        }
        row(out, "total", total, &each(1e3 * total), 1.0, "wall seconds of the run, its set-up left out");
        out.push_str("</table>\n");
    }
    if let Some(&cpu) = m.timings.get("cpu") {
        let _ = writeln!(
            out,
            "<p>Processor time of the first thread in steps, output left out: {} s, {} ms a step. What the phases took beyond it was waited for.</p>",
            three(cpu),
            each(1e3 * cpu)
        );
    }
    out.push_str("<table>\n<thead><tr><th>Counted</th><th>In all</th><th>Per step</th></tr></thead>\n");
    for (name, &count) in &m.counters {
        let name = escape(&name.replace('_', " "));
        let _ = writeln!(
            out,
            "<tr><td>{name}</td><td class=\"n\">{count}</td><td class=\"n\">{}</td></tr>",
            each(count as f64)
        );
    }
    out.push_str("</table>\n<p class=\"small\">From manifest.json: counters, timings; <code>carom run --profile</code> tells the same at once.</p>\n");
}

fn row(out: &mut String, name: &str, seconds: f64, each: &str, share: f64, what: &str) {
    let _ = writeln!(
        out,
        "<tr><td>{name}</td><td class=\"n\">{}</td><td class=\"n\">{each}</td><td class=\"n\">{:.0} %</td>\
         <td class=\"share\"><span style=\"width:{:.2}rem\"></span></td><td>{what}</td></tr>",
        three(seconds),
        100.0 * share,
        WIDTH * share
    );
}
