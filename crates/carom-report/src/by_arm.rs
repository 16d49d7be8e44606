//! Tables with a line for every metric and a column for every arm, in parts that are narrow enough
//! for print.

use carom_record::metrics::Metric;
use carom_record::study::Study;
use maud::{Markup, html};

use crate::text::Label;

/// The tables, each of at most `across` arms; `cell` is given the number of an arm.
pub(crate) fn tables(
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
                        td { code { (metric.name) } } td.unit { (Label(&metric.unit)) }
                        @for arm in part { td.n { (cell(*arm, metric)) } }
                    }
                }
            }
        }
    }
}
