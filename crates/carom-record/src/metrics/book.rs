//! The table of metrics for the book, and what each of them is.

use super::definition::Definition;
use super::evaluated::{of_any_column, of_no_column};
use super::overlay::OVERLAY;

/// All definitions as a Markdown table for the book.
pub fn book_table() -> String {
    let head = "| Metric | Definition | Formula | Unit | Source |\n| --- | --- | --- | --- | --- |\n";
    let rows = of_no_column().chain(&OVERLAY).map(|definition| row("", definition));
    rows.chain(of_any_column().map(|definition| row("COLUMN:", definition)))
        .fold(head.to_owned(), |text, row| text + &row)
}

/// Definition of a metric, in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Explanation {
    /// Name in expectations and studies, without that of a column.
    pub name: &'static str,
    /// Meaning, in one line.
    pub meaning: &'static str,
    /// Formula in columns of the history.
    pub formula: &'static str,
    /// Kind of unit, in words.
    pub unit: &'static str,
}

/// Every metric, those of columns and of measured data included.
///
/// ```
/// let all: Vec<_> = carom_record::metrics::explained().collect();
/// assert_eq!(all.iter().find(|of| of.name == "contact_duration").unwrap().formula, "t_b − t_a");
/// ```
pub fn explained() -> impl Iterator<Item = Explanation> {
    let all = of_no_column().chain(&OVERLAY).chain(of_any_column());
    all.map(|&Definition { name, unit, formula, meaning, .. }| Explanation {
        name,
        meaning,
        formula,
        unit: unit.word(),
    })
}

fn row(before: &str, Definition { name, unit, formula, source, meaning, .. }: &Definition) -> String {
    // As Markdown would otherwise end a cell, or set text between two signs in italics.
    let escape = |text: &str| text.replace('|', "\\|").replace('_', "\\_").replace('*', "\\*");
    let [meaning, formula, source] = [meaning, formula, source].map(|text| escape(text));
    format!("| `{before}{name}` | {meaning} | {formula} | {} | {source} |\n", unit.word())
}
