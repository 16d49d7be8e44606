//! What an ensemble shows: the median of every metric over the members of an arm, and their range.

use carom_record::Status;
use carom_record::study::Study;
use maud::{Markup, html};

use crate::digits::three;
use crate::document::file;
use crate::text::Label;

/// Nothing for a study without an ensemble.
pub(crate) fn section(study: &Study) -> Markup {
    let Some(ensemble) = &study.manifest.ensemble else { return Markup::default() };
    let failed = study.members.iter().filter(|row| row.status == Some(Status::Failed)).count();
    let metrics = study.metrics().into_iter().filter(|m| !m.is_work());
    let metrics: Vec<_> = metrics.collect();
    html! {
        h2 { "Ensemble" }
        p {
            "Every arm was run with " (ensemble.words()) ". Given are the median and, in brackets, the range."
            @if failed > 0 { " " (failed) " of " (study.members.len()) " members failed and are left out." }
        }
        details {
            summary { (metrics.len()) " metrics of " (study.rows.len()) " arms" }
            table {
                thead {
                    tr {
                        th { "Metric" } th { "Unit" } @for row in &study.rows { th.n { (row.name) } }
                    }
                }
                @for metric in metrics {
                    tr {
                        td { code { (metric.name) } } td { (Label(&metric.unit)) }
                        @for arm in 0..study.rows.len() {
                            td.n {
                                @match study.spread(arm, &metric.name) {
                                    Some(spread) => {
                                        @let (low, high) = spread.range();
                                        (three(spread.median()))
                                        @if spread.count() > 1 {
                                            br; span.small { "(" (three(low)) " to " (three(high)) ")" }
                                        }
                                    },
                                    None => "–",
                                }
                            }
                        }
                    }
                }
            }
            p.small { "Data in full precision: " (file("ensemble.csv")) "." }
        }
    }
}
