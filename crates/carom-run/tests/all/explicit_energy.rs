//! The energy of central differences: the guard lets a stable run pass, whose energy oscillates
//! with the size of the step, and stops one that its own deformation makes unstable.

use carom_run::{GridReport, Stopped};

use super::common::simulation;

fn column(law: &str, rest: &str) -> String {
    format!(
        r#"
dimension = 1
material = [{{ name = "m", law = "{law}", density = 1.0, lambda = 0.0, mu = 50.0 }}]
[[body]]
name = "bar"
material = "m"
element = "L2"
mesh = {{ shape = "interval", min = 0.0, max = 1.0, cells = 20 }}
mass = "lumped"
velocity = ["if(X > 0.5, -3, 0)"]
[[support]]
on = ["bar.left"]
fix = ["x"]
[time]
end = 2.0
step = 0.004
scheme = {{ kind = "central-difference" }}
{rest}
"#
    )
}

/// Against the recursion m (y₊ − 2 y + y₋)/Δt² = −K (y − X) of a linear bar from its start, at 0.8
/// of the stable step, with the guard as it is by default.
#[test]
fn a_stable_linear_bar_is_not_damped() {
    let mut sim = simulation(&column("linear-elastic", ""), &[""; 0]);
    let (n, dt, stiffness) = (21, 0.004, 100.0 * 20.0);
    let mass: Vec<f64> = (0..n).map(|i| if i == n - 1 { 0.025 } else { 0.05 }).collect();
    let speed = |i: usize| if i > 10 { -3.0 } else { 0.0 };
    let mut u = vec![0.0; n];
    // Without forces at the start, v at the half step is that at the start.
    let mut half: Vec<f64> = (0..n).map(speed).collect();
    let mut report = GridReport::default();
    while !sim.finished() {
        sim.advance(&mut report).unwrap();
        (0..n).for_each(|i| u[i] += dt * half[i]);
        let force = |i: usize| {
            let right = if i + 1 < n { u[i + 1] - u[i] } else { 0.0 };
            stiffness * (right - (u[i] - u[i - 1]))
        };
        (1..n).for_each(|i| half[i] += dt * force(i) / mass[i]);
    }
    assert_eq!(report.rejected, 0);
    let worst =
        (0..n).map(|i| (sim.state().y[i] - sim.model().reference[i] - u[i]).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-12, "{worst:e}");
    let ledger = &sim.state().ledger;
    assert!(ledger.created.most() < 1e-12 * ledger.scale(), "{:e}", ledger.created.most());
}

/// dP/dλ = μ (1 + λ⁻²) of a column with Λ = 0 that is pressed by P = −0.06 t: the stable step falls
/// from 0.05 to 0.04 where λ⁻² is 2.125, at t = 5.8, and the run stops soon after that.
#[test]
fn a_run_that_its_compression_makes_unstable_stops() {
    let load = "[[load]]\non = [\"bar.right\"]\ntraction = [\"-0.06*min(t, 20)\"]";
    let sets = ["material.m.mu=0.5", "body.bar.velocity=[0.0]", "time.step=0.04", "time.end=60.0"];
    let mut sim = simulation(&column("neo-hookean", load), &sets);
    let stopped = loop {
        assert!(!sim.finished());
        if let Err(stopped) = sim.advance(&mut GridReport::default()) {
            break stopped;
        }
    };
    let Stopped::EnergyGuard { time, .. } = stopped else { panic!("{stopped}") };
    assert!((5.8..7.5).contains(&time), "{stopped}");
    // With half of the step it stands; P = μ (λ − 1/λ).
    let half = [&sets[..2], &["time.step=0.02", "time.end=30.0"]].concat();
    let mut sim = simulation(&column("neo-hookean", load), &half);
    let mut least = f64::INFINITY;
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        let y = &sim.state().y;
        least = least.min(20.0 * (y[20] - y[19]));
    }
    let stretch: f64 = (-1.2 + 1.2_f64.hypot(1.0)) / 1.0;
    assert!((least / stretch - 1.0).abs() < 0.05, "{least} {stretch}");
}
