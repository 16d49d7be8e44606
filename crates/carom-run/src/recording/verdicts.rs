//! Comparison of a record with the expectations of its case.

use carom_case::ExpectSpec;
use carom_record::{Manifest, Run, Status};

/// The manifest with the verdicts on the record, if there are any. A stopped run is judged only if
/// one of its expectations concerns stopping.
pub(super) fn judged(mut run: Run, expects: &[ExpectSpec]) -> Option<Manifest> {
    let judged =
        run.manifest.status == Status::Finished || expects.iter().any(ExpectSpec::asks_whether_stopped);
    if expects.is_empty() || !judged {
        return None;
    }
    run.manifest.expectations = carom_record::judge(&run, expects);
    Some(run.manifest)
}
