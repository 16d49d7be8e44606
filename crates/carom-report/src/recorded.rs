//! A run with its case as typed facts.

use std::ops::Deref;

use carom_case::Case;
use carom_record::Run;

use crate::publish::ReportError;

/// A run, and the case that its manifest stores.
pub(crate) struct Recorded {
    run: Run,
    pub(crate) case: Case,
}

impl Deref for Recorded {
    type Target = Run;

    fn deref(&self) -> &Run {
        &self.run
    }
}

impl Recorded {
    /// Reads the case of a record.
    pub(crate) fn new(run: Run) -> Result<Self, ReportError> {
        let case = Case::from_json(run.manifest.case.clone()).map_err(|source| {
            let version = run.manifest.version.clone();
            ReportError::Case { directory: run.directory.clone(), version, source }
        })?;
        Ok(Self { run, case })
    }
}
