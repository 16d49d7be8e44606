//! The end of a reduced case.

use carom_run::reduce::shortest;

#[test]
fn products_are_written_without_their_round_off() {
    assert_eq!(shortest(39.0 * 5e-5).to_string(), "0.00195");
    assert_eq!(shortest(3.0 * 0.1).to_string(), "0.3");
    assert_eq!(shortest(7.0 / 3.0), 2.33333333333);
}
