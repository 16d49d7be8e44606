//! The warnings of a study: those of its arms, and arms whose records are the same.

use carom_record::Warning;
use carom_record::study::Study;
use maud::{Markup, html};

use crate::collected::Origin;
use crate::labels::listed;
use crate::text::{Label, typeset};

/// Largest number of arms that are named; of more, the numbers are given.
const FEW: usize = 4;

/// A warning with what several arms found, each with its arms.
struct Found<'a> {
    warning: &'a Warning,
    what: Vec<(&'a str, Vec<usize>)>,
}

/// The warnings of all arms; those that differ in their numbers only are one.
fn found(study: &Study) -> Vec<Found<'_>> {
    let mut found: Vec<Found> = Vec::new();
    for (warning, arms) in study.warnings() {
        let same = |other: &&mut Found| {
            let other = other.warning;
            (&other.id, &other.place, &other.why) == (&warning.id, &warning.place, &warning.why)
        };
        match found.iter_mut().find(same) {
            Some(known) => known.what.push((&warning.what, arms)),
            None => found.push(Found { warning, what: vec![(&warning.what, arms)] }),
        }
    }
    found
}

/// Names of arms, or where there are many, their numbers.
fn names(study: &Study, arms: &[usize]) -> String {
    match arms.len() {
        all if all == study.rows.len() && all > 1 => "all".to_owned(),
        few if few <= FEW => {
            arms.iter().map(|arm| study.rows[*arm].name.clone()).collect::<Vec<_>>().join("; ")
        }
        _ => {
            format!("numbers {}", arms.iter().map(|arm| (arm + 1).to_string()).collect::<Vec<_>>().join(", "))
        }
    }
}

/// Arms with the same record, and whether their inputs are the same too.
fn identical(study: &Study, origins: &[Origin]) -> Vec<(String, bool)> {
    let mut sets: Vec<Vec<&Origin>> = Vec::new();
    for origin in origins.iter().filter(|origin| !origin.record.is_empty()) {
        match sets.iter_mut().find(|set| set[0].record == origin.record) {
            Some(set) => set.push(origin),
            None => sets.push(vec![origin]),
        }
    }
    let words = |set: Vec<&Origin>| {
        let names: Vec<&str> = set.iter().map(|origin| study.rows[origin.arm].name.as_str()).collect();
        let quoted: Vec<String> = names.iter().map(|name| format!("“{name}”")).collect();
        let quoted: Vec<&str> = quoted.iter().map(String::as_str).collect();
        (listed(&quoted), set.iter().all(|origin| origin.input == set[0].input))
    };
    sets.into_iter().filter(|set| set.len() > 1).map(words).collect()
}

/// The section of the page; nothing where there are none.
pub(crate) fn section(study: &Study, origins: &[Origin]) -> Markup {
    let (found, identical) = (found(study), identical(study, origins));
    html! {
        @if !found.is_empty() || !identical.is_empty() { h2 { "Warnings" } }
        @if !identical.is_empty() {
            p { "Arms with bitwise identical records count as several, but are one:" }
            ul {
                @for (names, same) in &identical {
                    li {
                        (Label(names)) ": "
                        @if *same { "the same input." } @else { "the settings in which they differ have no effect." }
                    }
                }
            }
        }
        @if !found.is_empty() {
            table.stack {
                thead { tr { th { "Warning" } th { "What was found, and why it matters" } th { "Try" } th { "Arms" } } }
                @for Found { warning, what } in &found {
                    tr {
                        td { code { (warning.id) } }
                        td {
                            (typeset(&warning.place)) ": "
                            @for (k, (words, arms)) in what.iter().enumerate() {
                                @if k > 0 { "; " }
                                (typeset(words))
                                @if what.len() > 1 { " (" (names(study, arms)) ")" }
                            }
                            "; " (typeset(&warning.why)) "."
                        }
                        td { (typeset(&warning.advice)) }
                        td {
                            @let arms: Vec<usize> = what.iter().flat_map(|(_, arms)| arms.clone()).collect();
                            (names(study, &arms))
                        }
                    }
                }
            }
        }
    }
}
