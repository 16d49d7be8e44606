//! What an ensemble shows: the median of every metric over the members of an arm, and their range.

use carom_record::Status;
use carom_record::metrics::Metric;
use carom_record::study::Study;
use maud::{Markup, html};

use crate::by_arm;
use crate::digits::three;
use crate::document::file;
use crate::round_off::Scales;

/// Nothing for a study without an ensemble.
pub(crate) fn section(study: &Study) -> Markup {
    let Some(ensemble) = &study.manifest.ensemble else { return Markup::default() };
    let failed = study.members.iter().filter(|row| row.status == Some(Status::Failed)).count();
    let known = |name: &str| (0..study.rows.len()).any(|arm| study.spread(arm, name).is_some());
    let metrics = study.metrics().into_iter().filter(|m| !m.is_work() && known(&m.name));
    let metrics: Vec<_> = metrics.collect();
    let scales = Scales::of(study);
    html! {
        h2 { "Ensemble" }
        p {
            "Every arm was run with " (ensemble.words()) ". The table gives the median and, in brackets, the \
                range; headings are the numbers of the arms."
            @if failed > 0 { " " (failed) " of " (study.members.len()) " members failed and are omitted." }
        }
        details {
            summary { (metrics.len()) " metrics of " (study.rows.len()) " arms" }
            // Four medians with their ranges are as wide as the page.
            (by_arm::tables(study, &metrics, 4, |arm, metric| cell(study, &scales, arm, metric)))
            p.small { "Data in full precision: " (file("ensemble.csv")) "." }
        }
    }
}

/// Median and range of a metric over the members of an arm.
fn cell(study: &Study, scales: &Scales, arm: usize, metric: &Metric) -> Markup {
    let Some(spread) = study.spread(arm, &metric.name) else { return html! { "–" } };
    let (low, high) = spread.range();
    let shown = |value| scales.shown(metric, value, three);
    html! {
        (shown(spread.median()))
        @if spread.count() > 1 { br; span.small { "(" (shown(low)) " to " (shown(high)) ")" } }
    }
}
