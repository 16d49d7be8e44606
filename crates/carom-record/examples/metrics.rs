//! Prints the table of metrics for the book.

#![allow(clippy::print_stdout)]

fn main() {
    print!("{}", carom_record::metrics::book_table());
}
