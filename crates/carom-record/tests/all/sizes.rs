//! Sizes of the quantities of a run, beside which values are round-off.

use carom_record::{Column, History, Sizes};

/// Beside a force of 100 N, 1e-11 N is round-off, and so is 1e-6 Pa beside a modulus of 2e6 Pa.
#[test]
fn values_far_below_their_quantity_are_round_off() {
    let column = |name: &str, unit: &str| Column {
        name: name.into(),
        unit: unit.into(),
        description: String::new(),
        integer: false,
    };
    let columns = vec![column("contact_force_x", "N"), column("A.von_mises", "Pa")];
    let history = History::new(columns, vec![vec![0.0, -100.0], vec![0.0, 1e-6]]);
    let sizes = Sizes::in_history(&history, 2e6);
    assert!(sizes.is_round_off(1e-11, "N") && !sizes.is_round_off(1e-9, "N"));
    assert!(!sizes.is_round_off(0.0, "N") && !sizes.is_round_off(1e-30, "J"));
    assert!(sizes.is_round_off(1e-15, "") && sizes.is_round_off(1e-6, "Pa"));
}
