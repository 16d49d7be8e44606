//! Functions of sampled values.

use carom_record::metrics::samples::integral;

/// By hand: 1, 3, 3 at the times 0, 1, 4.
#[test]
fn integrals_by_hand() {
    assert_eq!(integral(&[0.0, 1.0, 4.0], &[1.0, 3.0, 3.0]), [0.0, 2.0, 11.0]);
    assert_eq!((integral(&[], &[]), integral(&[2.0], &[7.0])), (vec![], vec![0.0]));
}
