//! The verdict of a study and what stands behind it: ranking, what cannot be ranked on, orders by
//! phase.

use carom_record::metrics::WORK;
use carom_record::study::design::Goal;
use carom_record::study::ranking::{Ranking, error, standing};
use carom_record::study::reference::{Reference, Standing};
use carom_record::study::{Arm, Study, step};
use maud::{Markup, html};

use crate::digits::{five, three};
use crate::document::{file, joined, or_dash};
use crate::laboratory::methods;
use crate::ranked;
use crate::text::Label;

/// Metrics whose error against the reference a user should know before taking a recommendation.
const SIDE: [(&str, &str); 8] = [
    ("energy_lost", "energy lost"),
    ("dissipated_integrator", "dissipated by the integrator"),
    ("dissipated_contact", "taken by contact"),
    ("force_variation", "error of the force's variation"),
    ("impulse_x", "error of the impulse along x"),
    ("impulse_y", "error of the impulse along y"),
    ("contact_duration", "error of the contact's duration"),
    ("restitution", "error of restitution"),
];

/// What the columns of the ranking hold.
const COLUMNS: [&str; 9] = [
    "Errors and energies are relative.",
    "±: the uncertainty of the reference.",
    "Energy drift: its largest change at any time.",
    "Lost in an impact: over the one that changes the energy most.",
    "By integrator: what it took by the end.",
    "By contact: what it took by the end.",
    "TV beyond: total variation of the contact force over the reference's, minus 1.",
    "Peak: the stress averaged over a sixteenth of the contact.",
    "Orders: of the errors against the reference at the two finest levels, before the first contact and after it.",
];

/// The box at the top; nothing for a study without a goal.
pub(crate) fn summary(study: &Study) -> Markup {
    let Some(ranking) = &study.ranking else { return Markup::default() };
    let goal = format!("goal: {} ({}).", ranking.goal.word(), ranking.goal.meaning());
    let Some(verdict) = &ranking.verdict else {
        let why = match &ranking.measure {
            Err(why) => why.clone(),
            Ok(measure) => format!("no arm has a value of: {}", measure.words),
        };
        return html! {
            section.verdict.none {
                h2 { "No recommendation" }
                p { (goal) " Nothing can be ranked: " (Label(&why)) "." }
            }
        };
    };
    let arm = &study.manifest.arms[verdict.arm];
    let sets: Vec<&String> =
        arm.sets.iter().filter(|set| !set.trim_start().starts_with("time.step")).collect();
    let entry = |head: &str, lines: &[String]| {
        html! {
            dt { (head) }
            @for line in lines { dd { (Label(line)) } }
        }
    };
    html! {
        section.verdict {
            h2 {
                "Recommended: " (name(arm))
                @if let Some(h) = step(arm, "time.step") { ", Δt = " (five(h)) }
            }
            p { (goal) }
            dl {
                @if !sets.is_empty() {
                    dt { "In the case" }
                    dd { (joined(sets.iter().map(|set| html! { code { (set) } }), html! { br; })) }
                }
                (entry("Why", &verdict.reasons))
                @if !verdict.alike.is_empty() {
                    (entry("Not told apart from it", &[verdict.alike.join(" · ")]))
                }
                (entry("What it costs", &[costs(study, verdict.arm)]))
                (entry("What it distorts", &distorts(study, verdict.arm)))
                (entry(&format!("Confidence: {}", verdict.confidence.word()), &verdict.confidence_reasons))
            }
        }
    }
}

/// The method of an arm, or its own name where there are no methods.
fn name(arm: &Arm) -> &str {
    arm.role.method.as_ref().unwrap_or(&arm.name)
}

fn costs(study: &Study, arm: usize) -> String {
    let cost = |i: usize| study.rows[i].value("cpu_time");
    let level = study.manifest.arms[arm].role.level;
    let same = methods(study)
        .into_iter()
        .flat_map(|(_, arms)| arms)
        .filter(|i| study.manifest.arms[*i].role.level == level);
    let least = same.filter_map(cost).fold(f64::INFINITY, f64::min);
    let of = |name: &str| study.rows[arm].value(name).map_or("–".into(), three);
    let against = cost(arm)
        .filter(|c| least > 0.0 && c.is_finite())
        .map_or_else(String::new, |c| format!(", {} times the least of its level", three(c / least)));
    format!(
        "{} s of processor time{against}; {} steps, {} Newton iterations, {} factorisations, {} rejected steps",
        of("cpu_time"),
        of("steps"),
        of("newton_iterations"),
        of("factorisations"),
        of("rejected_steps")
    )
}

/// Side effects that can be told, each with the least of its level.
fn distorts(study: &Study, arm: usize) -> Vec<String> {
    let level = study.manifest.arms[arm].role.level;
    let same: Vec<usize> = methods(study)
        .into_iter()
        .flat_map(|(_, arms)| arms)
        .filter(|i| study.manifest.arms[*i].role.level == level)
        .collect();
    let mut lines = Vec::new();
    for (metric, words) in SIDE {
        let Standing::Established { value: right, .. } = standing(study.reference.as_ref(), metric) else {
            continue;
        };
        // An error that is relative to nothing says nothing.
        if right == 0.0 && !metric.starts_with("energy") && !metric.starts_with("dissipated") {
            continue;
        }
        let of = |i: usize| study.rows[i].value(metric).map(|v| error(v, right));
        let Some(mine) = study.rows[arm].value(metric) else { continue };
        let least = same.iter().filter_map(|i| of(*i)).fold(f64::INFINITY, f64::min);
        let shown = if right == 0.0 { mine } else { error(mine, right) };
        lines.push(format!("{words}: {} (least of its level {})", three(shown), three(least)));
    }
    if let Some((column, late)) =
        study.compared.get(arm).and_then(Option::as_ref).and_then(|c| c.late.clone())
    {
        lines.push(format!(
            "{column} is {} by {}",
            if late < 0.0 { "early" } else { "late" },
            three(late.abs())
        ));
    }
    lines
}

/// Ranking and what cannot be ranked on.
pub(crate) fn rankings(study: &Study) -> Markup {
    let Some(ranking) = &study.ranking else { return Markup::default() };
    html! {
        h2 { "Ranking" }
        @if let Ok(measure) = &ranking.measure {
            p { "By " (Label(&measure.words)) "; uncertainty of the errors " (three(measure.uncertainty)) "." }
            (ranked_table(study, ranking))
        }
        (other_goals(study))
        @match &study.reference {
            None => p {
                "The study has no finished reference: only what has a right value by itself, such as energy, \
                 can be ranked."
            },
            Some(reference) => (established(study, reference)),
        }
    }
}

/// What the reference establishes, and what it does not.
fn established(study: &Study, reference: &Reference) -> Markup {
    let (mut not, mut yes) = (Vec::new(), Vec::new());
    for metric in study.metrics().into_iter().filter(|m| !WORK.iter().any(|(d, _)| d.name == m.name)) {
        match standing(Some(reference), &metric.name) {
            Standing::Not(why) => not.push((metric.name.to_string(), why)),
            Standing::Established { value, uncertainty } => yes.push((metric, value, uncertainty)),
        }
    }
    not.extend(reference.columns().into_iter().filter_map(|c| match reference.uncertainty(c) {
        Standing::Not(why) => Some((format!("deviation of {c}"), why)),
        Standing::Established { .. } => None,
    }));
    html! {
        p { "Reference: " (reference.what) "." }
        details {
            summary { "What it establishes, with its uncertainty" }
            table {
                thead { tr { th { "Metric" } th { "Unit" } th.n { "Value" } th.n { "±" } } }
                @for (metric, value, uncertainty) in yes {
                    tr {
                        td { code { (metric.name) } }
                        td { (Label(&metric.unit)) }
                        td.n { (three(value)) }
                        td.n { (three(uncertainty)) }
                    }
                }
            }
        }
        details open {
            summary { "Not established by a refinement: never ranked on" }
            table { @for (name, why) in not { tr { td { code { (name) } } td { (why) } } } }
        }
    }
}

/// What would be recommended by the other goals.
fn other_goals(study: &Study) -> Markup {
    html! {
        h3 { "By other goals" }
        table {
            thead {
                tr { th { "Goal" } th { "Recommended" } th.n { "Δt" } th { "Confidence" } th { "By" } }
            }
            @for ranking in &study.other_rankings {
                tr {
                    td { (ranking.goal.word()) }
                    @match (&ranking.verdict, &ranking.measure) {
                        (Some(verdict), Ok(measure)) => {
                            @let arm = &study.manifest.arms[verdict.arm];
                            td {
                                (name(arm))
                                @if !verdict.alike.is_empty() {
                                    br; span.small { "not told apart: " (verdict.alike.join(" · ")) }
                                }
                            }
                            td.n { (or_dash(step(arm, "time.step"), five)) }
                            td { (verdict.confidence.word()) }
                            td { (Label(&measure.words)) }
                        }
                        (_, Err(why)) => td colspan="4" { "nothing can be ranked: " span.small { (why) } },
                        (None, Ok(measure)) => td colspan="4" {
                            "no arm has a value of: " span.small { (Label(&measure.words)) }
                        },
                    }
                }
            }
        }
    }
}

fn ranked_table(study: &Study, ranking: &Ranking) -> Markup {
    let placed = |arm: &usize| ranking.levels.iter().flatten().any(|r| r.arm == *arm);
    let without = methods(study).into_iter().flat_map(|(_, arms)| arms).filter(|arm| !placed(arm));
    let without: Vec<&str> = without.map(|arm| study.rows[arm].name.as_str()).collect();
    let why =
        if ranking.goal == Goal::Cost { "not accurate enough" } else { "without a value of the measure" };
    html! {
        (ranked::tables(study, ranking))
        @if !without.is_empty() {
            p.small { "In no place, because " (why) ": " (without.join("; ")) "." }
        }
        p.small {
            "Arms that share a place are not told apart: their errors differ by no more than the uncertainty \
             of the reference, or 5 %."
            @if study.manifest.arms.iter().any(|arm| study.manifest.by_cost(arm)) {
                " An exclamation mark: off the budget by more than 10 %."
            }
        }
        ul.small { @for line in COLUMNS { li { (line) } } }
        p.small { "All digits are in " (file("ranking.csv")) " and " (file("reference.csv")) "." }
    }
}

/// Observed orders before the first contact and after it.
pub(crate) fn phases(study: &Study) -> Markup {
    let cell = |order: &Result<f64, String>| {
        html! {
            @match order {
                Ok(order) => (format!("{order:.2}").replace('-', "−")),
                Err(why) => span.small { "no order (" (why) ")" },
            }
        }
    };
    html! {
        @if !study.phase_orders.is_empty() {
            h2 { "Order before and after the first contact" }
            table {
                thead {
                    tr { th { "Method" } th { "Column" } th { "Before the first contact" } th { "After it" } }
                }
                @for o in &study.phase_orders {
                    tr {
                        td { (o.method) }
                        td { code { (o.column) } }
                        td { (cell(&o.smooth)) }
                        td { (cell(&o.across)) }
                    }
                }
            }
            p.small {
                "From the errors against the reference at the two finest levels, root mean square over the rows \
                 before the reference's first contact, and over those after its end."
            }
        }
    }
}
