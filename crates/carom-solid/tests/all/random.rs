//! Random numbers for tests, all of one type: proptest's runner is compiled for it once.

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

/// Calls a test with so many lists of `count` numbers in −1..1. A list with which it fails is
/// simplified, and printed.
pub(crate) fn lists(cases: u32, count: usize, test: &dyn Fn(&[f64])) {
    let mut runner = TestRunner::new(Config { cases, failure_persistence: None, ..Config::default() });
    let result = runner.run(&prop::collection::vec(-1.0..1.0, count), |list| {
        test(&list);
        Ok(())
    });
    result.unwrap_or_else(|failed| panic!("{failed}"));
}

/// The integer in 0..`end` of a number in −1..1.
pub(crate) fn integer(x: f64, end: usize) -> usize {
    ((0.5 * (x + 1.0) * end as f64) as usize).min(end - 1)
}
