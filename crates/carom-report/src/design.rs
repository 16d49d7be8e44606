//! What made the arms of a study comparable, and where it failed to.

use std::fmt::Write as _;

use carom_record::study::design::Kind;
use carom_record::study::{Arm, Study};

use crate::digits::{five, three};
use crate::text::escape;

/// Costs are matched within this share of the budget.
pub(crate) const OFF_BUDGET: f64 = 0.1;

/// What made the arms comparable; nothing for a study that ranks nothing.
pub(crate) fn show(out: &mut String, study: &Study) {
    if study.ranking.is_none() && study.manifest.design.is_none() {
        return;
    }
    match study.manifest.design.as_ref().map(|d| (d.kind, &d.cost_of)) {
        None => {
            out.push_str(
                "<p>The arms are as written: neither their steps nor their costs were made equal.</p>\n",
            );
        }
        Some((Kind::MatchedStep, _)) => {
            let _ = writeln!(
                out,
                "<p>Matched step: at a level every method has the same step ({}).</p>",
                levels(study)
            );
            let by_cost = study.manifest.methods().into_iter().filter(|method| {
                let mut arms = study.manifest.arms.iter();
                arms.any(|arm| arm.role.method.as_deref() == Some(method) && study.manifest.by_cost(arm))
            });
            let by_cost: Vec<String> = by_cost.map(escape).collect();
            if let Some(design) = study.manifest.design.as_ref().filter(|_| !by_cost.is_empty()) {
                let _ = writeln!(
                    out,
                    "<p>By cost, not by step: {}. Each has the step at which its counted cost is that of <b>{}</b> at the level.</p>",
                    by_cost.join("; "),
                    escape(&design.cost_of)
                );
                out.push_str(&unmatched(study));
            }
        }
        Some((Kind::MatchedCost, of)) => {
            let _ = writeln!(
                out,
                "<p>Matched cost: at a level every method has the step at which it costs what <b>{}</b> does at its own ({}). Cost is counted (Newton iterations and factorisations, or \
                 steps) and weighted by processor seconds that a pilot run measured (<code>pilots/</code>); the column of processor time is what the arms themselves took.</p>",
                escape(of),
                levels(study)
            );
            out.push_str(&unmatched(study));
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
pub(crate) fn unmatched(study: &Study) -> String {
    let off = |arm: &&Arm| arm.role.cost.is_none_or(|share| (share - 1.0).abs() > OFF_BUDGET);
    let matched: Vec<&Arm> = study.manifest.arms.iter().filter(|a| study.manifest.by_cost(a)).collect();
    let missed: Vec<&Arm> = matched.iter().copied().filter(off).collect();
    if missed.is_empty() {
        return "<p>The counted cost of every arm whose cost is matched is within 10 % of its budget.</p>\n"
            .to_owned();
    }
    let told = |arm: &&Arm| {
        let share = arm.role.cost.map_or("none".to_owned(), three);
        format!("{} ({share} of the budget)", escape(&arm.name))
    };
    format!(
        "<p><span class=\"miss\">{} of {} arms are not within 10 % of their budget</span>, because no number of steps was found at which they cost it, or they \
         did not run to their end: {}. Errors of these arms are not at equal cost.</p>\n",
        missed.len(),
        matched.len(),
        missed.iter().map(told).collect::<Vec<_>>().join("; ")
    )
}
