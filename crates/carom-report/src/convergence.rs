//! Convergence in a study. For every key whose numerical value alone differs between arms: each
//! metric by step, its observed order, and the limit where the order is established
//! ([`carom_record::order`]).

use carom_record::Reason;
use carom_record::metrics::Metric;
use carom_record::order::{self, MARGIN};
use carom_record::study::{Refinement, Study, numeric_keys};
use maud::{Markup, html};

use crate::digits::{five, three};
use crate::document::or_dash;
use crate::labels::number;
use crate::settings::own_settings;
use crate::text::Label;

/// Fewest steps that are shown, and fewest from which an order can be established.
const LEAST: usize = 3;
const ENOUGH: usize = 4;

/// The section of the page; nothing for a study without refinement.
pub(crate) fn section(study: &Study) -> Markup {
    let keys = numeric_keys(&study.manifest, LEAST);
    html! {
        @if !keys.is_empty() {
            h2 { "Convergence" }
            @for (key, groups) in &keys {
                @for group in groups { (table(study, key, group)) }
            }
            @if keys.values().flatten().any(|group| group.steps.len() < ENOUGH) {
                p { "An order needs four steps; a table of three has none." }
            }
            @if keys.values().flatten().any(|group| group.steps.len() >= ENOUGH) {
            p.small {
                "Order: the exponent p of f = f₀ + C hᵖ through the three finest steps. An order is \
                 established where the estimates from the two finest triples of steps agree within " (MARGIN)
                ". The limit is then Richardson's extrapolation, and its uncertainty 1.25 times the distance \
                 of the finest value from it (P. J. Roache, J. Fluids Eng. 116, 1994)."
            }
            }
        }
    }
}

fn table(study: &Study, key: &str, group: &Refinement) -> Markup {
    let mut metrics = study.metrics();
    let values = |m: &Metric| group.arms.iter().map(|i| study.rows[*i].value(&m.name)).collect::<Vec<_>>();
    metrics.retain(|m| !m.is_work() && values(m).iter().any(Option::is_some));
    let common = own_settings(study, &group.common);
    let enough = group.steps.len() >= ENOUGH;
    html! {
        h3 {
            "Refinement of " code { (key) }
            @if key.ends_with("cells") { " (step: 1/cells)" }
            @if key == "refine" { " (step: 1/refine)" }
            @if !common.is_empty() { ", " code { (common) } }
        }
        details {
        summary { (metrics.len()) " metrics" }
        table.metrics {
            thead {
                tr {
                    th { "Metric" } th { "Unit" }
                    @for h in &group.steps { th.n { (number(*h)) } }
                    @if enough { th.n { "Order" } th.n { "Limit" } }
                }
            }
            @for metric in metrics {
                @let values = values(metric);
                tr {
                    td { code { (metric.name) } } td.unit { (Label(&metric.unit)) }
                    @for value in &values { td.n { (or_dash(*value, five)) } }
                    @if enough { (observed(&group.steps, &values)) }
                }
            }
        }
        }
    }
}

/// The cells of the observed order and the limit.
fn observed(steps: &[f64], values: &[Option<f64>]) -> Markup {
    let known: Option<Vec<f64>> = values.iter().copied().collect();
    let known = known.ok_or_else(|| Reason::from("not available in every run"));
    html! {
        @match known.and_then(|values| order::extrapolated(steps, &values)) {
            Ok(limit) => {
                td.n { (format_args!("{:.2}", limit.order)) }
                td.n { (five(limit.value)) " ± " (three(limit.band)) }
            }
            Err(why) => td colspan="2" { "no order " span.small { "(" (why) ")" } },
        }
    }
}
