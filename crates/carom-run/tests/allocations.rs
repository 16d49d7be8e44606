//! Explicit steps of the plane allocate nothing of the size of the bodies: rows and the problem of
//! the pairs alone. A program of its own, because it counts all allocations of the process.

use std::alloc::System;

use carom_run::case::{Document, read};
use carom_run::{GridReport, Setup};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Two discs that approach each other, 4214 unknowns each.
const DISCS: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 20.0, mu = 15.0 }]
contact = [{ name = "strike", secondary = "left.arc", primary = "right.arc" }]
time = { end = 1.0, step = 2e-4, scheme = { kind = "central-difference" } }
[[body]]
name = "left"
material = "rubber"
element = "T6"
mass = "lumped"
mesh = { shape = "disc", radius = 0.5, center = [-0.51, 0.0], size = 0.04 }
velocity = [1.0, 0.0]
[[body]]
name = "right"
material = "rubber"
element = "T6"
mass = "lumped"
mesh = { shape = "disc", radius = 0.5, center = [0.51, 0.0], size = 0.04 }
velocity = [-1.0, 0.0]
"#;

#[test]
fn an_explicit_step_allocates_nothing_of_the_size_of_the_bodies() {
    let document = Document::parse("case.toml", DISCS, &[]).unwrap();
    let mut simulation = Setup::new(&read(&document).unwrap()).start().unwrap();
    let vector = 8 * simulation.state().y.len();
    let mut report = GridReport::default();
    let (mut free, mut touching) = (0, 0);
    for step in 0..250 {
        report.events.clear();
        let region = Region::new(COUNTED);
        simulation.advance(&mut report).unwrap();
        let counted = region.change();
        // Buffers grow in the first steps, and where contact changes; events are texts.
        if step < 3 || !report.events.is_empty() {
            continue;
        }
        let touches = simulation.state().pairs.iter().flatten().any(|pair| pair.active);
        (free, touching) = (free + usize::from(!touches), touching + usize::from(touches));
        assert!(counted.bytes_allocated < vector, "step {step}, touching: {touches}: {counted:?}, {vector}");
    }
    assert!(free > 20 && touching > 20, "{free} steps in free flight, {touching} in contact");
}
