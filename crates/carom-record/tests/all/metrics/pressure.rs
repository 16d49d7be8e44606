//! Metrics of the contact pressure at rest, from the rows of contact.csv of the last recorded step
//! of a static run.

use carom_record::metrics::pressure::hertz;

/// Points of an ellipse with any centre give the ellipse, and so does a half of it.
#[test]
fn an_ellipse_is_found() {
    let p0 = 0.025;
    let a = 0.05;
    let c = 3.0;
    let ellipse = |s: f64| p0 * (1.0 - ((s - c) / a).powi(2)).max(0.0).sqrt();
    for range in [-7..=8, 0..=9, -9..=0] {
        let places: Vec<f64> = range.map(|i| c + 0.1 * a * f64::from(i)).collect();
        let pressures: Vec<f64> = places.iter().map(|s| ellipse(*s)).collect();
        let (peak, half) = hertz(&places, &pressures).unwrap();
        assert!((peak / p0 - 1.0).abs() < 1e-9 && (half / a - 1.0).abs() < 1e-9, "{peak} {half}");
    }
}

/// By hand: p² = 4, 3, 0 at s = 0, 1, 2 is 4 − s², so p₀ = 2 and a = 2. A single point, or
/// constant pressure, gives no ellipse.
#[test]
fn few_points() {
    let (peak, half) = hertz(&[0.0, 1.0, 2.0], &[2.0, 3.0_f64.sqrt(), 0.0]).unwrap();
    assert!((peak - 2.0).abs() < 1e-12 && (half - 2.0).abs() < 1e-12);
    assert_eq!(hertz(&[0.0], &[1.0]), None);
    assert_eq!(hertz(&[], &[]), None);
    assert_eq!(hertz(&[0.0, 1.0], &[1.0, 1.0]), None);
}

/// A flat punch has its peaks at the edges, in half a model at one end. That is no ellipse.
#[test]
fn a_flat_punch_has_no_ellipse() {
    let places = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2];
    let half = [1.775, 1.775, 1.774, 1.773, 1.774, 1.783, 1.801, 1.824, 1.853, 1.898, 1.985, 2.236, 3.036];
    assert_eq!(hertz(&places, &half), None);
    let reversed: Vec<f64> = half.into_iter().rev().collect();
    assert_eq!(hertz(&places, &reversed), None);
}

/// In half a model the largest pressure need not be that on the axis: here 4 % below that of its
/// neighbour, of p = √(9 − s²). The other end of the contact presses little.
#[test]
fn half_a_model_with_noise_on_its_axis() {
    let places = [0.0, 1.0, 2.0, 2.8];
    let mut pressures = places.map(|s: f64| (9.0 - s * s).sqrt());
    pressures[0] *= 0.93;
    let (_, half) = hertz(&places, &pressures).unwrap();
    assert!((half / 3.0 - 1.0).abs() < 0.05, "{half}");
}
