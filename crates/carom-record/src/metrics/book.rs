//! The table of metrics for the book.

use super::definition::Definition;
use super::table::{COLUMNS, FREE, HISTORY, PRESSURE, WORK};

/// All definitions as a Markdown table for the book.
pub fn book_table() -> String {
    let history = HISTORY.iter().map(|x| (String::new(), &x.0));
    let columns = COLUMNS.iter().chain(&FREE).map(|x| ("COLUMN:".to_owned(), &x.0));
    let all = history.chain(columns).chain(PRESSURE.iter().chain(&WORK).map(|x| (String::new(), &x.0)));
    let escape = |text: &str| text.replace('|', "\\|");
    let row = |(before, d): (String, &Definition)| {
        format!(
            "| `{before}{}` | {} | {} | {} | {} |\n",
            d.name,
            d.meaning,
            escape(d.formula),
            d.unit.word(),
            d.source
        )
    };
    let head = "| Metric | Definition | Formula | Unit | Source |\n| --- | --- | --- | --- | --- |\n";
    all.fold(head.to_owned(), |text, one| text + &row(one))
}
