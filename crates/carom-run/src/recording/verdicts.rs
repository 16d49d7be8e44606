//! Comparison of a record with the expectations of its case.

use carom_case::ExpectSpec;
use carom_record::{Run, Status};

use super::outcome::RunError;

/// Compares the record with the case's expectations and writes the verdicts into the manifest. A
/// stopped run is judged only if one of them concerns stopping.
pub(super) fn judge(mut run: Run, expects: &[ExpectSpec]) -> Result<(), RunError> {
    let judged =
        run.manifest.status == Status::Finished || expects.iter().any(ExpectSpec::asks_whether_stopped);
    if expects.is_empty() || !judged {
        return Ok(());
    }
    run.manifest.expectations = carom_record::judge(&run, expects);
    Ok(run.manifest.replace(&run.directory)?)
}
