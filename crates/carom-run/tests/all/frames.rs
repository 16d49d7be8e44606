//! Steps at which fields are written.

use carom_run::recording::frames::{Frames, REGULAR, Written};

/// The frames of a run of some steps with contact in a range of them.
fn frames(steps: u64, closed: std::ops::Range<u64>, in_contact: u64) -> Vec<u64> {
    let every = (steps as f64 / REGULAR).round().max(1.0) as u64;
    let mut frames =
        Frames { every, at: Vec::new(), in_contact: Some(in_contact), written: Written::default() };
    (1..=steps).filter(|&step| frames.take(step, step == steps, closed.contains(&step))).collect()
}

#[test]
fn a_short_contact_has_twenty_frames() {
    let found = frames(10_000, 4001..4241, 10);
    assert!(found.iter().filter(|step| (4001..4241).contains(*step)).count() >= 20);
    assert_eq!(found.iter().find(|step| **step > 4000), Some(&4010));
    assert!(found.len() < 120, "{}", found.len());
}

#[test]
fn a_million_steps_in_contact_have_few_frames() {
    let found = frames(1_000_000, 1..1_000_001, 100);
    assert!((100..=155).contains(&found.len()), "{}", found.len());
}

#[test]
fn a_short_run_writes_every_step() {
    assert_eq!(frames(60, 10..20, 1).len(), 60);
}
