//! Observed orders of convergence, and extrapolation to step zero.

use carom_record::order::{extrapolated, from_differences, from_errors, orders};

const EVEN: [f64; 4] = [0.4, 0.2, 0.1, 0.05];
const UNEVEN: [f64; 4] = [0.5, 0.3, 0.2, 0.05];

fn values(steps: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    steps.iter().map(|h| f(*h)).collect()
}

/// f = 7 − 3hᵖ: the order is p and the limit 7 for any steps.
#[test]
fn powers_have_their_order() {
    for steps in [EVEN, UNEVEN] {
        for p in [0.5, 1.0, 2.0, 3.0, 4.0] {
            let f = values(&steps, |h| 7.0 - 3.0 * h.powf(p));
            for order in orders(&steps, &f) {
                assert!((order.unwrap() - p).abs() < 1e-9, "{p}");
            }
            let limit = extrapolated(&steps, &f).unwrap();
            assert!((limit.value - 7.0).abs() < 1e-9 && (limit.order - p).abs() < 1e-9, "{limit:?}");
            assert!((limit.band - 1.25 * 3.0 * steps[3].powf(p)).abs() < 1e-9);
            let errors = [3.0 * steps[2].powf(p), -3.0 * steps[3].powf(p)];
            assert!((from_errors([steps[2], steps[3]], errors).unwrap() - p).abs() < 1e-12);
        }
    }
}

/// f = h + h²: p from a triple of halved steps is log₂((h₁ − h₂ + h₁² − h₂²)/(h₂ − h₃ + h₂² −
/// h₃²)).
#[test]
fn mixed_powers_by_hand() {
    let f = values(&EVEN, |h| h + h * h);
    let expected = ((0.2 + 0.12) / (0.1 + 0.03_f64)).log2();
    assert!((orders(&EVEN, &f)[0].clone().unwrap() - expected).abs() < 1e-9);
}

#[test]
fn no_order_says_why() {
    let why = |values: &[f64]| extrapolated(&EVEN[..values.len()], values).unwrap_err();
    assert!(why(&[1.0, 2.0, 3.0]).contains("need four"));
    assert!(why(&[1.0, 3.0, 2.0, 2.5]).contains("not monotonic"));
    assert!(why(&[1.0, 1.0, 1.0, 1.0]).contains("round-off"));
    assert!(why(&[0.0, 8.0, 10.0, 11.9]).contains("differ by more"));
    assert!(why(&[0.0, 1.0, 3.0, 7.0]).contains("grow"));
    assert!(from_differences([0.1, 0.2, 0.4], [1.0, 1.0]).unwrap_err().contains("do not decrease"));
    assert!(from_errors([0.2, 0.1], [1.0, 0.0]).is_err());
}
