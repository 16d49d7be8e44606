//! Figures and HTML pages from records alone; nothing here runs a simulation.
//!
//! [`report`] writes `figures/*.svg` and `report.html` into a run directory, [`study()`] does the
//! same for a study and [`verify`] for a verification. The pages are self-contained: they make no
//! network request, and all text from the user is escaped. A small script plays the animation of a
//! run and shows the values of its histories; without it, and in print, the figures remain.

mod again;
mod arc;
mod asked;
mod axis;
mod bands;
mod bars;
mod bodies;
mod chart;
mod digits;
mod document;
mod expectations;
mod figure;
mod figures;
mod headline;
mod histories;
mod instants;
mod labels;
mod made;
mod maps;
mod measured;
mod noise;
mod obstacles;
mod ordered;
mod overlap;
mod page;
mod palette;
mod pen;
mod place;
mod plot;
mod publish;
mod recorded;
mod results;
mod scene;
mod scientific;
mod setup;
mod sheet;
mod space;
mod stacked;
mod stopped;
mod study;
mod symbols;
mod tables;
mod text;
mod trace;
mod verify_page;

use std::path::Path;

pub use overlap::overlap;
use publish::publish;
pub use publish::{ReportError, ReportSummary};
use recorded::Recorded;
pub use study::study;
pub use verify_page::{verify, verify_markdown};

/// Writes the figures and the page of a run directory, from its record alone.
pub fn report(directory: &Path) -> Result<ReportSummary, ReportError> {
    let run = Recorded::open(directory)?;
    let shown = figures::all(&run);
    let page = page::page(&run, &shown);
    publish(directory, "report.html", &page, &shown.figures, shown.notes)
}
