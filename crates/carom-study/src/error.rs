//! Errors of studies.

use std::path::PathBuf;

use carom_record::RecordError;
use carom_run::recording::RunError;

/// Why a study cannot continue.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A record cannot be written or read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// An arm cannot be computed, for a reason other than a failure of the simulation.
    #[error("arm \"{arm}\": {source}")]
    Arm {
        /// Its name.
        arm: String,
        /// Why.
        source: RunError,
    },
    /// `study.json` has a case that this version cannot read.
    #[error("the case of arm \"{arm}\" is not compatible with this version of Carom: {what}")]
    Incompatible {
        /// The arm.
        arm: String,
        /// What is not compatible.
        what: String,
    },
    /// The directory exists.
    #[error("{} exists already; a study never overwrites a directory", path.display())]
    Exists {
        /// The directory.
        path: PathBuf,
    },
}
