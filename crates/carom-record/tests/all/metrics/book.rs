//! The table of metrics for the book, and what each of them is.

use carom_record::metrics::book_table;

#[test]
fn every_row_has_five_cells_and_no_emphasis() {
    for line in book_table().lines().skip(2) {
        let bare = line.replace("\\|", "").replace("\\_", "").replace("\\*", "");
        assert_eq!(bare.matches('|').count(), 6, "{line}");
        let code = bare.split('`').skip(2).collect::<String>();
        assert!(!code.contains(['_', '*']), "{line}");
    }
}
