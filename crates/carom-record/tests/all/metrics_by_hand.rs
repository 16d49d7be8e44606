//! A record whose metrics are calculated by hand: free flight, a parabolic pulse of the contact
//! force, free flight.

use carom_record::metrics::samples::{peak_mean, roughness};
use carom_record::metrics::{Episode, all, episodes};
use carom_record::question::{Question, Window};
use carom_record::{Column, History};

fn evaluate(history: &History, what: &str) -> Result<f64, String> {
    Ok(Question::parse(what)?.answer(history, Window::default())?)
}

fn history(columns: &[(&str, Vec<f64>)]) -> History {
    let describe = |(name, _): &(&str, Vec<f64>)| Column {
        name: (*name).into(),
        unit: format!("[{name}]"),
        description: String::new(),
        integer: false,
    };
    History::new(columns.iter().map(describe).collect(), columns.iter().map(|(_, v)| v.clone()).collect())
}

/// Contact in 1 ≤ t < 2 of 0 ≤ t ≤ 4, Δt = 1/16. The impulse along y is 9, with the force 54 s(1 −
/// s) and its peak 13.5 in the middle. The ball falls with −4 and leaves with +3 − 2(t − 2): the
/// apex is 2.25 above the point where it leaves, at t = 3.5.
fn bounce() -> History {
    let times: Vec<f64> = (0..=64).map(|i| f64::from(i) / 16.0).collect();
    let map = |f: fn(f64) -> f64| times.iter().map(|&t| f(t)).collect::<Vec<_>>();
    let zero = map(|_| 0.0);
    history(&[
        ("time", times.clone()),
        ("kinetic", map(|t| if t < 1.5 { 8.0 } else { 6.0 })),
        ("strain", map(|t| if t == 1.5 { 4.0 } else { 0.0 })),
        ("total", map(|t| if t < 1.5 { 8.0 } else { 6.0 })),
        ("external_work", map(|t| if t == 1.5 { -3.0 } else { -0.5 * f64::from(t > 1.5) })),
        ("active", map(|t| f64::from((1.0..2.0).contains(&t) && t != 1.25))),
        ("contact_force_x", zero.clone()),
        ("contact_force_y", map(|t| 54.0 * (t - 1.0).clamp(0.0, 1.0) * (2.0 - t).clamp(0.0, 1.0))),
        ("energy_created", map(|t| f64::from(t >= 1.5))),
        ("energy_scale", map(|t| if t < 1.5 { 8.0 } else { 10.0 })),
        ("contact_impulse_x", zero.clone()),
        (
            "contact_impulse_y",
            map(|t| {
                let s = (t - 1.0).clamp(0.0, 1.0);
                9.0 * s * s * (3.0 - 2.0 * s)
            }),
        ),
        ("penetration", map(|t| 1e-3 * f64::from(t == 1.5))),
        ("ball.center_x", zero.clone()),
        (
            "ball.center_y",
            map(|t| if t <= 1.0 { 7.0 - 4.0 * t } else { 2.0 + 3.0 * (t - 2.0) - (t - 2.0) * (t - 2.0) }),
        ),
        ("ball.velocity_x", zero.clone()),
        ("ball.velocity_y", map(|t| if t < 1.0 { -4.0 } else { 3.0 - 2.0 * (t - 2.0).max(0.0) })),
        ("block.velocity_x", zero),
        ("block.velocity_y", map(|t| 100.0 * f64::from(t > 1.0))),
    ])
}

#[test]
fn a_bounce_by_hand() {
    let history = bounce();
    let expected = [
        ("contact_start", 1.0, 0.0),
        ("contact_end", 2.0, 0.0),
        ("contact_duration", 1.0, 0.0),
        // The single row without contact, at 1.25, lasts 1/16 < 2 % of 4 = 0.08.
        ("contact_episodes", 1.0, 0.0),
        ("impulse_x", 0.0, 0.0),
        ("impulse_y", 9.0, 1e-14),
        ("peak_force", 13.5, 1e-14),
        // A window of 1/16 next to the middle: [P(1.5 + 1/16) − P(1.5)]·16.
        ("peak_mean_force", 9.0 * 16.0 * (0.5625 * 0.5625 * 1.875 - 0.5), 1e-12),
        ("force_roughness", 0.0, 1e-14),
        ("energy_drift", 0.15, 1e-15),
        ("energy_lost_impact", 0.15, 1e-15),
        ("apex", 2.0 + 2.25 - 7.0, 1e-13),
        ("apex_time", 3.5, 1e-13),
        // total 8 → 6, work −0.5; scale 10 at t = 1.5. At this time 6 − 8 + 3 = 1 is created.
        ("energy_lost", 0.15, 1e-15),
        ("energy_created", 0.1, 1e-15),
        ("penetration", 1e-3, 0.0),
        // One of fifteen rows in contact; the row at 1.25 is not.
        ("penetration_mean", 1e-3 / 15.0, 1e-18),
    ];
    let metrics = all(&history);
    for (name, value, tolerance) in expected {
        let metric = metrics.iter().find(|m| m.name == name).unwrap();
        let got = metric.value.unwrap_or(f64::NAN);
        assert!((got - value).abs() <= tolerance, "{name}: {got} instead of {value}");
        assert_eq!(evaluate(&history, name).unwrap(), got);
    }
    let episode = |start, end| Episode { start, end };
    assert_eq!(episodes(&history, 0.01), [episode(16, Some(20)), episode(21, Some(32))]);
    // An interruption of one row is as long as a bridge of one row, whatever the last digits.
    let times = history.times();
    let row = times[21] - times[20];
    for last_digits in [-1e-13, 0.0, 1e-13] {
        let bridge = row * (1.0 + last_digits);
        assert_eq!(episodes(&history, bridge).len(), 2, "{last_digits}");
    }
    assert_eq!(episodes(&history, 1.001 * row).len(), 1);
}

#[test]
fn no_contact_and_contact_without_an_end() {
    let run = |active: &[f64]| {
        let times = (0..active.len()).map(|i| i as f64).collect();
        history(&[("time", times), ("active", active.to_vec())])
    };
    let value =
        |history: &History, name: &str| all(history).into_iter().find(|m| m.name == name).unwrap().value;
    let open = run(&[0.0; 5]);
    assert_eq!((value(&open, "contact_start"), value(&open, "contact_episodes")), (None, Some(0.0)));
    let closed = run(&[0.0, 0.0, 2.0, 1.0]);
    assert_eq!((value(&closed, "contact_start"), value(&closed, "contact_end")), (Some(2.0), None));
    assert!(evaluate(&closed, "contact_end").unwrap_err().contains("first recorded time without"));
    assert!(all(&history(&[])).iter().all(|m| m.value.is_none()));
}

#[test]
fn roughness_counts_additional_humps() {
    assert_eq!(roughness(&[0.0, 1.0, 3.0, 3.0, 0.0]), Some(0.0));
    assert_eq!(roughness(&[0.0, 3.0, 0.0, 3.0, 0.0]), Some(1.0));
    assert_eq!(roughness(&[0.0, 0.0]), None);
}

#[test]
fn the_window_may_lie_between_rows() {
    // Force 1 on [0, 1], 3 on [1, 2] and 1 on [2, 3]: impulses 0 1 4 5.
    let times = [0.0, 1.0, 2.0, 3.0];
    let impulse = [0.0, 1.0, 4.0, 5.0];
    assert_eq!(peak_mean(&times, &[&impulse], 0.5), Some(3.0));
    assert_eq!(peak_mean(&times, &[&impulse], 2.0), Some(2.0));
    assert_eq!(peak_mean(&times, &[&impulse, &impulse], 1.0), Some(f64::hypot(3.0, 3.0)));
    assert_eq!(peak_mean(&times, &[&impulse], 4.0), None);
    // The largest window ends at a row and begins between rows: from 0.5 to 2, 0.5 · 1 + 3 in all.
    let mean = peak_mean(&[0.0, 1.0, 2.0, 4.0], &[&[0.0, 1.0, 4.0, 4.0]], 1.5).unwrap();
    assert!((mean - 7.0 / 3.0).abs() < 1e-15);
}

#[test]
fn expectations_of_columns() {
    let history = history(&[
        ("time", vec![0.0, 0.5, 2.0]),
        ("A.uy", vec![1.0, f64::NAN, 3.0]),
        ("B.uy", vec![1.0, -2.0, 4.0]),
    ]);
    let get = |what: &str| evaluate(&history, what);
    assert_eq!(get("min B.uy"), Ok(-2.0));
    assert_eq!(get("max B.uy"), Ok(4.0));
    assert_eq!(get("time of min B.uy"), Ok(0.5));
    assert_eq!(get("first B.uy"), Ok(1.0));
    assert_eq!(get("last  B.uy"), Ok(4.0));
    assert_eq!(get("at 0.25 B.uy"), Ok(-0.5));
    assert_eq!(get("at 1.25 B.uy"), Ok(1.0));
    assert_eq!(get("at 0.5 B.uy"), Ok(-2.0));
    assert!(get("min A.uy").unwrap_err().contains("not a number"));
    assert!(get("at 2.5 B.uy").unwrap_err().contains("0 to 2"));
    assert!(get("min C.uy").unwrap_err().contains("no column `C.uy`"));
    assert!(get("at x B.uy").unwrap_err().contains("`x` is not a time"));
    assert!(get("mean B.uy").unwrap_err().contains("restitution"));
}
