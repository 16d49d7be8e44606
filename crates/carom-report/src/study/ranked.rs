//! The ranking of the arms of a study and what it rests on: reference values, and the other goals.

use std::collections::BTreeMap;

use carom_record::metrics::Metric;
use carom_record::study::ranking::{Ranked, Ranking};
use carom_record::study::reference::{Established, Reference};
use carom_record::study::{Study, step};
use maud::{Markup, html};

use super::collected::{cells_of, in_time, time_unit};
use super::comparison::methods;
use crate::digits::{count, five, three};
use crate::document::{file, labelled, or_dash};
use crate::labels::with_unit;
use crate::text::{Label, typeset};

/// How places are given.
const PLACES: &str = "The place of an arm is one plus the number of arms of its level that are distinguishably better: \
    every solution within the uncertainty of the reference is nearer to them. Intervals may overlap; identical arms (see the warnings) count once. Cost is counted, in evaluations of the internal forces.";

/// Orders above it are not those of a scheme.
const HIGHEST: f64 = 4.0;

/// The ranking; nothing for a study without a goal.
pub(super) fn section(study: &Study) -> Markup {
    let Some(ranking) = &study.ranking else { return Markup::default() };
    html! {
        @if let Ok(measure) = &ranking.measure {
            p {
                "Ranked by " (Label(&measure.words)) " (uncertainty of the errors: " (three(measure.uncertainty)) ")."
                @if let Some(noise) = measure.noise { " The noise is known up to " (three(noise)) "." }
            }
            (table(study, ranking))
            p.small { (PLACES) " With all digits: " (file("ranking.csv")) "." }
        }
        @if !ranking.apart.is_empty() {
            p { "Set apart, and neither ranked nor recommended:" }
            ul {
                @for apart in &ranking.apart {
                    li { (Label(&study.rows[apart.arm].name)) ": " (typeset(&apart.why)) "." }
                }
            }
        }
        (other_goals(study))
        @match &study.reference {
            Some(reference) => (reference_values(study, reference)),
            None => p {
                "No finished reference: only quantities whose exact value is known, such as the energy, can be ranked."
            },
        }
    }
}

/// A heading, and the cells of the arms that have one.
type Column = (String, BTreeMap<usize, String>);

/// The columns that have a value in any of the arms.
fn columns(study: &Study, ranking: &Ranking) -> Vec<Column> {
    let column = |head: String, cell: &dyn Fn(&Ranked) -> Option<String>| {
        let ranked = ranking.levels.iter().flatten();
        (head, ranked.filter_map(|ranked| Some((ranked.arm, cell(ranked)?))).collect())
    };
    let metrics = study.metrics();
    let metric = |head: &str, name: &str, digits: fn(f64) -> String| {
        let unit = metrics.iter().find(|metric| metric.name == name).map_or("", |metric| &metric.unit);
        column(with_unit(head, unit), &|ranked| study.rows[ranked.arm].value(name).map(digits))
    };
    let step_of = |ranked: &Ranked| {
        let arm = &study.manifest.arms[ranked.arm];
        let budget = if study.manifest.is_off_budget(arm) { " !" } else { "" };
        Some(step(arm, "time.step").map(five)? + budget)
    };
    let interval = |ranked: &Ranked| {
        let [low, high] = ranked.interval.map(three);
        Some(format!("{low} to {high}"))
    };
    let late = |ranked: &Ranked| Some(three(study.compared.get(ranked.arm)?.as_ref()?.late.as_ref()?.1));
    let mut all = vec![
        column(with_unit("Δt", time_unit(study)), &step_of),
        column("Error".to_owned(), &|ranked| Some(three(ranked.error))),
        column("Interval".to_owned(), &interval),
        column("Noise".to_owned(), &|ranked| ranked.noise.map(three)),
        column(with_unit("Delay", time_unit(study)), &late),
        metric("Cost", "cost", count),
        metric("Newton iterations", "newton_iterations", count),
        metric("Energy error", "energy_error", three),
        metric("Energy lost", "energy_lost", three),
        metric("Penetration", "penetration", three),
    ];
    all.retain(|(_, cells): &Column| !cells.is_empty());
    all
}

fn table(study: &Study, ranking: &Ranking) -> Markup {
    let columns = columns(study, ranking);
    let chosen = ranking.verdict.as_ref().ok().map(|verdict| verdict.arm);
    let steps = study.manifest.design.as_ref().map_or(&[][..], |design| &design.steps);
    let level_words = |level: usize| match steps.get(level) {
        Some(h) => format!("Level {}: Δt = {}", level + 1, in_time(study, *h)),
        None => format!("Level {}", level + 1),
    };
    let is_ranked = |arm: usize| ranking.levels.iter().flatten().any(|ranked| ranked.arm == arm);
    let is_apart = |arm: usize| ranking.apart.iter().any(|apart| apart.arm == arm);
    let all = methods(study).into_iter().flat_map(|(_, arms)| arms);
    let without = all.filter(|arm| !is_ranked(*arm) && !is_apart(*arm));
    let without: Vec<&str> = without.map(|arm| study.rows[arm].name.as_str()).collect();
    let is_any_off = study.manifest.off_budget().next().is_some();
    html! {
        div {
            table.metrics.ranking {
                thead {
                    tr { th.n { "Place" } th { "Method" } @for (head, _) in &columns { th.n { (Label(head)) } } }
                }
                @for (level, ranked) in ranking.levels.iter().enumerate() {
                    @if ranking.levels.len() > 1 {
                        tr { td colspan=(columns.len() + 2) { b { (Label(&level_words(level))) } } }
                    }
                    @for r in ranked {
                        @let arm = &study.manifest.arms[r.arm];
                        tr {
                            td.n { (r.place) }
                            td.method {
                                @if chosen == Some(r.arm) { b { "▸ " (Label(arm.method())) } } @else { (Label(arm.method())) }
                                @if study.manifest.by_cost(arm) { span.small { " (matched by cost)" } }
                            }
                            @for (_, cells) in &columns { td.n { (Label(cells.get(&r.arm).map_or("–", String::as_str))) } }
                        }
                    }
                }
            }
        }
        p.small {
            "▸: recommended. Errors are relative; energies are fractions of the largest kinetic + strain energy. "
            @if study.manifest.ensemble.is_some() { "Error: the largest of the ensemble. " }
            @if is_any_off { "!: more than 10 % off the budget. " }
            @if !without.is_empty() { "Not ranked (metric not available): " (without.join("; ")) "." }
        }
    }
}

/// Recommendations for the other goals.
fn other_goals(study: &Study) -> Markup {
    html! {
        details {
            summary { "Recommendations for the other goals" }
            table.stack {
                thead { tr { th { "Goal" } th { "Recommended" } th { "Confidence" } th { "Ranked by" } } }
                @for ranking in &study.other_rankings {
                    tr {
                        td { (ranking.goal.word()) }
                        @match (&ranking.verdict, &ranking.measure) {
                            (Ok(verdict), Ok(measure)) => {
                                @let arm = &study.manifest.arms[verdict.arm];
                                td {
                                    (Label(arm.method()))
                                    @if let Some(h) = step(arm, "time.step") { ", Δt = " (Label(&in_time(study, h))) }
                                    @if !verdict.alike.is_empty() {
                                        br; span.small { "tied with " (Label(&verdict.alike.join("; "))) }
                                    }
                                }
                                td { (verdict.confidence.word()) } td { (Label(&measure.words)) }
                            }
                            (_, Err(why)) => td colspan="3" { "no ranking: " (why) },
                            (Err(reasons), Ok(_)) => td colspan="3" { "none: " (Label(&reasons.join("; "))) },
                        }
                    }
                }
            }
        }
    }
}

/// Values that the reference establishes, and reasons where it does not.
fn reference_values(study: &Study, reference: &Reference) -> Markup {
    let is_known = |m: &&Metric| study.rows.iter().any(|row| row.value(&m.name).is_some()) && !m.is_work();
    let metrics: Vec<&Metric> = study.metrics().into_iter().filter(is_known).collect();
    html! {
        details {
            summary { "Reference values and their uncertainties" }
            p { "Reference: " (typeset(&reference.what)) "." }
            table.metrics {
                thead {
                    tr { th { "Metric" } th { "Unit" } th.n { "Value" } th.n { "Uncertainty" } th.n { "Order" } th.n { "Spread" } }
                }
                @for metric in metrics {
                    tr {
                        (cells_of(metric))
                        @match study.standing(&metric.name) {
                            Ok(Established { value, uncertainty }) => {
                                @let estimate = reference.estimate(&metric.name).ok();
                                @let order = estimate.and_then(|estimate| estimate.order).filter(|_| uncertainty > 0.0);
                                td.n { (Label(&three(value))) }
                                td.n { @if uncertainty == 0.0 { "exact" } @else { (Label(&three(uncertainty))) } }
                                td.n { (or_dash(order, |p| if p > HIGHEST { format!("({p:.2})") } else { format!("{p:.2}") })) }
                                td.n { (labelled(estimate.map(|estimate| estimate.spread).filter(|s| *s > 0.0), three)) }
                            }
                            Err(why) => td colspan="4" { "not established: " (typeset(&why)) },
                        }
                    }
                }
                @for known in &reference.known {
                    tr {
                        td colspan="2" { "history: " (Label(&known.group.name)) }
                        @match &known.uncertainty {
                            Ok(bounds) => { td {} td.n { (or_dash(bounds.first().copied(), three)) } td colspan="2" {} }
                            Err(why) => td colspan="4" { "not established: " (typeset(why)) },
                        }
                    }
                }
            }
            p.small {
                "Uncertainty: that of the refinement (grid convergence index; of an ensemble its median), at least the \
                 distance to a second scheme and the change of the last halving of the step; plus the largest distance of \
                 a member from the median, plus a step for instants, plus twice what averaging over twice the window \
                 changes, for extremes and largest means. An order in brackets, above " (HIGHEST)
                ", shows that values do not converge regularly yet. "
                @if !reference.refines_mesh() {
                    "The mesh was not refined, so that nothing is established; " code { "mesh = [1, 2, 4]" } " in "
                    code { "[fine]" } " refines it."
                }
            }
        }
    }
}
