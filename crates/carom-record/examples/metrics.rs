//! Prints the table of metrics as the book shows it.

#![allow(clippy::print_stdout)]

fn main() {
    print!("{}", carom_record::metrics::book_table());
}
