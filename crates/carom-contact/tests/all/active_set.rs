//! Active sets: which pairs have zero gap, and cycles of them.

use carom_contact::{ActiveSet, Contender};

fn pair(active: bool, gap: f64, lambda: f64) -> Contender {
    Contender { active, gap, lambda, stiffness: 1.0 }
}

#[test]
fn penetration_closes_tension_opens_and_ties_stay() {
    let mut set = ActiveSet::new(1e-12, true);
    let state = [
        pair(false, -1e-3, 0.0),
        pair(true, 0.0, 0.5),
        pair(true, 0.0, -5.0),
        pair(true, 0.0, 1e-11),
        pair(false, -1e-13, 0.0),
    ];
    assert_eq!(set.changes(&state, false, |_, _| 1.0).unwrap(), [0, 1]);
}

#[test]
fn a_two_cycle_first_waits_for_convergence_then_goes_one_by_one_then_is_named() {
    let mut set = ActiveSet::new(0.0, true);
    let open = [pair(false, -1.0, 0.0)];
    let closed = [pair(true, 0.0, 1.0)];
    assert_eq!(set.changes(&open, false, |_, _| 1.0).unwrap(), [0]);
    assert!(set.changes(&closed, false, |_, _| 1.0).unwrap().is_empty());
    assert_eq!(set.changes(&closed, true, |_, _| 1.0).unwrap(), [0]);
    let _ = set.changes(&open, true, |_, _| 1.0);
    assert!(set.is_cautious());
    let mut named = false;
    for k in 0..4 {
        named |= set.changes(if k % 2 == 0 { &closed } else { &open }, true, |_, _| 1.0).is_err();
    }
    assert!(named);
}

/// The gaps g = q − A λ of a matrix with positive diagonal and negative determinant: the first
/// pair alone leaves the second open with penetration, both put it in tension, and it alone is
/// the solution.
#[test]
fn of_two_nearly_dependent_gaps_the_one_that_suffices_alone_is_found() {
    let q = [-1.0, -1.0];
    let a = [[1.0, 1.02], [0.99, 1.0]];
    let solved = |active: [bool; 2]| {
        let mut forces = [0.0; 2];
        match active {
            [true, true] => {
                let det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
                forces[0] = (a[1][1] * q[0] - a[0][1] * q[1]) / det;
                forces[1] = (a[0][0] * q[1] - a[1][0] * q[0]) / det;
            }
            [true, false] => forces[0] = q[0] / a[0][0],
            [false, true] => forces[1] = q[1] / a[1][1],
            [false, false] => {}
        }
        [0, 1].map(|k| {
            let gap = q[k] - a[k][0] * forces[0] - a[k][1] * forces[1];
            pair(active[k], gap, forces[k])
        })
    };
    let mut set = ActiveSet::new(1e-12, true);
    let mut active = [true, false];
    for _ in 0..12 {
        let state = solved(active);
        for k in set.changes(&state, true, |_, _| 1.0).unwrap() {
            active[k] = !active[k];
        }
    }
    assert_eq!(active, [false, true]);
}
