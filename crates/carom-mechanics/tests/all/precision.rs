//! Where a factor is stored in single precision.

use carom_algebra::Pattern;
use carom_mechanics::Point;
use carom_mechanics::linear::direct::{LARGE, single_is_enough};

#[test]
fn half_of_the_digits_are_for_large_factors_that_mass_holds_together() {
    let point = Point { mass: 2.0, stiffness: 2.0, ..Point::default() };
    let enough = |size: usize, mass: f64, stiffness: f64| {
        let pattern = Pattern::from_entries(size, []);
        let mut masses = vec![1.0; size];
        let mut stiffnesses = vec![10.0; size];
        (masses[7], stiffnesses[7]) = (mass, stiffness);
        single_is_enough(&pattern, &point, &masses, &stiffnesses)
    };
    assert!(enough(LARGE, 1.0, 999.0));
    assert!(!enough(LARGE - 1, 1.0, 999.0) && !enough(LARGE, 1.0, 1001.0) && !enough(LARGE, 0.0, 1.0));
}
