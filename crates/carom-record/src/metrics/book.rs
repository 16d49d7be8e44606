//! The table of metrics for the book.

use super::definition::Definition;
use super::overlay::OVERLAY;
use super::run_table::{PRESSURE, REBOUND, WORK};
use super::table::{COLUMNS, FREE, HISTORY};

/// All definitions as a Markdown table for the book.
pub fn book_table() -> String {
    let history = HISTORY.iter().map(|x| (String::new(), &x.0));
    let columns = COLUMNS.iter().chain(&FREE).map(|x| ("COLUMN:".to_owned(), &x.0));
    let measured = OVERLAY.iter().map(|x| (String::new(), &x.0));
    let all = history
        .chain(columns)
        .chain(measured)
        .chain(REBOUND.iter().chain(&PRESSURE).chain(&WORK).map(|x| (String::new(), &x.0)));
    // As Markdown would otherwise end a cell, or set text between two signs in italics.
    let escape = |text: &str| text.replace('|', "\\|").replace('_', "\\_").replace('*', "\\*");
    let row = |(before, d): (String, &Definition)| {
        format!(
            "| `{before}{}` | {} | {} | {} | {} |\n",
            d.name,
            escape(d.meaning),
            escape(d.formula),
            d.unit.word(),
            escape(d.source)
        )
    };
    let head = "| Metric | Definition | Formula | Unit | Source |\n| --- | --- | --- | --- | --- |\n";
    all.fold(head.to_owned(), |text, one| text + &row(one))
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
