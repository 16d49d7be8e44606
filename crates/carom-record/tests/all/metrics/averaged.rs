//! Metrics after the contact force and the columns of probes have been averaged over a short time.

use carom_record::metrics::averaged::{OF_COLUMN, OF_FORCE, averaged};
use carom_record::metrics::table::{COLUMNS, HISTORY};
use carom_record::{Column, History};

#[test]
fn the_metrics_of_few_rows_exist() {
    assert!(OF_FORCE.iter().all(|name| HISTORY.iter().any(|d| d.name == *name)));
    assert!(OF_COLUMN.iter().all(|name| COLUMNS.iter().any(|d| d.name == *name)));
}

/// By hand: the mean of t over any window inside is t, at the ends it is that of half a window;
/// of a single spike of 1 over two rows of a window of two steps it is 1/2.
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
    let averaged = averaged(&history, 2.0, |name| name != "time");
    let ramp = averaged.column("ramp").unwrap();
    assert_eq!((ramp[0], ramp[4], ramp[10]), (0.5, 4.0, 9.5));
    assert_eq!(averaged.column("spike").unwrap()[4..7], [0.25, 0.5, 0.25]);
}
