//! Energy balance, from the columns of the ledger.

use carom_record::metrics::{all, energy_lost_at};
use carom_record::{Column, History};

/// Two impacts by hand. The energy 10 drops to 9 in rows 1 to 3 and to 8.5 in flight, and rises
/// to 8.75 in the second impact; the integrator dissipated 1 of the 1.25. No load does work;
/// the largest kinetic + strain energy is 10.
#[test]
fn two_impacts_by_hand() {
    let names =
        ["time", "active", "kinetic", "strain", "total", "external_work", "contact_work", "dissipation"];
    let column = |name: &str| Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        integer: false,
    };
    let total = vec![10.0, 10.0, 9.5, 9.0, 8.5, 8.5, 8.0, 8.75, 8.75];
    let rows = total.len();
    let values = vec![
        (0..rows).map(|i| i as f64).collect(),
        vec![0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0],
        total.clone(),
        vec![0.0; rows],
        total,
        vec![0.0; rows],
        [vec![0.0; rows - 1], vec![-0.25]].concat(),
        [vec![0.0; rows - 1], vec![1.0]].concat(),
    ];
    let history = History::new(names.map(column).to_vec(), values);
    let metrics = all(&history);
    let value = |name: &str| metrics.iter().find(|m| m.name == name).unwrap().value;
    assert_eq!(value("contact_episodes"), Some(2.0));
    assert_eq!((value("energy_lost"), value("energy_drift")), (Some(0.125), Some(0.2)));
    assert_eq!((value("dissipated_integrator"), value("dissipated_contact")), (Some(0.1), Some(0.025)));
    assert_eq!((energy_lost_at(&history, 1), energy_lost_at(&history, 2)), (Some(0.1), Some(-0.025)));
    assert_eq!((energy_lost_at(&history, 3), energy_lost_at(&history, 0)), (None, None));
    assert_eq!(value("energy_lost_impact"), Some(0.1));
    assert_eq!(value("energy_error"), Some(0.125));
}
