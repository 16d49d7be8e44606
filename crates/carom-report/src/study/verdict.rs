//! The recommendation of a study: the setting, its reasons, its cost and its side effects.

use carom_record::study::ranking::error;
use carom_record::study::reference::Established;
use carom_record::study::{Study, step};
use maud::{Markup, html};

use super::collected::{in_time, time_unit};
use crate::digits::{count, three};
use crate::document::{joined, or_dash};
use crate::labels::capitalised;
use crate::scientific::powers;
use crate::text::{Label, Prose, typeset};

/// Metrics whose error a user should know before following a recommendation.
const SIDE_EFFECTS: [(&str, &str); 8] = [
    ("energy_lost", "energy lost"),
    ("dissipated_integrator", "energy dissipated by the integrator"),
    ("dissipated_contact", "energy dissipated by contact"),
    ("impulse_x", "error of the x impulse"),
    ("impulse_y", "error of the y impulse"),
    ("impulse_z", "error of the z impulse"),
    ("contact_duration", "error of the contact duration"),
    ("restitution", "error of the restitution"),
];

/// The recommendation; nothing for a study without a goal.
pub(super) fn section(study: &Study) -> Markup {
    let Some(ranking) = &study.ranking else { return Markup::default() };
    let goal = format!("Goal: {} ({}).", ranking.goal.word(), ranking.goal.meaning());
    let verdict = match &ranking.verdict {
        Ok(verdict) => verdict,
        Err(reasons) => {
            return html! {
                div.verdict.none {
                    p { b { "No recommendation. " } (Prose(&goal)) }
                    ul { @for reason in reasons { li { (Label(&capitalised(reason))) "." } } }
                }
            };
        }
    };
    let arm = &study.manifest.arms[verdict.arm];
    // Settings of the output files are no part of the recommendation.
    let mut sets: Vec<String> =
        arm.sets_without_step().filter(|set| !set.starts_with("output.")).cloned().collect();
    // The step of a design is among the settings to copy.
    if arm.role.method.is_some() || sets.len() < arm.sets.len() {
        sets.extend(step(arm, "time.step").map(|h| format!("time.step={h}")));
    }
    let entry = |head: &str, lines: &[String]| {
        html! {
            dt { (head) }
            @for line in lines { dd { (Prose(&powers(&capitalised(&typeset(line))))) "." } }
        }
    };
    html! {
        div.verdict {
            p {
                b { "Recommended: " (Label(arm.method())) }
                @if let Some(h) = step(arm, "time.step") { b { ", Δt = " (Label(&in_time(study, h))) } }
                ", confidence: " b { (verdict.confidence.word()) }
                ". " (Prose(&goal))
            }
            div.beside {
                dl {
                    (entry("Reasons", &verdict.reasons))
                    @if !verdict.alike.is_empty() { (entry("Tied: not distinguished or within 5 %, at 1.1 times its cost at most", &[verdict.alike.join("; ")])) }
                    (entry("Confidence", &verdict.confidence_reasons))
                }
                dl {
                    @if !sets.is_empty() {
                        dt { "Settings" }
                        dd { (joined(sets.iter().map(|set| html! { code { (set) } }), html! { br; })) }
                    }
                    (entry("Cost", &[costs(study, verdict.arm)]))
                    (entry("Side effects (in brackets: smallest of its level)", &side_effects(study, verdict.arm)))
                }
            }
        }
    }
}

/// The values of ranked arms at the level of an arm, itself included.
fn of_level(study: &Study, arm: usize, value: impl Fn(usize) -> Option<f64>) -> Vec<f64> {
    let levels = study.ranking.iter().flat_map(|ranking| &ranking.levels);
    let level = levels.filter(|level| level.iter().any(|ranked| ranked.arm == arm));
    level.flatten().filter_map(|ranked| value(ranked.arm)).collect()
}

fn costs(study: &Study, arm: usize) -> String {
    let time = |arm: usize| study.rows[arm].value("cost");
    let least = of_level(study, arm, time).into_iter().fold(f64::INFINITY, f64::min);
    let against = time(arm).filter(|time| *time > least && least > 0.0);
    let against = against
        .map_or_else(String::new, |time| format!(" ({} times the lowest of its level)", three(time / least)));
    let of = |name: &str| or_dash(study.rows[arm].value(name), count);
    format!(
        "{} evaluations of the internal forces{against}; {} steps, {} Newton iterations, {} factorisations",
        or_dash(time(arm), three),
        of("steps"),
        of("newton_iterations"),
        of("factorisations")
    )
}

/// Known side effects of an arm, each with the smallest magnitude of its level.
fn side_effects(study: &Study, arm: usize) -> Vec<String> {
    let percent = |share: f64| format!("{} %", three(100.0 * share));
    let mut lines = Vec::new();
    for (metric, words) in SIDE_EFFECTS {
        let Ok(Established { value: right, uncertainty }) = study.standing(metric) else { continue };
        let is_energy = metric.starts_with("energy") || metric.starts_with("dissipated");
        // A relative error needs a nonzero reference; energies are fractions already.
        if right == 0.0 && !is_energy {
            continue;
        }
        let error_of = if right != 0.0 && is_energy { "error of the " } else { "" };
        let words = format!("{error_of}{words}");
        // Energies keep their sign: one that was created is no loss.
        let shown = |value: f64| if right == 0.0 { value } else { error(value, right) };
        let of = |arm: usize| study.rows[arm].value(metric).map(shown);
        let Some(own) = of(arm) else { continue };
        let values = of_level(study, arm, of);
        let least = values.into_iter().min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(own);
        let known = if right == 0.0 { 0.0 } else { uncertainty / right.abs() };
        lines.push(match () {
            () if own.abs() < known => {
                format!("{words}: below the uncertainty of the reference, {}", percent(known))
            }
            () if least.abs() < known => format!("{words}: {}", percent(own)),
            () => format!("{words}: {} ({})", percent(own), percent(least)),
        });
    }
    let late = study.compared.get(arm).and_then(|compared| compared.as_ref()?.late.as_ref());
    if let Some((column, late)) = late {
        let known = study.standing("contact_start").map_or(0.0, |known| known.uncertainty);
        let direction = if *late < 0.0 { "leads" } else { "lags" };
        let amount = if late.abs() < known {
            format!("less than the uncertainty of its instants, {}", three(known))
        } else {
            three(late.abs())
        };
        let unit = time_unit(study);
        lines.push(format!("the motion ({column}) {direction} the reference by {amount} {unit}"));
    }
    lines
}
