//! References by hand.

use carom_record::metrics::Metric;
use carom_record::study::levels::Level;
use carom_record::study::reference::{Established, Reference};
use carom_record::study::trajectory::Trajectory;

/// Uncertainty after a last difference of two halved levels with the order 1, which counts as 2/3.
fn after(last: f64) -> f64 {
    1.25 * last / (2.0_f64.powf(2.0 / 3.0) - 1.0)
}

fn with(name: &'static str, value: f64) -> Trajectory {
    let metric = Metric { name: name.into(), value: Some(value), unit: String::new(), definition: "" };
    Trajectory { metrics: vec![metric], ..Trajectory::default() }
}

/// By hand: 1.4, 1.2, 1.1 at halved steps converge with first order; members at the
/// finest level that differ by 0.05 from their median widen the interval by as much.
#[test]
fn refinement_and_spread_add_up() {
    let level = |step: f64, values: &[f64]| Level {
        step,
        mesh: 1.0 / step,
        phases: 1,
        members: values.iter().map(|v| with("m", *v)).collect(),
    };
    let of = |finest: &[f64]| {
        let levels = vec![level(4.0, &[1.4]), level(2.0, &[1.2]), level(1.0, finest)];
        Reference::of_levels(String::new(), levels)
    };
    let found = of(&[1.1]).estimate("m").unwrap();
    assert!((found.order.unwrap() - 1.0).abs() < 1e-9 && (found.uncertainty - after(0.1)).abs() < 1e-9);
    let spread = of(&[1.1, 1.05, 1.15]).estimate("m").unwrap();
    assert!((spread.uncertainty - after(0.1) - 0.05).abs() < 1e-9 && (spread.spread - 0.05).abs() < 1e-12);
    assert!(of(&[3.0]).metric("m").is_err());
    let single = Reference::of_levels(String::new(), vec![level(1.0, &[1.0])]);
    assert!(single.metric("m").is_err());
}

/// By hand: the medians 1.4, 1.2, 1.1 are those of the first member and would be uncertain by 0.21.
/// The second does not converge and is uncertain by 3 · 0.2; the third converges with the order
/// 1.3, its last difference is 0.2, and its uncertainty, 0.43, is the median.
#[test]
fn every_member_is_refined_alone() {
    let level = |step: f64, values: [f64; 3]| Level {
        step,
        mesh: 1.0 / step,
        phases: 1,
        members: values.iter().map(|v| with("m", *v)).collect(),
    };
    let levels = [(4.0, [1.4, 1.3, 1.8]), (2.0, [1.2, 1.2, 1.3]), (1.0, [1.1; 3])];
    let levels = levels.map(|(step, values)| level(step, values)).into();
    let found = Reference::of_levels(String::new(), levels).estimate("m").unwrap();
    assert!((found.uncertainty - after(0.2)).abs() < 1e-9, "{found:?}");
}

/// By hand: instants 1.4, 1.2, 1.1 at the steps 4, 2, 1 are uncertain by 0.21 as above, and by
/// the step 2 of the level before. Members 0.2 before and after the median add 0.2; if they are
/// three phases, 3/2 of that, and a third of the step.
#[test]
fn instants_are_late() {
    let of = |phases: usize, finest: &[f64]| {
        let level = |step: f64, values: &[f64]| Level {
            step,
            mesh: 1.0 / step,
            phases,
            members: values.iter().map(|v| with("contact_end", *v)).collect(),
        };
        let levels = vec![level(4.0, &[1.4]), level(2.0, &[1.2]), level(1.0, finest)];
        Reference::of_levels(String::new(), levels).estimate("contact_end").unwrap().uncertainty
    };
    assert!((of(1, &[1.1]) - after(0.1) - 2.0).abs() < 1e-9);
    assert!((of(1, &[1.1, 0.9, 1.3]) - after(0.1) - 2.2).abs() < 1e-9);
    assert!((of(3, &[1.1, 0.9, 1.3]) - after(0.1) - 0.3 - 2.0 / 3.0).abs() < 1e-9);
}

/// Every tenth step is a row: instants are late by up to ten steps.
#[test]
fn instants_are_late_by_a_row() {
    let level = |step: f64, value: f64| {
        let times = (0..4).map(|k| 10.0 * step * f64::from(k)).collect();
        let run = Trajectory { times, ..with("contact_end", value) };
        Level { step, mesh: 1.0 / step, phases: 1, members: vec![run] }
    };
    let levels = vec![level(4.0, 1.4), level(2.0, 1.2), level(1.0, 1.1)];
    let found = Reference::of_levels(String::new(), levels).estimate("contact_end").unwrap();
    assert!((found.uncertainty - after(0.1) - 20.0).abs() < 1e-9);
}

/// Two levels, 1.2 and 1.1, with a step that is an eighth and a mesh that is twice as fine: the
/// smaller ratio counts, U = 3 · 0.1/(2 − 1). With one step for both nothing is known.
#[test]
fn levels_are_as_fine_as_the_coarser_of_step_and_mesh() {
    let of = |steps: [f64; 2]| {
        let level = |step: f64, mesh: f64, value: f64| Level {
            mesh,
            ..Level::single(step, with("restitution", value))
        };
        let levels = vec![level(steps[0], 1.0, 1.2), level(steps[1], 2.0, 1.1)];
        Reference::of_levels(String::new(), levels).estimate("restitution")
    };
    assert!((of([8.0, 1.0]).unwrap().uncertainty - 0.3).abs() < 1e-9);
    assert!(of([1.0, 1.0]).is_err());
}

/// By hand: averaging changes the peak of the finest run from 1.1 to 0.9; twice that is 0.4.
#[test]
fn what_averaging_changes_is_uncertain() {
    let levels = [(4.0, 1.4), (2.0, 1.2), (1.0, 1.1)];
    let levels = levels.map(|(step, value)| Level::single(step, with("peak_force", value)));
    let mut reference = Reference::of_levels(String::new(), levels.into());
    reference.averaged = with("peak_force", 0.9).metrics;
    assert!((reference.estimate("peak_force").unwrap().uncertainty - after(0.1) - 0.4).abs() < 1e-9);
}

/// Columns off from 10 t by 0.4, 0.2 and 0.1 on [0, 1], except at the ends, which set the
/// range: the deviations between successive levels are in the ratio of 2, so that the order is
/// 1 and the uncertainty that of the last deviation. By hand, with a row in the middle only of
/// three.
#[test]
fn uncertainty_and_band_of_a_column() {
    let run = |off: f64| Trajectory {
        times: vec![0.0, 0.5, 1.0],
        columns: [("A.uy".to_owned(), vec![0.0, 5.0 + off, 10.0])].into(),
        ..Trajectory::default()
    };
    let levels = |finest: Vec<Trajectory>| {
        let finest = Level { step: 1.0, mesh: 1.0, phases: 1, members: finest };
        let levels = vec![Level::single(4.0, run(0.4)), Level::single(2.0, run(0.2)), finest];
        Reference::of_levels(String::new(), levels)
    };
    let one = levels(vec![run(0.1)]);
    let rms = |off: f64| off / 10.0 / 3.0_f64.sqrt();
    let uncertainty = |of: &Reference| of.uncertainty("A.uy").unwrap();
    assert!((uncertainty(&one) - after(rms(0.1))).abs() < 1e-9);
    // In the middle the two finest levels differ by 0.1.
    let band = one.band("A.uy");
    assert!(band[0] == 0.0 && (band[1] - after(0.1)).abs() < 1e-9 && band[2] == 0.0, "{band:?}");
    // A member 0.3 away adds its deviation.
    let two = levels(vec![run(0.1), run(0.4)]);
    assert!((uncertainty(&two) - after(rms(0.1)) - rms(0.3)).abs() < 1e-9);
    assert!(one.uncertainty("B.uy").is_err() && one.band("B.uy").is_empty());
}

/// The bar on a wall: a force of 300 from 0.5 to 7/6. Its impulse is a difference of the
/// integral.
#[test]
fn metrics_of_exact_formulas() {
    let formulas = [
        ("active", "if(t >= 0.5, if(t < 7/6, 1, 0), 0)"),
        ("contact_force_x", "if(t >= 0.5, if(t < 7/6, 300, 0), 0)"),
        ("contact_impulse_x", "300*min(max(t-0.5,0),2/3)"),
    ];
    let formulas = formulas.map(|(name, text)| (name.to_owned(), text.to_owned())).into();
    let reference = Reference::of_formulas(&formulas, &[], 2.0);
    let value = |name: &str| reference.metric(name).unwrap();
    assert_eq!(value("peak_force"), Established { value: 300.0, uncertainty: 0.0 });
    assert!(reference.band("contact_force_x").iter().all(|off| *off == 0.0));
    assert!((value("impulse_x").value - 200.0).abs() < 1e-9);
    assert!(reference.metric("apex").is_err());
}
