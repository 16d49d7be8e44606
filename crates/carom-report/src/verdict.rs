//! The recommendation of a study and its basis: ranking and reference values.

use carom_record::metrics::Metric;
use carom_record::study::design::{Goal, Kind};
use carom_record::study::ranking::{Crosscheck, Ranking, error, standing};
use carom_record::study::reference::{Reference, Standing};
use carom_record::study::{Study, step};
use maud::{Markup, html};

use crate::collected::{Origin, in_time, time_unit};
use crate::design::is_off_budget;
use crate::digits::{count, five, three};
use crate::document::{file, joined, or_dash};
use crate::labels::{capitalised, with_unit};
use crate::laboratory::methods;
use crate::ranked;
use crate::text::{Label, Prose, typeset};

/// Metrics whose error a user should know before following a recommendation.
const SIDE_EFFECTS: [(&str, &str); 9] = [
    ("energy_lost", "energy lost"),
    ("dissipated_integrator", "energy dissipated by the integrator"),
    ("dissipated_contact", "energy dissipated by contact"),
    ("force_variation", "error of the total variation of the contact force"),
    ("impulse_x", "error of the x impulse"),
    ("impulse_y", "error of the y impulse"),
    ("impulse_z", "error of the z impulse"),
    ("contact_duration", "error of the contact duration"),
    ("restitution", "error of the restitution"),
];

/// How places are given.
const PLACES: &str = "The place of an arm is one plus the number of arms that are distinguishably better, of \
    which identical ones count once: by more than the uncertainty of the reference, more than the spreads of both over the ensemble added, and more \
    than 5 %. So arms share a place though one of them may be distinguished from a third and the other not. Within \
    a place arms are in the order of their cost.";

/// Orders above it are not those of a scheme.
const HIGHEST: f64 = 4.0;

fn order(p: f64) -> String {
    if p > HIGHEST { format!("({p:.2})") } else { format!("{p:.2}") }
}

/// What the columns of the ranking mean, each after a part of the headings that it explains.
const COLUMNS: [(&str, &str); 11] = [
    (
        "Error",
        "Error: by which the arms are ranked; with an ensemble its median ± the largest distance of a member from it. All other columns are of the arm as given.",
    ),
    ("Error", "Errors are relative errors; energies are fractions of the largest kinetic + strain energy."),
    (
        "±",
        "± in a heading: relative uncertainty of the reference value; step only: without the error of its mesh, which was not refined.",
    ),
    ("Delay", "Delay: time by which the motion lags the reference; negative where it leads."),
    ("Energy drift", "Energy drift: largest change of the energy at any time."),
    ("Lost in impact", "Lost in impact: energy lost over the impact that changes it most."),
    (
        "By ",
        "By integrator, by contact: energy dissipated until the end by the time integrator and by contact.",
    ),
    (
        "Excess variation",
        "Excess variation: total variation of the contact force divided by that of the reference, minus 1.",
    ),
    (
        "High-frequency",
        "High-frequency power: share of the power of the contact force above 16 cycles per contact.",
    ),
    ("Chatter", "Chatter: switches of contact nodes, on and off, per time in contact."),
    ("peak", "Peak: largest stress averaged over 1/16 of the contact."),
];

/// The recommendation at the top of the page; nothing for a study without a goal.
pub(crate) fn summary(study: &Study) -> Markup {
    let Some(ranking) = &study.ranking else { return Markup::default() };
    let goal = format!("Goal: {} ({}).", ranking.goal.word(), ranking.goal.meaning());
    let verdict = match &ranking.verdict {
        Ok(verdict) => verdict,
        Err(reasons) => {
            return html! {
                section.verdict.none {
                    h2 { "No recommendation" }
                    p { (Prose(&goal)) }
                    ul {
                        @for reason in reasons { li { (Label(&capitalised(reason))) "." } }
                        @if let Err(why) = &ranking.measure { li { (Label(&capitalised(why))) "." } }
                    }
                }
            };
        }
    };
    let arm = &study.manifest.arms[verdict.arm];
    let mut sets: Vec<String> = arm.sets_without_step().cloned().collect();
    // The step of a design is among the settings to copy.
    if arm.role.method.is_some() || sets.len() < arm.sets.len() {
        sets.extend(step(arm, "time.step").map(|h| format!("time.step={h}")));
    }
    let entry = |head: &str, lines: &[String]| {
        html! {
            dt { (head) }
            @for line in lines { dd { (Prose(&capitalised(&typeset(line)))) "." } }
        }
    };
    html! {
        section.verdict {
            h2 {
                "Recommended: " (Label(arm.method()))
                @if let Some(h) = step(arm, "time.step") { ", Δt = " (Label(&in_time(study, h))) }
            }
            p { (Prose(&goal)) }
            div.beside {
                dl {
                    (entry("Reasons", &verdict.reasons))
                    @if !verdict.alike.is_empty() { (entry("Tied with, over all levels", &[verdict.alike.join("; ")])) }
                    (entry(&format!("Confidence: {}", verdict.confidence.word()), &verdict.confidence_reasons))
                }
                dl {
                    @if !sets.is_empty() {
                        dt { "Settings" }
                        dd { (joined(sets.iter().map(|set| html! { code { (set) } }), html! { br; })) }
                    }
                    (entry("Cost", &[costs(study, verdict.arm)]))
                    (entry("Side effects", &side_effects(study, verdict.arm)))
                }
            }
        }
    }
}

/// Finished arms at the level of an arm, itself included.
fn same_level(study: &Study, arm: usize) -> impl Iterator<Item = usize> {
    let level = |arm: usize| study.manifest.arms[arm].role.level;
    let arms = methods(study).into_iter().flat_map(|(_, arms)| arms);
    arms.filter(move |i| level(*i) == level(arm))
}

fn costs(study: &Study, arm: usize) -> String {
    let cost = |i: usize| study.rows[i].value("cpu_time");
    let least = same_level(study, arm).filter_map(cost).fold(f64::INFINITY, f64::min);
    let of = |name: &str| or_dash(study.rows[arm].value(name), count);
    let cpu = or_dash(cost(arm), three);
    let against = match cost(arm) {
        Some(c) if c == least => " (the lowest of its level)".to_owned(),
        Some(c) if least > 0.0 && c.is_finite() => {
            format!(" ({} times the lowest of its level)", three(c / least))
        }
        _ => String::new(),
    };
    let (steps, newton) = (of("steps"), of("newton_iterations"));
    let (factorisations, rejected) = (of("factorisations"), of("rejected_steps"));
    format!(
        "{cpu} s of processor time{against}; {steps} steps, {newton} Newton iterations, {factorisations} \
         factorisations, {rejected} rejected steps"
    )
}

/// Known side effects of an arm, each with the smallest value of its level.
fn side_effects(study: &Study, arm: usize) -> Vec<String> {
    let mut lines = Vec::new();
    for (metric, words) in SIDE_EFFECTS {
        let Standing::Established { value: right, uncertainty } = standing(study.reference.as_ref(), metric)
        else {
            continue;
        };
        // A relative error needs a nonzero reference; energies are fractions already.
        if right == 0.0 && !metric.starts_with("energy") && !metric.starts_with("dissipated") {
            continue;
        }
        // Energies keep their sign: one that was created is no loss.
        let shown = |v: f64| if right == 0.0 { v } else { error(v, right) };
        let of = |i: usize| study.rows[i].value(metric).map(shown);
        let Some(mine) = of(arm) else { continue };
        let values: Vec<f64> = same_level(study, arm).filter_map(of).collect();
        let least = values.iter().copied().min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(mine);
        let known = if right == 0.0 { 0.0 } else { uncertainty / right.abs() };
        let percent = |share: f64| format!("{} %", three(100.0 * share));
        let beside = match () {
            () if least.abs() < known => String::new(),
            () if values.iter().any(|v| *v < 0.0) => {
                format!(" (smallest magnitude of its level: {})", percent(least))
            }
            () => format!(" (smallest of its level: {})", percent(least)),
        };
        lines.push(if mine.abs() < known {
            format!("{words}: below the uncertainty of the reference, {}", percent(known))
        } else {
            format!("{words}: {}{beside}", percent(mine))
        });
    }
    if let Some((column, late)) =
        study.compared.get(arm).and_then(Option::as_ref).and_then(|c| c.late.clone())
    {
        let direction = if late < 0.0 { "leads" } else { "lags" };
        let instants = standing(study.reference.as_ref(), "contact_start").established();
        let amount = match instants {
            Some((_, known)) if late.abs() < known => {
                format!("less than the uncertainty of its instants, {}", three(known))
            }
            _ => three(late.abs()),
        };
        lines.push(format!(
            "the motion ({column}) {direction} the reference by {amount} {}",
            time_unit(study)
        ));
    }
    lines
}

/// The ranking and the reference behind it.
pub(crate) fn rankings(study: &Study, origins: &[Origin]) -> Markup {
    let Some(ranking) = &study.ranking else { return Markup::default() };
    html! {
        h2 { "Ranking" }
        @if let Ok(measure) = &ranking.measure {
            @let uncertainty = three(measure.uncertainty);
            p { "Ranked by " (Label(&measure.words)) " (uncertainty of the errors: " (uncertainty) ")." }
            p.small { (PLACES) @if ranking.verdict.is_ok() { " ▸: recommended." } }
            (ranked_table(study, ranking, origins))
            (crosschecks(study, ranking))
        }
        (other_goals(study))
        @match &study.reference {
            Some(reference) => (reference_values(study, reference)),
            None => p {
                "The study has no finished reference: only quantities whose exact value is known, such as \
                 the energy, can be ranked."
            },
        }
    }
}

/// Which conclusions change between equal steps and equal cost.
fn crosschecks(study: &Study, ranking: &Ranking) -> Markup {
    let Some(design) = &study.manifest.design else { return Markup::default() };
    let (other, axis) = match design.kind {
        Kind::MatchedCost => ("equal steps", "step"),
        Kind::MatchedStep => ("equal cost", "cost"),
    };
    if ranking.crosschecks.is_empty() {
        if ranking.levels.len() < 2 || ranking.goal == Goal::Cost {
            return Markup::default();
        }
        return html! {
            h3 { "The same at " (other) }
            p.small {
                "Not known: at no level do the levels of another method reach the " (axis) " of the arm that \
                 stands first."
            }
        };
    }
    let value = |check: &Crosscheck| match check.at {
        "step" => format!("Δt = {}", in_time(study, check.value)),
        _ => format!("{} s of processor time", three(check.value)),
    };
    let best = |check: &Crosscheck| {
        let shown = check.errors.iter().take(5).map(|(method, error)| format!("{method}: {}", three(*error)));
        shown.collect::<Vec<_>>().join("; ")
    };
    let judged = |level: &usize| ranking.crosschecks.iter().any(|check| check.level == *level);
    let unknown: Vec<String> = (0..ranking.levels.len())
        .filter(|level| !judged(level))
        .map(|level| or_dash(design.steps.get(level).copied(), |h| in_time(study, h)))
        .collect();
    html! {
        h3 { "The same at " (other) }
        div.scroll {
            table.stack {
                thead {
                    tr {
                        th { "Level" } th { "First in the table" } th { "Compared at" }
                        th { "Smallest errors there" } th { "Conclusion" }
                    }
                }
                @for check in &ranking.crosschecks {
                    tr {
                        td.unit { "Δt = " (or_dash(design.steps.get(check.level).copied(), |h| in_time(study, h))) }
                        td { (Label(&check.first)) } td { (value(check)) } td { (Label(&best(check))) }
                        td {
                            @match &check.better {
                                Some(method) => { "changes: " (method) " is better" },
                                None if check.errors.first().is_some_and(|best| best.0 != check.first) => {
                                    "does not change: the difference is within the uncertainties of the errors"
                                }
                                None => "does not change",
                            }
                        }
                    }
                }
            }
        }
        p.small {
            "Errors of every method interpolated between its levels (linearly in logarithms) at the value of \
             the arm that stands first in the table of its level; a method whose levels do not reach it is left out."
            @if !unknown.is_empty() {
                " Not known at Δt = " (unknown.join(", ")) ": no other method reaches that value."
            }
        }
    }
}

/// What the reference establishes, and what it does not.
fn reference_values(study: &Study, reference: &Reference) -> Markup {
    let (mut not, mut yes) = (Vec::new(), Vec::new());
    // The impulse along z of plane cases has no value in any run.
    let known = |m: &&Metric| study.rows.iter().any(|row| row.value(&m.name).is_some());
    for metric in study.metrics().into_iter().filter(known).filter(|m| !m.is_work()) {
        match standing(Some(reference), &metric.name) {
            Standing::Not(why) => not.push((metric.name.to_string(), metric.unit.clone(), why)),
            Standing::Established { value, uncertainty } => yes.push((metric, value, uncertainty)),
        }
    }
    not.extend(reference.columns().into_iter().filter_map(|c| match reference.uncertainty(c) {
        Standing::Not(why) => Some((format!("deviation of {c}"), String::new(), why)),
        Standing::Established { .. } => None,
    }));
    html! {
        p { "Reference: " (typeset(&reference.what)) "." }
        details {
            summary { "Reference values and their uncertainties" }
            table {
                thead {
                    tr {
                        th { "Metric" } th { "Unit" } th.n { "Value" }
                        th.n { (if reference.refines_mesh() { "Uncertainty" } else { "Uncertainty, step only" }) }
                        th.n { "Observed order" } th.n { "Half-width of members" }
                    }
                }
                @for (metric, value, uncertainty) in yes {
                    @let estimate = reference.estimate(&metric.name).ok();
                    tr {
                        td { code { (metric.name) } } td.unit { (Label(&metric.unit)) }
                        td.n { (three(value)) }
                        td.n { @if uncertainty == 0.0 { "exact" } @else { (three(uncertainty)) } }
                        td.n { (or_dash(estimate.and_then(|e| e.order).filter(|_| uncertainty > 0.0), order)) }
                        td.n { (or_dash(estimate.map(|e| e.spread).filter(|s| *s > 0.0), three)) }
                    }
                }
            }
            p.small {
                "An order above " (HIGHEST) " is in brackets: no scheme has it, so that the values do not \
                 converge regularly yet. The uncertainty is that of the refinement (grid convergence index; with an ensemble the \
                 median over its members), plus the half-width of the ensemble, which is the largest \
                 distance of a member from the median, plus a step for instants (half a step with several \
                 phases), plus 5/4 of what averaging over 1/16 of the contact changes, for extremes and \
                 variations."
                @if !reference.refines_mesh() {
                    " The mesh was not refined: its error is not included, and the true values may lie \
                     outside. With "
                    code { "mesh = [1, 2, 4]" }
                    " in "
                    code { "[fine]" }
                    " it is."
                }
            }
        }
        details {
            summary { "Quantities without an established reference value (not used for ranking)" }
            table {
                thead { tr { th { "Quantity" } th { "Unit" } th { "Reason" } } }
                @for (name, unit, why) in not {
                    tr { td { code { (name) } } td.unit { (Label(&unit)) } td { (typeset(&why)) } }
                }
            }
        }
    }
}

/// What is recommended for the other goals.
fn other_goals(study: &Study) -> Markup {
    html! {
        h3 { "Recommendations for the other goals" }
        div.scroll { table.stack {
            thead {
                tr { th { "Goal" } th { "Recommended" } th.n { (with_unit("Δt", time_unit(study))) } th { "Confidence" } th { "Ranked by" } }
            }
            @for ranking in &study.other_rankings {
                tr {
                    td { (ranking.goal.word()) }
                    @match (&ranking.verdict, &ranking.measure) {
                        (Ok(verdict), Ok(measure)) => {
                            @let arm = &study.manifest.arms[verdict.arm];
                            td {
                                (Label(arm.method()))
                                @if !verdict.alike.is_empty() {
                                    br; span.small { "tied with " (Label(&verdict.alike.join("; "))) }
                                }
                                @if let Some(depth) = &verdict.penetration {
                                    br; span.small { "a penalty: " (depth) }
                                }
                            }
                            td.n { (or_dash(step(arm, "time.step"), five)) }
                            td { (verdict.confidence.word()) } td { (Label(&measure.words)) }
                        }
                        (_, Err(why)) => td colspan="4" { "no ranking: " span.small { (why) } },
                        (Err(reasons), Ok(_)) => td colspan="4" {
                            "no recommendation: " span.small { (Label(&reasons.join("; "))) }
                        },
                    }
                }
            }
        } }
        @if study.manifest.ensemble.is_some() {
            p.small {
                "An arm has the required accuracy, " (study.manifest.accuracy()) ", where neither the median of its \
                 error over the ensemble nor the largest distance of a member from it is larger."
            }
        }
    }
}

fn ranked_table(study: &Study, ranking: &Ranking, origins: &[Origin]) -> Markup {
    let placed = |arm: &usize| ranking.levels.iter().flatten().any(|r| r.arm == *arm);
    let without = methods(study).into_iter().flat_map(|(_, arms)| arms).filter(|arm| !placed(arm));
    let without: Vec<&str> = without.map(|arm| study.rows[arm].name.as_str()).collect();
    let why = if ranking.goal == Goal::Cost { "not accurate enough" } else { "metric not available" };
    let unsound = ranking.levels.iter().flatten().filter(|r| !r.sound);
    let unsound: Vec<&str> = unsound.map(|r| study.rows[r.arm].name.as_str()).collect();
    let (tables, heads) = ranked::tables(study, ranking, origins);
    html! {
        (tables)
        @if !without.is_empty() { p.small { "Not ranked (" (why) "): " (without.join("; ")) "." } }
        @if !unsound.is_empty() {
            p.small {
                "Placed behind all others of their level, and not recommended, because they created more \
                 energy than the default guard allows: " (unsound.join("; ")) "."
            }
        }
        @if study.manifest.arms.iter().any(|arm| is_off_budget(study, arm)) {
            p.small { "An exclamation mark means more than 10 % off the budget." }
        }
        ul.small {
            @for (_, line) in COLUMNS.iter().filter(|(part, _)| heads.iter().any(|head| head.contains(part))) {
                li { (line) }
            }
        }
        p.small { "Data in full precision: " (file("ranking.csv")) ", " (file("reference.csv")) "." }
    }
}
