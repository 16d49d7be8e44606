//! The claims of a study: each with the ratio of its two sides, its interval and whether it is
//! confirmed.

use carom_record::study::{Confirmed, Study, Verdict};
use maud::{Markup, html};

use crate::digits::three;
use crate::document::labelled;
use crate::text::Label;

fn class(v: &Verdict) -> &'static str {
    match v.word() {
        "confirmed" => "pass",
        "refuted" => "miss",
        _ => "undecided",
    }
}

/// The ratio of the sides, and what it is compared with: over an ensemble its median, and its range
/// as the interval.
fn ratio(v: &Verdict) -> Markup {
    let spread = v.ensemble.as_ref().and_then(|confirmed| confirmed.ratio.as_ref());
    let bound = v.bound.map_or_else(String::new, |(sign, bound)| format!("{sign} {}", three(bound)));
    html! {
        @match spread {
            Some(spread) => {
                b { (Label(&three(spread.median()))) } br;
                span.small { (Label(&three(spread.range().0))) " to " (Label(&three(spread.range().1))) }
            }
            None => b { (labelled(v.ratio, three)) },
        }
        @if !bound.is_empty() { br; span.small { "claimed " (Label(&bound)) } }
    }
}

/// The right side, with its constant factor beside the quantity.
fn factored(v: &Verdict, right: f64) -> String {
    match v.bound {
        Some((_, factor)) if factor != 1.0 && right != factor => {
            format!("{} = {} × {}", three(right), three(factor), three(right / factor))
        }
        _ => three(right),
    }
}

/// The section of the page; nothing for a study without claims.
pub(super) fn section(study: &Study) -> Markup {
    if study.verdicts.is_empty() {
        return Markup::default();
    }
    let all = study.manifest.ensemble.is_some();
    let confirmed = study.verdicts.iter().filter(|v| class(v) == "pass").count();
    let result = |v: &Verdict| match &v.ensemble {
        Some(Confirmed { count: 0, of, members, .. }) if of == members => {
            format!("refuted in all ({of} of {of})")
        }
        Some(confirmed) => format!("confirmed {} ({})", confirmed.word(), confirmed.words()),
        None => v.word().to_owned(),
    };
    html! {
        p { (confirmed) " of " (study.verdicts.len()) " confirmed" @if all { " in all members of the ensemble" } "." }
        div.scroll {
            table.claims {
                thead { tr { th { "Claim" } th { "Result" } th.n { "Ratio" } } }
                @for v in &study.verdicts {
                    tr {
                        td {
                            (v.claim.text) br; code { (v.claim.compare) }
                            @if let (Some(left), Some(right)) = (v.left, v.right) {
                                br; span.small { "left " (Label(&three(left))) ", right " (Label(&factored(v, right))) }
                            }
                        }
                        td.(class(v)) { (result(v)) }
                        td.n { (ratio(v)) }
                    }
                }
            }
        }
        p.small {
            "Ratio: the left quantity divided by the right one, without constant factors, and what is claimed \
             of it; for a comparison with a number, the left quantity itself. "
            @if all {
                "Median over the members of the ensemble in which the claim can be decided, and range."
            }
        }
    }
}
