//! Energy-conserving springs.

use carom_contact::interface::conserving_penalty::discrete_gradient;

#[test]
fn work_is_the_change_of_energy_and_the_stiffness_a_difference() {
    let energy = |g: f64| 0.5 * 7.0 * g.min(0.0).powi(2);
    for start in [-0.3, -0.01, 0.0, 0.2] {
        for end in [-0.4, -0.05, 0.1] {
            let (lambda, stiffness) = discrete_gradient(7.0, start, end - start);
            assert!((lambda * (end - start) - (energy(end) - energy(start))).abs() < 1e-15);
            let h = 1e-6;
            let difference = (discrete_gradient(7.0, start, end + h - start).0
                - discrete_gradient(7.0, start, end - h - start).0)
                / (2.0 * h);
            assert!((difference - stiffness).abs() < 1e-7, "{start} {end}: {difference} {stiffness}");
            assert!(lambda <= 0.0 && stiffness >= 0.0);
        }
    }
    assert_eq!(discrete_gradient(7.0, -0.1, 0.0).0, 7.0 * -0.1);
}
