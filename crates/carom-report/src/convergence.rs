//! Convergence in a study: for every key in which arms differ by numbers alone, each metric by
//! step, its observed order, and the limit where an order is established ([`carom_record::order`]).

use std::fmt::Write as _;

use carom_record::order::{self, MARGIN};
use carom_record::study::{Refinement, Study, numeric_keys};

use crate::labels::number;
use crate::text::{escape, html};

/// Fewest steps that say something of an order.
const LEAST: usize = 3;

/// Metrics of the work say nothing of the solution.
const WORK: [&str; 4] = ["steps", "newton_iterations", "rejected_steps", "wall_time"];

/// Adds the tables; nothing for a study that refines nothing.
pub(crate) fn show(out: &mut String, study: &Study) {
    let keys = numeric_keys(&study.manifest, LEAST);
    if keys.is_empty() {
        return;
    }
    out.push_str("<h2>Convergence</h2>\n");
    for (key, groups) in &keys {
        for group in groups {
            table(out, study, key, group);
        }
    }
    let _ = writeln!(
        out,
        "<p class=\"small\">Order: from the differences of successive values, f = f₀ + C hᵖ solved for p at the three finest steps. An order counts as \
         established where the estimates at the two finest triples of steps agree within {MARGIN}; then the limit is Richardson's extrapolation, \
         and its band 1.25 times the distance of the finest value from it (P. J. Roache, J. Fluids Eng. 116, 1994).</p>"
    );
}

fn table(out: &mut String, study: &Study, key: &str, group: &Refinement) {
    let common = if group.common.is_empty() {
        String::new()
    } else {
        format!(", <code>{}</code>", escape(&group.common))
    };
    let counted = if key.ends_with("cells") { " (step: 1/cells)" } else { "" };
    let _ = writeln!(out, "<h3>Against <code>{}</code>{counted}{common}</h3>", escape(key));
    let steps = group
        .steps
        .iter()
        .fold(String::new(), |row, h| row + &format!("<th class=\"n\">{}</th>", number(*h)));
    let _ = writeln!(
        out,
        "<table class=\"metrics\">\n<thead><tr><th>Metric</th><th>Unit</th>{steps}<th class=\"n\">Order</th><th class=\"n\">Limit</th></tr></thead>"
    );
    for metric in study.metrics().into_iter().filter(|m| !WORK.contains(&m.name.as_ref())) {
        let values: Vec<Option<f64>> =
            group.arms.iter().map(|i| study.rows[*i].value(&metric.name)).collect();
        if values.iter().all(Option::is_none) {
            continue;
        }
        let cells = values.iter().map(|v| format!("<td class=\"n\">{}</td>", v.map_or("–".into(), number)));
        let known: Option<Vec<f64>> = values.iter().copied().collect();
        let end = match known {
            Some(values) => verdict(&group.steps, &values),
            None => no("not every run has it"),
        };
        let (name, unit) = (escape(&metric.name), html(&metric.unit));
        let _ = writeln!(
            out,
            "<tr><td><code>{name}</code></td><td>{unit}</td>{}{end}</tr>",
            cells.collect::<String>()
        );
    }
    out.push_str("</table>\n");
}

fn verdict(steps: &[f64], values: &[f64]) -> String {
    match order::extrapolated(steps, values) {
        Ok(limit) => format!(
            "<td class=\"n\">{:.2}</td><td class=\"n\">{} ± {}</td>",
            limit.order,
            number(limit.value),
            number(limit.band)
        ),
        Err(why) => no(&why),
    }
}

fn no(why: &str) -> String {
    format!("<td colspan=\"2\">no order <span class=\"small\">({})</span></td>", escape(why))
}
