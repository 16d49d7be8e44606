//! Words of recorded quantities.

use carom_case::Quantity;

#[test]
fn names_of_quantities_are_those_of_cases() {
    for name in Quantity::WORDS {
        let read: Quantity = serde_json::from_value((*name).into()).unwrap();
        assert_eq!(read.word(), *name);
    }
}
