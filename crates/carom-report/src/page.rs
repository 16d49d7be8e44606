//! `report.html`: the page of a run in one file, for screen and print.

use std::collections::BTreeMap;

use carom_record::{Status, Warning};
use maud::{Markup, PreEscaped, html};
use serde_json::Value;

use crate::document::{figure, framed};
use crate::expectations::expectations;
use crate::figure::Figure;
use crate::figures::Shown;
use crate::headline::headline;
use crate::made::made;
use crate::recorded::Recorded;
use crate::results::results;
use crate::scientific::powers;
use crate::stopped;
use crate::text::{Label, Prose, typeset};

/// A part of the page, with its heading and its name in links; without a heading it is in no table
/// of contents.
struct Section {
    id: &'static str,
    title: &'static str,
    body: Markup,
}

/// The page.
pub(crate) fn page(run: &Recorded, shown: &Shown) -> String {
    let title = if run.case.title.is_empty() { "Carom run" } else { &run.case.title };
    let numbered = || shown.figures.iter().enumerate();
    let place = numbered().find(|(_, f)| f.name == "stopped").map(figure);
    let others: Vec<(usize, &Figure)> = numbered().filter(|(_, f)| f.name != "stopped").collect();
    let has_expectations = !run.manifest.expectations.is_empty();
    let is_said = |warning: &&Warning| run.stop.is_some() && stopped::cause(warning).is_some();
    let warnings: Vec<&Warning> = run.manifest.warnings.iter().filter(|warning| !is_said(warning)).collect();
    let sections = [
        run.stop.as_ref().map(|_| Section {
            id: "stop",
            title: "Why it stopped",
            body: stopped::section(run, place),
        }),
        Some(Section { id: "picture", title: "", body: picture(run, shown) }),
        (!warnings.is_empty()).then(|| Section {
            id: "warnings",
            title: "Warnings",
            body: html! { @for warning in &warnings { (warning_line(warning)) } },
        }),
        has_expectations.then(|| Section {
            id: "expectations",
            title: "Expectations",
            body: expectations(run),
        }),
        (!others.is_empty()).then(|| Section { id: "figures", title: "Figures", body: figures(&others) }),
        Some(Section {
            id: "metrics",
            title: "All metrics",
            body: html! { details { summary { "Table" } (results(run)) } },
        }),
        Some(Section { id: "made", title: "How the run was made", body: made(run) }),
    ];
    let sections: Vec<Section> = sections.into_iter().flatten().collect();
    let titles: Vec<&str> = others.iter().map(|(_, f)| f.title.as_str()).collect();
    let body = html! {
        (contents(&sections, &titles))
        main {
            h1 { (title) " " (status(run)) }
            @for note in &shown.notes { p.small { (note) } }
            @for section in &sections {
                section id=(section.id) {
                    @if !section.title.is_empty() { h2 { (section.title) } }
                    (section.body)
                }
            }
        }
        (scripts(shown))
    };
    framed(title, "", "run", &body)
}

/// The picture, and the numbers that a reader wants first.
fn picture(run: &Recorded, shown: &Shown) -> Markup {
    html! {
        @if let Some(scene) = &shown.scene { (scene.figure) }
        (headline(run, shown.scene.as_ref()))
    }
}

fn figures(figures: &[(usize, &Figure)]) -> Markup {
    html! {
        @for (k, (number, each)) in figures.iter().enumerate() {
            div id=(format_args!("figure-{}", k + 1)) {
                h3 { (each.title) }
                (figure((*number, *each)))
            }
        }
    }
}

/// Links to the sections and figures.
fn contents(sections: &[Section], figures: &[&str]) -> Markup {
    html! {
        nav.contents {
            details {
                summary { "Contents" }
                ul {
                    @for section in sections.iter().filter(|section| !section.title.is_empty()) {
                        li {
                            a href=(format_args!("#{}", section.id)) { (section.title) }
                            @if section.id == "figures" {
                                ul {
                                    @for (k, title) in figures.iter().enumerate() {
                                        li { a href=(format_args!("#figure-{}", k + 1)) { (title) } }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn warning_line(warning: &Warning) -> Markup {
    let Warning { id, place, what, why, advice } = warning;
    html! {
        p {
            b.miss { (typeset(place)) } ": " (Label(&powers(&typeset(what)))) "; " (Label(&typeset(why))) ". Try "
            (Prose(&typeset(advice))) ". " span.small { "(" code { (id) } ")" }
        }
    }
}

/// How the run ended.
fn status(run: &Recorded) -> Markup {
    let m = &run.manifest;
    let missed = m.expectations.iter().filter(|expectation| !expectation.pass).count();
    let (class, word) = match m.status {
        Status::Running => ("running", "running or interrupted; can be resumed".to_owned()),
        Status::Finished if missed > 0 => {
            ("failed", format!("finished; {missed} of {} expectations missed", m.expectations.len()))
        }
        Status::Finished => ("finished", "finished".to_owned()),
        Status::Stopped => ("stopped", "stopped; can be resumed".to_owned()),
        Status::Failed if run.stop.is_some() => ("failed", "stopped by an error".to_owned()),
        Status::Failed => ("failed", "failed".to_owned()),
    };
    html! {
        span.status.(class) { (word) }
        @if let Some(reason) = m.reason.as_ref().filter(|_| run.stop.is_none()) {
            " " span.small { (Label(&powers(&typeset(reason)))) }
        }
    }
}

/// The numbers of the charts and of the scene, and the script that shows them.
fn scripts(shown: &Shown) -> Markup {
    let charts: BTreeMap<&str, &Value> = shown
        .figures
        .iter()
        .filter_map(|figure| Some((figure.name.as_str(), figure.data.as_ref()?)))
        .collect();
    // Only `<` could end the script element.
    let data = |value: &str| PreEscaped(value.replace('<', "\\u003c"));
    let charts = serde_json::to_string(&charts).unwrap_or_default();
    html! {
        @if !shown.figures.is_empty() {
            script #charts-data type="application/json" { (data(&charts)) }
            @if let Some(scene) = &shown.scene { script #animation-data type="application/json" { (data(&scene.data.to_string())) } }
            script {
                (PreEscaped(include_str!("page.js")))
                @if shown.scene.is_some() {
                    (PreEscaped(include_str!("scene.js")))
                    "scene(document.getElementById('animation'), JSON.parse(document.getElementById('animation-data').textContent));"
                }
            }
        }
    }
}
