//! Sums of fixed order, in parallel lanes that processors add at once.

use carom_algebra::sums::{dot, max_abs, sum};

#[test]
fn every_number_counts_and_what_is_none_is_seen() {
    for n in 0..40 {
        let x: Vec<f64> = (1..=n).map(f64::from).collect();
        assert_eq!(dot(&x, &x), f64::from(n * (n + 1) * (2 * n + 1) / 6));
        assert_eq!(sum([&x, &x, &x], |[a, b, c]| a * b * c), f64::from(n * (n + 1) / 2).powi(2));
        for k in 0..n as usize {
            let mut other: Vec<f64> = x.iter().map(|x| -x).collect();
            other[k] = -100.0;
            assert_eq!(max_abs(&other), 100.0);
            for none in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                other[k] = none;
                assert_eq!(max_abs(&other), f64::INFINITY);
            }
        }
    }
}
