//! The table of metrics for the book.

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

fn row(before: &str, Definition { name, unit, formula, source, meaning, .. }: &Definition) -> String {
    // As Markdown would otherwise end a cell, or set text between two signs in italics.
    let escape = |text: &str| text.replace('|', "\\|").replace('_', "\\_").replace('*', "\\*");
    let [meaning, formula, source] = [meaning, formula, source].map(|text| escape(text));
    format!("| `{before}{name}` | {meaning} | {formula} | {} | {source} |\n", unit.word())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_five_cells_and_no_emphasis() {
        for line in book_table().lines().skip(2) {
            let bare = line.replace("\\|", "").replace("\\_", "").replace("\\*", "");
            assert_eq!(bare.matches('|').count(), 6, "{line}");
            let code = bare.split('`').skip(2).collect::<String>();
            assert!(!code.contains(['_', '*']), "{line}");
        }
    }
}
