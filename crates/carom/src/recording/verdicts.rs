//! A record held against the expectations of its case.

use std::path::Path;

use carom_case::ExpectSpec;
use carom_record::{Manifest, Run, Status};

use super::outcome::RunError;

/// Holds the record against the case's expectations and writes the verdicts into the manifest. A
/// run that stopped is judged only if one of them asks whether it did.
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
