//! The report of a study: its tables, its figures and its page.

mod claims;
mod collected;
mod comparison;
mod convergence;
mod curves;
mod ensemble;
mod fit;
mod histories;
mod numbers;
mod page;
mod ranked;
mod reproduce;
mod settings;
mod theory;
mod trend;
mod verdict;
mod warnings;

use std::path::Path;

use carom_record::metrics;
use carom_record::study::systems::Systems;
use carom_record::study::{Study, StudyManifest};

use crate::figure::Figure;
use crate::plot::Plot;
use crate::publish::{ReportError, ReportSummary, publish};
use crate::recorded::Recorded;
use crate::setup;
use collected::{Column, Measured, Origin, collect};

/// Writes the figures, tables and page of a study directory, from the records alone. Arms are read
/// one by one to limit the memory that long histories need.
///
/// # Errors
/// A file cannot be read or written.
pub fn study(directory: &Path) -> Result<ReportSummary, ReportError> {
    let manifest = StudyManifest::read(directory)?;
    let systems = Systems::of(&manifest);
    let mut measured = Measured(manifest.overlays);
    let mut columns: Vec<Column> = Vec::new();
    let mut time = String::new();
    let mut origins = Vec::new();
    let mut picture = None;
    let study = Study::open(directory, &mut |arm, run| {
        picture = picture.take().or_else(|| {
            let fields = run.field(run.fields.first()?).ok()?;
            setup::figure(&Recorded::new(run.clone()).ok()?, &fields)
        });
        if systems.is_own(arm) {
            run.history.unit("time").clone_into(&mut time);
            measured.add(metrics::overlays(run));
        }
        collect(&mut columns, &measured, arm, run);
        origins.push(Origin::of(arm, run));
    })?;
    study.write_tables()?;
    let mut plots: Vec<Plot> = comparison::plot(&study).into_iter().collect();
    plots.extend(histories::plots(&study, &columns, &measured, &time));
    plots.extend(trend::plots(&study));
    plots.extend(theory::plot(&study));
    // Figures that are folded away come last, so that those shown have successive numbers.
    plots.sort_by_key(|plot| plot.folded);
    let figures: Vec<(bool, Figure)> = plots.iter().map(|plot| (plot.folded, plot.figure())).collect();
    let page = page::page(&study, picture.as_ref(), &figures, &origins);
    let all = picture.iter().chain(figures.iter().map(|(_, figure)| figure));
    publish(directory, "study.html", &page, all, Vec::new())
}
