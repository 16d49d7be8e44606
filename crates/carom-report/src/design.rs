//! What made the arms of a study comparable, and where it failed to.

use carom_record::study::design::Kind;
use carom_record::study::{Arm, Study};
use maud::{Markup, html};

use crate::digits::{five, three};

/// Costs are matched within this share of the budget.
pub(crate) const OFF_BUDGET: f64 = 0.1;

/// What made the arms comparable; nothing for a study that ranks nothing.
pub(crate) fn paragraphs(study: &Study) -> Markup {
    let m = &study.manifest;
    if study.ranking.is_none() && m.design.is_none() {
        return Markup::default();
    }
    let Some(design) = &m.design else {
        return html! { p { "The arms are as written: neither their steps nor their costs were made equal." } };
    };
    let of_cost =
        |method: &&str| m.arms.iter().any(|arm| arm.role.method.as_deref() == Some(method) && m.by_cost(arm));
    let by_cost: Vec<&str> = m.methods().into_iter().filter(of_cost).collect();
    html! {
        @match design.kind {
            Kind::MatchedStep => {
                p { "Matched step: at a level every method has the same step (" (levels(study)) ")." }
                @if !by_cost.is_empty() {
                    p {
                        "By cost, not by step: " (by_cost.join("; ")) ". Each has the step at which its \
                         counted cost is that of " b { (design.cost_of) } " at the level."
                    }
                    (unmatched(study))
                }
            }
            Kind::MatchedCost => {
                p {
                    "Matched cost: at a level every method has the step at which it costs what "
                    b { (design.cost_of) } " does at its own (" (levels(study)) "). Cost is counted (Newton \
                     iterations and factorisations, or steps) and weighted by processor seconds that a pilot \
                     run measured (" code { "pilots/" } "); the column of processor time is what the arms \
                     themselves took."
                }
                (unmatched(study))
            }
        }
    }
}

/// The steps of the levels, in words.
fn levels(study: &Study) -> String {
    let steps = study.manifest.design.iter().flat_map(|d| &d.steps);
    let steps: Vec<String> =
        steps.enumerate().map(|(i, h)| format!("level {} Δt = {}", i + 1, five(*h))).collect();
    steps.join(", ")
}

/// Whether costs were matched within the tenth that is claimed, and of which arms not.
pub(crate) fn unmatched(study: &Study) -> Markup {
    let off = |arm: &&Arm| arm.role.cost.is_none_or(|share| (share - 1.0).abs() > OFF_BUDGET);
    let matched: Vec<&Arm> = study.manifest.arms.iter().filter(|a| study.manifest.by_cost(a)).collect();
    let missed: Vec<&Arm> = matched.iter().copied().filter(off).collect();
    let told = |arm: &&Arm| {
        let share = arm.role.cost.map_or("none".to_owned(), three);
        format!("{} ({share} of the budget)", arm.name)
    };
    html! {
        @if missed.is_empty() {
            p { "The counted cost of every arm whose cost is matched is within 10 % of its budget." }
        } @else {
            p {
                span.miss { (missed.len()) " of " (matched.len()) " arms are not within 10 % of their budget" }
                ", because no number of steps was found at which they cost it, or they did not run to their \
                 end: " (missed.iter().map(told).collect::<Vec<_>>().join("; ")) ". Errors of these arms are \
                 not at equal cost."
            }
        }
    }
}
