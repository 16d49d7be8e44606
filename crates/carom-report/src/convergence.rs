//! Convergence in a study: for every key in which arms differ by numbers alone, each metric by
//! step, its observed order, and the limit where an order is established ([`carom_record::order`]).

use carom_record::order::{self, MARGIN};
use carom_record::study::{Refinement, Study, numeric_keys};
use maud::{Markup, html};

use crate::document::or_dash;
use crate::labels::number;
use crate::text::Label;

/// Fewest steps that say something of an order.
const LEAST: usize = 3;

/// Metrics of the work say nothing of the solution.
const WORK: [&str; 4] = ["steps", "newton_iterations", "rejected_steps", "wall_time"];

/// The section; nothing for a study that refines nothing.
pub(crate) fn section(study: &Study) -> Markup {
    let keys = numeric_keys(&study.manifest, LEAST);
    html! {
        @if !keys.is_empty() {
            h2 { "Convergence" }
            @for (key, groups) in &keys {
                @for group in groups { (table(study, key, group)) }
            }
            p.small {
                "Order: from the differences of successive values, f = f₀ + C hᵖ solved for p at the three finest \
                 steps. An order counts as established where the estimates at the two finest triples of steps \
                 agree within " (MARGIN) "; then the limit is Richardson's extrapolation, and its band 1.25 times \
                 the distance of the finest value from it (P. J. Roache, J. Fluids Eng. 116, 1994)."
            }
        }
    }
}

fn table(study: &Study, key: &str, group: &Refinement) -> Markup {
    let mut metrics = study.metrics();
    metrics.retain(|m| !WORK.contains(&m.name.as_ref()));
    html! {
        h3 {
            "Against " code { (key) }
            @if key.ends_with("cells") { " (step: 1/cells)" }
            @if !group.common.is_empty() { ", " code { (group.common) } }
        }
        table.metrics {
            thead {
                tr {
                    th { "Metric" } th { "Unit" }
                    @for h in &group.steps { th.n { (number(*h)) } }
                    th.n { "Order" } th.n { "Limit" }
                }
            }
            @for metric in metrics {
                @let values: Vec<_> = group.arms.iter().map(|i| study.rows[*i].value(&metric.name)).collect();
                @if values.iter().any(Option::is_some) {
                    tr {
                        td { code { (metric.name) } }
                        td { (Label(&metric.unit)) }
                        @for value in &values { td.n { (or_dash(*value, number)) } }
                        (observed(&group.steps, &values))
                    }
                }
            }
        }
    }
}

/// The cells of the order and the limit.
fn observed(steps: &[f64], values: &[Option<f64>]) -> Markup {
    let known: Option<Vec<f64>> = values.iter().copied().collect();
    let limit = known.ok_or_else(|| "not every run has it".to_owned());
    html! {
        @match limit.and_then(|values| order::extrapolated(steps, &values)) {
            Ok(limit) => {
                td.n { (format_args!("{:.2}", limit.order)) }
                td.n { (number(limit.value)) " ± " (number(limit.band)) }
            }
            Err(why) => td colspan="2" { "no order " span.small { "(" (why) ")" } },
        }
    }
}
