//! Observed orders of the methods of a study before the first contact and after it.

use carom_record::Reason;
use carom_record::study::Study;
use maud::{Markup, html};

use crate::labels::capitalised;
use crate::text::{Label, typeset};

/// Tables with more rows are folded.
const FEW: usize = 12;

/// A number in a reason, without the comma behind it.
fn number(word: &str) -> Option<(&str, f64)> {
    let plain = word.trim_end_matches(',');
    plain.parse().ok().map(|value| (plain, value))
}

/// Whether two reasons differ in their numbers only.
fn is_alike(a: &str, b: &str) -> bool {
    let parts = |text: &str| -> Vec<String> {
        text.split(' ').map(|word| number(word).map_or(word, |_| "#").to_owned()).collect()
    };
    parts(a) == parts(b)
}

/// Reasons that differ in their numbers only, as one with ranges.
fn together(reasons: &[String]) -> String {
    let parts: Vec<Vec<&str>> = reasons.iter().map(|reason| reason.split(' ').collect()).collect();
    let range = |(k, word): (usize, &&str)| {
        let mut found: Vec<(&str, f64)> = parts.iter().filter_map(|words| number(words[k])).collect();
        found.sort_by(|a, b| a.1.total_cmp(&b.1));
        let comma = if word.ends_with(',') { "," } else { "" };
        match (found.first(), found.last()) {
            (Some(least), Some(most)) if least.1 < most.1 => format!("{} to {}{comma}", least.0, most.0),
            _ => (*word).to_owned(),
        }
    };
    let words: Vec<String> = parts.first().into_iter().flatten().enumerate().map(range).collect();
    words.join(" ")
}

/// Observed orders before the first contact and after it; why there is none is said below the
/// table.
pub(crate) fn section(study: &Study) -> Markup {
    let mut reasons: Vec<Vec<String>> = Vec::new();
    let mut cell = |order: &Result<f64, Reason>| {
        let why = match order {
            Ok(order) if *order >= 0.0 => return format!("{order:.2}"),
            Ok(_) => "errors grow with a shorter step".to_owned(),
            Err(why) => why.to_string(),
        };
        let at = reasons.iter().position(|known| is_alike(&known[0], &why)).unwrap_or_else(|| {
            reasons.push(Vec::new());
            reasons.len() - 1
        });
        reasons[at].push(why);
        format!("none^{{{}}}", at + 1)
    };
    let cells: Vec<[String; 2]> =
        study.phase_orders.iter().map(|o| [cell(&o.smooth), cell(&o.across)]).collect();
    html! {
        @if !study.phase_orders.is_empty() {
            h2 { "Order of convergence before and after the first contact" }
            details open[study.phase_orders.len() <= FEW] {
                summary { "Orders by method and quantity" }
                table {
                    thead { tr { th { "Method" } th { "Quantity" } th.n { "Before" } th.n { "After" } } }
                    @for (o, [before, after]) in study.phase_orders.iter().zip(&cells) {
                        tr {
                            td { (Label(&o.method)) } td { code { (o.column) } }
                            td.n { (Label(before)) } td.n { (Label(after)) }
                        }
                    }
                }
                @for (k, why) in reasons.iter().enumerate() {
                    p.small { sup { (k + 1) } " " (typeset(&capitalised(&together(why)))) "." }
                }
            }
            p.small {
                "Orders of the root mean square errors against the reference, from the two finest levels. \
                 Before: rows before the first contact of the reference. After: rows after the end of this \
                 contact."
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_with_other_numbers_are_one() {
        let reason = |error: &str, known: &str| format!("its error, {error}, is less than {known}");
        let all = [reason("1.1e-3", "9.6e-4"), reason("7.5e-4", "9.6e-4")];
        assert!(is_alike(&all[0], &all[1]) && !is_alike(&all[0], "exact up to round-off"));
        assert_eq!(together(&all), "its error, 7.5e-4 to 1.1e-3, is less than 9.6e-4");
    }
}
