//! The warnings of a study: those of its arms, and arms whose records are the same.

use carom_record::Warning;
use carom_record::study::Study;
use maud::{Markup, html};

use crate::collected::Origin;
use crate::labels::listed;
use crate::ordered::grouped;
use crate::text::{Label, typeset};

/// Largest number of arms that are named; of more, the numbers are given.
const FEW: usize = 4;

/// The warnings of all arms, each with its arms; those that differ in their numbers only are
/// together.
fn found<'a>(study: &'a Study) -> Vec<Vec<(&'a Warning, Vec<usize>)>> {
    let one = |(warning, arms): (&'a Warning, Vec<usize>)| {
        let Warning { id, place, why, .. } = warning;
        ((id, place, why), (warning, arms))
    };
    grouped(study.warnings().into_iter().map(one)).into_iter().map(|(_, same)| same).collect()
}

/// What several arms found, each with its arms; said once where only one number differs:
/// `it rose by 70 % (a), 63 % (b) of its scale`.
fn together(what: &[(String, Vec<usize>)], names: impl Fn(&[usize]) -> String) -> String {
    if let [(only, _)] = what {
        return only.clone();
    }
    let parts: Vec<Vec<&str>> = what.iter().map(|(words, _)| words.split(' ').collect()).collect();
    let differs = |k: &usize| parts.iter().any(|words| words.get(*k) != parts[0].get(*k));
    let apart: Vec<usize> = (0..parts[0].len()).filter(differs).collect();
    let is_one = parts.iter().all(|words| words.len() == parts[0].len());
    if let ([at], true) = (&apart[..], is_one) {
        // The number goes with its unit.
        let end = at + 1 + usize::from(parts[0].get(at + 1) == Some(&"%"));
        let each = parts.iter().zip(what);
        let each: Vec<String> = each
            .map(|(words, (_, arms))| format!("{} ({})", words[*at..end].join(" "), names(arms)))
            .collect();
        let (before, after) = (parts[0][..*at].join(" "), parts[0][end..].join(" "));
        return format!("{before} {} {after}", each.join(", ")).trim().to_owned();
    }
    let each: Vec<String> = what.iter().map(|(words, arms)| format!("{words} ({})", names(arms))).collect();
    each.join("; ")
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
    let recorded = origins.iter().filter(|origin| !origin.record.is_empty());
    let sets = grouped(recorded.map(|origin| (&origin.record, origin)));
    let words = |(_, set): (_, Vec<&Origin>)| {
        let quoted: Vec<String> =
            set.iter().map(|origin| format!("“{}”", study.rows[origin.arm].name)).collect();
        (listed(&quoted), set.iter().all(|origin| origin.input == set[0].input))
    };
    sets.into_iter().filter(|(_, set)| set.len() > 1).map(words).collect()
}

/// The section of the page; nothing where there are none.
pub(crate) fn section(study: &Study, origins: &[Origin]) -> Markup {
    let (found, identical) = (found(study), identical(study, origins));
    html! {
        @if !found.is_empty() || !identical.is_empty() { h2 { "Warnings" } }
        @if !identical.is_empty() {
            p {
                "Arms with bitwise identical records"
                @if study.ranking.is_some() { ", which the ranking counts once" } ":"
            }
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
                @for same in &found {
                    @let warning = same[0].0;
                    tr {
                        td { code { (warning.id) } }
                        td {
                            // The last column names the runs.
                            @if warning.place != "the run" { (typeset(&warning.place)) ": " }
                            // Names stay as they are.
                            @let set: Vec<_> = same.iter().map(|(one, arms)| (typeset(&one.what), arms.clone())).collect();
                            (Label(&together(&set, |arms| names(study, arms)))) "; "
                            (typeset(&warning.why)) "."
                        }
                        td { (typeset(&warning.advice)) }
                        td {
                            @let arms: Vec<usize> = same.iter().flat_map(|(_, arms)| arms.clone()).collect();
                            (names(study, &arms))
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::together;

    #[test]
    fn what_differs_in_a_number_is_said_once() {
        let names = |arms: &[usize]| format!("arm {}", arms[0]);
        let one = ("it rose by 70.3 % of its scale".to_owned(), vec![6]);
        let other = ("it rose by 62.7 % of its scale".to_owned(), vec![9]);
        assert_eq!(together(std::slice::from_ref(&one), names), "it rose by 70.3 % of its scale");
        assert_eq!(
            together(&[one.clone(), other], names),
            "it rose by 70.3 % (arm 6), 62.7 % (arm 9) of its scale"
        );
        let third = ("it fell".to_owned(), vec![2]);
        assert_eq!(together(&[one, third], names), "it rose by 70.3 % of its scale (arm 6); it fell (arm 2)");
    }
}
