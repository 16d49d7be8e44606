//! "Expectations": what the case expects of the run, and what came out.

use carom_record::{Expectation, Sizes};
use maud::{Markup, html};

use crate::asked;
use crate::document::{minus, or_dash};
use crate::ordered::distinct;
use crate::recorded::Recorded;
use crate::scientific::{powers, significant};
use crate::text::Label;

/// Significant digits of a result beside its tolerance.
const DIGITS: usize = 6;

/// An expected value with its tolerance, which stay on one line.
fn expected(text: &str) -> String {
    let exact = text.strip_suffix(" ± 0").map_or_else(|| text.to_owned(), |value| format!("= {value}"));
    powers(&minus(&exact)).replace(" ± ", "\u{a0}±\u{a0}").replace(" %", "\u{a0}%")
}

/// Sources of more than one expectation that are too long to be repeated.
fn repeated_sources(run: &Recorded) -> Vec<&String> {
    let sources = || run.manifest.expectations.iter().filter_map(|e| e.source.as_ref());
    let is_repeated = |source: &&String| sources().filter(|other| other == source).count() > 1;
    distinct(sources().filter(|source| source.chars().count() > 40).filter(is_repeated))
}

/// Whether a result is round-off of its quantity, and its tolerance is not of that size.
fn is_zero(run: &Recorded, e: &Expectation) -> bool {
    let (Some(got), Some(unit)) = (e.got, asked::unit(run, &e.what).filter(|unit| !unit.is_empty())) else {
        return false;
    };
    Sizes::of(run).is_round_off(got, &unit) && e.tolerance.is_none_or(|tolerance| tolerance > got.abs())
}

/// The section of the page; nothing where the case has none.
pub(crate) fn expectations(run: &Recorded) -> Markup {
    let all = &run.manifest.expectations;
    let repeated = repeated_sources(run);
    html! {
        @if !all.is_empty() {
            table.expectations {
                thead {
                    tr {
                        th { "Quantity" } th { "Expected" } th.n { "Result" } th { "Unit" } th { "Verdict" }
                        th { "Source" }
                    }
                }
                @for e in all {
                    tr {
                        td { code { (e.what) } } td.expected { (Label(&expected(&e.expected))) }
                        td.n {
                            @if is_zero(run, e) { "≈ 0" } @else { (Label(&or_dash(e.got, |x| significant(x, DIGITS)))) }
                        }
                        // A dash for numbers, nothing where it is not known.
                        td.unit {
                            @if let Some(unit) = asked::unit(run, &e.what) {
                                @if unit.is_empty() { "–" } @else { (Label(&unit)) }
                            }
                        }
                        @if e.pass { td.pass { "met" } } @else { td.miss { "missed" } }
                        td {
                            @if let Some(source) = &e.source {
                                @if let Some(k) = repeated.iter().position(|other| *other == source) {
                                    "[" (k + 1) "]"
                                } @else { (Label(source)) }
                            }
                        }
                    }
                }
            }
            @for (k, source) in repeated.iter().enumerate() { p.small { "[" (k + 1) "] " (Label(source)) } }
        }
    }
}
