//! Smoothness of the contact force, and steadiness of contact, in the first episode or in all of
//! them.

use carom_record::metrics::all;
use carom_record::metrics::force::high_frequency;
use carom_record::{Column, History};

/// 1 + cos with k cycles in 128 samples has the power 128 + 64: a third of it is in the cosine,
/// which counts for k > 16.
#[test]
fn power_above_sixteen_cycles() {
    let wave = |k: f64| -> Vec<f64> {
        (0..128).map(|i| 1.0 + (std::f64::consts::TAU * k * f64::from(i) / 128.0).cos()).collect()
    };
    assert!((high_frequency(&wave(17.0)).unwrap() - 1.0 / 3.0).abs() < 1e-14);
    assert!((high_frequency(&wave(40.0)).unwrap() - 1.0 / 3.0).abs() < 1e-14);
    assert!(high_frequency(&wave(16.0)).unwrap() < 1e-14);
    // The sign changes with every sample: a cosine of 64 cycles.
    let alternating: Vec<f64> = (0..128).map(|i| 3.0 * f64::from(1 - 2 * (i % 2))).collect();
    assert!((high_frequency(&alternating).unwrap() - 1.0).abs() < 1e-14);
    assert_eq!((high_frequency(&[1.0; 8]), high_frequency(&[0.0; 128])), (None, None));
}

/// Contact in rows 2 to 4 and 7, Δt = 0.5: the time in contact is 1.5 + 0.5, with three
/// activations and three releases.
#[test]
fn chatter_and_depth_by_hand() {
    let column = |name: &str| Column {
        name: name.into(),
        unit: "u".into(),
        description: String::new(),
        integer: false,
    };
    let names = ["time", "active", "activations", "releases", "contact_force_x", "penetration"];
    let values = vec![
        (0..9).map(|i| 0.5 * f64::from(i)).collect(),
        vec![0.0, 0.0, 1.0, 2.0, 1.0, 0.0, 0.0, 1.0, 0.0],
        vec![0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0],
        vec![0.0, 0.0, 4.0, 1.0, -4.0, 0.0, 0.0, 2.0, 0.0],
        vec![0.0, 0.0, 0.1, 0.3, 0.0, 0.9, 0.0, 0.4, 0.0],
    ];
    let history = History::new(names.map(column).to_vec(), values);
    let metrics = all(&history);
    let of = |name: &str| metrics.iter().find(|m| m.name == name).unwrap();
    assert_eq!((of("chatter").value, of("chatter").unit.as_str()), (Some(3.0), "1/u"));
    assert_eq!(of("penetration_mean").value, Some(0.2));
    assert_eq!(of("force_high_frequency").value, None);
}
