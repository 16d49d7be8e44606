//! Numbers with units in messages.

use carom_run::quantity::{at_least, at_most, quantity};

#[test]
fn four_digits_and_a_unit() {
    assert_eq!(quantity(10.0, "mm"), "10 mm");
    assert_eq!(quantity(0.001, "m"), "0.001 m");
    assert_eq!(quantity(3.0 * 0.1, ""), "0.3");
    assert_eq!(quantity(1.23456e-7, "s"), "1.235e-7 s");
    assert_eq!(quantity(-1234567.0, "N"), "-1.235e6 N");
    assert_eq!((quantity(0.0, "m"), quantity(f64::NAN, "m")), ("0 m".to_owned(), "NaN m".to_owned()));
}

#[test]
fn bounds_are_kept() {
    assert_eq!(at_least(0.123412, "m"), "0.1235 m");
    assert_eq!(at_least(0.1234, "m"), "0.1234 m");
    assert_eq!(at_most(0.00123999, "s"), "0.001239 s");
}
