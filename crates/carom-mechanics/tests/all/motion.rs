//! Motions that are prescribed, against differences of their displacements.

use carom_formula::Formula;
use carom_mechanics::model::{Motion, Motions, Turn};

/// Lengths are kept, and velocities and accelerations are the differences of displacements.
#[test]
fn a_turn_is_rigid_and_its_derivatives_are_those_of_differences() {
    let read = |text: &str| Formula::parse(text, &["X", "Y", "Z", "t"]).unwrap();
    let turn = Turn {
        label: "the cam".to_owned(),
        moves: vec![Some(read("0.1*t")), None, Some(read("t^2"))],
        angle: read("90*t^2"),
        centre: vec![0.3, -0.2, 0.1],
        axis: [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0],
    };
    let places = [vec![1.0, 0.5, -0.3], vec![-0.4, 0.9, 0.2]];
    let moved = (0..6).map(|dof| (dof, 0, places[dof / 3].clone()));
    let motions = Motions::new(vec![Motion::Rigid(turn)], moved);
    let at = |time: f64| {
        let mut out = Vec::new();
        motions.at(time, &mut out).unwrap();
        out
    };
    let now = at(0.7);
    let y = |i: usize| places[i / 3][i % 3] + now[i].motion[0];
    let apart = |f: &dyn Fn(usize) -> f64| (0..3).map(|i| (f(i) - f(i + 3)).powi(2)).sum::<f64>();
    assert!((apart(&y) - apart(&|i| places[i / 3][i % 3])).abs() < 1e-14);
    let h = 1e-4;
    let [before, after] = [at(0.7 - h), at(0.7 + h)];
    for i in 0..6 {
        let [u, v, a] = now[i].motion;
        let [low, high] = [before[i].motion[0], after[i].motion[0]];
        assert!(((high - low) / (2.0 * h) - v).abs() < 1e-6, "{i}");
        assert!(((high - 2.0 * u + low) / (h * h) - a).abs() < 1e-5, "{i}");
    }
}
