//! The claims of a study: each with the ratio of its two sides, its interval and whether it is
//! confirmed.

use carom_record::study::{Held, Study, Verdict};
use maud::{Markup, html};

use crate::digits::three;
use crate::document::or_dash;

fn class(v: &Verdict) -> &'static str {
    match (&v.held, v.holds) {
        (Some(held), _) if held.held == held.of => "pass",
        (Some(held), _) if held.held == 0 => "miss",
        (None, Some(true)) => "pass",
        (None, Some(false)) => "miss",
        _ => "undecided",
    }
}

/// The ratio of the sides: over an ensemble its median, and its range as the interval.
fn ratio(v: &Verdict) -> Markup {
    if let Some(spread) = v.held.as_ref().and_then(|held| held.ratio.as_ref()) {
        let (low, high) = spread.range();
        return html! { b { (three(spread.median())) } br; span.small { (three(low)) " to " (three(high)) } };
    }
    let ratio = v.left.zip(v.right).map(|(left, right)| left / right).filter(|ratio| ratio.is_finite());
    html! { b { (or_dash(ratio, three)) } }
}

/// The section of the page; nothing for a study without claims.
pub(crate) fn section(study: &Study) -> Markup {
    if study.verdicts.is_empty() {
        return Markup::default();
    }
    let all = study.manifest.ensemble.is_some();
    let confirmed = study.verdicts.iter().filter(|v| class(v) == "pass").count();
    let result = |v: &Verdict| match &v.held {
        Some(held @ Held { held: k, of, .. }) => format!("confirmed {} ({k} of {of})", held.word()),
        None => v.word().to_owned(),
    };
    html! {
        h2 { "Claims" }
        p { (confirmed) " of " (study.verdicts.len()) " confirmed" @if all { " in all members of the ensemble" } "." }
        div.scroll {
            table {
                thead { tr { th { "Claim" } th { "Result" } th.n { "Left / right" } } }
                @for v in &study.verdicts {
                    tr {
                        td {
                            (v.claim.text) br; code { (v.claim.compare) }
                            @if let (Some(left), Some(right)) = (v.left, v.right) {
                                br; span.small { "left " (three(left)) ", right " (three(right)) }
                            }
                        }
                        td.(class(v)) { (result(v)) }
                        td.n { (ratio(v)) }
                    }
                }
            }
        }
        @if all {
            p.small {
                "Left / right: median of the ratio of the two sides over the members of the ensemble in which \
                 it can be decided, and its range. Left and right: of the arms as given."
            }
        } @else {
            p.small {
                "Left / right: ratio of the two sides. Without an ensemble ("
                code { "[ensemble]" } ") it has no interval."
            }
        }
    }
}
