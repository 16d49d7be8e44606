//! Two sets of nodes far from each other.

use carom_contact::kinematics::apart::Apart;
use carom_solid::Bounds;

/// Nodes 0 and 2 beside a facet at the origin: boxes 3 apart, A = 1, no margins. Both may move by
/// 0.5: seen from a frame that moves by 1 against them, the end of a path is 1.5 away.
#[test]
fn holds_until_the_boxes_may_meet() {
    let mut apart = Apart::new([2, 0, 2], 2, 1.0);
    let facet = Bounds::of(&[0.0, 0.0]);
    let node = Bounds::of(&[3.0, 1.0]);
    let y = [0.0, 0.0, 9.0, 9.0, 3.0, 1.0];
    assert!(!apart.holds(0.0, [&y, &y]));
    apart.searched([&facet, &node], [0.0; 2], &y);
    let with = |dof: usize, x: f64| {
        let mut moved = y;
        moved[dof] += x;
        moved
    };
    assert!(apart.holds(0.0, [&with(4, -0.49), &with(0, 0.49)]));
    assert!(!apart.holds(0.0, [&with(4, -0.51), &y]) && !apart.holds(0.0, [&y, &with(1, 0.51)]));
    // Node 1 belongs to neither; a wider margin was not searched.
    assert!(apart.holds(0.0, [&y, &with(3, 5.0)]) && !apart.holds(0.1, [&y, &y]));
    assert!(!apart.holds(0.0, [&y, &with(4, f64::NAN)]));
    apart.searched([&facet, &Bounds::of(&[0.0, 0.0])], [0.0; 2], &y);
    assert!(!apart.holds(0.0, [&y, &y]));
}
