//! What can be said for the numbers of a study: how each arm ended, the fingerprints by which a
//! repetition is known to be one, and what was tried on one arm.

use std::fmt::Write as _;

use carom_record::Status;
use carom_record::study::Study;

use crate::collected::Origins;
use crate::design::unmatched;
use crate::digits::three;
use crate::text::escape;

/// Digits of a hash that are shown.
const DIGITS: usize = 12;

/// Adds the section.
pub(crate) fn show(out: &mut String, study: &Study, origins: &Origins) {
    out.push_str("<h2>Integrity</h2>\n<table class=\"metrics ranking\"><thead><tr><th>Arm</th><th>Ended</th><th class=\"n\">Rejected steps</th><th class=\"n\">Cycles, fallbacks</th><th class=\"n\">Deepest penetration</th><th>Input</th><th>Record</th></tr></thead>\n");
    let short = |hash: &str| hash.get(..DIGITS).unwrap_or(hash).to_owned();
    for origin in &origins.arms {
        let row = &study.rows[origin.arm];
        let word = if row.status == Some(Status::Finished) { "finished" } else { "not finished" };
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td>{word}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td><code>{}</code></td><td><code>{}</code></td></tr>",
            escape(&row.name),
            origin.rejected,
            origin.told,
            row.value("penetration").map_or("–".into(), three),
            short(&origin.input),
            short(&origin.record)
        );
    }
    out.push_str("</table>\n<p class=\"small\">Input: blake3 of the case and what the arm sets. Record: blake3 of <code>history.csv</code> and <code>contact.csv</code>; a repetition with the \
                  same version on the same platform has the same. Events stand in each arm's <code>log.jsonl</code>.</p>\n");
    tried(out, study);
    if study.manifest.arms.iter().any(|arm| study.manifest.by_cost(arm)) {
        out.push_str(&unmatched(study));
    }
}

/// Whether an arm, computed again, came to the same bits.
fn tried(out: &mut String, study: &Study) {
    let Some(checks) = &study.checks else {
        out.push_str(
            "<p>No arm of this study was computed again with more threads, or stopped and resumed.</p>\n",
        );
        return;
    };
    let word = |hash: &str| {
        if hash == checks.fingerprint {
            "<b>the same bits</b>"
        } else {
            "<b class=\"miss\">other bits</b> (kept in <code>checks/</code>)"
        }
    };
    let active_pairs = match checks.active_pairs {
        0 => "no pair active".to_owned(),
        1 => "one pair active".to_owned(),
        n => format!("{n} pairs active"),
    };
    let _ = writeln!(
        out,
        "<p>Tried on the arm with the fewest steps and iterations, {}, record <code>{}</code>: with {} threads {}; stopped after step {}, with {active_pairs}, and resumed from its files {}.</p>",
        escape(&checks.arm),
        checks.fingerprint.get(..DIGITS).unwrap_or_default(),
        checks.threads.0,
        word(&checks.threads.1),
        checks.resumed.0,
        word(&checks.resumed.1)
    );
}
