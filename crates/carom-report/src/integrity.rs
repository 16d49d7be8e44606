//! What can be said for the numbers of a study: how each arm ended, the fingerprints by which a
//! repetition is known to be one, and what was tried on one arm.

use carom_record::Status;
use carom_record::study::Study;
use maud::{Markup, html};

use crate::collected::Origins;
use crate::design::unmatched;
use crate::digits::three;
use crate::document::or_dash;

/// The beginning of a hash, which is enough to compare two by eye.
fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

/// The section.
pub(crate) fn section(study: &Study, origins: &Origins) -> Markup {
    html! {
        h2 { "Integrity" }
        table.metrics.ranking {
            thead {
                tr {
                    th { "Arm" }
                    th { "Ended" }
                    th.n { "Rejected steps" }
                    th.n { "Cycles, fallbacks" }
                    th.n { "Deepest penetration" }
                    th { "Input" }
                    th { "Record" }
                }
            }
            @for origin in &origins.arms {
                @let row = &study.rows[origin.arm];
                tr {
                    td { (row.name) }
                    td { @if row.status == Some(Status::Finished) { "finished" } @else { "not finished" } }
                    td.n { (origin.rejected) }
                    td.n { (origin.told) }
                    td.n { (or_dash(row.value("penetration"), three)) }
                    td { code { (short(&origin.input)) } }
                    td { code { (short(&origin.record)) } }
                }
            }
        }
        p.small {
            "Input: blake3 of the case and what the arm sets. Record: blake3 of " code { "history.csv" } " and "
            code { "contact.csv" } "; a repetition with the same version on the same platform has the same. \
             Events stand in each arm's " code { "log.jsonl" } "."
        }
        (tried(study))
        @if study.manifest.arms.iter().any(|arm| study.manifest.by_cost(arm)) { (unmatched(study)) }
    }
}

/// Whether an arm, computed again, came to the same bits.
fn tried(study: &Study) -> Markup {
    let Some(checks) = &study.checks else {
        return html! {
            p { "No arm of this study was computed again with more threads, or stopped and resumed." }
        };
    };
    let word = |hash: &str| {
        html! {
            @if hash == checks.fingerprint {
                b { "the same bits" }
            } @else {
                b.miss { "other bits" } " (kept in " code { "checks/" } ")"
            }
        }
    };
    let active_pairs = match checks.active_pairs {
        0 => "no pair active".to_owned(),
        1 => "one pair active".to_owned(),
        n => format!("{n} pairs active"),
    };
    html! {
        p {
            "Tried on the arm with the fewest steps and iterations, " (checks.arm) ", record "
            code { (short(&checks.fingerprint)) } ": with " (checks.threads.0) " threads " (word(&checks.threads.1))
            "; stopped after step " (checks.resumed.0) ", with " (active_pairs) ", and resumed from its files "
            (word(&checks.resumed.1)) "."
        }
    }
}
