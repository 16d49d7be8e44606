//! Evidence that the numbers of a study can be reproduced: how each arm ended, hashes of its input
//! and its record, and the arm that was recomputed.

use carom_record::Status;
use carom_record::study::{Row, Study};
use maud::{Markup, html};

use crate::collected::Origin;
use crate::digits::three;
use crate::document::or_dash;
use crate::labels::with_unit;
use crate::round_off::Scales;
use crate::text::{Label, Prose};

const HASHES: &str = "Input hash: BLAKE3 of the case and the settings of the arm. Record hash: BLAKE3 of \
    `history.csv` and `contact.csv`; a repetition with the same version on the same platform gives the same \
    hash. Cycles and fallbacks are logged in `log.jsonl` of the arm.";

/// The first digits of a hash, enough to compare two by eye.
fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

fn has_finished(study: &Study, origin: &Origin) -> bool {
    study.rows[origin.arm].status == Some(Status::Finished)
}

/// What is not as it should be in an arm; nothing where all is.
fn exception(study: &Study, origin: &Origin) -> Option<String> {
    let number = |count: u64, one: &str, more: &str| match count {
        0 => None,
        1 => Some(format!("1 {one}")),
        _ => Some(format!("{count} {more}")),
    };
    let words = [
        (!has_finished(study, origin)).then(|| "not finished".to_owned()),
        number(origin.rejected, "rejected step", "rejected steps"),
        number(origin.fallbacks as u64, "cycle or fallback", "cycles and fallbacks"),
    ];
    let words: Vec<String> = words.into_iter().flatten().collect();
    (!words.is_empty()).then(|| format!("{}: {}", study.rows[origin.arm].name, words.join(", ")))
}

/// The section of the page.
pub(crate) fn section(study: &Study, origins: &[Origin]) -> Markup {
    let metrics = study.metrics();
    let unit = metrics.iter().find(|m| m.name == "penetration").map_or("", |m| &m.unit);
    let exceptions: Vec<String> = origins.iter().filter_map(|origin| exception(study, origin)).collect();
    let is_short = origins.len() <= 4;
    let scales = Scales::of(study);
    let depth = |row: &Row| {
        let metric = row.metrics.iter().find(|m| m.name == "penetration");
        metric.map_or_else(|| "–".to_owned(), |m| or_dash(m.value, |value| scales.shown(m, value, three)))
    };
    let penetration = with_unit("Max. penetration", unit);
    html! {
        h2 { "Integrity" }
        @if !is_short && !exceptions.is_empty() {
            p { (exceptions.join("; ")) "." }
        }
        details open[is_short] {
        summary { "How each arm ended, and hashes of its input and its record" }
        table.metrics.ranking {
            thead {
                tr {
                    th { "Arm" } th { "Status" } th.n { "Rejected steps" } th.n { "Cycles and fallbacks" }
                    th.n { (Label(&penetration)) } th { "Input hash" } th { "Record hash" }
                }
            }
            @for origin in origins {
                @let row = &study.rows[origin.arm];
                tr {
                    td { (row.name) }
                    td { @if has_finished(study, origin) { "finished" } @else { "not finished" } }
                    td.n { (origin.rejected) } td.n { (origin.fallbacks) }
                    td.n { (depth(row)) }
                    td { code { (short(&origin.input)) } } td { code { (short(&origin.record)) } }
                }
            }
        }
        p.small { (Prose(HASHES)) }
        }
        (recomputed(study))
    }
}

/// Whether an arm that was computed again gave the same bits.
fn recomputed(study: &Study) -> Markup {
    let Some(checks) = &study.checks else {
        return html! {
            p {
                "Bitwise reproducibility was not checked: no arm was computed again with more threads, or \
                 stopped and resumed."
            }
        };
    };
    let result = |hash: &str| {
        html! {
            @if hash == checks.fingerprint {
                b { "bitwise identical" } "."
            } @else {
                b.miss { "different" } " (saved in " code { "checks/" } ")."
            }
        }
    };
    let contact = match checks.active_pairs {
        0 => "no active contact pair".to_owned(),
        1 => "one active contact pair".to_owned(),
        n => format!("{n} active contact pairs"),
    };
    html! {
        p {
            "Reproducibility was checked on the arm with the fewest steps and iterations, " (checks.arm)
            " (record hash " code { (short(&checks.fingerprint)) } "). With " (checks.threads.0) " threads: "
            (result(&checks.threads.1)) " Stopped after step " (checks.resumed.0) ", with " (contact)
            ", and resumed from its files: " (result(&checks.resumed.1))
        }
    }
}
