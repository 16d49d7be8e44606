//! Measures of goals: the errors of all runs, and their uncertainty.

use carom_record::metrics::Metric;
use carom_record::study::Row;
use carom_record::study::measure::{error, standing};
use carom_record::study::reference::Established;

#[test]
fn errors_are_relative_unless_the_reference_is_zero() {
    assert_eq!((error(-0.5, 0.0), error(3.0, -2.0), error(2.0, 2.0)), (0.5, 2.5, 0.0));
}

/// Without friction no energy is lost; with it, only what the reference says.
#[test]
fn friction_takes_energy() {
    let with = |name: &'static str| Row {
        metrics: vec![Metric { name: name.into(), value: Some(0.1), unit: String::new(), definition: "" }],
        ..Row::default()
    };
    let is_zero = |name: &str, row: Row| standing(None, &[row], name) == Ok(Established::default());
    assert!(is_zero("energy_lost", with("restitution")) && is_zero("energy_error", with("friction_lost")));
    assert!(!is_zero("energy_lost", with("friction_lost")) && !is_zero("energy_drift", with("plastic_lost")));
}
