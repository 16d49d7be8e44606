//! Measured data beside a column of the history, and how far the column is from them.

use carom_record::metrics::given::Given;
use carom_record::metrics::overlay::{peak, rms, shift};
use carom_record::{Column, History, Overlay};

fn history(f: impl Fn(f64) -> f64) -> History {
    let column = |name: &str| Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        integer: false,
    };
    let times: Vec<f64> = (0..=1000).map(|i| 0.01 * f64::from(i)).collect();
    let values = times.iter().map(|t| f(*t)).collect();
    History::new(vec![column("time"), column("u")], vec![times, values])
}

fn overlay(points: &[(f64, f64)]) -> Overlay {
    let (times, values) = points.iter().copied().unzip();
    Overlay { name: "test".into(), column: "u".into(), times, values, source: None }
}

/// By hand: c = 2t at 1, 2, 3 is 2, 4, 6; measured 2, 5, 8 give differences 0, −1, −2, so
/// √(5/3) and 6/8 − 1. The point at 20 is outside the run.
#[test]
fn differences_by_hand() {
    let line = history(|t| 2.0 * t);
    let data = overlay(&[(1.0, 2.0), (2.0, 5.0), (3.0, 8.0), (20.0, 0.0)]);
    assert!((rms(&Given::of(&line).beside(&data)).unwrap() - (5.0_f64 / 3.0).sqrt()).abs() < 1e-12);
    assert!((peak(&Given::of(&line).beside(&data)).unwrap() + 0.25).abs() < 1e-12);
}

/// A sine that is 0.3 late.
#[test]
fn a_late_column_has_a_positive_shift() {
    let points: Vec<(f64, f64)> = (1..60).map(|i| 0.15 * f64::from(i)).map(|t| (t, t.sin())).collect();
    let late = history(|t| (t - 0.3).sin());
    let data = overlay(&points);
    let found = shift(&Given::of(&late).beside(&data)).unwrap();
    assert!((found - 0.3).abs() < 1e-4, "{found}");
    let other = Overlay { column: "v".into(), ..data.clone() };
    assert_eq!(rms(&Given::of(&late).beside(&other)), None);
}
