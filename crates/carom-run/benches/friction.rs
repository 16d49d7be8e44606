//! What friction costs: processor time per Newton iteration of a sliding contact with μ = 0.3 and
//! without friction.
//!
//!     cargo bench -p carom-run --bench friction

#![allow(clippy::print_stdout)]

use std::sync::atomic::AtomicBool;

use carom_record::Source;
use carom_run::case::{Document, read};
use carom_run::recording::run_in_memory;

/// Rounds, alternately without and with friction, of which the fastest counts.
const ROUNDS: usize = 5;
/// Largest ratio.
const BOUND: f64 = 1.3;

/// A block that is pressed on a longer one and slides along it: 3 876 dofs, 33 nodes against 33.
const CASE: &str = r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
young = 1e3
poisson = 0.3
[[body]]
name = "upper"
material = "rubber"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.5], cells = [16, 8] }
velocity = [1.0, 0.0]
[[body]]
name = "lower"
material = "rubber"
element = "T6"
mesh = { shape = "rectangle", min = [-0.5, -0.5], max = [2.0, 0.0], cells = [40, 8] }
[[support]]
on = ["lower.bottom"]
fix = ["x", "y"]
[[contact]]
name = "slide"
secondary = "upper.bottom"
primary = "lower.top"
[[load]]
on = ["upper.top"]
pressure = 5.0
[time]
end = 0.1
step = 1e-3
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
"#;

/// Processor time per Newton iteration, in microseconds.
fn cost(sets: &[String]) -> f64 {
    let case = read(&Document::parse("case.toml", CASE, sets).expect("it is TOML")).expect("it is valid");
    let go = AtomicBool::new(false);
    let (_, record) = run_in_memory(&case, Source::default(), 1, &mut |_| (), &go).expect("it runs");
    let manifest = &record.run.manifest;
    1e6 * manifest.timings["cpu"] / manifest.counters["newton"] as f64
}

fn main() {
    let mut best = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        for (best, sets) in best.iter_mut().zip([vec![], vec!["contact.slide.mu=0.3".to_owned()]]) {
            *best = best.min(cost(&sets));
        }
    }
    let [without, with] = best;
    let ratio = with / without;
    println!("processor time per Newton iteration: {without:.0} µs without friction, {with:.0} µs with it");
    println!("ratio {ratio:.2}, bound {BOUND}");
    std::process::exit(i32::from(ratio > BOUND));
}
