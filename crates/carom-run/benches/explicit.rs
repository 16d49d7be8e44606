//! Explicit steps in space beside what the machine allows: nanoseconds per cell and step of a block
//! of Tet4 cells and one of Hex8 cells with mean dilatation, with one thread and two, and two lower
//! bounds that are measured in the same run:
//!
//! ```text
//! memory      what any code moves per step: y and v of the nodes, read and written, 1/m, and per cell
//!             its nodes, ∂ξ/∂X and volume, at the bandwidth of a triad
//! arithmetic  the forces of the law alone (`explicit/bare.rs`), for cells that stay in the cache
//! ```
//!
//!     cargo bench -p carom-run --bench explicit                on an idle machine
//!     cargo bench -p carom-run --bench explicit -- floors      the bounds of Tet4 cells alone

#![allow(clippy::print_stdout)]

#[path = "explicit/bare.rs"]
mod bare;

use std::hint::black_box;
use std::time::Instant;

use carom_run::case::{Document, read};
use carom_run::{GridReport, Setup, Simulation};

/// Rounds of which the fastest counts.
const ROUNDS: usize = 4;
/// Steps of a round, after as many that warm up.
const STEPS: usize = 10;
/// Largest time of a step with one thread, in bounds.
const WITHIN: f64 = 3.0;
/// Smallest speed-up with two threads.
const SPEED_UP: f64 = 1.6;
/// Bytes per node: y and v read and written, 1/m read.
const PER_NODE: f64 = 8.0 * (4.0 * 3.0 + 1.0);
/// Doubles of each array of the triad: 64 MiB.
const TRIAD: usize = 1 << 23;

const CASE: &str = r#"
dimension = 3
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
time = { end = 1.0, step = 2e-5, scheme = { kind = "central-difference" } }
[[body]]
name = "block"
material = "rubber"
element = "Tet4"
mass = "lumped"
mesh = { shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0], cells = [24, 24, 24] }
velocity = ["0.5*Z*sin(2*Y)", "0", "-3*Z"]
"#;

/// The bandwidth of a = b + s c in bytes per second, with the lines of a that are read before they
/// are written.
fn bandwidth() -> f64 {
    let (mut a, b, c) = (vec![0.0; TRIAD], vec![1.0; TRIAD], vec![2.0; TRIAD]);
    let round = |a: &mut [f64]| {
        let begin = Instant::now();
        for ((a, b), c) in a.iter_mut().zip(&b).zip(&c) {
            *a = b + 3.0 * c;
        }
        black_box(&a);
        begin.elapsed().as_secs_f64()
    };
    let fastest = (0..ROUNDS).map(|_| round(black_box(&mut a))).fold(f64::INFINITY, f64::min);
    4.0 * 8.0 * TRIAD as f64 / fastest
}

fn simulation(sets: &[String], threads: usize) -> Simulation {
    let case = read(&Document::parse("case.toml", CASE, sets).expect("it is TOML")).expect("it is valid");
    Setup::new(&case).threads(threads).start().expect("it starts")
}

/// Seconds of a step.
fn step(simulation: &mut Simulation) -> f64 {
    let begin = Instant::now();
    for _ in 0..STEPS {
        simulation.advance(&mut GridReport::default()).expect("it runs");
    }
    begin.elapsed().as_secs_f64() / STEPS as f64
}

/// A line of the table; whether both bounds are met.
fn measure(name: &str, sets: &[&str], bare: f64, bandwidth: f64) -> bool {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let mut runs = [1, 2].map(|threads| simulation(&sets, threads));
    let mesh = runs[0].model().parts[0].body.mesh().clone();
    let (cells, nodes) = (mesh.cell_count() as f64, mesh.nodes.len() as f64);
    for run in &mut runs {
        step(run);
    }
    let mut best = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        for (best, run) in best.iter_mut().zip(&mut runs) {
            *best = best.min(step(run));
        }
    }
    let [one, two] = best.map(|seconds| 1e9 * seconds / cells);
    let bytes = bytes(nodes / cells, mesh.element.nodes());
    let memory = 1e9 * bytes / bandwidth;
    let floor = memory.max(bare);
    let (times, speed_up) = (one / floor, one / two);
    println!("{name}: {cells} cells, {nodes} nodes");
    println!(
        "  step    {one:6.1} ns per cell with one thread, {two:.1} with two: {speed_up:.2} times as fast"
    );
    println!("  memory  {memory:6.1} ns per cell for {bytes:.0} bytes; arithmetic {bare:.1} ns");
    let met = times <= WITHIN && speed_up >= SPEED_UP;
    let word = if met { "met" } else { "missed" };
    println!("  {times:.2} times the larger bound (at most {WITHIN}), speed-up at least {SPEED_UP}: {word}");
    met
}

/// Bytes per cell that any code moves in a step.
fn bytes(nodes_per_cell: f64, nodes_of_cell: usize) -> f64 {
    PER_NODE * nodes_per_cell + 4.0 * nodes_of_cell as f64 + 8.0 * 10.0
}

/// The lower bounds of a large block of Tet4 cells, which has a node for six of them.
fn floors(bandwidth: f64) {
    let memory = 1e9 * bytes(1.0 / 6.0, 4) / bandwidth;
    println!("  memory  {memory:6.1} ns per cell; arithmetic {:.1} ns", bare::tetrahedra());
}

fn main() {
    let bandwidth = bandwidth();
    println!("triad: {:.1} GB/s with one thread", 1e-9 * bandwidth);
    if std::env::args().any(|word| word == "floors") {
        floors(bandwidth);
        return;
    }
    let [tetrahedron, hexahedron] = [bare::tetrahedra(), bare::hexahedra()];
    let tetrahedra = measure("Tet4", &[], tetrahedron, bandwidth);
    let sets =
        ["body.block.element=Hex8", "body.block.volumetric=mean", "body.block.mesh.cells=[40, 40, 40]"];
    let hexahedra = measure("Hex8, mean dilatation", &sets, hexahedron, bandwidth);
    std::process::exit(i32::from(!(tetrahedra && hexahedra)));
}
