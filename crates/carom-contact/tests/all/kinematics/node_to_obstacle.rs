//! Secondary nodes against a rigid obstacle.

use carom_contact::{Kinematics, NodeToObstacle, Obstacle, Pairing, Rows};

#[test]
fn gap_is_the_signed_distance() {
    let plane = NodeToObstacle::new(vec![0], 2, Obstacle::plane(&[0.0, 1.0], &[0.0, 4.0]));
    let mut pairing = Pairing::default();
    let mut rows = Rows::new(2);
    plane.search(&[], &[], &mut pairing, &mut Vec::new());
    plane.measure(&mut pairing.pairs[0], &[7.0, 0.25], &mut rows).unwrap();
    assert_eq!((rows.row(0).gap, rows.row(0).gradient), (-0.75, &[0.0, 1.0][..]));
}
