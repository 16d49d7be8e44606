//! Figures and a page from a run directory alone; nothing here runs anything.
//!
//! `report` writes `figures/*.svg` and a self-contained `report.html` beside the record: no request
//! to anywhere, every text that came from a user escaped, one small script for the animation
//! without which, as on paper, the figures remain.

mod animation;
mod axis;
mod bands;
mod bodies;
mod chart;
mod collected;
mod convergence;
mod design;
mod digits;
mod document;
mod figures;
mod integrity;
mod labels;
mod laboratory;
mod page;
mod palette;
mod pen;
mod plot;
mod publish;
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

use std::path::Path;

use carom_record::Run;

pub use figures::Figure;
use publish::publish;
pub use publish::{ReportError, ReportSummary};
pub use study::study;
pub use verify_page::{verify, verify_markdown};

/// Makes figures and page of a run directory, from the record alone.
pub fn report(directory: &Path) -> Result<ReportSummary, ReportError> {
    let run = Run::open(directory)?;
    let figures::Shown { figures, animation, notes } = figures::all(&run);
    let page = page::page(&run, &figures, animation.as_ref(), &notes);
    publish(directory, "report.html", &page, figures.iter().map(|f| (f.name, f.svg.as_str())), notes)
}
