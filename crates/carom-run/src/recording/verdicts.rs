//! Comparison of a record with the expectations of its case.

use carom_case::ExpectSpec;
use carom_record::{Run, Status};

/// Adds the verdicts on a record to its manifest; returns whether there are any. A stopped run is
/// judged only if one of its expectations concerns stopping.
pub(super) fn judge(run: &mut Run, expects: &[ExpectSpec]) -> bool {
    let is_judged =
        run.manifest.status == Status::Finished || expects.iter().any(ExpectSpec::asks_whether_stopped);
    if expects.is_empty() || !is_judged {
        return false;
    }
    run.manifest.expectations = carom_record::judge(run, expects);
    true
}
