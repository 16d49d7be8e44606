//! Figures and a page from a run directory alone; nothing here runs anything.
//!
//! `report` writes `figures/*.svg` and a self-contained `report.html` beside the record: no request to anywhere, every text that came
//! from a user escaped, one small script for the animation without which, as on paper, the figures remain.

mod animation;
mod axis;
mod bands;
mod bodies;
mod chart;
mod collected;
mod convergence;
mod design;
mod digits;
mod figures;
mod integrity;
mod labels;
mod laboratory;
mod page;
mod palette;
mod pen;
mod plot;
mod ranked;
mod redraw;
mod setup;
mod study;
mod study_page;
mod symbols;
mod text;
mod trace;
mod verdict;
mod verify_page;
mod work;

use std::fs;
use std::path::{Path, PathBuf};

use carom_record::{RecordError, Run};

pub use figures::Figure;
pub use study::study;
pub use verify_page::{verify, verify_markdown};

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

/// Makes figures and page of a run directory, from the record alone.
pub fn report(directory: &Path) -> Result<ReportSummary, ReportError> {
    let run = Run::open(directory)?;
    let figures::Shown { figures, animation, notes } = figures::all(&run);
    let page = page::page(&run, &figures, animation.as_deref(), &notes);
    publish(directory, "report.html", &page, figures.iter().map(|f| (f.name, f.svg.as_str())), notes)
}

/// Writes figures (name, SVG) and a page into a run or study directory.
fn publish<'a>(
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
