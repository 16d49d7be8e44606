//! Numbers of the arms of a study: how each ended and its main metrics, all metrics, expectations.

use carom_record::Status;
use carom_record::metrics::Metric;
use carom_record::study::{Row, Study};
use maud::{Markup, html};

use super::collected::cells_of;
use super::comparison::style_of;
use super::trend;
use crate::digits::five;
use crate::document::{file, labelled, minus};
use crate::labels::with_unit;
use crate::plot::{APART, style};
use crate::text::{Label, typeset};

/// Metrics in the table of results.
const MAIN: usize = 6;
/// Arms side by side in a table of metrics.
const COLUMNS: usize = 8;

/// The arms with the metrics in which they differ.
pub(super) fn results(study: &Study) -> Markup {
    let mut metrics = study.metrics();
    metrics.retain(|metric| !metric.is_work() && differs(study, &metric.name));
    metrics.sort_by_key(|metric| trend::rank(&metric.name));
    metrics.truncate(MAIN);
    html! {
        div {
            table.metrics.ranking {
                thead {
                    tr {
                        th.n { "No." } th { "Line" } th { "Arm" } th { "Ended" }
                        @for metric in &metrics {
                            th.n title=(metric.definition) { (Label(&with_unit(&metric.name.replace('_', " "), &metric.unit.replace(' ', "\u{a0}")))) }
                        }
                        th.n { "Steps" }
                    }
                }
                @for (i, (row, arm)) in study.rows.iter().zip(&study.manifest.arms).enumerate() {
                    tr {
                        td.n { (i + 1) }
                        td { (line(style_of(study, i), row.is_unsound())) }
                        td.method {
                            a href={ (arm.directory) "/report.html" } { (row.name) }
                            @if study.manifest.reference.as_ref() == Some(&row.name) { " (reference)" }
                        }
                        (ended(study, i, row))
                        @for metric in &metrics { td.n { (result(row, metric)) } }
                        td.n { (arm.steps) }
                    }
                }
            }
        }
    }
}

/// A metric of an arm. Shares of the energy far below one are round-off.
fn result(row: &Row, metric: &Metric) -> Markup {
    const ROUND_OFF: f64 = 1e-12;
    match row.value(&metric.name) {
        Some(x) if metric.unit.is_empty() && x != 0.0 && x.abs() < ROUND_OFF => html! { "≈ 0" },
        value => labelled(value, five),
    }
}

/// Whether a metric has different values.
fn differs(study: &Study, name: &str) -> bool {
    let values: Vec<f64> = study.rows.iter().filter_map(|row| row.value(name)).collect();
    values.len() > 1 && !trend::is_constant(&values)
}

/// How an arm ended, and why.
fn ended(study: &Study, arm: usize, row: &Row) -> Markup {
    let (class, word) = match row.status {
        Some(Status::Finished) if row.is_unsound() => ("undecided", "finished, created energy"),
        Some(Status::Finished) => ("pass", "finished"),
        Some(Status::Failed) => ("miss", "failed"),
        Some(Status::Running | Status::Stopped) => ("undecided", "not finished"),
        None if row.is_damaged() => ("miss", "damaged"),
        None => ("undecided", "not started"),
    };
    html! {
        td.(class) {
            (word)
            @if let Some(reason) = &row.reason { br; span.small.plain { (typeset(reason)) } }
            @if let Some(others) = study.finished_alike(arm) { br; span.small.plain { (typeset(&others)) } }
        }
    }
}

/// The line of an arm in the figures.
fn line(number: usize, apart: bool) -> Markup {
    let color = if apart { APART } else { style(number).0 };
    html! {
        svg.line width="44" height="10" { path d="M1 5h42" stroke=(color) stroke-width="2" {} }
    }
}

/// The expectations with their results, open where one is missed.
pub(super) fn expectations(study: &Study) -> Markup {
    let arms = study.rows.iter().flat_map(|row| row.expectations.iter().map(move |e| (row.name.as_str(), e)));
    let all: Vec<_> = arms.chain(study.expectations.iter().map(|e| ("all", e))).collect();
    let met = all.iter().filter(|(_, e)| e.pass).count();
    html! {
        @if !all.is_empty() {
            details open[met < all.len()] {
                summary { (met) " of " (all.len()) " met" }
                table.stack {
                    thead {
                        tr {
                            th { "Quantity" } th { "Arm" } th { "Expected" } th.n { "Result" } th { "Met" } th { "Source" }
                        }
                    }
                    @for (arm, e) in all {
                        tr {
                            td {
                                code { (e.what) }
                                @if let Some(why) = &e.why { br; span.small { (why) } }
                            }
                            td { (arm) } td { (minus(&e.expected)) } td.n { (labelled(e.got, five)) }
                            @if e.pass { td.pass { "yes" } } @else { td.miss { "missed" } }
                            td { @if let Some(source) = &e.source { (source) } }
                        }
                    }
                }
            }
        }
    }
}

/// All metrics of all arms, folded.
pub(super) fn metrics(study: &Study) -> Markup {
    let mut shown = study.metrics();
    shown.retain(|metric| study.rows.iter().any(|row| row.value(&metric.name).is_some()));
    html! {
        details {
            summary { (shown.len()) " metrics of " (study.rows.len()) " arms" }
            (by_arm(study, &shown, COLUMNS, |arm, metric| {
                result(&study.rows[arm], metric)
            }))
            p.small {
                "Headings are the numbers of the arms. "
                @if !study.systems.is_one() { "Values are in the units of the first arm. " }
                "With all digits: " (file("study.csv")) "; with measured times: " (file("study_tidy.csv")) "."
            }
        }
    }
}

/// Tables with a line for every metric and a column for every arm, each of at most `across` arms,
/// so that they can be printed; `cell` is given the number of an arm.
pub(super) fn by_arm(
    study: &Study,
    metrics: &[&Metric],
    across: usize,
    cell: impl Fn(usize, &Metric) -> Markup,
) -> Markup {
    let arms: Vec<usize> = (0..study.rows.len()).collect();
    html! {
        @for part in arms.chunks(across) {
            table.metrics {
                thead { tr { th { "Metric" } th { "Unit" } @for arm in part { th.n { (arm + 1) } } } }
                @for metric in metrics {
                    tr {
                        (cells_of(metric))
                        @for arm in part { td.n { (cell(*arm, metric)) } }
                    }
                }
            }
        }
    }
}
