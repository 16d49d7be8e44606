//! Why a study cannot go on.

use std::path::PathBuf;

use carom_record::RecordError;
use carom_run::recording::RunError;

/// Why a study cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A record cannot be written or read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// An arm cannot be computed for a reason that is not its numbers.
    #[error("arm \"{arm}\": {source}")]
    Arm {
        /// Its name.
        arm: String,
        /// Why.
        source: RunError,
    },
    /// `study.json` holds a case this version cannot read.
    #[error("the case of arm \"{arm}\" does not fit this version of Carom: {what}")]
    Incompatible {
        /// The arm.
        arm: String,
        /// What does not fit.
        what: String,
    },
    /// The directory exists.
    #[error("{} exists already, and a study never overwrites", path.display())]
    Exists {
        /// The directory.
        path: PathBuf,
    },
}
