//! The warnings of a study: those of its arms, and arms whose records are the same.

use carom_record::study::Study;
use maud::{Markup, html};

use super::collected::Origin;
use crate::labels::listed;
use crate::ordered::grouped;
use crate::text::{Label, Prose, typeset};

/// Largest number of arms that are named; of more, the numbers are given.
const FEW: usize = 4;

/// Names of arms, or where there are many, their numbers.
fn names(study: &Study, arms: &[usize]) -> String {
    match arms.len() {
        all if all == study.rows.len() && all > 1 => "all".to_owned(),
        few if few <= FEW => {
            arms.iter().map(|arm| study.rows[*arm].name.clone()).collect::<Vec<_>>().join("; ")
        }
        _ => {
            let numbers: Vec<String> = arms.iter().map(|arm| (arm + 1).to_string()).collect();
            format!("numbers {}", numbers.join(", "))
        }
    }
}

/// Arms with the same record, and whether their inputs are the same too.
fn identical(study: &Study, origins: &[Origin]) -> Vec<String> {
    let recorded = origins.iter().filter(|origin| !origin.record.is_empty());
    let sets = grouped(recorded.map(|origin| (&origin.record, origin)));
    let words = |(_, set): (_, Vec<&Origin>)| {
        let quoted = set.iter().map(|origin| format!("“{}”", study.rows[origin.arm].name));
        let is_same = set.iter().all(|origin| origin.input == set[0].input);
        let why = if is_same { "the same input" } else { "the settings in which they differ have no effect" };
        format!("{}: {why}.", listed(&quoted.collect::<Vec<_>>()))
    };
    sets.into_iter().filter(|(_, set)| set.len() > 1).map(words).collect()
}

/// The section of the page; nothing where there are none.
pub(super) fn section(study: &Study, origins: &[Origin]) -> Markup {
    let identical = identical(study, origins);
    // Of several arms, what was found differs in its numbers: it is said once, of the first.
    let found = study
        .warnings()
        .into_iter()
        .map(|(warning, arms)| ((&warning.id, &warning.place, &warning.why), (warning, arms)));
    let found = grouped(found);
    html! {
        @if !identical.is_empty() {
            p { "Arms with bitwise identical records" @if study.ranking.is_some() { ", which the ranking counts once" } ":" }
            ul { @for words in &identical { li { (Label(words)) } } }
        }
        @if !found.is_empty() {
            table.stack {
                thead { tr { th { "Warning" } th { "What was found, and why it matters" } th { "Try" } th { "Arms" } } }
                @for (_, same) in &found {
                    @let warning = same[0].0;
                    @let arms: Vec<usize> = same.iter().flat_map(|(_, arms)| arms.clone()).collect();
                    tr {
                        td { code { (warning.id) } }
                        td {
                            @if warning.place != "the run" { (typeset(&warning.place)) ": " }
                            (Label(&typeset(&warning.what)))
                            @if same.len() > 1 { " (" (study.rows[arms[0]].name) "; with other numbers in the others)" }
                            "; " (typeset(&warning.why)) "."
                        }
                        td { (Prose(&typeset(&warning.advice))) } td { (names(study, &arms)) }
                    }
                }
            }
        }
    }
}
