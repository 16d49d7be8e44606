//! Convergence in a study. For every key whose numerical value alone differs between arms: each
//! metric by step, its observed order, and the limit where the order is established
//! ([`carom_record::order`]); and the orders of the methods against the reference.

use carom_record::Reason;
use carom_record::order::{self, MARGIN};
use carom_record::study::{Refinement, Study, count, refined_keys, step};
use maud::{Markup, html};

use super::collected::cells_of;
use super::settings::own_settings;
use crate::digits::{five, three};
use crate::document::labelled;
use crate::labels::number;
use crate::text::{Label, typeset};

/// Fewest steps that are shown, and fewest from which an order can be established.
const LEAST: usize = 3;
const ENOUGH: usize = 4;

/// The section of the page; nothing for a study without refinement.
pub(super) fn section(study: &Study) -> Markup {
    let keys = refined_keys(&study.manifest, LEAST, step);
    let is_enough = |group: &Refinement| group.steps.len() >= ENOUGH;
    html! {
        @for (key, groups) in &keys {
            @for group in groups { (table(study, key, group)) }
        }
        @if keys.values().flatten().any(|group| !is_enough(group)) { p.small { "An order needs four steps." } }
        @if keys.values().flatten().any(is_enough) {
            p.small {
                "Order: the exponent p of f = f₀ + C hᵖ through the three finest steps, established where the \
                 estimates from the two finest triples of steps agree within " (MARGIN) ". Limit: Richardson's \
                 extrapolation ± 1.25 times its distance from the finest value (P. J. Roache, J. Fluids Eng. 116, 1994)."
            }
        }
        (phases(study))
    }
}

fn table(study: &Study, key: &str, group: &Refinement) -> Markup {
    let mut metrics = study.metrics();
    let values = |name: &str| group.arms.iter().map(|i| study.rows[*i].value(name)).collect::<Vec<_>>();
    metrics.retain(|metric| !metric.is_work() && values(&metric.name).iter().any(Option::is_some));
    let common = own_settings(study, &group.common);
    let enough = group.steps.len() >= ENOUGH;
    html! {
        details {
            summary {
                "Refinement of " code { (key) }
                @if let Some(counted) = count(key) { " (step: 1/" (counted) ")" }
                @if !common.is_empty() { ", " code { (common.join(", ")) } }
            }
            table.metrics {
                thead {
                    tr {
                        th { "Metric" } th { "Unit" }
                        @for h in &group.steps { th.n { (number(*h)) } }
                        @if enough { th.n { "Order" } th.n { "Limit" } }
                    }
                }
                @for metric in metrics {
                    @let values = values(&metric.name);
                    tr {
                        (cells_of(metric))
                        @for value in &values { td.n { (labelled(*value, five)) } }
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
                td.n { (Label(&five(limit.value))) " ± " (Label(&three(limit.band))) }
            }
            Err(why) => td colspan="2" { "no order " span.small { "(" (why) ")" } },
        }
    }
}

/// Observed orders before the first contact and after it.
fn phases(study: &Study) -> Markup {
    let cell = |order: &Result<f64, Reason>| match order {
        Ok(order) if *order >= 0.0 => html! { td.n { (format_args!("{order:.2}")) } },
        Ok(_) => html! { td { "none " span.small { "(errors grow with a shorter step)" } } },
        Err(why) => html! { td { "none " span.small { "(" (typeset(why)) ")" } } },
    };
    html! {
        @if !study.phase_orders.is_empty() {
            details {
                summary { "Orders before and after the first contact" }
                table.metrics {
                    thead { tr { th { "Method" } th { "Quantity" } th.n { "Before" } th.n { "After" } } }
                    @for order in &study.phase_orders {
                        tr {
                            td { (Label(&order.method)) } td { code { (order.column) } }
                            (cell(&order.smooth)) (cell(&order.across))
                        }
                    }
                }
                p.small {
                    "Of the root mean square errors against the reference at the two finest levels: before the first \
                     contact of the reference, and after its end."
                }
            }
        }
    }
}
