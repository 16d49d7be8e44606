//! Writing of figures and pages, and its errors.

use std::fs;
use std::path::{Path, PathBuf};

use carom_record::RecordError;

use crate::figure::Figure;

/// The files of a report.
#[derive(Clone, Debug)]
pub struct ReportSummary {
    /// The page.
    pub page: PathBuf,
    /// The figures' files.
    pub figures: Vec<PathBuf>,
    /// Notes on what could not be shown.
    pub notes: Vec<String>,
}

/// Reasons why a report cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The record cannot be read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The case in the manifest is not one of this version.
    #[error(
        "{}: manifest.json: the stored case cannot be read by this version of Carom: {source}; the record was written by \
         version {version}, whose `carom report` reads it",
        directory.display()
    )]
    Case {
        /// The run directory.
        directory: PathBuf,
        /// Version of Carom that wrote the record.
        version: String,
        /// Error that names the missing or unknown key.
        source: serde_json::Error,
    },
    /// The page or a figure cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The input/output error.
        source: std::io::Error,
    },
}

impl ReportError {
    /// Exit code of the command line: 4 for an input/output error, 2 for a faulty record.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Record(error) => error.exit_code(),
            Self::Case { .. } => 2,
            Self::Write { .. } => 4,
        }
    }
}

/// Writes a file and returns its path.
pub(crate) fn write(path: PathBuf, text: &str) -> Result<PathBuf, ReportError> {
    fs::write(&path, text).map_err(|source| ReportError::Write { path: path.clone(), source })?;
    Ok(path)
}

/// Writes figures with their files and a page into a run or study directory.
pub(crate) fn publish<'a>(
    directory: &Path,
    name: &str,
    page: &str,
    figures: impl IntoIterator<Item = &'a Figure>,
    notes: Vec<String>,
) -> Result<ReportSummary, ReportError> {
    let folder = directory.join("figures");
    fs::create_dir_all(&folder).map_err(|source| ReportError::Write { path: folder.clone(), source })?;
    let mut written = Vec::new();
    for figure in figures {
        let beside = |ending: &str| folder.join(format!("{}.{ending}", figure.name));
        written.push(write(beside("svg"), &figure.svg)?);
        if let Some(table) = &figure.table {
            write(beside("csv"), table)?;
        }
    }
    Ok(ReportSummary { page: write(directory.join(name), page)?, figures: written, notes })
}
