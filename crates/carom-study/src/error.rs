//! Errors of studies.

use std::path::{Path, PathBuf};

use carom_record::RecordError;
use carom_record::study::Arm;
use carom_run::case::gibibytes;
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
        /// Name of the arm.
        arm: String,
        /// Error of the run.
        source: RunError,
    },
    /// The record of an arm is damaged.
    #[error("the record of arm \"{arm}\" cannot be used: {what}")]
    Damaged {
        /// Name of the arm.
        arm: String,
        /// Directory of the run.
        place: PathBuf,
        /// Description of the damage.
        what: String,
    },
    /// `study.json` has a case that this version cannot read.
    #[error("the case of arm \"{arm}\" is not compatible with this version of Carom: {what}")]
    Incompatible {
        /// Name of the arm.
        arm: String,
        /// Message of the reader: the part of the case that it cannot read.
        what: String,
    },
    /// The steps of some arms are not known before other runs.
    #[error(
        "arm \"{arm}\" has a step of matched cost, which trial runs find; they must be made before runs are \
         computed one by one"
    )]
    Unsettled {
        /// Name of the arm.
        arm: String,
    },
    /// The concurrent runs do not fit into the memory together.
    #[error("{what} need about {}, and {} are available", gibibytes(*need), gibibytes(*available))]
    Memory {
        /// Runs that were to be computed at once.
        what: String,
        /// Bytes that they need.
        need: f64,
        /// Bytes that are available.
        available: f64,
        /// Number of concurrent runs that fit; none if fewer runs are no remedy.
        fitting: Option<usize>,
    },
    /// The study has no run with this number.
    #[error("the study in {} has no run {number}: its runs are 1 to {count}", directory.display())]
    NoRun {
        /// Directory of the study.
        directory: PathBuf,
        /// The number asked for, from 1.
        number: usize,
        /// Number of runs of the study.
        count: usize,
    },
    /// The directory exists already.
    #[error("{} exists already; a study never overwrites a directory", path.display())]
    Exists {
        /// Path of the directory.
        path: PathBuf,
    },
}

impl StudyError {
    /// Suggested remedy; none if the message of the cause contains it.
    pub fn cure(&self) -> Option<String> {
        Some(match self {
            Self::Record(error) => return error.cure(),
            Self::Arm { .. } => return None,
            Self::Damaged { place, .. } => format!("remove {} and compute the arm again", place.display()),
            Self::Unsettled { .. } => {
                "plan it with `carom study plan --settle`, which finds these steps there and then, compute it \
                 in one process (in Python without `client`), or give the arms their steps"
                    .to_owned()
            }
            Self::NoRun { .. } => "give one of these numbers".to_owned(),
            Self::Memory { fitting: Some(jobs), .. } => format!("use --jobs {jobs}"),
            Self::Memory { fitting: None, .. } => {
                "use coarser meshes, or give the process more memory".to_owned()
            }
            Self::Incompatible { .. } | Self::Exists { .. } => {
                "run the study again, into another directory".to_owned()
            }
        })
    }

    /// An error of the record of an arm, with the directory that can be removed.
    pub(crate) fn of_record(arm: &Arm, study: &Path, error: RecordError) -> Self {
        match error {
            error @ (RecordError::Io { .. } | RecordError::Busy { .. } | RecordError::Exists { .. }) => {
                Self::Arm { arm: arm.name.clone(), source: error.into() }
            }
            error => {
                Self::Damaged { arm: arm.name.clone(), place: study.join(&arm.directory), what: error.what() }
            }
        }
    }
}
