//! How to reproduce a study, and how to cite it.

use carom_record::study::Study;
use maud::{Markup, html};

use crate::document::file;
use crate::text::Prose;

/// A bibliography entry with the version of the program and the hash of the input.
fn bibtex(study: &Study) -> String {
    let m = &study.manifest;
    let (year, hash) = (m.created.get(..4).unwrap_or_default(), m.input_hash.get(..16).unwrap_or_default());
    let title = "Carom: impact and contact by the positional finite element method";
    format!(
        "@software{{carom,\n  author  = {{{{The Carom developers}}}},\n  title   = {{{title}}},\n  version = {{{}}},\n  year    = {{{year}}},\n  \
         note    = {{study \"{}\", input {hash}}}\n}}",
        m.version, m.title
    )
}

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

/// The section of the page.
pub(super) fn section(study: &Study) -> Markup {
    let m = &study.manifest;
    let beside = m.source.case_path.rsplit('/').next().unwrap_or_default();
    let there = FILES.iter().filter(|name| study.directory.join(name).is_file());
    html! {
        h2 { "How to reproduce" }
        p {
            (Prose("Save the study file below as `study.toml` and the case file as "))
            code { (m.source.case_path) } " relative to it"
            @if m.source.case_path.contains('/') {
                " (or beside it, with " code { "case = \"" (beside) "\"" } " in the study file)"
            }
            ", and run Carom " (m.version) ":"
        }
        pre { "carom study study.toml" }
        p.small {
            "Input hash " code.hash { (m.input_hash) } "; created " (m.created) " on " (m.machine.cpus)
            " cores, " (m.machine.os) " " (m.machine.arch) ". Results do not depend on the number of jobs; \
             wall times do."
        }
        details { summary { "Study file" } pre { (m.source.study) } }
        details { summary { "Case file" } pre { (m.source.case) } }
        @for (path, text) in &m.source.others {
            details { summary { "Case file " code { (path) } } pre { (text) } }
        }
        p {
            (Prose("The folder of this page is the complete record of the study: archive it as a whole, and \
                    `carom report` rebuilds the page from it. Files: `arms/`"))
            @for name in there { " · " (file(name)) }
        }
        h2 { "How to cite" }
        pre { (bibtex(study)) }
    }
}
