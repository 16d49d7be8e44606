//! The last search of a solve.

use carom_contact::OnFacet;
use carom_contact::kinematics::recent::Recent;

/// Nodes 0 and 2 in the plane, A = 1: positions may change by s/(4√3).
#[test]
fn a_search_is_repeated_up_to_what_certificates_leave() {
    let mut recent: Recent<f64> = Recent::new(vec![0, 2], 2, 1.0, 1);
    let before = [0.0, 0.0, 9.0, 9.0, 3.0, 1.0];
    let now = [0.1, 0.0, 9.0, 9.0, 3.0, 1.0];
    let separation = 4.0 * 3.0_f64.sqrt();
    let margin = 0.5;
    let with = |dof: usize, by: f64| {
        let mut moved = now;
        moved[dof] += by;
        moved
    };
    assert!(!recent.repeats(margin, [&before, &now], separation));
    recent.begin(margin, [&before, &now]);
    assert_eq!(recent.get(0), None);
    recent.set(0, Some(OnFacet { facet: 7, xi: 0.5 }));
    assert!(recent.repeats(margin, [&before, &with(4, 0.99)], separation));
    assert!(!recent.repeats(margin, [&before, &with(4, 1.01)], separation));
    assert!(!recent.repeats(margin, [&before, &with(0, f64::NAN)], separation));
    // Node 1 belongs to neither side. The start must be the same to the last bit.
    assert!(recent.repeats(margin, [&before, &with(3, 5.0)], separation));
    assert!(!recent.repeats(margin, [&with(0, -0.1 + 1e-16), &now], separation));
    assert!(!recent.repeats(0.4, [&before, &now], separation));
    assert_eq!(recent.get(0), Some(Some(OnFacet { facet: 7, xi: 0.5 })));
    recent.forget();
    assert!(!recent.repeats(margin, [&before, &now], separation));
    recent.begin(margin, [&before, &now]);
    assert_eq!(recent.get(0), None);
}
