//! Messages of runs that stopped.

use carom_mechanics::{Rejected, Stopped};

#[test]
fn percentages_have_three_digits() {
    let stopped = Stopped::EnergyGuard { time: 0.5, dt: 0.01, created: 0.0123456, share: 5e-6, scale: 0.1 };
    let message = "energy was created at t = 0.500000 [time]: 1.2346e-2 [energy], which is 12.3 % of the energy scale, 1.0000e-1 [energy]; the limit is 0.0005 %";
    assert_eq!(stopped.to_string(), message);
}

#[test]
fn times_have_the_digits_of_the_step() {
    let stopped = Stopped::Interrupted { time: 1.02e-6, dt: 2e-8 };
    assert_eq!(stopped.to_string(), "interrupted in the step that begins at t = 0.00000102 [time]");
    let rejected = Rejected::NegativeMass;
    let stopped = Stopped::NoStep { time: 1.02e-6, dt: 2e-8 / 8.0, halvings: 3, rejected };
    assert!(stopped.to_string().starts_with("the step at t = 0.00000102 [time] was bisected 3 times"));
}
