//! The set-up of a study: the drawing of the case, the settings of the arms, and the design.

use carom_record::study::design::Kind;
use carom_record::study::{Arm, Study};
use maud::{Markup, html};

use super::collected::in_time;
use crate::digits::three;
use crate::document::{codes, figure};
use crate::figure::Figure;
use crate::setup;
use crate::text::Label;

/// Arms other than those of a computed reference, with their numbers.
fn arms(study: &Study) -> impl Iterator<Item = (usize, &Arm)> {
    study.manifest.arms.iter().enumerate().filter(|(_, arm)| !arm.role.fine)
}

/// Settings that all arms have.
fn shared(study: &Study) -> Vec<&String> {
    let is_shared = |set: &&String| arms(study).all(|(_, arm)| arm.sets.contains(set));
    let first = arms(study).next().filter(|_| study.manifest.arms.len() > 1);
    first.into_iter().flat_map(|(_, arm)| &arm.sets).filter(is_shared).collect()
}

/// Those of some settings that not all arms have.
pub(super) fn own_settings<'a>(study: &Study, settings: &'a [String]) -> Vec<&'a str> {
    let shared = shared(study);
    settings.iter().filter(|set| !shared.contains(set)).map(String::as_str).collect()
}

/// The section of the page.
pub(super) fn section(study: &Study, picture: Option<&Figure>) -> Markup {
    let manifest = &study.manifest;
    let case = manifest.arms.first().and_then(|arm| carom_case::Case::from_json(arm.case.clone()).ok());
    let shared = shared(study);
    html! {
        details {
            summary { "The case " code { (manifest.source.case_path) } }
            @match (picture, case) {
                (Some(picture), _) => (figure((0, picture))),
                (None, Some(case)) => (setup::table(&case, None)),
                (None, None) => {}
            }
        }
        details {
            summary { "Settings of the arms" }
            @if !shared.is_empty() { p { "In all arms: " (codes(&shared, ", ")) } }
            (table(study))
        }
        (design(study))
    }
}

/// A row for each arm with its own settings.
fn table(study: &Study) -> Markup {
    html! {
        table.stack {
            thead { tr { th.n { "No." } th { "Arm" } th { "Settings" } } }
            @for (i, arm) in arms(study) {
                tr {
                    td.n { (i + 1) } td { (arm.name) }
                    td {
                        @if let Some(path) = &arm.case_path { "case " code { (path) } br; }
                        (codes(&own_settings(study, &arm.sets), html! { br; }))
                    }
                }
            }
        }
    }
}

/// The design, which makes the arms comparable: equal time steps or equal costs.
fn design(study: &Study) -> Markup {
    let manifest = &study.manifest;
    let Some(design) = &manifest.design else {
        return html! {
            @if study.ranking.is_some() { p { "Neither time steps nor costs of the arms were matched." } }
        };
    };
    let levels = design.steps.iter().enumerate();
    let levels: Vec<String> =
        levels.map(|(i, h)| format!("level {}: Δt = {}", i + 1, in_time(study, *h))).collect();
    let missed: Vec<String> = manifest
        .off_budget()
        .map(|arm| {
            let share = arm.role.cost.map_or_else(|| "unknown".to_owned(), three);
            format!("{} ({share})", arm.name)
        })
        .collect();
    let is_cost = design.kind == Kind::MatchedCost;
    html! {
        p {
            @if is_cost { "Matched cost" } @else { "Matched step" } " (" (Label(&levels.join(", "))) "). "
            @if is_cost || manifest.arms.iter().any(|arm| manifest.by_cost(arm)) {
                "An arm matched by cost has the time step at which its cost equals that of " b { (design.cost_of) }
                " at its level, counted from its steps, iterations and factorisations (trials: " code { "pilots/" } ")."
            }
        }
        @if !missed.is_empty() {
            p {
                span.miss { "More than 10 % off the budget" } " (share of it in brackets): "
                (missed.join("; ")) "."
            }
        }
    }
}
