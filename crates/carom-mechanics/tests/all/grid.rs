//! The grid of times: its steps fill the interval, with and without a phase.

use carom_mechanics::Grid;

/// 200 steps from 0 to 0.75; a shifted grid has one more.
fn grid(phase: f64) -> Grid {
    Grid { dt: 3.75e-3, steps: 200 + u64::from(phase > 0.0), phase, guard: None, floor: 0.0 }
}

#[test]
fn steps_fill_the_interval() {
    for phase in [0.0, 0.2, 0.5, 0.7] {
        let grid = grid(phase);
        let mut sum = 0.0;
        for step in 1..=grid.steps {
            sum += grid.length(step);
            assert!((grid.time(step) - sum).abs() < 1e-12, "{phase} {step}");
        }
        assert!(grid.time(0) == 0.0 && (sum - 0.75).abs() < 1e-12, "{phase}: {sum}");
    }
}

#[test]
fn the_nearest_step() {
    for phase in [0.0, 0.2, 0.3, 0.5, 0.7, 0.95] {
        let grid = grid(phase);
        for k in 0..=1000_u32 {
            let time = 0.75 * f64::from(k) / 1000.0;
            let away = |step: u64| (grid.time(step) - time).abs();
            let least = (0..=grid.steps).map(away).fold(f64::INFINITY, f64::min);
            assert!(away(grid.nearest(time)) <= least + 1e-12, "{phase} {time}: {}", grid.nearest(time));
        }
    }
    // The last step, shorter than half of one, ends at the end.
    assert_eq!([grid(0.3).nearest(0.75), grid(0.3).nearest(0.748), grid(0.0).nearest(0.75)], [201, 200, 200]);
}
