//! Anderson's mixing of corrections with an old tangent.

use carom_algebra::Mixing;
use carom_algebra::mixing::least_squares;

/// y = b − Ay with a contraction of at worst 0.9: with as many directions as unknowns the
/// solution is reached in one more step (Walker, Ni, theorem 2.2); without any, hardly a digit
/// is gained.
#[test]
fn linear_problems_end_after_as_many_steps_as_there_are_unknowns() {
    let old = [[0.9, 0.1, 0.0], [0.0, -0.4, 0.2], [0.1, 0.0, 0.5]];
    let solution = [1.0, -2.0, 3.0];
    for (depth, error) in [(0, 0.1..10.0), (1, 1e-8..1.0), (3, 0.0..1e-13)] {
        let mut mixing = Mixing::default();
        let mut y = [0.0; 3];
        for _ in 0..5 {
            let away: Vec<f64> = y.iter().zip(&solution).map(|(y, s)| s - y).collect();
            let correction: Vec<f64> =
                (0..3).map(|i| away[i] - (0..3).map(|j| old[i][j] * away[j]).sum::<f64>()).collect();
            let mut step = correction.clone();
            let mut multiplier = [2.0 * correction[0]];
            mixing.improve([&mut step, &mut multiplier], depth);
            // Quantities linear in the positions remain so.
            assert!((multiplier[0] - 2.0 * step[0]).abs() < 1e-12);
            y.iter_mut().zip(&step).for_each(|(y, step)| *y += step);
        }
        let left = y.iter().zip(&solution).map(|(y, s)| (y - s).abs()).fold(0.0, f64::max);
        assert!(error.contains(&left), "{depth}: {left:e}");
    }
}

#[test]
fn a_direction_that_repeats_another_is_left_out() {
    let products = [[2.0, 2.0, 1.0], [2.0, 2.0, 1.0], [1.0, 1.0, 5.0]];
    let mut right = [2.0, 2.0, 10.0];
    let mut of_nothing = [0.0];
    least_squares(|i, j| products[i][j], &mut right);
    least_squares(|_, _| 0.0, &mut of_nothing);
    assert_eq!((right, of_nothing), ([0.0, 0.0, 2.0], [0.0]));
}
