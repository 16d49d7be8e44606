//! What makes the arms of a study comparable: equal time steps or equal costs.

use carom_record::study::design::Kind;
use carom_record::study::{Arm, Study};
use maud::{Markup, html};

use crate::collected::in_time;
use crate::digits::three;

/// A cost is matched when it is within this fraction of the budget.
pub(crate) const OFF_BUDGET: f64 = 0.1;

/// The design in words; nothing for a study that ranks nothing.
pub(crate) fn paragraphs(study: &Study) -> Markup {
    let m = &study.manifest;
    let Some(design) = &m.design else {
        return html! {
            @if study.ranking.is_some() {
                p { "The arms run as written: neither their time steps nor their costs were matched." }
            }
        };
    };
    let levels =
        design.steps.iter().enumerate().map(|(i, h)| format!("level {}: Δt = {}", i + 1, in_time(study, *h)));
    let levels = levels.collect::<Vec<_>>().join(", ");
    let matched_by_cost =
        |method: &&str| m.arms.iter().any(|arm| arm.role.method.as_deref() == Some(method) && m.by_cost(arm));
    let by_cost: Vec<&str> = m.methods().into_iter().filter(matched_by_cost).collect();
    html! {
        @match design.kind {
            Kind::MatchedStep => {
                p { "Matched step: at each level all methods have the same time step (" (levels) ")." }
                @if !by_cost.is_empty() {
                    p {
                        "Matched by cost instead: " (by_cost.join("; ")) ". At each level such a method has \
                         the time step at which its counted cost equals that of " b { (design.cost_of) } "."
                    }
                    (budgets(study))
                }
            }
            Kind::MatchedCost => {
                p {
                    "Matched cost: at each level a method has the time step at which its cost equals that of "
                    b { (design.cost_of) } " (" (levels) "). The cost is counted in Newton iterations and \
                     factorisations, or in steps, each weighted by its processor time in a pilot run. The \
                     processor times in the tables are those of the arms themselves. Pilot runs: "
                    code { "pilots/" } "."
                }
                (budgets(study))
            }
        }
    }
}

/// Whether the cost of an arm, where it is matched, is more than 10 % off its budget.
pub(crate) fn is_off_budget(study: &Study, arm: &Arm) -> bool {
    study.manifest.by_cost(arm) && arm.role.cost.is_none_or(|share| (share - 1.0).abs() > OFF_BUDGET)
}

/// Whether all matched costs are within 10 % of their budget, and which arms miss it.
pub(crate) fn budgets(study: &Study) -> Markup {
    let matched: Vec<&Arm> = study.manifest.arms.iter().filter(|a| study.manifest.by_cost(a)).collect();
    let missed: Vec<&Arm> = matched.iter().copied().filter(|arm| is_off_budget(study, arm)).collect();
    let cost = |arm: &&Arm| match arm.role.cost {
        Some(share) => format!("{} ({} of the budget)", arm.name, three(share)),
        None => format!("{} (cost unknown)", arm.name),
    };
    html! {
        @if missed.is_empty() {
            p { "The counted costs of all arms matched by cost are within 10 % of their budgets." }
        } @else {
            p {
                span.miss {
                    (missed.len()) " of " (matched.len()) " arms missed the budget by more than 10 %"
                }
                ", because no number of steps with this cost was found or because the run did not finish: "
                (missed.iter().map(cost).collect::<Vec<_>>().join("; ")) ". These arms are not compared at \
                 equal cost."
            }
        }
    }
}
