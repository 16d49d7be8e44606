//! The table of the arms of a study.

use carom_record::Status;
use carom_record::study::{Arm, Row, Study};
use maud::{Markup, html};

use super::parameters;
use crate::collected::{Origin, twin};
use crate::document::codes;
use crate::laboratory::style_of;
use crate::plot::{APART, style};
use crate::settings;
use crate::text::typeset;

/// Longer lists of arms are folded.
const MANY: usize = 12;

/// The section of the page.
pub(super) fn section(study: &Study, origins: &[Origin]) -> Markup {
    let m = &study.manifest;
    let own = |arm: &Arm| {
        let own = arm.sets.iter().filter(|set| !settings::is_shared(study, set));
        own.map(|set| settings::brief(set)).collect::<Vec<_>>()
    };
    // What the table of parameters lists is not said twice.
    let listed = m.arms.iter().any(|arm| arm.case_path.is_some())
        || !parameters::has_matrix(study) && m.arms.iter().any(|arm| !own(arm).is_empty());
    html! {
        h2 { "Arms" }
        // A long list would push the results down the page.
        details open[study.rows.len() <= MANY] {
            summary { (study.rows.len()) " arms (variants of the case)" }
            table {
                thead {
                    tr {
                        th.n { "No." } th { "Line" } th { "Arm" }
                        @if listed { th { "Settings" } }
                        th.n { "Steps" } th { "Status" }
                    }
                }
                @for (i, (row, arm)) in study.rows.iter().zip(&m.arms).enumerate() {
                    tr {
                        td.n { (i + 1) }
                        td { (line(style_of(study, i), row.is_unsound())) }
                        td {
                            a href={ (arm.directory) "/report.html" } { (row.name) }
                            @if m.reference.as_ref() == Some(&row.name) { " (reference)" }
                        }
                        @if listed {
                            @let sets = own(arm);
                            td {
                                @if let Some(path) = &arm.case_path { "case " code { (path) } }
                                @if arm.case_path.is_some() && !sets.is_empty() { br; }
                                (codes(&sets, html! { br; }))
                            }
                        }
                        td.n { (arm.steps) }
                        (ended(study, i, row, twin(origins, i)))
                    }
                }
            }
        }
    }
}

/// How an arm ended, and why.
fn ended(study: &Study, arm: usize, row: &Row, twin: Option<usize>) -> Markup {
    let (class, word) = match row.status {
        Some(Status::Finished) if row.is_unsound() => ("undecided", "finished, created energy"),
        Some(Status::Finished) => ("pass", "finished"),
        Some(Status::Failed) => ("miss", "failed"),
        Some(Status::Running | Status::Stopped) => ("undecided", "not finished"),
        None if row.is_damaged() => ("miss", "damaged"),
        None => ("undecided", "not started"),
    };
    html! {
        td.(class) {
            (word)
            @if let Some(reason) = &row.reason { br; span.small.plain { (typeset(reason)) } }
            @if let Some(twin) = twin { br; span.small.plain { "identical to No. " (twin + 1) } }
            @if let Some(others) = study.finished_alike(arm) { br; span.small.plain { (typeset(&others)) } }
        }
    }
}

/// The line of an arm in the figures.
fn line(number: usize, apart: bool) -> Markup {
    let (color, width) = if apart { (APART, "1") } else { (style(number).0, "2") };
    html! {
        svg.line width="44" height="10" { path d="M1 5h42" stroke=(color) stroke-width=(width) {} }
    }
}
