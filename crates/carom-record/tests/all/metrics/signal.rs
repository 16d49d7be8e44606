//! Distance of two records in a vector quantity, apart from its rough part.

use std::f64::consts::TAU;

use carom_record::metrics::Signal;

fn sampled(n: u32, f: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let times: Vec<f64> = (0..=n).map(|i| f64::from(i) / f64::from(n)).collect();
    let values = times.iter().map(|t| f(*t)).collect();
    (times, values)
}

/// Exact: t against t + 3 has the smooth distance 3 and no rough one; two components of 3 and 4
/// have 5.
#[test]
fn an_offset_is_smooth() {
    let (times, values) = sampled(10, |t| t);
    let (fine, known) = sampled(37, |t| t + 3.0);
    let far = sampled(37, |t| t + 4.0).1;
    let one = Signal::of(&times, vec![&values]).distance(&Signal::of(&fine, vec![&known]), 0.1).unwrap();
    assert!((one.smooth - 3.0).abs() < 1e-12 && one.rough < 1e-12, "{one:?}");
    let two = Signal::of(&times, vec![&values; 2]).distance(&Signal::of(&fine, vec![&known, &far]), 0.0);
    assert!((two.unwrap().smooth - 5.0).abs() < 1e-12);
}

/// An oscillation of 64 cycles averages out over two of them: it is noise, of the norm 1/√2.
/// Steps and rows may be halved without end: the norms stay, where the total variation of an
/// alternating signal doubles.
#[test]
fn an_oscillation_is_rough_and_has_a_limit() {
    for rows in [2048, 4096, 8192] {
        let (times, values) = sampled(rows, |t| (64.0 * TAU * t).sin());
        let found = Signal::of(&times, vec![&values]).norms(2.0 / 64.0).unwrap();
        assert!((found.rough - 0.5_f64.sqrt()).abs() < 5e-3 && found.smooth < 0.03, "{found:?}");
        let alternating: Vec<f64> = (0..=rows).map(|i| 1.0 - 2.0 * f64::from(i % 2)).collect();
        let found = Signal::of(&times, vec![&alternating]).norms(1.0 / 16.0).unwrap();
        assert!(found.smooth < 0.02 && (found.rough - (1.0_f64 / 3.0).sqrt()).abs() < 0.03, "{found:?}");
    }
}

/// A recorded impulse replaces the integral of the rows: rows that miss a spike of the impulse
/// 1 do not hide it.
#[test]
fn impulses_are_those_recorded() {
    let (times, values) = sampled(100, |_| 0.0);
    let impulse = times.iter().map(|t| if *t < 0.5 { 0.0 } else { 1.0 }).collect();
    let struck = Signal::of(&times, vec![&values]).with_integrals(vec![impulse]);
    let found = struck.norms(0.25).unwrap();
    // ⟨F⟩ is 4 over a window of 1/4: ‖·‖² = 16/4.
    assert!((found.smooth - 2.0).abs() < 0.03, "{found:?}");
}

/// Exact: t has no distance from a record of t that goes on for longer.
#[test]
fn the_end_of_a_record_is_no_error() {
    let (times, values) = sampled(100, |t| t);
    let longer: Vec<f64> = times.iter().map(|t| 1.5 * t).collect();
    let one = Signal::of(&times, vec![&values]);
    let found = one.distance(&Signal::of(&longer, vec![&longer]), 0.25).unwrap();
    assert!(found.smooth < 1e-12 && found.rough < 1e-12, "{found:?}");
}

/// An exact square pulse has a rough part, which is no fault of a history that has it too.
#[test]
fn the_same_jump_is_no_noise() {
    let pulse = |t: f64| f64::from((0.25..0.75).contains(&t));
    let (times, values) = sampled(1000, pulse);
    let (fine, known) = sampled(4000, pulse);
    let one = Signal::of(&times, vec![&values]);
    assert!(one.norms(1.0 / 32.0).unwrap().rough > 0.05);
    let found = one.distance(&Signal::of(&fine, vec![&known]), 1.0 / 32.0).unwrap();
    assert!(found.rough < 0.02 && found.smooth < 5e-3, "{found:?}");
}

/// A parabola t² is above its chords of the length 1/100 by (1/100)²/4 at most.
#[test]
fn chords_of_a_parabola() {
    let (times, values) = sampled(100, |t| t * t);
    let found = Signal::of(&times, vec![&values]).chords();
    assert!((found / 2.5e-5 - 1.0).abs() < 1e-6, "{found}");
}
