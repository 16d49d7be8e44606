//! Times as people write them.

use carom_record::decimal::decimal;

/// The decimals of k·Δt in integers: k · 3125 in units of 10⁻⁶, and so on.
#[test]
fn instants_of_a_grid_are_its_decimals() {
    for (mantissa, places) in [(3125_u64, 6), (1, 1), (1875, 6), (375, 5), (7, 3), (1, 4), (333, 6)] {
        let parsed = |mantissa: u64| format!("{mantissa}e-{places}").parse::<f64>().unwrap();
        let step = parsed(mantissa);
        for k in 0..5000_u64 {
            let time = decimal(k as f64 * step);
            assert_eq!(time, parsed(k * mantissa), "{k} times {step}");
        }
    }
    assert_eq!((3.0 * 0.003125_f64).to_string(), "0.009375000000000001");
    assert_eq!(decimal(3.0 * 0.003125).to_string(), "0.009375");
}

/// Other numbers keep their digits, up to the last one.
#[test]
fn other_times_remain() {
    for time in [0.0, 1.0 / 3.0, std::f64::consts::PI, 1e-300, 2.5e17] {
        assert!((decimal(time) - time).abs() <= f64::EPSILON * time, "{time}");
    }
    assert!(decimal(f64::NAN).is_nan());
}
