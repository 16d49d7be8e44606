//! Results of an ensemble: the median of every metric over the members of an arm, and their range.

use carom_record::Status;
use carom_record::metrics::Metric;
use carom_record::study::Study;
use maud::{Markup, html};

use super::numbers::by_arm;
use crate::digits::three;
use crate::document::file;
use crate::text::Label;

/// Nothing for a study without an ensemble.
pub(super) fn section(study: &Study) -> Markup {
    let Some(ensemble) = &study.manifest.ensemble else { return Markup::default() };
    let failed = study.members.iter().filter(|row| row.status == Some(Status::Failed)).count();
    let is_known = |metric: &&Metric| {
        !metric.is_work() && (0..study.rows.len()).any(|arm| study.spread(arm, &metric.name).is_some())
    };
    let metrics: Vec<&Metric> = study.metrics().into_iter().filter(is_known).collect();
    html! {
        p {
            "Every arm was run with " (ensemble.words()) "."
            @if failed > 0 { " " (failed) " of " (study.members.len()) " members failed and are omitted." }
        }
        details {
            summary { "Median and range of " (metrics.len()) " metrics" }
            // Three medians with their ranges are as wide as the page.
            (by_arm(study, &metrics, 3, |arm, metric| cell(study, arm, metric)))
            p.small { "With all digits: " (file("ensemble.csv")) "." }
        }
    }
}

/// Median and range of a metric over the members of an arm.
fn cell(study: &Study, arm: usize, metric: &Metric) -> Markup {
    let Some(spread) = study.spread(arm, &metric.name) else { return html! { "–" } };
    let (low, high) = spread.range();
    html! {
        (Label(&three(spread.median())))
        @if spread.count() > 1 { br; span.small { "(" (Label(&three(low))) " to " (Label(&three(high))) ")" } }
    }
}
