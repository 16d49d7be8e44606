//! Figures and HTML pages from records alone; nothing here runs a simulation.
//!
//! [`report`] writes `figures/*.svg` and `report.html` into a run directory, [`study()`] does the
//! same for a study and [`verify`] for a verification. The pages are self-contained: they make no
//! network request, and all text from the user is escaped. One small script plays the animation of
//! a run; without it, and in print, the figures remain.

mod again;
mod animation;
mod arc;
mod asked;
mod axis;
mod bands;
mod bars;
mod bodies;
mod chart;
mod digits;
mod document;
mod energy;
mod expectations;
mod figure;
mod figures;
mod instants;
mod labels;
mod measured;
mod noise;
mod obstacles;
mod ordered;
mod over_time;
mod overlap;
mod page;
mod palette;
mod pen;
mod place;
mod plot;
mod pressure;
mod publish;
mod quantity;
mod recorded;
mod results;
mod scientific;
mod setup;
mod sheet;
mod space;
mod stacked;
mod stick_slip;
mod stopped;
mod study;
mod symbols;
mod tables;
mod text;
mod timing;
mod trace;
mod unshown;
mod values;
mod verify_page;

use std::path::Path;

use carom_record::Run;

pub use overlap::overlap;
use publish::publish;
pub use publish::{ReportError, ReportSummary};
pub use study::study;
pub use verify_page::{verify, verify_markdown};

/// Writes the figures and the page of a run directory, from its record alone.
pub fn report(directory: &Path) -> Result<ReportSummary, ReportError> {
    let run = Run::open(directory)?;
    let figures::Shown { figures, animation, notes } = figures::all(&run);
    let page = page::page(&run, &figures, animation.as_ref(), &notes);
    publish(directory, "report.html", &page, &figures, notes)
}
