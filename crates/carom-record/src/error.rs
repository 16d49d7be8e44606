//! Errors of run directories: input/output or system errors, damaged records, and directories that
//! cannot be used.

use std::io;
use std::path::{Path, PathBuf};

/// An error of a run directory; `exit_code` separates system errors from all others.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// Input/output or system error.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The operation.
        action: &'static str,
        /// Path of the file or directory that the operation failed on.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A run directory is never overwritten.
    #[error("{} exists already; a run directory is never overwritten: choose another --out, or `carom resume` it", path.display())]
    Exists {
        /// The directory.
        path: PathBuf,
    },
    /// Another process is writing this run.
    #[error("{} is being written by another process; wait for it or stop it first", path.display())]
    Busy {
        /// The directory.
        path: PathBuf,
    },
    /// No manifest where a run directory was expected.
    #[error("{} is not a run directory: it has no manifest.json", path.display())]
    NotARun {
        /// The directory.
        path: PathBuf,
    },
    /// A file of the record is damaged.
    #[error("{}; {hint}", damage(path, *line, what))]
    Corrupt {
        /// The damaged file.
        path: PathBuf,
        /// Line, counted from 1, in files that have lines.
        line: Option<u64>,
        /// Description of the damage.
        what: String,
        /// Suggested remedy.
        hint: &'static str,
    },
    /// Fields that an earlier version wrote into one file, which is no longer read.
    #[error("{} is of an earlier version, whose fields are no longer read; open it in ParaView, and move it out of the run directory to read the rest of the record", path.display())]
    OneFile {
        /// The file.
        path: PathBuf,
    },
    /// A row does not match the columns of the manifest.
    #[error("a history row has {got} values, but the manifest has {expected} columns")]
    Width {
        /// Values in the row.
        got: usize,
        /// Columns of the manifest.
        expected: usize,
    },
    /// No study where the directory of one was expected.
    #[error("{}", if path.exists() {
        format!("{} is not the directory of a study: it has no study.json", path.display())
    } else {
        format!("there is no directory {}", path.display())
    })]
    NotAStudy {
        /// The directory.
        path: PathBuf,
    },
    /// Lengths inside a field set contradict each other.
    #[error("field set: {what}")]
    Field {
        /// The lengths that contradict each other, with numbers.
        what: String,
    },
}

impl RecordError {
    /// Exit code of the command line: 4 for input/output or system errors, 2 otherwise.
    pub fn exit_code(&self) -> u8 {
        if self.is_system() { 4 } else { 2 }
    }

    /// Whether this is an error of the operating system rather than of the record.
    pub fn is_system(&self) -> bool {
        matches!(self, Self::Io { .. })
    }

    /// Description of the error without its remedy, for records that are a part of something else,
    /// where the remedy may not be possible.
    pub fn what(&self) -> String {
        match self {
            Self::Corrupt { path, line, what, .. } => damage(path, *line, what),
            other => other.to_string(),
        }
    }

    /// Suggested remedy; none if the message contains it, or if it depends on the system.
    pub fn cure(&self) -> Option<String> {
        Some(match self {
            Self::Io { .. }
            | Self::Corrupt { .. }
            | Self::Busy { .. }
            | Self::Exists { .. }
            | Self::OneFile { .. } => return None,
            // A study's.
            Self::NotARun { path } if path.join("study.json").is_file() => {
                format!("give that of one of its runs: they are in {}", path.join("arms").display())
            }
            Self::NotARun { .. } => {
                "give a directory that `carom run` created, for example runs/impact".to_owned()
            }
            Self::NotAStudy { .. } => {
                "give a directory that `carom study` created, for example runs/fair".to_owned()
            }
            Self::Width { .. } | Self::Field { .. } => {
                "run the case again, or continue with carom resume".to_owned()
            }
        })
    }

    /// The input/output error of an action on a file.
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self + use<> {
        let path = path.to_path_buf();
        move |source| Self::Io { action, path, source }
    }

    pub(crate) fn corrupt(
        path: &Path,
        line: Option<u64>,
        what: impl Into<String>,
        hint: &'static str,
    ) -> Self {
        Self::Corrupt { path: path.to_path_buf(), line, what: what.into(), hint }
    }
}

fn damage(path: &Path, line: Option<u64>, what: &str) -> String {
    let line = line.map(|line| format!(":{line}")).unwrap_or_default();
    format!("{}{line} is damaged: {what}", path.display())
}
