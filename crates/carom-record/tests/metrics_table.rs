//! The book's table of metrics is the one in the code.

use carom_record::metrics::book_table;

#[test]
fn the_book_has_every_metric() {
    let book = include_str!("../../../docs/book/src/generated/metrics.md");
    let how = "cargo run -p carom-record --example metrics > docs/book/src/generated/metrics.md";
    assert_eq!(book.trim(), book_table().trim(), "{how}");
}
