//! A finished record held against the expectations of its case.

use std::path::Path;

use carom_record::{Manifest, Run};

use super::session::RunError;
use crate::case::{Bound, ExpectSpec};

/// Holds the record against the case's expectations and writes the verdicts into the manifest.
pub(super) fn judge(directory: &Path, expects: &[ExpectSpec], mut manifest: Manifest) -> Result<(), RunError> {
    if expects.is_empty() {
        return Ok(());
    }
    let run = Run::open(directory)?;
    manifest.expectations = expects.iter().map(|expect| verdict(&run, expect)).collect();
    Ok(manifest.replace(directory)?)
}

fn verdict(run: &Run, expect: &ExpectSpec) -> carom_record::Expectation {
    let got = carom_record::evaluate(&run.history, &expect.what).ok();
    let (expected, holds): (String, Box<dyn Fn(f64) -> bool>) = match expect.bound {
        Bound::Near { value, tolerance } => {
            (format!("{value} ± {tolerance}"), Box::new(move |x| (x - value).abs() <= tolerance))
        }
        Bound::Relative { value, relative } => (
            format!("{value} ± {} %", relative * 100.0),
            Box::new(move |x| (x - value).abs() <= relative * value.abs()),
        ),
        Bound::AtMost(most) => (format!("≤ {most}"), Box::new(move |x| x <= most)),
        Bound::AtLeast(least) => (format!("≥ {least}"), Box::new(move |x| x >= least)),
    };
    carom_record::Expectation {
        what: expect.what.clone(),
        expected,
        got,
        pass: got.is_some_and(holds),
        source: expect.source.clone(),
    }
}
