//! When a frozen tangent is made anew.

use std::sync::Arc;

use carom_mechanics::stage::renewal::Renewal;
use carom_mechanics::{FrozenTangent, Point};

#[test]
fn a_factor_is_made_anew_where_more_solves_are_left_than_it_costs() {
    let mut renewal = Renewal::new(&FrozenTangent::default(), [1.0, 1.0], true, 6.0);
    assert!(renewal.due, "there is none");
    renewal.renewed(Arc::default());
    assert!(!renewal.pays(1.0, 1e-9), "nothing has been seen of it yet");
    renewal.observe(0.1);
    // Eight more solves by a tenth each against six for a factor; two against six.
    assert!(renewal.pays(1e-1, 1e-9) && !renewal.pays(1e-6, 1e-9));
    assert!((renewal.solves(1e-3, 1e-6) - 2.0).abs() < 1e-9);
}

#[test]
fn steps_that_take_longer_than_the_mean_end_the_life_of_a_factor() {
    let point = Arc::new(Point { mass: 1.0, stiffness: 1.0, ..Point::default() });
    let mut frozen = {
        let mut renewal = Renewal::new(&FrozenTangent::default(), [1.0, 1.0], true, 6.0);
        renewal.renewed(point);
        renewal.observe(0.01);
        renewal.finish()
    };
    // ln 1e-2 takes 3.9 solves per step and the factor 6: the mean after n steps is 3.9 + 6/n.
    for _ in 0..5 {
        let mut renewal = Renewal::new(&frozen, [1.0, 1.0], true, 6.0);
        assert!(!renewal.due);
        renewal.observe(0.01);
        frozen = renewal.finish();
    }
    let mut slow = Renewal::new(&frozen, [1.0, 1.0], true, 6.0);
    slow.observe(0.1);
    assert!(Renewal::new(&slow.finish(), [1.0, 1.0], true, 6.0).due);
    assert!(Renewal::new(&frozen, [2.0, 1.0], true, 6.0).due, "another step has another matrix");
}
