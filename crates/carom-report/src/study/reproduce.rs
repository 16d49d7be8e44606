//! How to reproduce and cite a study: input, hashes of the records, and the arm that was
//! recomputed.

use carom_record::study::Study;
use maud::{Markup, html};

use super::collected::Origin;
use crate::document::file;
use crate::text::Prose;

const HASHES: &str = "Input hash: BLAKE3 of the case and the settings of the arm. Record hash: BLAKE3 of \
    `history.csv` and `contact.csv`; of a finished arm, the same version on the same platform gives the same. Cycles and fallbacks of the \
    solver are logged in `log.jsonl` of the arm.";

/// Files that a study directory may contain.
const FILES: [&str; 9] = [
    "study.json",
    "study.csv",
    "study_tidy.csv",
    "ranking.csv",
    "reference.csv",
    "claims.csv",
    "theory.csv",
    "frequencies.csv",
    "checks.json",
];

/// The first digits of a hash, enough to compare two by eye.
fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

/// A bibliography entry with the version of the program and the hash of the input.
fn bibtex(study: &Study) -> String {
    let m = &study.manifest;
    let year = m.created.get(..4).unwrap_or_default();
    let hash = m.input_hash.get(..16).unwrap_or_default();
    format!(
        "@software{{carom,\n  author  = {{{{The Carom developers}}}},\n  title   = {{Carom: impact and contact by the \
         positional finite element method}},\n  version = {{{}}},\n  year    = {{{year}}},\n  note    = {{study \"{}\", \
         input {hash}}}\n}}",
        m.version, m.title
    )
}

/// The section of the page.
pub(super) fn section(study: &Study, origins: &[Origin]) -> Markup {
    let m = &study.manifest;
    let there = FILES.iter().filter(|name| study.directory.join(name).is_file());
    html! {
        p {
            "Save the study file as " code { "study.toml" } " and the case file as " code { (m.source.case_path) }
            " relative to it, and run Carom " (m.version) ": " code { "carom study study.toml" } ". The directory of \
             this page is the complete record; " code { "carom report" } " rebuilds the page from it."
        }
        p.small { "Files: " code { "arms/" } @for name in there { " · " (file(name)) } }
        p.small {
            "Input hash " code.hash { (m.input_hash) } "; created " (m.created) " on " (m.machine.cpus) " cores, "
            (m.machine.os) " " (m.machine.arch) "."
        }
        (recomputed(study))
        details { summary { "Hashes of the records" } (hashes(study, origins)) }
        details { summary { "Study file" } pre { (m.source.study) } }
        details { summary { "Case file" } pre { (m.source.case) } }
        @for (path, text) in &m.source.others {
            details { summary { "Case file " code { (path) } } pre { (text) } }
        }
        details { summary { "BibTeX entry" } pre { (bibtex(study)) } }
    }
}

fn hashes(study: &Study, origins: &[Origin]) -> Markup {
    html! {
        div {
            table.metrics.ranking {
                thead {
                    tr {
                        th { "Arm" } th.n { "Rejected steps" } th.n { "Cycles and fallbacks" }
                        th { "Input hash" } th { "Record hash" }
                    }
                }
                @for origin in origins {
                    tr {
                        td { (study.rows[origin.arm].name) }
                        td.n { (origin.rejected) } td.n { (origin.fallbacks) }
                        td { code { (short(&origin.input)) } } td { code { (short(&origin.record)) } }
                    }
                }
            }
        }
        p.small { (Prose(HASHES)) }
    }
}

/// Whether an arm that was computed again gave the same bits.
fn recomputed(study: &Study) -> Markup {
    let Some(checks) = &study.checks else { return Markup::default() };
    let result = |hash: &str| {
        html! {
            @if hash == checks.fingerprint { b { "bitwise identical" } "." }
            @else { b.miss { "different" } " (saved in " code { "checks/" } ")." }
        }
    };
    html! {
        p {
            "Computed again: " (checks.arm) " (record hash " code { (short(&checks.fingerprint)) } "). With "
            (checks.threads.0) " threads: " (result(&checks.threads.1)) " Stopped after step " (checks.resumed.0)
            ", with " (checks.active_pairs) " active contact pairs, and resumed: " (result(&checks.resumed.1))
        }
    }
}
