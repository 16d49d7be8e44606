//! Metrics of a column in the first contact episode.

use carom_record::metrics::column::{column_roughness, peak_of_means};
use carom_record::metrics::given::Given;
use carom_record::{Column, History};

fn history(probe: Vec<f64>) -> History {
    let rows = probe.len();
    let active = (0..rows).map(|i| f64::from(i > 0 && i + 1 < rows)).collect();
    let column = |name: &str| Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        integer: false,
    };
    let names = ["time", "active", "B.s"].map(column).to_vec();
    History::new(names, vec![(0..rows).map(|i| i as f64).collect(), active, probe])
}

/// Stress −32 in every row in contact, rows 1 to 32 of 34, except 32 in the middle row; windows
/// of two rows. The mean is −32 without the middle row, and 0 across it.
#[test]
fn mean_peaks_by_hand() {
    let mut values = vec![-32.0; 34];
    values[17] = 32.0;
    let history = history(values);
    assert_eq!(peak_of_means(&Given::of(&history).with_column("B.s")), Some(32.0));
}

/// By hand: one hump, a ramp, and three humps through the whole range.
#[test]
fn roughness_counts_humps() {
    let of = |values: &[f64]| column_roughness(&Given::of(&history(values.to_vec())).with_column("B.s"));
    assert_eq!(of(&[0.0, -1.0, -4.0, -2.0, 0.0]), Some(0.0));
    assert_eq!(of(&[0.0, 1.0, 2.0, 5.0]), Some(-0.5));
    assert_eq!(of(&[0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0]), Some(2.0));
    assert_eq!(of(&[1.0; 5]), None);
    assert_eq!(column_roughness(&Given::of(&history(vec![0.0; 5])).with_column("C")), None);
}
