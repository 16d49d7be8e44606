//! Comparison of a column with that of a reference.

use carom_record::metrics::{deviation, phase_shift};

fn sampled(n: u32, f: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let times: Vec<f64> = (0..=n).map(|i| 10.0 * f64::from(i) / f64::from(n)).collect();
    let values = times.iter().map(|t| f(*t)).collect();
    (times, values)
}

/// Sines with a delay and with an advance, on rows that differ from those of the reference.
#[test]
fn the_delay_of_a_sine() {
    let reference = sampled(4000, f64::sin);
    for late in [0.05, -0.2, 0.0] {
        let (t, c) = sampled(333, |t| (t - late).sin());
        let found = phase_shift(&t, &c, (&reference.0, &reference.1)).unwrap();
        assert!((found - late).abs() < 2e-6, "{found} for {late}");
    }
    assert_eq!(phase_shift(&[0.0, 1.0], &[1.0, 1.0], (&[0.0, 1.0], &[1.0, 1.0])), None);
}

/// r = t on [0, 10] and c = t + 2: deviation 2 of the range 10.
#[test]
fn deviation_by_hand() {
    let reference = sampled(10, |t| t);
    let (t, c) = sampled(7, |t| t + 2.0);
    assert!((deviation(&t, &c, (&reference.0, &reference.1)).unwrap() - 0.2).abs() < 1e-15);
    assert_eq!(deviation(&t, &c, (&[0.0, 10.0], &[1.0, 1.0])), None);
}
