//! Gaps with their gradients: one row per constraint over the nodes on which it depends, in
//! compressed rows.

use carom_contact::{Row, Rows};

#[test]
fn rows_are_what_was_pushed() {
    let mut rows = Rows::new(2);
    rows.push(-0.5, [(3, [0.0, 1.0, 9.0]), (1, [0.0, -1.0, 9.0])]);
    rows.push_open();
    assert_eq!(
        rows.row(0),
        Row { gap: -0.5, nodes: &[3, 1], gradient: &[0.0, 1.0, 0.0, -1.0], reversed: false, own: 1 }
    );
    assert_eq!(rows.row(0).along(&[0.0, 0.0, 5.0, 2.0, 0.0, 0.0, 7.0, 10.0]), 8.0);
    assert_eq!((rows.len(), rows.row(1).gap, rows.row(1).along(&[])), (2, f64::INFINITY, 0.0));
    let copy = { rows.row(0).nodes.to_vec() };
    rows.clear();
    assert_eq!((copy, rows.is_empty()), (vec![3, 1], true));
}
