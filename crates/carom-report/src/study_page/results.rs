//! Expectations and metrics on the page of a study.

use carom_record::study::{Row, Study};
use maud::{Markup, html};

use crate::by_arm;
use crate::collected::time_unit;
use crate::digits::five;
use crate::document::{codes, file, joined, minus, or_dash};
use crate::ordered::{distinct, grouped};
use crate::results::by_title;
use crate::round_off::Scales;
use crate::systems::Systems;
use crate::text::Label;

/// The unit of a metric, or of a reduction of one column, of the first arm named; empty for other
/// expressions.
fn unit_of_question(study: &Study, what: &str) -> String {
    let plain = what.split(" of \"").next().unwrap_or(what);
    let (form, column) = plain.rsplit_once(' ').unwrap_or(("", plain));
    if plain.contains(['[', '/', '*', '+']) || what.matches(" of \"").count() > 1 {
        return String::new();
    }
    let metrics = study.metrics();
    let unit = |name: &str| metrics.iter().find(|m| m.name == name).map(|m| m.unit.clone());
    let of_column = || unit(&format!("{column}:min"));
    match form.split(' ').next() {
        Some("") | None => unit(plain),
        Some("time") => Some(time_unit(study).to_owned()),
        Some("min" | "max" | "first" | "last" | "at" | "range" | "drift" | "peak" | "rms") => of_column(),
        _ => None,
    }
    .unwrap_or_default()
}

/// The expectations with their results; nothing for a study without.
pub(super) fn expectations(study: &Study, systems: &Systems) -> Markup {
    let arms = study.rows.iter().flat_map(|row| row.expectations.iter().map(move |e| (row.name.as_str(), e)));
    let all: Vec<_> = arms.chain(study.expectations.iter().map(|e| ("", e))).collect();
    let met = all.iter().filter(|(_, e)| e.pass).count();
    let table = met_by_arm(study);
    // Those of arms are in the units of their cases.
    let unit = |what: &str| {
        if systems.is_one() { unit_of_question(study, what) } else { String::new() }
    };
    let (of_arms, units) =
        (all.iter().any(|(arm, _)| !arm.is_empty()), all.iter().any(|(_, e)| !unit(&e.what).is_empty()));
    html! {
        @if !all.is_empty() {
            h2 { "Expectations" }
            p { (met) " of " (all.len()) " met." }
            @if let Some(table) = &table { (table) }
            details open[table.is_none()] {
                summary { "All expectations with their sources" }
                table.stack {
                    thead {
                        tr {
                            th { "Quantity" }
                            @if of_arms { th { "Arm" } }
                            th { "Expected" } th.n { "Result" }
                            @if units { th { "Unit" } }
                            th { "Met" } th { "Source" }
                        }
                    }
                    @for (arm, e) in all {
                        tr {
                            td {
                                code { (e.what) }
                                @if let Some(why) = &e.why { br; span.small { (why) } }
                            }
                            @if of_arms { td { (arm) } }
                            td { (minus(&e.expected)) }
                            td.n { (or_dash(e.got, five)) }
                            @if units { td.unit { (Label(&unit(&e.what))) } }
                            @if e.pass { td.pass { "yes" } } @else { td.miss { "missed" } }
                            td { @if let Some(source) = &e.source { (source) } }
                        }
                    }
                }
            }
        }
    }
}

/// Largest number of columns of tables by arm.
const COLUMNS: usize = 8;

/// Expectations by arm, one row per arm and one column per quantity, result above expected value;
/// nothing for fewer than three arms.
fn met_by_arm(study: &Study) -> Option<Markup> {
    let all = study.rows.iter().flat_map(|row| &row.expectations);
    let quantities = distinct(all.map(|e| e.what.as_str()));
    let arms: Vec<_> = study.rows.iter().filter(|row| !row.expectations.is_empty()).collect();
    if arms.len() < 3 || quantities.is_empty() || quantities.len() > COLUMNS {
        return None;
    }
    let cell = |row: &Row, quantity: &str| {
        let mine: Vec<_> = row.expectations.iter().filter(|e| e.what == quantity).collect();
        let class = if mine.iter().all(|e| e.pass) { "pass" } else { "miss" };
        let Some(first) = mine.first() else { return html! { td {} } };
        html! {
            td.n {
                span.(class) { (or_dash(first.got, five)) }
                br;
                span.small { (joined(mine.iter().map(|e| minus(&e.expected)), ", ")) }
            }
        }
    };
    Some(html! {
        table.metrics {
            thead { tr { th { "Arm" } @for quantity in &quantities { th.n { code { (quantity) } } } } }
            @for row in arms {
                tr { td { (row.name) } @for quantity in &quantities { (cell(row, quantity)) } }
            }
        }
    })
}

/// All metrics of all arms, folded.
pub(super) fn metrics(study: &Study, systems: &Systems) -> Markup {
    let mut shown = study.metrics();
    shown.retain(|m| study.rows.iter().any(|r| r.value(&m.name).is_some()));
    let scales = Scales::of(study);
    html! {
        h2 { "Metrics" }
        @for (title, members) in by_title(&shown) {
            details {
                summary { (title) " " span.small { "(" (joined(members.iter().map(|m| &m.name), ", ")) ")" } }
                (by_arm::tables(study, &members, COLUMNS, |arm, metric| {
                    html! { (or_dash(study.rows[arm].value(&metric.name), |v| scales.shown(metric, v, five))) }
                }))
                table {
                    // Metrics of columns have the same for every probe.
                    @for (definition, names) in grouped(members.iter().map(|m| (m.definition, &m.name))) {
                        tr { td { (codes(&names, ", ")) } td { (definition) } }
                    }
                }
            }
        }
        p.small {
            "Column headings are the numbers of the arms. "
            @if !systems.is_one() { "Values are in the units of the first arm. " }
            "Every value is computed from the directory of its \
             arm alone. Data in full precision: " (file("study.csv")) ", and with measured times \
             " (file("study_tidy.csv")) "."
        }
    }
}
