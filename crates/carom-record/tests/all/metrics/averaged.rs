//! Metrics after the contact force and the columns of probes have been averaged over a short time.

use carom_record::metrics::averaged::{OF_COLUMN, OF_FORCE, averaged, period};
use carom_record::metrics::table::{COLUMNS, HISTORY};
use carom_record::{Column, History};

#[test]
fn the_metrics_of_few_rows_exist() {
    assert!(OF_FORCE.iter().all(|name| HISTORY.iter().any(|d| d.name == *name)));
    assert!(OF_COLUMN.iter().all(|name| COLUMNS.iter().any(|d| d.name == *name)));
}

/// By hand: the mean of t over any window is t, at the ends of the record, too, where the window
/// shrinks; of a single spike of 1 over two rows of a window of two steps it is 1/2.
#[test]
fn means_by_hand() {
    let column = |name: &str| Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        integer: false,
    };
    let times: Vec<f64> = (0..11).map(f64::from).collect();
    let mut spike = vec![0.0; 11];
    spike[5] = 1.0;
    let names = ["time", "ramp", "spike"].map(column).to_vec();
    let history = History::new(names, vec![times.clone(), times, spike]);
    let averaged = averaged(&history, |name, _| (name != "time").then_some(2.0));
    let ramp = averaged.column("ramp").unwrap();
    assert_eq!((ramp[0], ramp[4], ramp[10]), (0.0, 4.0, 10.0));
    assert_eq!(averaged.column("spike").unwrap()[4..7], [0.25, 0.5, 0.25]);
}

/// A vibration about any value has its period, and a ramp that of the record.
#[test]
fn periods_by_hand() {
    let times: Vec<f64> = (0..2001).map(|k| f64::from(k) / 100.0).collect();
    let vibration: Vec<f64> =
        times.iter().map(|t| 3.0 + (2.0 * std::f64::consts::PI * t + 0.1).sin()).collect();
    assert!((period(&times, &vibration) - 1.0).abs() < 0.03);
    assert_eq!(period(&times, &times), 20.0);
}
