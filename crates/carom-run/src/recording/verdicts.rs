//! Comparison of a record with the expectations of its case.

use std::path::Path;

use carom_case::ExpectSpec;
use carom_record::{Manifest, Run, Status};

use super::outcome::RunError;

/// Compares the record with the case's expectations and writes the verdicts into the manifest. A
/// stopped run is judged only if one of them concerns stopping.
pub(super) fn judge(
    directory: &Path,
    expects: &[ExpectSpec],
    mut manifest: Manifest,
) -> Result<(), RunError> {
    let judged = manifest.status == Status::Finished || expects.iter().any(ExpectSpec::asks_whether_stopped);
    if expects.is_empty() || !judged {
        return Ok(());
    }
    let run = Run::open(directory)?;
    manifest.expectations = carom_record::judge(&run, expects);
    Ok(manifest.replace(directory)?)
}
