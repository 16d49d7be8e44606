//! Figures and a page put on disk, and why they cannot be.

use std::fs;
use std::path::{Path, PathBuf};

use carom_record::RecordError;

/// What a report consists of.
#[derive(Clone, Debug)]
pub struct ReportSummary {
    /// The page.
    pub page: PathBuf,
    /// The figures' files.
    pub figures: Vec<PathBuf>,
    /// What could not be shown, and why.
    pub notes: Vec<String>,
}

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The record cannot be read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The page or a figure cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// Which file.
        path: PathBuf,
        /// The system's answer.
        source: std::io::Error,
    },
}

impl ReportError {
    /// Exit code of the command line: 4 when the machine refused, 2 when the record is at fault.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Record(error) => error.exit_code(),
            Self::Write { .. } => 4,
        }
    }
}

/// Writes figures (name, SVG) and a page into a run or study directory.
pub(crate) fn publish<'a>(
    directory: &Path,
    name: &str,
    page: &str,
    figures: impl Iterator<Item = (&'a str, &'a str)>,
    notes: Vec<String>,
) -> Result<ReportSummary, ReportError> {
    let write = |path: PathBuf, text: &str| match fs::write(&path, text) {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Write { path, source }),
    };
    let folder = directory.join("figures");
    fs::create_dir_all(&folder).map_err(|source| ReportError::Write { path: folder.clone(), source })?;
    let written = figures.map(|(name, svg)| write(folder.join(format!("{name}.svg")), svg));
    let written = written.collect::<Result<Vec<_>, _>>()?;
    Ok(ReportSummary { page: write(directory.join(name), page)?, figures: written, notes })
}
