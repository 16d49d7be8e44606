//! Explicit steps of the plane allocate nothing of the size of the bodies: rows and the problem of
//! the pairs alone. A program of its own, because it counts all allocations of the process.

use std::alloc::System;

use carom_run::case::{Document, read};
use carom_run::{GridReport, Setup};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Two discs that collide after some forty steps.
const DISCS: &str = include_str!("../../../cases/disc/head-on.toml");
const SETS: [&str; 7] = [
    "body.upper.mass=lumped",
    "body.upper.mesh.size=0.08",
    "body.upper.mesh.center=[0.0, 1.01]",
    "body.lower.mass=lumped",
    "body.lower.mesh.size=0.08",
    "body.lower.mesh.center=[0.0, -1.01]",
    "time={ end = 0.7, step = 1e-4, scheme = { kind = \"central-difference\" } }",
];

#[test]
fn an_explicit_step_allocates_nothing_of_the_size_of_the_bodies() {
    // Friction's problem of the pairs takes the room of 1.5 vectors on this mesh.
    for (more, vectors) in [(vec![], 1), (vec!["contact.strike.mu=0.3"], 2)] {
        let sets: Vec<String> = SETS.into_iter().chain(more).map(str::to_owned).collect();
        let document = Document::parse("head-on.toml", DISCS, &sets).unwrap();
        let mut simulation = Setup::new(&read(&document).unwrap()).start().unwrap();
        let most = vectors * 8 * simulation.state().y.len();
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
            assert!(counted.bytes_allocated < most, "step {step}, touching: {touches}: {counted:?}, {most}");
        }
        assert!(free > 20 && touching > 20, "{free} steps in free flight, {touching} in contact");
    }
}
